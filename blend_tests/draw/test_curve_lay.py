# SPDX-License-Identifier: GPL-3.0-or-later
"""object.limit_curve_lay: curves that exist are laid onto the surface, between their points too."""

import bpy
import draw_scenes as drawn
import numpy as np
import pytest
import scenes

TOLERANCE = 1e-3
ROUNDING = 1e-6


@pytest.fixture
def target():
    ob = scenes.grid_with_holes()
    ob.location, ob.rotation_euler, ob.scale = (1, -2, 0.5), (0.3, 0.2, -0.4), (1.5, 0.7, 1.2)
    bpy.context.view_layer.update()
    return ob


def curve(kind, positions, cyclic=False):
    """Adds a Curve object with one spline through points of the world; its own matrix is another
    one.
    """
    data = bpy.data.curves.new("Cable", "CURVE")
    data.dimensions = "3D"
    ob = bpy.data.objects.new("Cable", data)
    bpy.context.collection.objects.link(ob)
    ob.location, ob.scale = (0.5, 1, -1), (2, 2, 2)
    bpy.context.view_layer.update()
    inside = scenes.transformed(
        np.linalg.inv(np.array(ob.matrix_world, np.float64)), np.array(positions, float)
    )
    spline = data.splines.new(kind)
    points = spline.bezier_points if kind == "BEZIER" else spline.points
    points.add(len(inside) - 1)
    for point, position in zip(points, inside, strict=True):
        if kind == "BEZIER":
            point.co = position
            point.handle_left_type = point.handle_right_type = "AUTO"
        else:
            point.co = (*position, 1)
    spline.use_cyclic_u = cyclic
    spline.resolution_u = 64  # so that samples show the curve itself
    return ob


def over(target, places, rise=0.2):
    """Points of the world above places (x, y) of the target's own space."""
    surface = scenes.surface_without_addon(target)
    origins = np.array([(*place, 5) for place in places], float)
    hits = surface.ray_cast(origins, np.tile([0.0, 0, -1], (len(places), 1)))
    on = hits.position + [0, 0, rise]
    return scenes.transformed(np.array(target.matrix_world, np.float64), on)


PLACES = [(0.4, 0.3), (2.5, 0.6), (4.4, 0.4), (4.5, 2.5)]


def lay(ob, target, **properties):
    for other in bpy.context.selected_objects:
        other.select_set(False)
    ob.select_set(True)
    target.select_set(True)
    scenes.activate(target)
    return bpy.ops.object.limit_curve_lay(**{"tolerance": TOLERANCE} | properties)


@pytest.mark.parametrize("spline", ["BEZIER", "POLY"])
@pytest.mark.parametrize("kind", ["BEZIER", "POLY"])
def test_curve_is_laid_between_its_points(target, kind, spline):
    ob = curve(kind, over(target, PLACES))
    before, matrix = drawn.world_points(ob, 0), np.array(ob.matrix_world)
    assert drawn.distance_from(target, before).max() > 10 * TOLERANCE
    assert lay(ob, target, spline=spline) == {"FINISHED"}
    assert ob.data.splines[0].type == spline
    np.testing.assert_array_equal(ob.matrix_world, matrix)
    after = drawn.world_points(ob, 0)
    assert drawn.distance_from(target, after).max() < TOLERANCE + ROUNDING
    # the feet of what was there
    feet = drawn.surface_in_world(target).closest(before[::10]).position
    assert drawn.distance_from_polyline(feet, after).max() < 2 * TOLERANCE


def test_report_states_the_largest_distance(target, capfd):
    ob = curve("BEZIER", over(target, PLACES))
    lay(ob, target)
    said = capfd.readouterr().out
    assert "1 curve with " in said
    stated = float(said.split("at most ")[1].split(" from ")[0])
    found = drawn.distance_from(target, drawn.world_points(ob, 0)).max()
    assert stated <= TOLERANCE
    assert stated == pytest.approx(found, rel=0.2)


def test_offset_and_closed_curves(target):
    ring = curve("BEZIER", over(target, [(2.3, 0.3), (4.5, 0.4), (4.4, 1.7), (2.4, 1.6)]), True)
    lay(ring, target, offset=0.05)
    assert ring.data.splines[0].use_cyclic_u
    off = drawn.distance_from(target, drawn.world_points(ring, 0)) - 0.05
    assert np.abs(off).max() < TOLERANCE + ROUNDING
    assert ring.data["limit_offset"] == pytest.approx(0.05)
    lay(ring, target)
    assert "limit_offset" not in ring.data
    assert drawn.distance_from(target, drawn.world_points(ring, 0)).max() < TOLERANCE + ROUNDING


