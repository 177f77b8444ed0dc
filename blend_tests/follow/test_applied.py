# SPDX-License-Identifier: GPL-3.0-or-later
"""Things whose modifier of following was applied: they keep the shape of that frame."""

import bpy
import follow_truth
import live_scenes
import numpy as np
import pytest
import scenes
from follow_scenes import check_hair, deforming, follow
from limit_surface import ids
from limit_surface.placing.follow_state import State

FRAME = 17


def apply(thing: bpy.types.Object, name: str) -> None:
    scenes.activate(thing)
    assert bpy.ops.object.modifier_apply(modifier=name) == {"FINISHED"}


def applied_hair() -> tuple[bpy.types.Object, bpy.types.Object, np.ndarray]:
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, tilt=(0.4, 0.2), follow="NODES")
    bpy.context.scene.frame_set(FRAME)
    shown = follow_truth.shown_strands(hair)
    apply(hair, ids.FOLLOW_HAIR_GROUP)
    np.testing.assert_array_equal(scenes.strands(hair), shown)
    return ob, hair, shown


def test_hair_is_bound_in_its_shape():
    ob, hair, shown = applied_hair()
    (trouble,) = State.of(hair).troubles(None)
    assert "Limit Hair has lost the modifier by which it followed" in trouble.text
    assert trouble.remedy == ids.FOLLOW
    follow(hair)
    np.testing.assert_allclose(follow_truth.shown_strands(hair), shown, atol=4e-6)
    for frame in (1, 28):
        bpy.context.scene.frame_set(frame)
        check_hair(ob, hair)


def test_hair_is_bound_live_in_its_shape():
    ob, hair, shown = applied_hair()
    live_scenes.follow(hair)
    np.testing.assert_allclose(follow_truth.shown_strands(hair), shown, atol=4e-6)
    for frame in (1, 28):
        bpy.context.scene.frame_set(frame)
        live_scenes.check_hair(ob, hair)


@pytest.mark.parametrize("shape", ["SHOWN", "REST"])
def test_hair_is_unbound_in_its_shape(shape):
    ob, hair, shown = applied_hair()
    assert bpy.ops.object.limit_unbind(shape=shape) == {"FINISHED"}
    np.testing.assert_array_equal(scenes.strands(hair), shown)
    assert ids.TILE not in hair.data.attributes
    assert ids.CAPTURE_GROUP not in ob.modifiers
    if shape == "SHOWN":
        follow(hair)
        np.testing.assert_allclose(follow_truth.shown_strands(hair), shown, atol=4e-6)
        bpy.context.scene.frame_set(28)
        check_hair(ob, hair)


def test_hair_is_not_bound_anew_from_its_old_roots():
    _ob, hair, shown = applied_hair()
    with pytest.raises(RuntimeError, match="was applied in this frame: run Follow Limit Surface"):
        bpy.ops.object.limit_rebind()
    np.testing.assert_array_equal(scenes.strands(hair), shown)


def test_a_decal_is_bound_in_its_shape():
    ob = deforming("monkey")
    scenes.activate(ob)
    assert bpy.ops.object.limit_mesh(levels=1, follow="NODES") == {"FINISHED"}
    decal = bpy.context.object
    bpy.context.scene.frame_set(FRAME)
    shown = follow_truth.shown(decal, ids.POSITION)
    (modifier,) = (m.name for m in decal.modifiers if m.type == "NODES")
    apply(decal, modifier)
    follow(decal)
    np.testing.assert_allclose(follow_truth.shown(decal, ids.POSITION), shown, atol=4e-6)
    bpy.context.scene.frame_set(28)
    now = follow_truth.on_surface(ob, decal.data).position
    np.testing.assert_allclose(follow_truth.shown(decal, ids.POSITION), now, atol=1e-5)


def test_hair_whose_modifier_was_deleted_is_posed_again():
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NODES")
    bpy.context.scene.frame_set(FRAME)
    shown = follow_truth.shown_strands(hair)
    hair.modifiers.clear()
    follow(hair)
    np.testing.assert_allclose(follow_truth.shown_strands(hair), shown, atol=4e-6)
    check_hair(ob, hair)
