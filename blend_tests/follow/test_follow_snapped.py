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
from limit_surface.reading import attributes, cage, displayed_mesh
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


def snap(thing: bpy.types.Object, ob: bpy.types.Object, **properties: object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    thing.select_set(True)
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


@pytest.mark.parametrize("is_dragged", [False, True])
@pytest.mark.parametrize("target", ["VIEWPORT", "RENDER"])
@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_hair_that_is_snapped_to_displayed_polygons_keeps_its_distance(follow, target, is_dragged):
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, per_side=1, follow=follow) if is_dragged else loose_hair()
    bpy.context.scene.frame_set(7)
    if is_dragged:
        bpy.context.scene.limit_surface.target = ob
        scenes.activate(hair)
        assert bpy.ops.view3d.limit_snap_modal(face=5, uv=(0.2, 0.3), element=3, target=target) == {
            "FINISHED"
        }
    else:
        snap(hair, ob, follow=follow, target=target)
    chosen = slice(3, 4) if is_dragged else slice(None)
    face, uv = scenes.locations(hair.data)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = cage.read(ob, depsgraph)
    local = displayed_mesh.read(ob, depsgraph, found, target).positions(face[chosen], uv[chosen])
    polygons = scenes.transformed(live_scenes.relation(ob, hair), local)
    shown = live_scenes.follow_truth.shown_strands(hair)[chosen, 0]
    np.testing.assert_allclose(shown, polygons, atol=2e-5)
    limit = found.surface().evaluate(face[chosen], uv[chosen]).position
    assert np.linalg.norm(local - limit, axis=1).max() > 1e-3
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


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_hair_that_also_follows_another_surface_by_another_object_is_refused(follow):
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NODES", per_side=1)
    twin = hair.copy()  # with the same strands
    bpy.context.collection.objects.link(twin)
    twin.modifiers.clear()
    other = deforming("mixed polygons")
    before = scenes.strands(hair).copy()
    with pytest.raises(RuntimeError, match="Limit Hair.001 shares its data with Limit Hair, which"):
        snap(twin, other, follow=follow)
    np.testing.assert_array_equal(scenes.strands(hair), before)
    assert hair.data.surface == ob
    follow_scenes.check_hair(ob, hair)


def combed(hair: bpy.types.Object) -> np.ndarray:
    """Combs some strands of hair that was placed, and returns all as they are shown in frame 20."""
    points = scenes.strands(hair).copy()
    points[::2, 1:] += [0.1, 0.2, -0.05]
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", points)
    hair.data.update_tag()
    bpy.context.scene.frame_set(20)
    return live_scenes.follow_truth.shown_strands(hair)


@pytest.mark.parametrize("is_edited", [False, True])
@pytest.mark.parametrize("align", ["NONE", "NORMAL_DU"])
@pytest.mark.parametrize("part", ["STRAND", "ROOT"])
@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_what_follows_and_is_on_the_surface_stays_there(follow, part, align, is_edited):
    """Also in a frame in which the mesh has another shape than when the hair was bound."""
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow=follow, points=4, per_side=2)
    shown = combed(hair)
    if is_edited:
        bpy.context.scene.limit_surface.target = ob
        scenes.activate(hair)
        bpy.ops.object.mode_set(mode="EDIT")
        assert bpy.ops.object.limit_snap(hair=part, align=align) == {"FINISHED"}
        bpy.ops.object.mode_set(mode="OBJECT")
    else:
        snap(hair, ob, hair=part, align=align)
    np.testing.assert_allclose(live_scenes.follow_truth.shown_strands(hair), shown, atol=2e-5)
    check(ob, hair)


@pytest.mark.parametrize("part", ["STRAND", "ROOT", "BLEND"])
@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_a_strand_that_follows_is_dragged_from_where_it_is_shown(follow, part):
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow=follow, points=4, per_side=2)
    shown = combed(hair)
    bpy.context.scene.limit_surface.target = ob
    scenes.activate(hair)
    assert bpy.ops.view3d.limit_snap_modal(face=5, uv=(0.5, 0.25), element=3, hair=part) == {
        "FINISHED"
    }
    now = live_scenes.follow_truth.shown_strands(hair)
    np.testing.assert_allclose(np.delete(now, 3, 0), np.delete(shown, 3, 0), atol=2e-5)
    limit = scenes.surface_without_addon(ob)
    root = limit.evaluate([5], [[0.5, 0.25]]).position
    root = scenes.transformed(live_scenes.relation(ob, hair), root)[0]
    share = {"STRAND": [1, 1, 1, 1], "ROOT": [1, 0, 0, 0]}.get(part)
    if share is None:
        world = scenes.transformed(hair.matrix_world, shown[3].astype(np.float64))
        along = np.cumsum([0, *np.linalg.norm(np.diff(world, axis=0), axis=1)])
        share = 1 - along / along[-1]
    expected = shown[3] + np.multiply.outer(share, root - shown[3, 0])
    np.testing.assert_allclose(now[3], expected, atol=2e-5)
    check(ob, hair)


def test_only_selected_strands_get_another_shape_at_rest():
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NODES", points=4, per_side=2)
    before = scenes.strands(hair).copy()
    bpy.context.scene.frame_set(20)
    shown = live_scenes.follow_truth.shown_strands(hair)
    chosen = np.zeros(len(before), bool)
    chosen[::3] = True
    attributes.write(hair.data, ids.SELECTION, "BOOLEAN", "CURVE", chosen)
    bpy.context.scene.limit_surface.target = ob
    scenes.activate(hair)
    bpy.ops.object.mode_set(mode="SCULPT_CURVES")
    assert bpy.ops.object.limit_snap(offset=0.1) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_array_equal(scenes.strands(hair)[~chosen], before[~chosen])
    now = live_scenes.follow_truth.shown_strands(hair)
    np.testing.assert_allclose(now[~chosen], shown[~chosen], atol=2e-5)
    apart = np.array(hair.matrix_world)[:3, :3] @ (now - shown)[chosen].reshape(-1, 3).T
    np.testing.assert_allclose(np.linalg.norm(apart, axis=0), 0.1, atol=2e-5)
    check(ob, hair)
