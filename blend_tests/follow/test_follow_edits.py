# SPDX-License-Identifier: GPL-3.0-or-later
"""What follows a surface survives modes, edits, and modifiers behind the subdivision."""

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import check_hair, deforming
from limit_surface import ids
from limit_surface.reading import attributes


def followed() -> tuple[bpy.types.Object, bpy.types.Object]:
    ob = deforming("grid with holes")
    return ob, scenes.add_hair(ob, tilt=(0.4, 0.2), points=4, follow="NODES")


def check_frames(ob: bpy.types.Object, hair: bpy.types.Object) -> None:
    for frame in (5, 30):
        bpy.context.scene.frame_set(frame)
        check_hair(ob, hair)


def solidify(ob: bpy.types.Object) -> None:
    ob.modifiers.new("Solidify", "SOLIDIFY").thickness = 0.3


def second_subdivision(ob: bpy.types.Object) -> None:
    ob.modifiers.new("Finer", "SUBSURF").levels = 2


def finer(ob: bpy.types.Object) -> None:
    ob.modifiers["Subdivision"].levels = 3


def coarse(ob: bpy.types.Object) -> None:
    ob.modifiers["Subdivision"].levels = 0


def without_limit(ob: bpy.types.Object) -> None:
    ob.modifiers["Subdivision"].use_limit_surface = False


BEHIND = {
    made.__name__: made for made in (solidify, second_subdivision, finer, coarse, without_limit)
}


@pytest.mark.parametrize("name", BEHIND)
def test_what_stands_behind_makes_no_difference(name):
    ob, hair = followed()
    bpy.context.scene.frame_set(21)
    shown = follow_truth.shown_strands(hair)
    BEHIND[name](ob)
    bpy.context.scene.frame_set(21)
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), shown)
    check_frames(ob, hair)


def test_a_hidden_surface_is_followed():
    ob, hair = followed()
    bpy.context.scene.frame_set(30)
    shown = follow_truth.shown_strands(hair)
    bpy.context.scene.frame_set(1)
    ob.hide_viewport = ob.hide_render = True
    bpy.context.scene.frame_set(30)
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), shown)


@pytest.mark.parametrize("mode", ["EDIT", "SCULPT_CURVES"])
def test_modes_of_the_hair(mode):
    ob, hair = followed()
    bpy.context.scene.frame_set(30)
    shown = follow_truth.shown_strands(hair)
    scenes.activate(hair)
    bpy.ops.object.mode_set(mode=mode)
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), shown)
    bpy.ops.object.mode_set(mode="OBJECT")
    check_frames(ob, hair)


@pytest.mark.parametrize("mode", ["SCULPT", "WEIGHT_PAINT", "EDIT"])
def test_modes_of_the_surface(mode):
    ob, hair = followed()
    bpy.context.scene.frame_set(30)
    shown = follow_truth.shown_strands(hair)
    scenes.activate(ob)
    bpy.ops.object.mode_set(mode=mode)
    bpy.context.view_layer.update()
    if mode == "WEIGHT_PAINT":
        np.testing.assert_array_equal(follow_truth.shown_strands(hair), shown)
    assert np.isfinite(follow_truth.shown_strands(hair)).all()
    bpy.ops.object.mode_set(mode="OBJECT")
    check_frames(ob, hair)


def test_hair_follows_the_edited_control_mesh():
    """In Edit Mode Blender evaluates only the modifiers that are shown there."""
    ob = scenes.grid_with_holes()
    wave = ob.modifiers.new("Wave", "WAVE")
    subsurf = scenes.add_subsurf(ob)
    for modifier in (wave, subsurf):
        modifier.show_in_editmode = modifier.show_on_cage = True
    hair = scenes.add_hair(ob, follow="NODES")
    bpy.context.scene.frame_set(30)
    shown = follow_truth.shown_strands(hair)
    scenes.activate(ob)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.view_layer.update()
    np.testing.assert_allclose(follow_truth.shown_strands(hair), shown, atol=1e-5)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.translate(value=(0, 0, 2))
    bpy.context.view_layer.update()
    moved = follow_truth.shown_strands(hair) - shown
    np.testing.assert_allclose(moved, np.broadcast_to([0, 0, 2], moved.shape), atol=1e-5)
    bpy.ops.object.mode_set(mode="OBJECT")
    check_frames(ob, hair)


@pytest.mark.skipif(bpy.app.version < (4, 3), reason="Python cannot do that before Blender 4.3")
def test_removed_strands():
    ob, hair = followed()
    count = len(hair.data.curves)
    hair.data.remove_curves(indices=list(range(0, count, 3)))
    assert len(hair.data.curves) < count
    check_frames(ob, hair)


@pytest.mark.skipif(bpy.app.version < (4, 3), reason="Python cannot do that before Blender 4.3")
def test_longer_strands():
    ob, hair = followed()
    hair.data.resize_curves([7] * len(hair.data.curves))
    strands = attributes.read(hair.data, ids.POSITION)
    bpy.context.scene.frame_set(30)
    shown = follow_truth.shown(hair, ids.POSITION)
    now = follow_truth.on_surface(ob, hair.data)
    sizes = np.array([len(curve.points) for curve in hair.data.curves])
    of = np.repeat(np.arange(len(sizes)), sizes)
    now = follow_truth.Frames(now.position[of], now.frame[of])
    rest = follow_truth.rest(hair.data)
    local = np.einsum("nji,nj->ni", rest.frame[of], strands - rest.position[of])
    expected = now.position + np.einsum("nij,nj->ni", now.frame, local)
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    assert sizes[0] == 7
    assert np.abs(shown - expected).max() < bound
