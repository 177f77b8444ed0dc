# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair that is snapped to a surface and follows it from then on."""

import bpy
import follow_scenes
import live_scenes
import numpy as np
import pytest
import scenes
from follow_scenes import deforming
from limit_surface import ids
from limit_surface.placing.followers import live_modifier_of, modifier_of
from limit_surface.reading import attributes
from live_scenes import FRAMES


def loose_hair(count: int = 30) -> bpy.types.Object:
    """Adds strands near the surfaces that belong to none."""
    data = bpy.data.hair_curves.new("Loose")
    data.add_curves([4] * count)
    rng = np.random.default_rng(3)
    root = rng.uniform((0.5, 0.5, 0.5), (4.5, 3.5, 1), (count, 1, 3))
    points = root + np.linspace(0, 0.5, 4)[:, None] * [0.2, 0.1, 1]
    attributes.write(data, ids.POSITION, "FLOAT_VECTOR", "POINT", points)
    hair = bpy.data.objects.new("Loose", data)
    bpy.context.collection.objects.link(hair)
    return hair


def snap(hair: bpy.types.Object, ob: bpy.types.Object, **properties: object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    hair.select_set(True)
    ob.select_set(True)
    scenes.activate(ob)
    assert bpy.ops.object.limit_snap(**properties) == {"FINISHED"}


def check(ob: bpy.types.Object, hair: bpy.types.Object) -> None:
    check_hair = live_scenes.check_hair if live_modifier_of(hair) else follow_scenes.check_hair
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        check_hair(ob, hair)


@pytest.mark.parametrize(
    ("follow", "way"),
    [("AUTO", modifier_of), ("NODES", modifier_of), ("LIVE", live_modifier_of), ("NONE", None)],
)
def test_snapped_hair_follows_as_it_is_told_to(follow, way):
    ob, hair = deforming("grid with holes"), loose_hair()
    bpy.context.scene.frame_set(7)
    snap(hair, ob, follow=follow)
    assert hair.data.surface == ob
    assert len(hair.modifiers) == (way is not None)
    if way:
        assert way(hair)
        snapped = scenes.strands(hair).copy()
        check(ob, hair)
        bpy.context.scene.frame_set(7)
        shown = live_scenes.follow_truth.shown_strands(hair)
        np.testing.assert_allclose(shown, snapped, atol=2e-5)


def test_hair_on_a_mesh_that_cannot_deform_gets_no_modifier():
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    hair = loose_hair()
    snap(hair, ob)
    assert not hair.modifiers


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_hair_that_follows_goes_on_in_its_way(follow):
    ob, hair = deforming("grid with holes"), loose_hair()
    snap(hair, ob, follow=follow)
    modifiers = [modifier.name for modifier in hair.modifiers]
    bpy.context.scene.frame_set(20)
    snap(hair, ob, offset=0.05, follow="NONE")
    assert [modifier.name for modifier in hair.modifiers] == modifiers
    check(ob, hair)


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_hair_that_follows_changes_to_another_surface(follow):
    ob, hair = deforming("grid with holes"), loose_hair()
    snap(hair, ob, follow=follow)
    other = deforming("mixed polygons")
    bpy.context.scene.frame_set(20)
    snap(hair, other)
    assert hair.data.surface == other
    check(other, hair)
