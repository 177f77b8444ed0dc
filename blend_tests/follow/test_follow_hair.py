# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapped hair and Bézier hair that follow a deforming surface by Geometry Nodes."""

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
import snap_scenes
from follow_scenes import deforming
from limit_surface import ids
from limit_surface.reading import attributes, curve_lines

HANDLES = ("handle_left", "handle_right")


def follow(hair: bpy.types.Object) -> None:
    scenes.activate(hair)
    assert bpy.ops.object.limit_follow() == {"FINISHED"}


def make_bezier(hair: bpy.types.Object, use_handles: bool = False) -> None:
    scenes.activate(hair)
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.curves.curve_type_set(type="BEZIER", use_handles=use_handles) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")


def bezier_hair(ob: bpy.types.Object, kind: str) -> bpy.types.Object:
    """Adds Bézier strands whose handles point to all directions."""
    hair = scenes.add_hair(ob, per_side=2, points=4, follow="NONE")
    make_bezier(hair)
    rng = np.random.default_rng(3)
    positions = attributes.read(hair.data, ids.POSITION)
    for name in HANDLES:
        handles = positions + rng.uniform(-0.1, 0.1, positions.shape)
        attributes.write(hair.data, name, "FLOAT_VECTOR", "POINT", handles)
    for name in ("handle_type_left", "handle_type_right"):
        kinds = np.full(len(positions), {"FREE": 0, "ALIGN": 3}[kind])
        attributes.write(hair.data, name, "INT8", "POINT", kinds)
    if kind == "ALIGN":
        left = attributes.read(hair.data, "handle_left")
        attributes.write(
            hair.data, "handle_right", "FLOAT_VECTOR", "POINT", 2.5 * positions - 1.5 * left
        )
    hair.data.update_tag()
    return hair


def check(ob: bpy.types.Object, hair: bpy.types.Object, names: tuple[str, ...]) -> None:
    relation = np.linalg.inv(np.array(hair.matrix_world)) @ np.array(ob.matrix_world)
    now = follow_truth.on_surface(ob, hair.data, relation)
    count = len(hair.data.curves)
    scale = max(1, np.abs(relation).max())
    for name in names:
        points = attributes.read(hair.data, name).astype(np.float64).reshape(count, -1, 3)
        expected = follow_truth.moved(points, hair.data, now)
        error = np.abs(follow_truth.shown(hair, name).reshape(count, -1, 3) - expected).max()
        assert error < scale * follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)


@pytest.mark.parametrize("kind", ["FREE", "ALIGN"])
def test_handles_turn_with_the_surface(kind):
    ob = deforming("cross")
    hair = bezier_hair(ob, kind)
    follow(hair)
    bpy.context.scene.frame_set(30)
    check(ob, hair, (ids.POSITION, *HANDLES))


@pytest.mark.parametrize("use_handles", [False, True])
def test_handles_that_blender_has_made_turn_too(use_handles):
    ob = deforming("cross")
    hair = scenes.add_hair(ob, per_side=2, points=4, follow="NONE")
    bend(hair)
    make_bezier(hair, use_handles)
    follow(hair)
    bpy.context.scene.frame_set(30)
    check(ob, hair, (ids.POSITION, *HANDLES))


def bend(hair: bpy.types.Object) -> None:
    bent = scenes.strands(hair) + np.array([[0, 0, 0], [0, 0, 0], [0.1, 0, 0], [0, 0.2, 0]])
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", bent)


def test_strands_that_become_bezier_are_bound_anew():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, per_side=2, points=4)
    assert hair.modifiers[0].node_group.name == ids.FOLLOW_HAIR_GROUP
    make_bezier(hair)
    follow(hair)
    assert [m.node_group.name for m in hair.modifiers] == [ids.FOLLOW_BEZIER_GROUP]


@pytest.mark.parametrize("mirrored", [False, True])
def test_snapped_hair_follows(mirrored):
    ob = deforming("grid with holes", mirrored)
    bpy.context.view_layer.update()
    hair = snap_scenes.add_hair(ob, sizes=[4] * 20)
    scenes.activate(ob)
    assert bpy.ops.object.limit_snap(align="NORMAL") == {"FINISHED"}
    follow(hair)
    for frame, subframe in ((1, 0.0), (13, 0.5), (30, 0.0)):
        bpy.context.scene.frame_set(frame, subframe=subframe)
        check(ob, hair, (ids.POSITION,))


