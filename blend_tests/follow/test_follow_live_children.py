# SPDX-License-Identifier: GPL-3.0-or-later
"""Live children in the panel, and in the operators that bind again and unbind."""

import bpy
import children_truth
import follow_truth
import numpy as np
import pytest
import scenes
from figures.meshes import grids
from follow_scenes import deforming
from limit_surface import ids
from limit_surface.follow import panel, stale
from limit_surface.nodes import children as nodes
from limit_surface.nodes import groups
from limit_surface.placing import following, live_children
from limit_surface.placing.follow_state import State
from limit_surface.reading import attributes, cage

BOUND = 4e-6


@pytest.fixture
def scene():
    ob = deforming("grid with holes")
    settings = {"distribution": "UNIFORM", "count": 12, "points": 8, "length": 0.3}
    guides = scenes.add_hair(ob, **settings, follow="NODES", random=0.8)
    return ob, guides, add_live(guides)


def add_live(guides: bpy.types.Object, **properties: object) -> bpy.types.Object:
    scenes.activate(guides)
    settings = {"distribution": "UNIFORM", "count": 300, "viewport_share": 1.0, "seed": 4}
    bpy.ops.object.limit_children_add(mode="LIVE", **settings | properties)
    return bpy.context.active_object


def select(*objects: bpy.types.Object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for ob in objects:
        ob.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def signature(ob: bpy.types.Object) -> str:
    return following.signature(cage.read(ob, bpy.context.evaluated_depsgraph_get()))


def troubles(ob: bpy.types.Object) -> list[str]:
    state = State.of(ob)
    return [trouble.text for trouble in state.troubles(signature(state.surface))]


def change_faces(ob: bpy.types.Object) -> None:
    ob.shape_key_clear()
    capture = [m.name for m in ob.modifiers if m.name not in (ids.CAPTURE_GROUP, "Subdivision")]
    for name in capture:
        ob.modifiers.remove(ob.modifiers[name])
    ob.data.clear_geometry()
    positions = [(x, y, 0) for y in range(6) for x in range(6)]
    ob.data.from_pydata(positions, [], grids.grid_faces(5, 5).tolist())


def check(live: bpy.types.Object, guides: bpy.types.Object, ob: bpy.types.Object) -> None:
    found = children_truth.shown_strands(live)
    assert len(found) == len(children_truth.table_of(live).data.vertices) > 0
    away = np.abs(found - children_truth.expected(live, guides, ob)).max()
    assert away < BOUND * follow_truth.diagonal(ob)


def test_the_state_names_them(scene):
    ob, guides, live = scene
    for each in (ob, live):
        state = State.of(each)
        assert state.surface == ob
        assert state.children == (live,)
        assert state.child_count == 300
        assert state.followers == [guides]
    assert troubles(live) == troubles(ob) == []


class _Layout:
    """Collects labels."""

    def __init__(self) -> None:
        self.labels: list[str] = []

    def column(self, **_options: object) -> "_Layout":
        return self

    def label(self, text: str = "", **_options: object) -> None:
        self.labels.append(text)


def test_the_panel_tells_how_many_there_are(scene):
    ob, guides, _live = scene
    add_live(guides, count=1200)
    layout = _Layout()
    panel._draw_state(layout, State.of(ob))
    assert "2 objects grow live children: 1,500" in layout.labels
    assert stale.troubles(bpy.context, State.of(ob)) == []


@pytest.mark.skipif(bpy.app.version < (4, 3), reason="Python cannot do that before Blender 4.3")
def test_other_guides_are_seen_and_rebound(scene):
    ob, guides, live = scene
    places = children_truth.stored(live)[:2]
    guides.data.remove_curves(indices=[3, 5])
    guides.data.update_tag()
    assert len(children_truth.shown_strands(live)) == 0
    assert troubles(live) == [f"The number of guides of {live.name} has changed from 12 to 10"]
    select(live)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    assert troubles(live) == []
    check(live, guides, ob)
    for before, after in zip(places, children_truth.stored(live)[:2], strict=True):
        np.testing.assert_array_equal(before, after)
    assert bpy.context.active_object == live


def test_as_many_guides_with_other_roots_are_seen_and_rebound(scene):
    ob, guides, live = scene
    face = attributes.read(guides.data, ids.FACE)
    uv = attributes.read(guides.data, ids.UV)
    order = np.roll(
        np.arange(len(face)), 1
    )  # a guide removed at one end, another added at the other
    attributes.write(guides.data, ids.FACE, "INT", "CURVE", face[order])
    attributes.write(guides.data, ids.UV, "FLOAT2", "CURVE", uv[order])
    expected = [f"The guides of {live.name} have other roots than when it was made"]
    assert troubles(live) == expected
    select(live)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    assert troubles(live) == []
    live.pop(ids.CHILDREN_GUIDES)  # a file of an older version
    assert troubles(live) == []


def test_combed_guides_need_no_rebinding(scene):
    _ob, guides, live = scene
    points = attributes.read(guides.data, "position")
    points[1::2] += 0.01
    attributes.write(guides.data, "position", "FLOAT_VECTOR", "POINT", points)
    assert troubles(live) == []


def test_faces_that_changed_are_seen_and_rebound(scene):
    ob, guides, live = scene
    children_truth.set_input(live, nodes.RADIUS, 0.02)
    change_faces(ob)
    assert f"The faces of {ob.name} have changed since {live.name} was made" in troubles(ob)
    select(ob)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    assert troubles(ob) == []
    check(live, guides, ob)
    assert live_children.count_of(live) == 300
    (modifier,) = groups.modifiers(live, ids.CHILDREN_GROUP)
    assert groups.get_input(modifier, nodes.RADIUS) == pytest.approx(0.02)


def test_settings_are_those_that_they_were_made_with(scene):
    ob, guides, _live = scene
    ob.data.edges.foreach_set("use_seam", np.ones(len(ob.data.edges), bool))
    live = add_live(guides, count=200, guide_count=1, seed=9, parting="SEAMS")
    before = children_truth.stored(live)
    select(live)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    for old, new in zip(before, children_truth.stored(live), strict=True):
        np.testing.assert_array_equal(old, new)


def add_groups(ob: bpy.types.Object) -> None:
    """Adds groups of the left and of the right half, and colors of the same."""
    right = np.array([vertex.co.x > 0 for vertex in ob.data.vertices])
    for name, inside in (("Left", ~right), ("Right", right)):
        ob.vertex_groups.new(name=name).add(np.flatnonzero(inside).tolist(), 1.0, "REPLACE")
        colors = np.repeat(inside.astype(np.float32)[:, None], 4, axis=1)
        attribute = ob.data.color_attributes.new(f"{name} Color", "FLOAT_COLOR", "POINT")
        attribute.data.foreach_set("color", colors.ravel())


def activate_group(ob: bpy.types.Object, name: str) -> None:
    ob.vertex_groups.active = ob.vertex_groups[name]
    ob.data.color_attributes.active_color = ob.data.color_attributes[f"{name} Color"]


@pytest.mark.parametrize("source", ["VERTEX_GROUP", "COLOR_ATTRIBUTE"])
def test_what_was_active_when_they_were_made_steers_them_again(scene, source):
    ob, guides, _live = scene
    add_groups(ob)
    activate_group(ob, "Left")
    live = add_live(guides, density_source=source)
    before = children_truth.stored(live)
    activate_group(ob, "Right")
    select(live)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    for old, new in zip(before, children_truth.stored(live), strict=True):
        np.testing.assert_array_equal(old, new)


@pytest.mark.parametrize("table", [nodes.TABLE, nodes.TILES])
def test_a_deleted_table_is_made_again(scene, table):
    ob, guides, live = scene
    (modifier,) = groups.modifiers(live, ids.CHILDREN_GROUP)
    bpy.data.objects.remove(groups.get_input(modifier, table))
    assert troubles(live) == [f"A hidden table that {live.name} reads was deleted"]
    select(live)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    check(live, guides, ob)


def test_deleted_guides_are_refused(scene):
    _ob, guides, live = scene
    bpy.data.objects.remove(guides)
    assert len(troubles(live)) == 1
    select(live)
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match="were deleted: choose other guides"):
        bpy.ops.object.limit_rebind()
    assert scenes.file_contents() == before
    live.pop(ids.CHILDREN_SETTINGS)
    with pytest.raises(RuntimeError, match="does not store the settings"):
        bpy.ops.object.limit_rebind()


