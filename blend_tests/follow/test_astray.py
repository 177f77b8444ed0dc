# SPDX-License-Identifier: GPL-3.0-or-later
"""Things whose modifier names another surface than the one that they belong to: their modifiers
were copied from another object, or their surface was changed by hand.
"""

import bpy
import follow_truth
import live_scenes
import numpy as np
import pytest
import scenes
from bakes import bake
from follow_scenes import check_hair, deforming, look
from limit_surface import ids
from limit_surface.bake_frames import command
from limit_surface.follow import panel
from limit_surface.placing import live_kept
from limit_surface.placing.follow_state import State
from limit_surface.placing.followers import (
    followed_surface,
    is_astray,
    live_modifier_of,
    modifier_of,
)
from limit_surface.reading import attributes

SCENES = ["grid with holes", "mixed polygons"]  # the same faces as the other surface, and others
WAYS = ["NODES", "LIVE"]


def two_surfaces(scene: str) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Returns a surface, and one with the faces of this scene."""
    there, here = deforming("grid with holes"), deforming(scene)
    there.name, here.name = "HeadA", "HeadB"
    here.location.x += 9
    bpy.context.view_layer.update()
    return there, here


def copy_modifiers(source: bpy.types.Object, *targets: bpy.types.Object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for target in targets:
        target.select_set(True)
    source.select_set(True)
    bpy.context.view_layer.objects.active = source
    bpy.ops.object.make_links_data(type="MODIFIERS")


def select(*things: bpy.types.Object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for thing in things:
        thing.select_set(True)
        bpy.context.view_layer.objects.active = thing


def copied(scene: str, way: str, before: str) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Returns a surface, and its hair with the modifiers of hair on another surface."""
    there, here = two_surfaces(scene)
    scenes.activate(there)
    source = scenes.add_hair(there, per_side=2, follow=way)
    hair = scenes.add_hair(here, per_side=1, follow=before)
    hair.name = "HairB"
    bpy.context.scene.frame_set(13)
    copy_modifiers(source, hair)
    bpy.context.scene.frame_set(30)
    return here, hair


def told(thing: bpy.types.Object) -> list[tuple[str, str]]:
    """Returns what the panel shows."""
    found = look(thing) if State.of(thing) else []
    live = panel._live_troubles(panel._live_things(thing))
    return [*found, *((trouble.text, trouble.remedy) for trouble in live)]


def trouble(names_it: str = "Object Data > Surface", name: str = "HairB") -> str:
    ob = bpy.data.objects[name]
    modifier = modifier_of(ob) or live_modifier_of(ob)
    return (
        f"{name} belongs to HeadB ({names_it}), but its modifier {modifier.name} names the surface "
        "HeadA instead"
    )


def check(here: bpy.types.Object, hair: bpy.types.Object, way: str) -> None:
    assert followed_surface(hair) == here
    assert told(hair) == told(here) == []
    for frame in (30, 13):
        bpy.context.scene.frame_set(frame)
        (live_scenes.check_hair if way == "LIVE" else check_hair)(here, hair)


@pytest.mark.parametrize("by", ["hair", *scenes.slow("surface")])
@pytest.mark.parametrize("before", ["NODES", "LIVE", "NONE"])
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("scene", SCENES)
def test_copied_modifiers_are_told_and_put_right(scene, way, before, by):
    here, hair = copied(scene, way, before)
    assert told(hair) == told(here) == [(trouble(), ids.FOLLOW)]
    assert told(bpy.data.objects["HeadA"]) == []
    select(here if by == "surface" else hair)
    assert bpy.ops.object.limit_follow(mode=way) == {"FINISHED"}
    check(here, hair, way)


@pytest.mark.parametrize("way", WAYS)
def test_rebinding_keeps_hair_on_the_surface_that_it_belongs_to(way):
    here, hair = copied("mixed polygons", way, way)
    bpy.context.scene.frame_set(1)
    select(hair)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    check(here, hair, way)


@pytest.mark.parametrize("way", WAYS)
def test_hair_is_not_left_as_it_is_shown_on_another_surface(way):
    _here, hair = copied("grid with holes", way, way)
    rest = live_scenes.rest(hair) if way == "LIVE" else scenes.strands(hair)
    select(hair)
    with pytest.raises(RuntimeError, match="belongs to HeadB .* run Follow Limit Surface"):
        bpy.ops.object.limit_unbind()
    assert is_astray(hair)
    assert bpy.ops.object.limit_unbind(shape="REST") == {"FINISHED"}
    assert not hair.modifiers
    np.testing.assert_allclose(scenes.strands(hair), rest, atol=1e-6)


def test_what_follows_live_stays_where_it_is():
    _here, hair = copied("grid with holes", "LIVE", "LIVE")
    before = follow_truth.shown_strands(hair).copy()
    bpy.context.scene.frame_set(7)
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), before)
    assert (live_kept.trouble(hair), live_kept.remedy(hair)) == (trouble(), ids.FOLLOW)


@pytest.mark.parametrize("way", WAYS)
def test_loading_tells_it_and_bakes_refuse_it(way, tmp_path, capfd):
    copied("grid with holes", way, way)
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    capfd.readouterr()
    bpy.ops.wm.open_mainfile(filepath=path)
    assert f"Limit Surface: {trouble()}\n" in capfd.readouterr().out
    assert bake(tmp_path / "bake", "HairB", frames="30") == command.STALE_BINDING
    assert f"{trouble()}; {ids.FOLLOW} puts it right" in capfd.readouterr().err


