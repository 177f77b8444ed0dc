# SPDX-License-Identifier: GPL-3.0-or-later
"""The hidden copy of Fast Viewport is in step with its surface, or what is wrong is named. What is
written does not depend on it.
"""

from collections.abc import Callable

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from bakes import bake
from follow_scenes import check_hair, look
from limit_surface import ids
from limit_surface.placing import tables


def fast(
    add: Callable[[bpy.types.Object], None],
) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Returns a sheet with modifiers, and hair that follows it with Fast Viewport."""
    ob = scenes.flat_grid(4)
    add(ob)
    scenes.add_subsurf(ob)
    hair = scenes.add_hair(ob, per_side=1, follow="NODES")
    scenes.activate(hair)
    assert bpy.ops.object.limit_follow(use_proxy=True) == {"FINISHED"}
    return ob, hair


def add_lattice(ob: bpy.types.Object) -> None:
    lattice = bpy.data.objects.new("Lattice", bpy.data.lattices.new("Lattice"))
    bpy.context.collection.objects.link(lattice)
    lattice.scale = (9, 9, 9)
    lattice.data.points_u = 3
    lattice.data.points[2].co_deform.z += 0.4
    ob.modifiers.new("Lattice", "LATTICE").object = lattice


def add_twist(ob: bpy.types.Object) -> None:
    twist = ob.modifiers.new("Twist", "SIMPLE_DEFORM")
    twist.deform_method, twist.angle = "TWIST", 0.0


def add_slider(ob: bpy.types.Object) -> None:
    add_twist(ob)
    ob["bend"] = 0.0
    driver = ob.modifiers["Twist"].driver_add("angle").driver
    target = driver.variables.new().targets[0]
    driver.type = "SUM"
    target.id, target.data_path = ob, '["bend"]'


def add_action(ob: bpy.types.Object) -> None:
    add_twist(ob)
    ob.modifiers["Twist"].keyframe_insert("angle", frame=1)


def add_keys(ob: bpy.types.Object) -> None:
    ob.shape_key_add(name="Basis")
    up = ob.shape_key_add(name="Up")
    up.value = 0.0  # Blender 5.2 adds keys with the value 1
    for point in up.data:
        point.co.z += 0.5


def move(ob: bpy.types.Object) -> None:
    ob.location.x = 1.0


def parent(ob: bpy.types.Object) -> None:
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.collection.objects.link(empty)
    ob.parent, empty.location.x = empty, 1.0


def slide(ob: bpy.types.Object) -> None:
    ob["bend"] = 1.0
    ob.update_tag()


def act_differently(ob: bpy.types.Object) -> None:
    ob.animation_data.action = bpy.data.actions.new("Other")
    twist = ob.modifiers["Twist"]
    for frame, twist.angle in ((1, 0.0), (10, 1.0)):
        twist.keyframe_insert("angle", frame=frame)
    bpy.context.scene.frame_set(10)


def twist_more(ob: bpy.types.Object) -> None:
    ob.modifiers["Twist"].angle = 1.0


def rename(ob: bpy.types.Object) -> None:
    ob.modifiers["Twist"].name = "Turn"
    ob.modifiers["Turn"].deform_method = "BEND"


def pin(ob: bpy.types.Object) -> None:
    ob.active_shape_key_index, ob.show_only_shape_key = 1, True


def add_another(ob: bpy.types.Object) -> None:
    twist = ob.modifiers.new("More", "SIMPLE_DEFORM")
    twist.deform_method, twist.angle = "TWIST", 1.0
    ob.modifiers.move(len(ob.modifiers) - 1, 0)


def limit_to_a_group(ob: bpy.types.Object) -> None:
    ob.vertex_groups.new(name="Few").add(range(9), 1.0, "REPLACE")
    ob.modifiers["Twist"].vertex_group = "Few"


IN_STEP = {
    "moved": (add_lattice, move),
    "parented": (add_lattice, parent),
    "driven": (add_slider, slide),
    "another action": (add_action, act_differently),
    "another value": (add_twist, twist_more),
    "another name and choice": (add_twist, rename),
}
LEFT_BEHIND = {
    "pinned": (add_keys, pin, "does not show the same shape key alone as Flat"),
    "added": (add_twist, add_another, "has other modifiers than Flat"),
    "group": (add_twist, limit_to_a_group, "has other settings of the modifier Twist than Flat"),
}


@pytest.mark.parametrize("case", IN_STEP)
def test_the_copy_stays_in_step(case):
    add, change = IN_STEP[case]
    ob, hair = fast(add)
    change(ob)
    bpy.context.view_layer.update()
    check_hair(ob, hair)
    assert look(ob) == []


@pytest.mark.parametrize("case", LEFT_BEHIND)
def test_what_is_left_behind_is_named_and_put_right(case):
    add, change, reason = LEFT_BEHIND[case]
    ob, hair = fast(add)
    if case == "group":
        ob.modifiers["Twist"].angle = 1.0
    change(ob)
    bpy.context.view_layer.update()
    with pytest.raises(AssertionError):
        check_hair(ob, hair)
    ((text, remedy),) = look(ob)
    assert text.endswith(f"Limit Proxy of Flat, which Fast Viewport reads, {reason}")
    assert remedy == ids.FOLLOW
    scenes.activate(ob)
    assert bpy.ops.object.limit_follow() == {"FINISHED"}
    check_hair(ob, hair)
    assert look(ob) == []


def test_another_shape_in_this_frame_is_named():
    def add_hook(ob: bpy.types.Object) -> None:
        empty = bpy.data.objects.new("Empty", None)
        bpy.context.collection.objects.link(empty)
        hook = ob.modifiers.new("Hook", "HOOK")
        hook.object = empty
        hook.vertex_indices_set(range(3))
        empty.location.z = 0.5

    ob, hair = fast(add_hook)
    check_hair(ob, hair)
    assert look(ob) == []
    ob.modifiers["Hook"].vertex_indices_set(range(9))
    ob.update_tag()
    bpy.context.view_layer.update()
    ((text, remedy),) = look(ob)
    assert text.endswith("has another shape than Flat in this frame")
    assert remedy == ids.FOLLOW
    scenes.activate(ob)
    assert bpy.ops.object.limit_follow() == {"FINISHED"}
    assert look(ob) == []
    check_hair(ob, hair)


def stale() -> tuple[bpy.types.Object, bpy.types.Object]:
    ob, hair = fast(add_keys)
    pin(ob)
    bpy.context.view_layer.update()
    return ob, hair


def roots_off(ob: bpy.types.Object, roots: np.ndarray, data: bpy.types.ID) -> float:
    """Returns how far roots are from the surface, as a part of its diagonal."""
    now = follow_truth.on_surface(ob, data, np.eye(4))
    return np.abs(roots - now.position).max() / follow_truth.diagonal(ob)


def test_unbinding_reads_the_surface_itself():
    ob, hair = stale()
    scenes.activate(hair)
    assert bpy.ops.object.limit_unbind(shape="SHOWN") == {"FINISHED"}
    roots = scenes.strands(hair)[:, 0]
    assert roots_off(ob, roots, hair.data) < follow_truth.POSITION_BOUND


def test_bakes_read_the_surface_itself(tmp_path):
    ob, hair = stale()
    assert bake(tmp_path, hair.name, frames="1", options=("--format", "npz")) == 0
    with np.load(tmp_path / f"{hair.name}.0001.npz") as cache:
        roots = cache["position"][cache["curve_offsets"][:-1]]
    assert roots_off(ob, roots, hair.data) < follow_truth.POSITION_BOUND
    ((_text, remedy),) = look(ob)  # afterwards the viewport reads the copy again
    assert remedy == ids.FOLLOW


def test_children_read_the_surface_itself():
    def add_slope(ob: bpy.types.Object) -> None:
        ob.shape_key_add(name="Basis")
        for point in ob.shape_key_add(name="Slope").data:
            point.co.z += point.co.x

    ob, hair = fast(add_slope)
    pin(ob)
    scenes.activate(hair)
    assert bpy.ops.object.limit_children_add(
        distribution="JITTERED", per_side=1, follow="NONE"
    ) == {"FINISHED"}
    strands = scenes.strands(bpy.context.active_object)
    along = strands[:, -1] - strands[:, 0]
    along /= np.linalg.norm(along, axis=1)[:, None]
    np.testing.assert_allclose(along, np.tile((-(0.5**0.5), 0, 0.5**0.5), (16, 1)), atol=1e-4)


def test_a_full_copy_does_not_use_the_copy_of_the_original():
    ob, _hair = fast(add_twist)
    bpy.ops.scene.new(type="FULL_COPY")
    other = bpy.context.scene.objects["Flat.001"]
    scenes.activate(other)
    ((text, remedy),) = look(other)
    assert text.endswith("Limit Proxy of Flat, which Fast Viewport reads, is a copy of Flat")
    assert remedy == ids.FOLLOW
    assert bpy.ops.object.limit_follow() == {"FINISHED"}
    assert look(other) == []
    assert {f"{ids.PROXY_OBJECT} of {each.name}" for each in (ob, other)} == {
        each.name for each in bpy.data.objects if each.name.startswith(ids.PROXY_OBJECT)
    }
    assert tables.of_surface(ob) != tables.of_surface(other)