def test_what_makes_them_impossible_is_named(scene):
    ob, guides, _live = scene
    ob.data.edges.foreach_set("use_seam", np.ones(len(ob.data.edges), bool))
    live = add_live(guides, parting="SEAMS")
    before = children_truth.stored(live)
    ob.data.edges.foreach_set("use_seam", np.zeros(len(ob.data.edges), bool))
    select(live)
    with pytest.raises(RuntimeError, match="could not be made again: .* marked as seams"):
        bpy.ops.object.limit_rebind()
    for old, new in zip(before, children_truth.stored(live), strict=True):
        np.testing.assert_array_equal(old, new)


def test_unbound_they_are_curves_that_can_follow(scene):
    ob, guides, live = scene
    children_truth.set_input(live, nodes.SHARE, 0.1)
    children_truth.set_input(live, nodes.RADIUS, 0.02)
    bpy.context.scene.frame_set(12)
    table = children_truth.table_of(live).name
    face, uv = children_truth.stored(live)[:2]
    expected = children_truth.expected(live, guides, ob)
    select(live)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    made = scenes.strands(live)
    assert np.abs(made - expected).max() < BOUND * follow_truth.diagonal(ob)
    assert live_children.modifier_of(live) is None
    assert table not in bpy.data.objects
    assert attributes.read(live.data, "radius") == pytest.approx(0.02)
    stored = scenes.locations(live.data)
    np.testing.assert_array_equal(stored[0], face)
    np.testing.assert_array_equal(stored[1], uv)
    select(live)
    assert bpy.ops.object.limit_follow() == {"FINISHED"}
    np.testing.assert_allclose(follow_truth.shown_strands(live), made, atol=1e-5)
    bpy.context.scene.frame_set(20)
    now = follow_truth.on_surface(ob, live.data)
    away = np.abs(follow_truth.shown_strands(live)[:, 0] - now.position).max()
    assert away < 1e-5 * follow_truth.diagonal(ob)