@pytest.mark.parametrize("parent", ["old", "new", "none"])
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("scene", SCENES)
def test_another_surface_that_was_chosen_by_hand(scene, way, parent):
    there, here = two_surfaces(scene)
    hair = scenes.add_hair(there, per_side=1, follow=way)
    hair.name = "HairB"
    hair.parent = {"old": there, "new": here, "none": None}[parent]
    hair.data.surface = here
    bpy.context.view_layer.update()
    assert trouble() in dict(told(hair))
    select(hair)
    if scene == "mixed polygons":
        with pytest.raises(
            RuntimeError, match="bound to other faces than those that HeadB has now"
        ):
            bpy.ops.object.limit_follow(mode=way)
        assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    else:
        assert bpy.ops.object.limit_follow(mode=way) == {"FINISHED"}
    check(here, hair, way)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("scene", SCENES)
def test_points_belong_to_their_parent(scene, way):
    there, here = two_surfaces(scene)
    source = scenes.add_points(there, count=9, distribution="UNIFORM", follow=way)
    points = scenes.add_points(here, count=9, distribution="UNIFORM", follow=way)
    points.name = "Dots"
    copy_modifiers(source, points)
    bpy.context.scene.frame_set(30)
    assert told(points) == [(trouble("its parent", "Dots"), ids.FOLLOW)]
    select(points)
    assert bpy.ops.object.limit_follow(mode=way) == {"FINISHED"}
    assert told(points) == []
    bpy.context.scene.frame_set(13)
    now = follow_truth.on_surface(here, points.data, follow_truth.relation(here, points))
    shown = follow_truth.shown(points, ids.POSITION)
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(here)
    assert np.abs(shown - now.position).max() < bound


def outline(curve: bpy.types.Object) -> np.ndarray:
    """Returns the points that are shown."""
    evaluated = curve.evaluated_get(bpy.context.evaluated_depsgraph_get())
    shown = attributes.read(evaluated.to_mesh(), ids.POSITION)
    evaluated.to_mesh_clear()
    return shown


@pytest.mark.parametrize("repair", ["follow", "rebind"])
def test_a_curve_does_not_take_over_the_places_of_another_one(repair):
    there, here = two_surfaces("mixed polygons")
    curves = []
    for surface in (there, here):
        data = bpy.data.curves.new("Line", "CURVE")
        data.dimensions = "3D"
        data.splines.new("POLY").points.add(2)
        for point, vertex in zip(data.splines[0].points, surface.data.vertices, strict=False):
            point.co = (*vertex.co, 1)
        curve = bpy.data.objects.new("Line", data)
        bpy.context.collection.objects.link(curve)
        curve.parent = surface
        bpy.context.view_layer.update()
        select(curve)
        assert bpy.ops.object.limit_follow() == {"FINISHED"}
        curves.append(curve)
    shown = outline(curves[1])
    copy_modifiers(*curves)
    name = curves[1].name
    assert told(curves[1]) == [(trouble("its parent", name), ids.FOLLOW)]
    select(curves[1])
    operator = bpy.ops.object.limit_follow if repair == "follow" else bpy.ops.object.limit_rebind
    assert operator() == {"FINISHED"}
    assert told(curves[1]) == told(curves[0]) == []
    np.testing.assert_allclose(outline(curves[1]), shown, atol=1e-5)


@pytest.mark.parametrize("way", WAYS)
def test_copies_of_surface_and_hair_follow_their_own_surface(way):
    """Data of linked duplicates, and copies of these data, name the original surface."""
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, per_side=1, follow=way)
    for linked in (False, True):
        select(ob, hair)
        bpy.ops.object.duplicate(linked=linked)
        twin = next(thing for thing in bpy.context.selected_objects if thing.type == "CURVES")
        assert followed_surface(twin) == twin.parent != ob
        assert not is_astray(twin)
    assert twin.data.surface == ob
    parent, twin.parent = twin.parent, None
    assert not is_astray(twin)
    twin.parent = parent
    bpy.ops.object.make_single_user(type="SELECTED_OBJECTS", object=True, obdata=True)
    twin = next(thing for thing in bpy.context.selected_objects if thing.type == "CURVES")
    assert (twin.data.users, twin.data.surface) == (1, ob)
    assert not is_astray(twin)


@pytest.mark.parametrize("way", WAYS)
def test_meshes_may_have_any_parent_and_cleared_surfaces_are_no_trouble(way):
    ob = deforming("grid with holes")
    bpy.ops.mesh.primitive_uv_sphere_add()
    ball = bpy.context.active_object
    ball.parent = scenes.add_mesh("Parent", [(0, 0, 0)], [])
    select(ball, ob)
    assert bpy.ops.object.limit_follow(mode=way) == {"FINISHED"}
    hair = scenes.add_hair(ob, per_side=1, follow=way)
    hair.parent = hair.data.surface = None
    points = scenes.add_points(ob, count=5, distribution="UNIFORM", follow=way)
    points.parent = None
    bpy.context.scene.frame_set(13)
    for thing in (ball, hair, points):
        assert not is_astray(thing)
        assert told(thing) == []
        select(thing)
        assert bpy.ops.object.limit_follow(mode=way) == {"FINISHED"}
        assert followed_surface(thing) == ob


@pytest.mark.parametrize("unbound", [False, True])
def test_hair_of_a_deleted_surface_is_bound_to_the_one_that_is_chosen(unbound):
    there, here = two_surfaces("mixed polygons")
    hair = scenes.add_hair(there, per_side=1, follow="NODES")
    select(there)
    bpy.ops.object.delete()
    if unbound:
        select(hair)
        assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    select(hair, here)
    with pytest.raises(RuntimeError, match="choose HeadB in Object Data > Surface and run Rebind"):
        bpy.ops.object.limit_follow()
    hair.data.surface = here
    select(hair)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    check(here, hair, "NODES")
