# SPDX-License-Identifier: GPL-3.0-or-later
"""Ordinary objects that are attached to a deforming surface."""

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import deforming
from limit_surface import ids
from limit_surface.attach import parenting
from limit_surface.nodes import groups
from limit_surface.placing.followers import live_modifier_of, modifier_of
from limit_surface.reading import attributes
from mathutils import Euler, Matrix
from meanwhile_cases import select

FRAMES = ((1, 0.0), (13, 0.5), (30, 0.0))
#: What attaching may change in an object's matrix, in single precision
AXES_BOUND = 1e-5


def add_object(name: str, data: bpy.types.ID | None, world: np.ndarray) -> bpy.types.Object:
    ob = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(ob)
    ob.matrix_world = Matrix(world)
    return ob


def props(ob: bpy.types.Object, count: int = 6, seed: int = 1) -> list[bpy.types.Object]:
    """Adds objects of several types near the mesh, turned and unevenly scaled."""
    rng = np.random.default_rng(seed)
    vertices = attributes.read(ob.data, ids.POSITION)
    near = vertices[rng.permutation(len(vertices))[:count]] + rng.uniform(0, 0.2, (count, 3))
    world = scenes.transformed(ob.matrix_world, near)
    made = []
    for i, at in enumerate(world):
        data = (
            None,
            bpy.data.lights.new("Light", "POINT"),
            bpy.data.meshes.new("Button"),
            bpy.data.cameras.new("Camera"),
        )[i % 4]
        matrix = Matrix.Translation(at) @ Euler(rng.uniform(-3, 3, 3)).to_matrix().to_4x4()
        made.append(add_object(f"Prop {i}", data, matrix @ Matrix.Diagonal((1, 2, 0.5, 1))))
    bpy.context.view_layer.update()
    return made


def attach(ob: bpy.types.Object, objects: list[bpy.types.Object]) -> None:
    select(ob, objects)
    assert bpy.ops.object.limit_attach() == {"FINISHED"}


def matrices(objects: list[bpy.types.Object]) -> np.ndarray:
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return np.array([ob.evaluated_get(depsgraph).matrix_world for ob in objects], np.float64)


def carriers() -> list[bpy.types.Object]:
    return [ob for ob in bpy.data.objects if ids.CARRIER_MARK in ob]


def check(ob: bpy.types.Object, objects: list[bpy.types.Object], before: np.ndarray) -> None:
    """Checks the objects in all frames. `before` holds their matrices when they were attached."""
    (carrier,) = carriers()
    rows = [child.parent_vertices[0] for child in objects]
    rest = follow_truth.rest(carrier.data)
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob) * scale_of(ob)
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        now = follow_truth.on_surface(ob, carrier.data, np.array(ob.matrix_world))
        turn = np.einsum("nij,nkj->nik", now.frame, rest.frame)[rows]
        expected = before.copy()
        expected[:, :3, :3] = turn @ before[:, :3, :3]
        offset = before[:, :3, 3] - rest.position[rows]
        expected[:, :3, 3] = now.position[rows] + np.einsum("nij,nj->ni", turn, offset)
        error = np.abs(matrices(objects) - expected)
        assert error[:, :3, 3].max() < 2 * bound  # the offset from the surface turns with the axes
        assert error[:, :3, :3].max() < follow_truth.FRAME_BOUND


def scale_of(ob: bpy.types.Object) -> float:
    return max(1.0, float(np.abs(np.array(ob.matrix_world)[:3, :3]).max()))


@pytest.mark.every(3)
@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("scene", scenes.SCENES)
def test_objects_follow(scene, mirrored):
    ob = deforming(scene, mirrored)
    objects = props(ob)
    before, own = matrices(objects), [child.matrix_basis.copy() for child in objects]
    attach(ob, objects)
    assert np.abs(matrices(objects) - before).max() < AXES_BOUND
    assert [child.matrix_basis for child in objects] == own
    check(ob, objects, before)


def test_places_are_the_closest_ones():
    ob = deforming("grid with holes")
    objects = props(ob)
    attach(ob, objects)
    surface = scenes.surface_without_addon(ob)
    surface.set_positions(scenes.transformed(ob.matrix_world, surface.positions))
    origins = matrices(objects)[:, :3, 3]
    (carrier,) = carriers()
    face, uv = scenes.locations(carrier.data)
    rows = [child.parent_vertices[0] for child in objects]
    own = np.linalg.norm(surface.evaluate(face, uv).position[rows] - origins, axis=1)
    # Places at corners keep a distance of 2^-12 of a face from them.
    np.testing.assert_allclose(own, surface.closest(origins).distance, atol=1e-3)


