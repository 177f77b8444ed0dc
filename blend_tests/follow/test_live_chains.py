# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair that follows a surface live which itself follows another surface live."""

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from limit_surface.placing import live
from live_scenes import check_hair, deforming, follow, limit_of


def chain(order: str) -> tuple[bpy.types.Object, bpy.types.Object, bpy.types.Object]:
    """Adds a surface that deforms, a mesh on it, and hair on that mesh. The names say in which
    order Blender lists them.
    """
    body = deforming("cross")
    assert bpy.ops.object.limit_mesh(levels=1, follow="NONE", store_locations=True) == {"FINISHED"}
    cloth = bpy.context.object
    hair = scenes.add_hair(cloth, follow="NONE")
    for ob, name in zip((body, cloth, hair), order, strict=True):
        ob.name = name
    follow(cloth, hair)
    return body, cloth, hair


@pytest.mark.parametrize("order", ["ABC", "CBA", "BAC"])
def test_each_frame_is_that_of_the_surface_on_which_it_stands(order):
    _, cloth, hair = chain(order)
    for frame in (1, 30, 7, 12):
        bpy.context.scene.frame_set(frame)
        check_hair(cloth, hair)


def test_a_frame_depends_on_nothing_but_itself():
    _, _, hair = chain("CBA")

    def shown(frame):
        bpy.context.scene.frame_set(frame)
        return follow_truth.shown_strands(hair).tobytes()

    forwards = {frame: shown(frame) for frame in range(1, 9)}
    for frame in (8, 3, 7, 1):
        live.forget()  # as after undo, and in another file
        assert shown(frame) == forwards[frame]
    assert len(set(forwards.values())) == 8


def test_one_change_moves_the_whole_chain():
    body, cloth, hair = chain("CBA")
    before = follow_truth.shown_strands(hair).copy()
    body.modifiers["Wave"].height *= 2
    bpy.context.view_layer.update()
    assert np.abs(follow_truth.shown_strands(hair) - before).max() > 0.02
    check_hair(cloth, hair)


def test_a_surface_that_another_one_that_follows_deforms():
    """The hair stands on a mesh of its own, which is bound to the one that follows."""
    _, cloth, old_hair = chain("CBA")
    bpy.data.objects.remove(old_hair)
    copy = cloth.copy()
    copy.data = cloth.data.copy()
    copy.modifiers.clear()
    copy.name = "A surface that Blender lists first"
    bpy.context.collection.objects.link(copy)
    copy.modifiers.new("Bound", "SURFACE_DEFORM").target = cloth
    scenes.activate(copy)
    assert bpy.ops.object.surfacedeform_bind(modifier="Bound") == {"FINISHED"}
    hair = scenes.add_hair(copy, follow="NONE")
    follow(hair)
    for frame in (1, 30, 7):
        bpy.context.scene.frame_set(frame)
        roots = follow_truth.shown_strands(hair)[:, 0].copy()  # limit_of may update the scene
        expected = limit_of(hair).evaluate(*scenes.locations(hair.data)).position
        assert np.abs(roots - expected).max() < 1e-5


def test_things_on_each_other_do_not_hang():
    body, cloth, _ = chain("CBA")
    body.modifiers.new("Bound", "SHRINKWRAP").target = cloth
    bpy.context.scene.frame_set(30)
    bpy.context.scene.frame_set(1)
