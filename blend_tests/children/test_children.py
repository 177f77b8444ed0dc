# SPDX-License-Identifier: GPL-3.0-or-later
"""Children as curves: roots, shapes, guides along the surface, partings, refusals."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from children_scenes import add_children, add_guides, check_parted, lengths, sheet, two_sided
from follow_scenes import deforming
from limit_surface import ids
from limit_surface.children.operator import OBJECT_OT_limit_children_add
from limit_surface.children.spread import Spread
from limit_surface.errors import CancelledError
from limit_surface.reading import attributes


def subdivided(name: str) -> bpy.types.Object:
    ob = scenes.SCENES[name]()
    scenes.add_subsurf(ob)
    return ob


@pytest.mark.parametrize("name", ["cross", "mixed polygons", "monkey"])
def test_roots_are_exact(name):
    ob = subdivided(name)
    made = add_children(add_guides(ob))
    surface = scenes.surface_without_addon(ob)
    roots = surface.evaluate(*scenes.locations(made.data)).position.astype(np.float32)
    np.testing.assert_array_equal(scenes.strands(made)[:, 0], roots)
    assert made.parent == ob
    assert made.data.surface == ob


@pytest.mark.parametrize("transform", [{}, scenes.STRETCHED, scenes.MIRRORED])
def test_straight_guides_make_straight_children_along_the_normal(transform):
    """Guides are straight in the world, and have the same length there."""
    ob = subdivided("cross")
    scenes.place(ob, transform)
    guides = add_guides(ob, length=0.25)
    made = add_children(guides)
    strands, matrix = scenes.strands(made).astype(float), np.array(ob.matrix_world)[:3, :3]
    normal = scenes.surface_without_addon(ob).frames(*scenes.locations(made.data))[:, :, 2]
    normal = normal @ np.linalg.inv(matrix)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    along = (strands[:, -1] - strands[:, 0]) @ matrix.T
    np.testing.assert_allclose(along, 0.25 * normal, atol=1e-6)


def test_lengths_are_those_of_guides():
    ob = subdivided("cross")
    guides = add_guides(ob, random=1.0, random_length=0.8)
    made = add_children(guides, guide_count=1)
    known = lengths(scenes.strands(guides).astype(float))
    found = lengths(scenes.strands(made).astype(float))
    assert np.abs(found[:, None] - known).min(axis=1).max() < 1e-5
    blended = lengths(scenes.strands(add_children(guides)).astype(float))
    assert known.min() - 1e-6 < blended.min() < blended.max() < known.max() + 1e-6
    assert np.abs(blended[:, None] - known).min(axis=1).max() > 1e-3


def test_points_and_radius():
    ob = subdivided("cross")
    ob.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    made = add_children(add_guides(ob), points=3, radius=0.01)
    assert scenes.strands(made).shape == (300, 3, 3)
    np.testing.assert_allclose(attributes.read(made.data, "radius"), 0.005, rtol=1e-6)


def test_guides_count_as_they_are_shown_now():
    ob = subdivided("grid with holes")
    guides = add_guides(ob)
    before = scenes.strands(add_children(guides))
    points = attributes.read(guides.data, "position")
    points[:, 2] += np.tile(np.linspace(0, 1, 8) ** 2, 30)
    guides.data.points.foreach_set("position", points.ravel())
    guides.data.update_tag()
    after = scenes.strands(add_children(guides))
    np.testing.assert_array_equal(after[:, 0], before[:, 0])
    assert (after[:, -1, 2] > before[:, -1, 2]).all()


def disable(hair):
    hair.hide_viewport = True


def exclude(hair):
    collection = bpy.data.collections.new("Hidden")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(hair)
    bpy.context.collection.objects.unlink(hair)
    bpy.context.view_layer.layer_collection.children["Hidden"].exclude = True


@pytest.mark.parametrize("hide", [disable, exclude])
def test_hidden_guides_count_as_they_are_in_this_frame(hide):
    """Blender does not evaluate such hair, so it would be at rest."""
    ob = deforming("cross")
    guides = add_guides(ob, follow="NODES")
    bpy.context.scene.frame_set(17)
    expected = scenes.strands(add_children(guides, follow="NONE"))
    hide(guides)
    bpy.context.view_layer.update()
    before = scenes.file_contents()
    scenes.activate(ob)
    settings = {"guides": guides.name, "distribution": "UNIFORM", "count": 300}
    assert bpy.ops.object.limit_children_add(**settings, follow="NONE") == {"FINISHED"}
    found = scenes.strands(bpy.context.active_object)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6)
    bpy.data.hair_curves.remove(bpy.context.active_object.data)
    assert scenes.file_contents() == before


def test_hidden_guides_that_follow_live_are_refused():
    ob = deforming("cross")
    guides = add_guides(ob, follow="LIVE")
    disable(guides)
    bpy.context.scene.frame_set(17)
    scenes.activate(ob)
    with pytest.raises(RuntimeError, match="Limit Hair follows live, but is disabled"):
        bpy.ops.object.limit_children_add(guides=guides.name)


def test_children_follow_by_nodes():
    ob = subdivided("cross")
    follow_truth.animate(ob)
    made = add_children(add_guides(ob), follow="NODES")
    bpy.context.scene.frame_set(20)
    now = follow_truth.on_surface(ob, made.data)
    away = np.abs(follow_truth.shown_strands(made)[:, 0] - now.position).max()
    assert away < follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)


def mark_middle(ob: bpy.types.Object) -> np.ndarray:
    ends = attributes.read(ob.data, ids.EDGE_VERTICES)
    x = attributes.read(ob.data, "position")[:, 0]
    return (x[ends] == 2).all(axis=1)


def test_without_a_parting_sides_mix():
    made = add_children(two_sided(sheet()))
    strands = scenes.strands(made)
    leans = np.abs(strands[:, -1, 0] - strands[:, 0, 0]) / lengths(strands)
    # With a parting all lean by more than 0.9.
    assert (leans < 0.9).any()


def test_seams_part():
    ob = sheet()
    guides = two_sided(ob)
    ob.data.edges.foreach_set("use_seam", mark_middle(ob))
    check_parted(add_children(guides, parting="SEAMS"))


def test_edge_attributes_part():
    ob = sheet()
    guides = two_sided(ob)
    attributes.write(ob.data, "parting", "BOOLEAN", "EDGE", mark_middle(ob))
    check_parted(add_children(guides, parting="EDGE_ATTRIBUTE", parting_attribute="parting"))


@pytest.mark.parametrize("kind", ["INT", "BOOLEAN"])
def test_face_maps_part(kind):
    ob = sheet()
    guides = two_sided(ob)
    right = np.tile([0, 0, 1, 1], 4)
    attributes.write(ob.data, "side", kind, "FACE", right)
    check_parted(add_children(guides, parting="FACE_ATTRIBUTE", parting_attribute="side"))


def test_materials_part():
    ob = sheet()
    guides = two_sided(ob)
    for _ in range(2):
        ob.data.materials.append(None)
    ob.data.polygons.foreach_set("material_index", np.tile([0, 0, 1, 1], 4).astype(np.int32))
    check_parted(add_children(guides, parting="MATERIALS"))


@pytest.mark.parametrize("mode", ["MADE", "LIVE"])
def test_guides_whose_control_points_are_not_what_is_shown(mode, capfd):
    guides = add_guides(scenes.grid_with_holes(), follow="NONE")
    add_children(guides, mode=mode, follow="NONE")
    assert "Bezier" not in capfd.readouterr().out
    scenes.activate(guides)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curves.select_all(action="SELECT")
    bpy.ops.curves.curve_type_set(type="BEZIER")
    bpy.ops.object.mode_set(mode="OBJECT")
    add_children(guides, mode=mode, follow="NONE")
    said = capfd.readouterr().out
    assert f"{len(guides.data.curves)} strands of {guides.name} are Bezier or NURBS" in said


@pytest.mark.parametrize("distribution", ["JITTERED", "UNIFORM", "BLUE_NOISE"])
def test_no_child_stands_on_its_guide(distribution):
    """Guides and children have the same seed, unless artists choose another."""
    ob = scenes.grid_with_holes()
    spread = {"distribution": distribution, "count": 300, "per_side": 4}
    guides = add_guides(ob, **spread)
    made = add_children(guides, **spread)
    roots = scenes.strands(guides)[:, 0]
    for root in scenes.strands(made)[:, 0]:
        assert np.abs(roots - root).max(axis=1).min() > 1e-6


def test_places_without_guides_are_left_out():
    ob = sheet()
    attributes.write(ob.data, "side", "INT", "FACE", np.tile([0, 0, 1, 1], 4))
    attributes.write(ob.data, "left", "BOOLEAN", "FACE", np.tile([1, 1, 0, 0], 4))
    guides = add_guides(ob, faces="ATTRIBUTE", face_attribute="left")
    made = add_children(guides, parting="FACE_ATTRIBUTE", parting_attribute="side")
    roots = scenes.strands(made)[:, 0, 0]
    assert 0 < len(roots) < 300
    assert (roots < 2).all()


def test_children_do_not_reach_through_a_lip():
    """Two sheets lie close above each other and hang together at one side only."""
    x, z = np.r_[0:6, 5.0, 5:-1:-1.0], np.r_[np.zeros(6), 0.01, np.full(6, 0.02)]
    y = np.arange(4.0)
    positions = [(px, py, pz) for py in y for px, pz in zip(x, z, strict=True)]
    n = len(x)
    faces = [
        (j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i)
        for j in range(3)
        for i in range(n - 1)
    ]
    ob = scenes.add_mesh("Lip", positions, faces)
    scenes.add_subsurf(ob)
    guides = add_guides(ob, distribution="JITTERED", per_side=1)
    strands = scenes.strands(guides)
    below = scenes.locations(guides.data)[0] % (n - 1) < 6
    strands[:, :, 2] = strands[:, :1, 2] + np.where(below, -1, 1)[:, None] * np.linspace(0, 1, 8)
    guides.data.points.foreach_set("position", strands.ravel())
    guides.data.update_tag()
    made = add_children(guides)
    face = scenes.locations(made.data)[0] % (n - 1)
    strands = scenes.strands(made)
    rises = strands[:, -1, 2] - strands[:, 0, 2]
    assert (rises[face < 3] < -0.9).all()
    assert (rises[face > 8] > 0.9).all()


def refused(match: str, active: bpy.types.Object, **properties: object) -> None:
    scenes.activate(active)
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_children_add(**properties)
    assert scenes.file_contents() == before
    assert bpy.context.active_object == active


def test_refusals_change_nothing():
    ob = sheet()
    guides = add_guides(ob)
    refused("Children need guides", ob)
    refused("no object 'Nobody'", guides, guides="Nobody")
    refused("Flat has no edges that are marked", guides, parting="SEAMS")
    refused("has no attribute 'none'", guides, parting="FACE_ATTRIBUTE", parting_attribute="none")
    attributes.write(ob.data, "side", "FLOAT", "FACE", np.zeros(16))
    refused("is of type FLOAT", guides, parting="FACE_ATTRIBUTE", parting_attribute="side")
    refused("choose the mode Curves", guides, mode="LIVE", target="VIEWPORT")
    refused("cannot follow in the mode Live", guides, mode="LIVE", follow="LIVE")
    other = scenes.cross()
    refused("stands on Flat, not on Cross", other, guides=guides.name)
    bare = bpy.data.hair_curves.new("Bare")
    bare.add_curves([2])
    bare.surface = ob
    loose = bpy.data.objects.new("Bare", bare)
    bpy.context.collection.objects.link(loose)
    refused("Bare stores no places", loose)


@pytest.mark.parametrize("mode", ["MADE", "LIVE"])
def test_guides_that_are_nowhere_are_refused(mode):
    guides = add_guides(subdivided("cross"))
    guides.data.curves[2].points[0].position = (float("nan"), 0, 0)
    with pytest.raises(RuntimeError, match=f"Strand 2 of {guides.name} has coordinates"):
        add_children(guides, mode=mode)


def test_guides_of_another_topology_are_refused():
    ob = sheet()
    guides = add_guides(ob, follow="NODES")
    ob.data.clear_geometry()
    ob.data.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    refused("bound before the faces", guides)


def test_poll():
    assert not bpy.ops.object.limit_children_add.poll()
    made = add_children(add_guides(sheet()))
    assert bpy.context.active_object == made
    assert bpy.ops.object.limit_children_add.poll()
    points = scenes.add_points(made.parent)
    assert bpy.ops.object.limit_children_add.poll()
    points.parent = None
    assert not bpy.ops.object.limit_children_add.poll()


@pytest.mark.parametrize("mode", ["MADE", "LIVE"])
def test_work_that_is_cancelled_leaves_nothing(mode, monkeypatch):
    guides = add_guides(sheet())
    scatter = Spread.scatter

    def cancelled(self, region, progress):
        def stop(part):
            if part > 0.5:  # the locations are there, and their guides are looked for
                raise CancelledError("Cancelled: nothing was made")

        return scatter(self, region, stop)

    monkeypatch.setattr(Spread, "scatter", cancelled)
    refused("Cancelled", guides, mode=mode, distribution="UNIFORM", count=1000)


@pytest.mark.parametrize("parting", ["NONE", "FACE_ATTRIBUTE"])
def test_the_redo_panel_shows_all_properties(parting):
    sheet()
    kind = bpy.ops.object.limit_children_add.get_rna_type()
    settings = {p.identifier: getattr(p, "default", None) for p in kind.properties}
    chosen = SimpleNamespace(**settings | {"mode": "LIVE", "parting": parting})
    layout = MagicMock()
    OBJECT_OT_limit_children_add.draw_own(layout, chosen)
    drawn = [*layout.prop.call_args_list, *layout.prop_search.call_args_list]
    names = {"mode", "guides", "guide_count", "points", "radius", "viewport_share", "parting"}
    if parting == "FACE_ATTRIBUTE":
        names.add("parting_attribute")
    assert {call.args[1] for call in drawn} == names