def test_it_follows_the_mesh_afterwards(target):
    ob = curve("POLY", over(target, PLACES))
    ob.select_set(True)
    scenes.activate(target)
    bpy.ops.object.limit_follow()
    lay(ob, target, spline="POLY")
    shown = drawn.evaluated_points(ob)
    matrix = np.array(ob.matrix_world, np.float64)
    assert drawn.distance_from(target, scenes.transformed(matrix, shown)).max() < TOLERANCE + 1e-5
    for vertex in target.data.vertices:
        vertex.co.z = 2 * vertex.co.z + 0.3 * vertex.co.x
    target.data.update()
    bpy.context.view_layer.update()
    shown = drawn.evaluated_points(ob)
    points = scenes.transformed(matrix, shown)
    near = drawn.distance_from(target, points)
    assert len(near) == len(ob.data.splines[0].points)
    assert near.max() < 1e-5


def test_pieces_where_the_surface_has_no_way(target, capfd):
    box = scenes.add_mesh(
        "Slab",
        [(x, y, 0.05 * z) for z in (0, 1) for y in (0, 1) for x in (0, 1)],
        [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)],
    )
    bpy.context.view_layer.update()
    ob = curve("POLY", [(0.3, 0.5, 0.3), (0.5, 0.5, 0.3), (0.5, 0.5, -0.3), (0.7, 0.5, -0.3)])
    lay(ob, box)
    assert len(ob.data.splines) == 2
    said = capfd.readouterr().out
    assert "2 curves with " in said
    assert "2 pieces were made of 1 curve," in said


def test_modifiers_that_show_a_curve_elsewhere_are_named(target, capfd):
    ob = curve("POLY", over(target, PLACES))
    ob.modifiers.new("Bent", "SIMPLE_DEFORM")
    ob.modifiers.new("Tube", "NODES")
    lay(ob, target)
    assert "It is shown as its modifiers change it: Bent\n" in capfd.readouterr().out
    ob.modifiers["Bent"].show_viewport = False
    lay(ob, target)
    assert "as its modifiers" not in capfd.readouterr().out


def test_curves_that_another_object_shares_are_refused(target):
    ob = curve("POLY", over(target, PLACES))
    other = bpy.data.objects.new("Other", ob.data)
    bpy.context.collection.objects.link(other)
    before = drawn.control_points(ob.data.splines[0])
    with pytest.raises(RuntimeError, match=f"{ob.name} shares its curves with Other"):
        lay(ob, target)
    np.testing.assert_array_equal(drawn.control_points(ob.data.splines[0]), before)


REFUSALS = {
    "NURBS": "convert them",
    "2D": "2D curve",
    "one point": "two control points",
}


@pytest.mark.parametrize("what", REFUSALS)
def test_refusals_change_nothing(target, what):
    ob = curve("NURBS" if what == "NURBS" else "POLY", over(target, PLACES))
    if what == "2D":
        ob.data.dimensions = "2D"
    if what == "one point":
        ob.data.splines.clear()
        ob.data.splines.new("POLY")
    before = [drawn.control_points(spline) for spline in ob.data.splines]
    there = scenes.file_contents()
    with pytest.raises(RuntimeError, match=REFUSALS[what]):
        lay(ob, target)
    for spline, points in zip(ob.data.splines, before, strict=True):
        np.testing.assert_array_equal(drawn.control_points(spline), points)
    assert scenes.file_contents() == there


def test_only_with_curves_and_a_mesh(target):
    assert not bpy.ops.object.limit_curve_lay.poll()
    ob = curve("POLY", over(target, PLACES))
    ob.select_set(True)
    scenes.activate(target)
    assert bpy.ops.object.limit_curve_lay.poll()
    scenes.activate(ob)
    assert not bpy.ops.object.limit_curve_lay.poll()


def test_materials_and_shading_stay(target):
    ob = curve("BEZIER", over(target, PLACES))
    for name in "AB":
        ob.data.materials.append(bpy.data.materials.new(name))
    ob.data.splines[0].material_index, ob.data.splines[0].use_smooth = 1, False
    lay(ob, target)
    (spline,) = ob.data.splines
    assert (spline.material_index, spline.use_smooth) == (1, False)


def test_curves_without_a_place_in_the_world_are_refused(target):
    ob = curve("BEZIER", over(target, PLACES))
    before = ob.scale.copy()
    ob.scale = (0, 1, 1)
    with pytest.raises(RuntimeError, match="scale"):
        lay(ob, target)
    ob.scale = before
    ob.data.splines[0].bezier_points[1].co.x = float("nan")
    with pytest.raises(RuntimeError, match="Spline 0 of Cable has coordinates"):
        lay(ob, target)


def test_library_overrides_are_refused(tmp_path):
    """Blender does not save points that are written to them."""
    target = scenes.cross()
    ob, target = scenes.overridden(tmp_path, curve("POLY", over(target, PLACES)), target)
    before = drawn.control_points(ob.data.splines[0])
    with pytest.raises(RuntimeError, match="is a library override: Blender does not save"):
        lay(ob, target)
    np.testing.assert_array_equal(drawn.control_points(ob.data.splines[0]), before)