def test_unbound_they_are_hair_as_the_other_mode_makes_it():
    ob = deforming("grid with holes")
    scenes.add_uv_map(ob, lambda p: p[:, :2] / 5)
    guides = scenes.add_hair(ob, distribution="UNIFORM", count=12, follow="NODES")
    guides.data.materials.append(bpy.data.materials.new("Of the guides"))
    live = add_live(guides)
    chosen = bpy.data.materials.new("Chosen since")
    children_truth.set_input(live, nodes.MATERIAL, chosen)
    select(live)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    scenes.activate(guides)
    bpy.ops.object.limit_children_add(distribution="UNIFORM", count=300, seed=4, follow="NONE")
    made = bpy.context.active_object.data
    assert set(live.data.attributes.keys()) == set(made.attributes.keys())
    for name, bound in ((ids.SURFACE_UV, 0), ("radius", 1e-6), (ids.POSITION, 1e-5)):
        found, expected = (attributes.read(data, name) for data in (live.data, made))
        np.testing.assert_allclose(found, expected, atol=bound)
    assert live.data.surface_uv_map == made.surface_uv_map == "Flat"
    assert list(live.data.materials) == [chosen]


def test_the_surface_unbinds_them_with_their_guides(scene):
    ob, guides, live = scene
    select(ob)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    assert State.of(ob) is None or not State.of(ob).children
    assert len(live.data.curves) == 300
    assert not [m for m in guides.modifiers if m.type == "NODES"]


@pytest.mark.skipif(bpy.app.version < (4, 3), reason="Python cannot do that before Blender 4.3")
def test_what_does_not_grow_is_not_unbound(scene):
    _ob, guides, live = scene
    guides.data.remove_curves(indices=[3])
    guides.data.update_tag()
    select(live)
    with pytest.raises(RuntimeError, match="grows no strands"):
        bpy.ops.object.limit_unbind()
    assert live_children.modifier_of(live) is not None


def subdivide(ob: bpy.types.Object) -> None:
    select(ob)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")


def test_rebinding_a_copy_leaves_the_original():
    """Copies of live children read the same hidden table."""
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    guides = scenes.add_hair(ob, distribution="UNIFORM", count=12, follow="NODES")
    live = add_live(guides)
    select(ob, guides, live)
    bpy.ops.object.duplicate()
    (copy,) = [each for each in bpy.context.selected_objects if each.type == "MESH"]
    subdivide(copy)
    select(copy)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    assert not troubles(ob)
    assert not troubles(copy)
    check(live, guides, ob)
    (of_copy,) = live_children.on_surface(copy)
    check(of_copy, live_children.guides_of(of_copy), copy)


def test_other_guides_of_a_copy_leave_the_original(scene):
    ob, guides, live = scene
    others = scenes.add_hair(ob, distribution="UNIFORM", count=7, seed=9, follow="NODES")
    select(live)
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    children_truth.set_input(copy, nodes.GUIDES, others)
    bpy.context.view_layer.update()
    select(copy)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    check(live, guides, ob)
    check(copy, others, ob)


def tables_in_file() -> list[str]:
    return [each.name for each in bpy.data.objects if each.name.startswith(ids.CHILDREN_TABLE)]


def test_a_table_whose_children_were_deleted_is_removed_with_the_next_change(scene):
    ob, guides, live = scene
    select(live)
    bpy.ops.object.delete()
    assert len(tables_in_file()) == 1
    again = add_live(guides)
    assert len(tables_in_file()) == 1
    check(again, guides, ob)
    select(again)
    bpy.ops.object.delete()
    select(ob)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}  # what follows
    assert not tables_in_file()


def test_a_table_whose_children_were_deleted_is_removed_where_nothing_follows():
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    live = add_live(scenes.add_hair(ob, follow="NONE"), follow="NONE")
    select(live)
    bpy.ops.object.delete()
    select(ob)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    assert not tables_in_file()
    assert not bpy.ops.object.limit_unbind.poll()
