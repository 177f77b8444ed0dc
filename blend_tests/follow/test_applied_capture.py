# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces on which *Limit Capture* was applied, alone or because the surface was converted. Its
attributes then stay in the mesh, and mean nothing there.
"""

import bpy
import follow_scenes
import live_scenes
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.follow.panel import _live_things, _live_troubles
from limit_surface.nodes.capture import STORED
from limit_surface.placing import live_kept
from limit_surface.reading import attributes

CHECKS = {"NODES": follow_scenes.check_hair, "LIVE": live_scenes.check_hair}
APPLIED = (
    "Holes: the modifier Limit Capture was applied. Without it, what follows Holes by nodes does "
    "not move, and what follows it live is slower",
    ids.FOLLOW,
)
BY_EITHER_WAY = pytest.mark.parametrize("mode", CHECKS)


def followed(mode: str, levels: int | None = 2) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Adds a surface, without a Subdivision Surface if there are no levels, and hair on it."""
    ob = scenes.grid_with_holes()
    if levels is not None:
        scenes.add_subsurf(ob).levels = levels
    return ob, scenes.add_hair(ob, per_side=2, follow=mode)


def apply_capture(ob: bpy.types.Object) -> None:
    scenes.activate(ob)
    assert bpy.ops.object.modifier_apply(modifier=ids.CAPTURE_GROUP) == {"FINISHED"}
    assert left_in(ob) == set(STORED)


def convert(ob: bpy.types.Object) -> None:
    select_alone(ob)
    assert bpy.ops.object.convert(target="MESH") == {"FINISHED"}
    assert not ob.modifiers
    assert left_in(ob) == set(STORED)


def select_alone(ob: bpy.types.Object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    ob.select_set(True)
    scenes.activate(ob)


def left_in(ob: bpy.types.Object) -> set[str]:
    return set(STORED).intersection(ob.data.attributes.keys())


def bend(ob: bpy.types.Object) -> None:
    positions = attributes.read(ob.data, ids.POSITION)
    positions[:, 2] += 0.3 * np.sin(positions[:, 0])
    attributes.write(ob.data, ids.POSITION, "FLOAT_VECTOR", "POINT", positions)
    ob.data.update()
    bpy.context.view_layer.update()


def troubles(ob: bpy.types.Object, mode: str) -> list[tuple[str, str]]:
    """Returns what the panel shows for the surface."""
    if mode == "NODES":
        return follow_scenes.look(ob)
    return [(trouble.text, trouble.remedy) for trouble in _live_troubles(_live_things(ob))]


@pytest.mark.parametrize(("spoil", "levels"), [(apply_capture, 2), (convert, 0), (convert, None)])
def test_live_hair_follows_without_the_modifier(spoil, levels):
    ob, hair = followed("LIVE", levels)
    assert live_kept.known(ob).pose.checksums is not None  # the modifier has handed it on
    spoil(ob)
    for frame in (2, 3):
        bend(ob)
        live_scenes.check_hair(ob, hair)
        bpy.context.scene.frame_set(frame)
        live_scenes.check_hair(ob, hair)
    assert live_kept.known(ob).pose.checksums is None
    assert troubles(ob, "LIVE") == [APPLIED]


@BY_EITHER_WAY
@pytest.mark.parametrize(("spoil", "levels"), [(apply_capture, 2), (convert, None)])
def test_one_button_puts_it_right(spoil, levels, mode):
    ob, hair = followed(mode, levels)
    spoil(ob)
    bend(ob)
    assert troubles(ob, mode) == [APPLIED]
    select_alone(ob)
    assert bpy.ops.object.limit_follow() == {"FINISHED"}
    assert left_in(ob) == set()
    assert troubles(ob, mode) == []
    bend(ob)
    CHECKS[mode](ob, hair)


@BY_EITHER_WAY
def test_undo_brings_the_attributes_back(mode):
    ob, _hair = followed(mode)
    apply_capture(ob)
    select_alone(ob)
    bpy.ops.ed.undo_push(message="before")
    assert bpy.ops.object.limit_follow() == {"FINISHED"}
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    ob = bpy.data.objects["Holes"]
    assert left_in(ob) == set(STORED)
    assert troubles(ob, mode) == [APPLIED]


@BY_EITHER_WAY
def test_a_converted_surface_with_other_faces_is_bound_again(mode, tmp_path, capfd):
    ob, hair = followed(mode)
    convert(ob)
    bpy.context.view_layer.update()
    changed = f"The faces of Holes have changed since {hair.name} was bound"
    named = [(changed, ids.REBIND), (APPLIED[0], ids.REBIND)]
    assert troubles(ob, mode) == named

    path = str(tmp_path / "converted.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    capfd.readouterr()
    bpy.ops.wm.open_mainfile(filepath=path)
    lines = capfd.readouterr().out.splitlines()
    said = [line for line in lines if line.startswith("Limit Surface:")]
    assert said[0] == f"Limit Surface: {changed}"
    ob, hair = (bpy.data.objects[name] for name in ("Holes", "Limit Hair"))
    assert troubles(ob, mode) == named

    select_alone(ob)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    assert left_in(ob) == set()
    assert troubles(ob, mode) == []
    bend(ob)
    CHECKS[mode](ob, hair)


@BY_EITHER_WAY
@pytest.mark.parametrize("is_added_again", [False, True])
def test_edit_mode_raises_no_error(is_added_again, mode, capfd):
    ob, hair = followed(mode)
    apply_capture(ob)
    if is_added_again:  # but not for Edit Mode
        capture = ob.modifiers.new("Capture", "NODES")
        capture.node_group = bpy.data.node_groups[ids.CAPTURE_GROUP]
        capture.show_in_editmode = False
        ob.modifiers.move(1, 0)
    select_alone(ob)
    capfd.readouterr()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.translate(value=(0, 0, 0.2))
    bpy.context.scene.frame_set(2)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert "Traceback" not in "".join(capfd.readouterr())
    if mode == "LIVE" or is_added_again:
        CHECKS[mode](ob, hair)


@BY_EITHER_WAY
@pytest.mark.parametrize("shape", ["SHOWN", "REST"])
def test_nothing_is_left_after_unbinding(shape, mode):
    ob, hair = followed(mode)
    other = scenes.add_hair(ob, per_side=1, follow=mode)
    apply_capture(ob)
    for thing, left in ((hair, set(STORED)), (other, set())):
        select_alone(thing)
        assert bpy.ops.object.limit_unbind(shape=shape) == {"FINISHED"}
        assert left_in(ob) == left


@BY_EITHER_WAY
def test_what_deleted_hair_leaves_is_removed(mode):
    ob, hair = followed(mode)
    apply_capture(ob)
    bpy.data.objects.remove(hair)
    select_alone(ob)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    assert left_in(ob) == set()
    assert not bpy.ops.object.limit_unbind.poll()


@BY_EITHER_WAY
def test_attributes_of_users_stay(mode):
    ob, hair = followed(mode)
    attributes.add(ob.data, ids.CAGE_COUNT, "INT", "POINT")
    ob.data.update_tag()
    bend(ob)
    CHECKS[mode](ob, hair)
    select_alone(hair)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    assert left_in(ob) == {ids.CAGE_COUNT}