def test_more_objects_extend_the_carrier():
    ob = deforming("cross")
    first = props(ob, 4)
    before = matrices(first)
    attach(ob, first)
    bpy.context.scene.frame_set(9)
    second = props(ob, 3, seed=7)
    later = matrices(second)
    attach(ob, second)
    (carrier,) = carriers()
    assert len(carrier.data.vertices) == 3 * 7
    assert carrier.hide_viewport
    assert carrier.hide_render
    assert len([o for o in bpy.data.objects if o.name.startswith(ids.TILES_TABLE)]) == 1
    check(ob, first, before)
    check(ob, second, later)


def test_the_surface_may_move_and_change_its_scale():
    ob = deforming("cross")
    ob.keyframe_insert("scale", frame=1)
    ob.keyframe_insert("rotation_euler", frame=1)
    ob.scale, ob.rotation_euler = (2, 0.6, 1), (1, 0, 2)
    ob.keyframe_insert("scale", frame=30)
    ob.keyframe_insert("rotation_euler", frame=30)
    bpy.context.scene.frame_set(1)
    objects = props(ob)
    before = matrices(objects)
    attach(ob, objects)
    check(ob, objects, before)


def test_animated_and_constrained_objects_keep_their_own_motion():
    ob = deforming("cross")
    moving, held = props(ob, 2)
    moving.keyframe_insert("location", frame=1)
    moving.location.z += 1
    moving.keyframe_insert("location", frame=30)
    held.delta_location = (0.1, 0, 0)
    held.constraints.new("LIMIT_SCALE").use_max_x = True
    bpy.context.scene.frame_set(1)
    before = matrices([moving, held])
    attach(ob, [moving, held])
    assert np.abs(matrices([moving, held]) - before).max() < AXES_BOUND
    location = moving.location.copy()
    bpy.context.scene.frame_set(30)
    assert (moving.location - location).length == pytest.approx(1, abs=1e-5)


@pytest.mark.parametrize("to_another", [False, True])
@pytest.mark.parametrize("probes", [1, 2, 256])
def test_attached_objects_can_be_attached_anew(to_another, probes, monkeypatch, capfd):
    monkeypatch.setattr(parenting, "MOST_PROBES", probes)
    ob = deforming("cross")
    objects = props(ob, 3)
    attach(ob, objects)
    bpy.context.scene.frame_set(20)
    before = matrices(objects)
    target = ob
    if to_another:
        target = scenes.flat_grid(3)
        follow_truth.animate(target)
    attach(target, objects)
    assert not [each for each in bpy.data.objects if each.name.startswith(ids.CARRIED_BY)]
    assert len(bpy.data.scenes) == 1
    told = capfd.readouterr().out
    assert f"3 objects are attached to {target.name}. The largest distance from the" in told
    assert "3 objects were attached already and got new places; " in told
    assert np.abs(matrices(objects) - before).max() < AXES_BOUND
    assert len(carriers()) == 1 + to_another
    if not to_another:
        check(ob, objects, before)


def test_constraints_that_hold_objects_elsewhere_are_named(capfd):
    ob = deforming("cross")
    objects = props(ob, 5)
    for each, kind in zip(objects, ("TRACK_TO", "COPY_LOCATION", "COPY_LOCATION"), strict=False):
        each.constraints.new(kind).target = objects[4]
    objects[2].constraints[0].influence = 0
    attach(ob, objects)
    assert "Constraints may hold 1 object elsewhere: Prop 1\n" in capfd.readouterr().out


def test_modifiers_that_do_not_count_are_named(capfd):
    ob = deforming("cross")
    ob.modifiers.new("Later", "WAVE")
    attach(ob, props(ob, 2))
    assert "; ignored after Subdivision: Later\n" in capfd.readouterr().out