@pytest.mark.parametrize("to_another", [False, True])
def test_hair_that_follows_is_bound_at_its_new_places_when_it_is_snapped(to_another):
    ob = deforming("grid with holes")
    bpy.context.view_layer.update()
    hair = snap_scenes.add_hair(ob, sizes=[4] * 20)
    scenes.activate(ob)
    assert bpy.ops.object.limit_snap() == {"FINISHED"}
    follow(hair)
    if to_another:
        hair.location.x += 0.4
        ob = deforming("cross")
    attributes.write(
        hair.data,
        ids.POSITION,
        "FLOAT_VECTOR",
        "POINT",
        attributes.read(hair.data, ids.POSITION) + np.float32([0.3, 0.1, 0.2]),
    )
    bpy.context.view_layer.update()
    hair.select_set(True)
    scenes.activate(ob)
    assert bpy.ops.object.limit_snap() == {"FINISHED"}
    for frame in (1, 30):
        bpy.context.scene.frame_set(frame)
        check(ob, hair, (ids.POSITION,))


def test_new_hair_is_evaluated_once():
    """Evaluation takes longer than all else for many strands."""
    ob = deforming("cross")
    evaluated = []

    def note(_scene, depsgraph):
        evaluated.extend(
            update.id.name
            for update in depsgraph.updates
            if update.is_updated_geometry and isinstance(update.id, bpy.types.Curves)
        )

    bpy.app.handlers.depsgraph_update_post.append(note)
    try:
        hair = scenes.add_hair(ob, follow="NODES")
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(note)
    assert evaluated == [hair.data.name]


def store(data: bpy.types.Curves, name: str, value: int) -> None:
    kind, values = {"cyclic": ("BOOLEAN", bool), "resolution": ("INT", np.int32)}[name]
    attributes.write(data, name, kind, "CURVE", np.full(len(data.curves), value, values))


def write_new(data: bpy.types.Curves, name: str, value: int) -> None:
    store(data, name, value)


def overwrite(data: bpy.types.Curves, name: str, value: int) -> None:
    store(data, name, {"cyclic": 0, "resolution": 1}[name])
    data.update_tag()
    bpy.context.view_layer.update()
    store(data, name, value)


def rename(data: bpy.types.Curves, name: str, value: int) -> None:
    store(data, name, value)
    data.attributes[name].name = "other"
    data.update_tag()
    bpy.context.view_layer.update()
    data.attributes["other"].name = name


def shown_lines(hair: bpy.types.Object) -> np.ndarray:
    hair.data.update_tag()
    return curve_lines.read(hair, bpy.context.evaluated_depsgraph_get())


def check_all_lines_are_there(hair: bpy.types.Object, count: int) -> None:
    lines = shown_lines(hair)
    assert len(lines) == count
    corners = np.array(hair.evaluated_get(bpy.context.evaluated_depsgraph_get()).bound_box)
    corners = scenes.transformed(np.array(hair.matrix_world), corners)
    assert (lines >= corners.min(axis=0) - 1e-5).all()
    assert (lines <= corners.max(axis=0) + 1e-5).all()


CHANGES = pytest.mark.parametrize("change", [write_new, overwrite, rename])
ATTRIBUTES = pytest.mark.parametrize(
    ("name", "value", "segments"), [("cyclic", 1, 8 * 12), ("resolution", 40, 7 * 40)]
)


@CHANGES
@ATTRIBUTES
def test_attributes_that_change_the_number_of_evaluated_points_are_noticed(
    name, value, segments, change
):
    """Blender itself does not notice all of them, and has written beyond the end of memory."""
    hair = scenes.add_hair(deforming("cross"), points=8, follow="NODES")
    bpy.context.view_layer.update()
    change(hair.data, name, value)
    check_all_lines_are_there(hair, segments * len(hair.data.curves))


@CHANGES
@ATTRIBUTES
@pytest.mark.parametrize("follow", ["NONE", "LIVE"])
def test_hair_without_nodes_is_read_with_these_changes(name, value, segments, change, follow):
    hair = scenes.add_hair(deforming("cross"), points=8, follow=follow)
    bpy.context.view_layer.update()
    change(hair.data, name, value)
    lines = shown_lines(hair)
    assert len(lines) == segments * len(hair.data.curves)
    assert np.abs(lines).max() < 10


def test_bezier_strands_whose_number_of_evaluated_points_changes_are_counted_anew():
    ob = deforming("cross")
    hair = bezier_hair(ob, "FREE")
    follow(hair)
    bpy.context.view_layer.update()
    overwrite(hair.data, "resolution", 40)
    check_all_lines_are_there(hair, 3 * 40 * len(hair.data.curves))


def test_hair_becomes_cyclic_in_edit_mode():
    hair = scenes.add_hair(deforming("cross"), points=8, follow="NODES")
    bpy.context.view_layer.update()
    scenes.activate(hair)
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.curves.cyclic_toggle() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    check_all_lines_are_there(hair, 8 * 12 * len(hair.data.curves))