def test_blenders_own_clear_parent_detaches():
    ob = deforming("cross")
    objects = props(ob, 4)
    before = matrices(objects)
    attach(ob, objects)
    bpy.context.scene.frame_set(30)
    there = matrices(objects)
    select(objects[0], [])
    assert bpy.ops.object.parent_clear(type="CLEAR_KEEP_TRANSFORM") == {"FINISHED"}
    bpy.context.view_layer.update()
    assert np.abs(matrices(objects) - there).max() < 1e-4  # the parent's matrix is dissolved
    bpy.context.scene.frame_set(1)
    assert np.abs(matrices(objects[:1]) - there[0]).max() < 1e-4
    check(ob, objects[1:], before[1:])
    # the vertices of the detached object are used again
    more = props(ob, 2, seed=9)
    bpy.context.scene.frame_set(1)
    later = matrices(more)
    attach(ob, more)
    (carrier,) = carriers()
    assert len(carrier.data.vertices) == 3 * 5
    check(ob, objects[1:], before[1:])
    check(ob, more, later)


def test_it_plays_after_a_reload(tmp_path):
    ob = deforming("cross")
    objects = props(ob)
    before, names = matrices(objects), [child.name for child in objects]
    attach(ob, objects)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    check(bpy.data.objects["Cross"], [bpy.data.objects[name] for name in names], before)


def rig(ob: bpy.types.Object, child: bpy.types.Object) -> None:
    ob.parent = child


def hook(ob: bpy.types.Object, child: bpy.types.Object) -> None:
    ob.modifiers.new("Hook", "HOOK").object = child


def drive(ob: bpy.types.Object, child: bpy.types.Object) -> None:
    variable = ob.driver_add("location", 0).driver.variables.new()
    variable.targets[0].id = child
    variable.targets[0].data_path = "location.x"


def read_by_nodes(ob: bpy.types.Object, child: bpy.types.Object) -> None:
    group = bpy.data.node_groups.new("Own", "GeometryNodeTree")
    for kind in ("Geometry", "Object"):
        group.interface.new_socket(kind, in_out="INPUT", socket_type=f"NodeSocket{kind}")
    modifier = ob.modifiers.new("Own", "NODES")
    modifier.node_group = group
    groups.set_input(modifier, "Object", child)


def collected(child: bpy.types.Object) -> bpy.types.Collection:
    """Returns a collection that holds the object in another one."""
    outer, inner = (bpy.data.collections.new(name) for name in ("Outer", "Inner"))
    outer.children.link(inner)
    inner.objects.link(child)
    return outer


def cut_by_collection(ob: bpy.types.Object, child: bpy.types.Object) -> None:
    boolean = ob.modifiers.new("Boolean", "BOOLEAN")
    boolean.operand_type, boolean.collection = "COLLECTION", collected(child)


def read_collection_by_nodes(ob: bpy.types.Object, child: bpy.types.Object) -> None:
    group = bpy.data.node_groups.new("Own", "GeometryNodeTree")
    for kind in ("Geometry", "Collection"):
        group.interface.new_socket(kind, in_out="INPUT", socket_type=f"NodeSocket{kind}")
    modifier = ob.modifiers.new("Own", "NODES")
    modifier.node_group = group
    groups.set_input(modifier, "Collection", collected(child))


def name_within_nodes(ob: bpy.types.Object, child: bpy.types.Object) -> None:
    outer, inner = (bpy.data.node_groups.new(n, "GeometryNodeTree") for n in ("Outer", "Inner"))
    inner.nodes.new("GeometryNodeObjectInfo").inputs["Object"].default_value = child
    outer.nodes.new("GeometryNodeGroup").node_tree = inner
    ob.modifiers.new("Own", "NODES").node_group = outer


def constrain_bone(ob: bpy.types.Object, child: bpy.types.Object) -> None:
    data = bpy.data.armatures.new("Bones")
    bones = add_object("Bones", data, np.eye(4))
    scenes.activate(bones)
    bpy.ops.object.mode_set(mode="EDIT")
    data.edit_bones.new("Bone").tail = (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    bones.pose.bones["Bone"].constraints.new("COPY_LOCATION").target = child
    ob.modifiers.new("Armature", "ARMATURE").object = bones


def constrain_indirectly(ob: bpy.types.Object, child: bpy.types.Object) -> None:
    between = add_object("Between", None, np.eye(4))
    between.constraints.new("COPY_LOCATION").target = child
    ob.constraints.new("CHILD_OF").target = between


def give_parent(ob: bpy.types.Object, child: bpy.types.Object) -> None:
    child.parent = add_object("Mother", None, np.eye(4))


def bind_hair(ob: bpy.types.Object, child: bpy.types.Object, mode: str = "NODES") -> None:
    hair = scenes.add_hair(ob, follow=mode)
    hair.parent = None
    child.name, hair.name = "Other", "Prop 0"
    assert modifier_of(hair) or live_modifier_of(hair)


@pytest.mark.parametrize(
    ("prepare", "message"),
    [
        (rig, "Prop 0 cannot be attached to Cross, because Cross depends on Prop 0"),
        (hook, "because Cross depends on Prop 0"),
        (drive, "because Cross depends on Prop 0"),
        (read_by_nodes, "because Cross depends on Prop 0"),
        (cut_by_collection, "because Cross depends on Prop 0"),
        (read_collection_by_nodes, "because Cross depends on Prop 0"),
        (name_within_nodes, "because Cross depends on Prop 0"),
        (constrain_bone, "because Cross depends on Prop 0"),
        (constrain_indirectly, "because Cross depends on Prop 0"),
        (give_parent, "Prop 0 has the parent Mother: clear it first"),
        (lambda ob, child: bind_hair(ob, child, "LIVE"), "Prop 0 follows a surface by itself"),
        (bind_hair, "Prop 0 follows a surface by itself: run Unbind from Limit Surface"),
    ],
)
def test_refusals_leave_everything_as_it_was(prepare, message):
    ob = deforming("cross")
    (child,) = props(ob, 1)
    prepare(ob, child)
    contents = scenes.file_contents()
    stack = [m.name for m in ob.modifiers]
    select(ob, [bpy.data.objects["Prop 0"]])
    with pytest.raises(RuntimeError, match=message):
        bpy.ops.object.limit_attach()
    assert scenes.file_contents() == contents
    assert [m.name for m in ob.modifiers] == stack


def test_nothing_to_attach():
    ob = deforming("cross")
    select(ob, [])
    with pytest.raises(RuntimeError, match="Select the objects to attach"):
        bpy.ops.object.limit_attach()


@pytest.mark.parametrize("shape", ["SHOWN", "REST"])
def test_unbinding_the_surface_holds_the_objects(shape):
    ob = deforming("cross")
    objects = props(ob, 3)
    before = matrices(objects)
    attach(ob, objects)
    bpy.context.scene.frame_set(20)
    expected = matrices(objects) if shape == "SHOWN" else before
    select(ob, [])
    assert bpy.ops.object.limit_unbind(shape=shape) == {"FINISHED"}
    for frame in (20, 30):
        bpy.context.scene.frame_set(frame)
        assert np.abs(matrices(objects) - expected).max() < AXES_BOUND


def test_a_carrier_that_carries_nothing_any_more_is_removed():
    ob = deforming("grid with holes")
    objects = props(ob)
    attach(ob, objects)
    bpy.ops.object.select_all(action="DESELECT")
    scenes.activate(ob)
    bpy.ops.object.limit_unbind()
    attach(ob, objects[:3])
    assert len(carriers()) == 2  # the first one holds the others where they are
    before = matrices(objects)
    attach(ob, objects)
    assert np.abs(matrices(objects) - before).max() < AXES_BOUND
    check(ob, objects, before)


@pytest.mark.parametrize("follows", ["by nodes", "live"])
@pytest.mark.parametrize("leave", ["delete", "detach"])
def test_a_carrier_that_carries_nothing_is_removed_when_it_is_unbound(leave, follows):
    ob = deforming("cross")
    objects = props(ob, 2)
    attach(ob, objects)
    select(objects[0], objects)
    if leave == "delete":
        bpy.ops.object.delete()
    else:
        bpy.ops.object.parent_clear(type="CLEAR_KEEP_TRANSFORM")
    select(ob, [])
    if follows == "live":
        assert bpy.ops.object.limit_follow(mode="LIVE") == {"FINISHED"}
        (carrier,) = carriers()
        assert live_modifier_of(carrier)
        assert not modifier_of(carrier)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    assert not carriers()
    assert not [mesh for mesh in bpy.data.meshes if mesh.name.startswith("Limit")]


def test_rebinding_the_surface_keeps_the_objects():
    ob = deforming("cross")
    objects = props(ob, 4)
    before = matrices(objects)
    attach(ob, objects)
    boundary = ob.modifiers["Subdivision"]
    boundary.boundary_smooth = "PRESERVE_CORNERS"
    select(ob, [])
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    (carrier,) = carriers()
    triangles = attributes.read(carrier.data, ids.POSITION).reshape(-1, 3, 3)
    sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)
    np.testing.assert_allclose(sides, sides.mean(), rtol=1e-5)
    # objects near pinned corners go with the surface there
    assert np.abs(matrices(objects) - before).max() < 1
