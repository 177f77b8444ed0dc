# SPDX-License-Identifier: GPL-3.0-or-later
"""view3d.limit_draw without a window: strokes that are given, and refusals.

Mouse and keys are tested in blend_tests/gui.
"""

from dataclasses import replace

import bmesh
import bpy
import draw_scenes as drawn
import numpy as np
import pytest
import scenes

TOLERANCE = 1e-3
#: Blender stores coordinates up to 8 in single precision
ROUNDING = 1e-6


@pytest.fixture
def target():
    ob = scenes.cross()
    ob.location, ob.rotation_euler, ob.scale = (1, -2, 0.5), (0.3, 0.2, -0.4), (1.5, 0.7, -1.2)
    bpy.context.view_layer.update()
    return ob


def draw(strokes, **properties):
    return bpy.ops.view3d.limit_draw(
        **{"strokes": drawn.points(*strokes), "tolerance": TOLERANCE} | properties
    )


ACROSS = drawn.Given([0, 0, 1], [(0.2, 0.3), (0.8, 0.6), (0.5, 0.5)])
WITHIN = drawn.Given([2, 2, 2], [(0.1, 0.1), (0.9, 0.2), (0.5, 0.9)])
ONE_PLACE = drawn.Given([2, 2], [(0.5, 0.5), (0.5, 0.5)])


@pytest.mark.parametrize("spline", ["BEZIER", "POLY"])
@pytest.mark.parametrize("offset", [0.0, 0.02])
def test_curve_is_on_the_surface_everywhere(target, spline, offset):
    assert draw([ACROSS, WITHIN], spline=spline, offset=offset) == {"FINISHED"}
    ob = bpy.context.active_object
    assert ob.parent == target
    np.testing.assert_array_equal(ob.matrix_world, target.matrix_world)
    assert [each.type for each in ob.data.splines] == [spline] * 2
    for number, given in enumerate((ACROSS, WITHIN)):
        shown = drawn.world_points(ob, number)
        off = drawn.distance_from(target, shown) - offset
        assert np.abs(off).max() < TOLERANCE + ROUNDING
        wanted = drawn.world_places(target, given, offset)
        assert drawn.distance_from_polyline(wanted, shown).max() < TOLERANCE


def test_every_control_point_carries_its_location(target):
    draw([ACROSS, WITHIN])
    data = bpy.context.active_object.data
    face, uv = np.array(data["limit_face"]), np.array(data["limit_uv"]).reshape(-1, 2)
    points = np.concatenate([drawn.control_points(spline) for spline in data.splines])
    assert len(face) == len(uv) == len(points)
    np.testing.assert_array_equal(uv, uv.astype(np.float32))
    exact = scenes.surface_without_addon(target).evaluate(face, uv).position
    np.testing.assert_array_equal(points, exact.astype(np.float32))


def test_tolerance_zero_is_a_share_of_the_extent(target):
    draw([ACROSS], tolerance=0)
    ob = bpy.context.active_object
    size = np.linalg.norm(np.ptp(drawn.samples(target), axis=0))
    off = drawn.distance_from(target, drawn.world_points(ob, 0))
    assert off.max() < 1.01e-4 * size + ROUNDING
    few = len(ob.data.splines[0].bezier_points)
    scenes.activate(target)
    draw([ACROSS], tolerance=0.05)
    assert len(bpy.context.active_object.data.splines[0].bezier_points) < few


def test_pressure_becomes_the_radius(target):
    thin = drawn.Given(WITHIN.face, WITHIN.uv, [1.0, 0.25, 0.5])
    draw([thin], radius=0.03)
    data = bpy.context.active_object.data
    scale = np.cbrt(abs(np.linalg.det(np.array(target.matrix_world)[:3, :3])))
    assert data.bevel_depth == pytest.approx(0.03 / scale, rel=1e-6)
    radius = [point.radius for point in data.splines[0].bezier_points]
    assert radius[0] == 1.0
    assert radius[-1] == 0.5
    assert min(radius) == 0.25


def test_closed_stroke(target):
    ring = drawn.Given([2] * 4, [(0.2, 0.2), (0.8, 0.2), (0.8, 0.8), (0.2, 0.8)], is_closed=True)
    draw([ring])
    ob = bpy.context.active_object
    assert ob.data.splines[0].use_cyclic_u
    shown = drawn.world_points(ob, 0)
    np.testing.assert_allclose(shown[0], shown[-1], atol=ROUNDING)
    assert drawn.distance_from(target, shown).max() < TOLERANCE + ROUNDING
    assert drawn.distance_from_polyline(drawn.world_places(target, ring), shown).max() < TOLERANCE


def test_strokes_are_added_to_the_active_curve_and_replaced(target):
    draw([ACROSS])
    ob = bpy.context.active_object
    first = drawn.control_points(ob.data.splines[0])
    draw([WITHIN])
    assert bpy.context.active_object == ob
    assert len(ob.data.splines) == 2
    np.testing.assert_array_equal(drawn.control_points(ob.data.splines[0]), first)
    counts = [len(spline.bezier_points) for spline in ob.data.splines]
    assert len(ob.data["limit_face"]) == sum(counts)
    draw([], removed=[{"name": "", "index": 0}])
    assert [len(spline.bezier_points) for spline in ob.data.splines] == counts[1:]
    assert set(ob.data["limit_face"]) == {2}
    assert len(bpy.data.objects) == 2


def test_guides_are_rooted_where_strokes_begin(target):
    scenes.add_uv_map(target, lambda p: 0.1 * p[:, :2])
    assert draw([ACROSS, WITHIN], output="GUIDES", points=6, offset=0.1) == {"FINISHED"}
    ob = bpy.context.active_object
    assert ob.type == "CURVES"
    assert ob.data.surface == target
    assert [curve.points_length for curve in ob.data.curves] == [6, 6]
    strands = scenes.strands(ob)
    uv = np.array([(0.2, 0.3), (0.1, 0.1)], np.float32)
    exact = scenes.surface_without_addon(target).evaluate([0, 2], uv.astype(float)).position
    np.testing.assert_array_equal(strands[:, 0], exact.astype(np.float32))
    matrix = np.array(target.matrix_world, np.float64)
    rise = drawn.distance_from(target, scenes.transformed(matrix, strands.reshape(-1, 3)))
    np.testing.assert_allclose(rise.reshape(2, 6), [np.linspace(0, 0.1, 6)] * 2, atol=1e-5)
    names = {"limit_face", "limit_uv", "rest_root", "rest_rot", "surface_uv_coordinate", "radius"}
    assert names <= set(ob.data.attributes.keys())


@pytest.mark.parametrize("output", ["CURVE", "GUIDES"])
def test_what_is_drawn_follows_the_mesh(output):
    target = scenes.flat_grid(4)
    draw([drawn.Given([5, 6], [(0.5, 0.5), (0.5, 0.5)])], output=output, follow="NODES")
    ob = bpy.context.active_object
    before = drawn.evaluated_points(ob)
    for vertex in target.data.vertices:
        vertex.co.z += 1
    target.data.update()
    bpy.context.view_layer.update()
    np.testing.assert_allclose(drawn.evaluated_points(ob), before + [0, 0, 1], atol=10 * ROUNDING)


def test_why_a_drawing_does_not_follow_by_itself_is_told(target, capfd):
    target.shape_key_add(name="Basis")
    shown, rendered = scenes.add_subsurf(target), scenes.add_subsurf(target)
    shown.show_render = rendered.show_viewport = False
    draw([ACROSS])
    said = capfd.readouterr().out
    assert "it does not follow the surface: Cross is subdivided first by" in said


REFUSED = [
    ({}, "Scripts set `strokes`"),
    ({"strokes": drawn.points(drawn.Given([99, 99], [(0, 0), (1, 1)]))}, "face 99 is not"),
    ({"strokes": drawn.points(drawn.Given([0], [(0, 0)]))}, "at least two"),
    ({"strokes": drawn.points(ONE_PLACE)}, "at least two different points"),
    ({"strokes": drawn.points(ONE_PLACE), "output": "GUIDES"}, "at least two different points"),
    ({"strokes": drawn.points(ACROSS), "offset": np.nan}, "Offset is not a number"),
    ({"strokes": drawn.points(ACROSS), "radius": np.nan}, "Radius is not a number"),
    ({"strokes": drawn.points(ACROSS), "offset": np.inf}, "Offset is infinite"),
    (
        {"strokes": drawn.points(ACROSS), "offset": -np.inf, "output": "GUIDES"},
        "Offset is infinite",
    ),
    (
        {"strokes": drawn.points(replace(WITHIN, radius=(1.0, np.nan, 1.0)))},
        "The radius of a point is not a number",
    ),
    (
        {"strokes": drawn.points(ACROSS), "removed": [{"name": "", "index": 0}]},
        "no curve is active",
    ),
]


@pytest.mark.parametrize(("properties", "reason"), REFUSED)
def test_refusals_change_nothing(target, properties, reason):
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match=reason):
        bpy.ops.view3d.limit_draw(**properties)
    assert scenes.file_contents() == before


def test_points_without_a_place_are_named(target):
    wrong = drawn.Given([0, 999], [(0.5, 0.5), (0.5, 0.5)])
    with pytest.raises(RuntimeError, match=r"^Error: Point 1 of the strokes: face 999 "):
        draw([wrong])
    number = len(drawn.points(ACROSS)) + 1
    with pytest.raises(RuntimeError, match=rf"^Error: Point {number} of the strokes: face 999 "):
        draw([ACROSS, wrong])


def test_strokes_at_one_place_are_left_out(target):
    draw([WITHIN, ONE_PLACE, ACROSS])
    assert len(bpy.context.active_object.data.splines) == 2


def test_only_where_there_is_something_to_draw_on():
    assert not bpy.ops.view3d.limit_draw.poll()
    bpy.ops.curve.primitive_bezier_circle_add()
    assert not bpy.ops.view3d.limit_draw.poll()
    target = scenes.cross()
    assert bpy.ops.view3d.limit_draw.poll()
    bpy.ops.object.mode_set(mode="EDIT")
    assert not bpy.ops.view3d.limit_draw.poll()
    bpy.ops.object.mode_set(mode="OBJECT")
    draw([ACROSS])
    ob = bpy.context.active_object
    assert ob.parent == target
    ob.data.dimensions = "2D"
    assert not bpy.ops.view3d.limit_draw.poll()


def test_undo_and_redo(target):
    bpy.ops.ed.undo_push(message="Before")
    draw([ACROSS])
    bpy.ops.ed.undo_push(message="Drawn")
    bpy.ops.ed.undo()
    assert not bpy.data.curves
    assert bpy.context.active_object.type == "MESH"


@pytest.mark.parametrize("output", ["CURVE", "GUIDES"])
def test_nothing_is_left_of_a_drawing_that_cannot_follow(target, output):
    shown, rendered = scenes.add_subsurf(target), scenes.add_subsurf(target)
    shown.show_render = rendered.show_viewport = False
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match="subdivided first by"):
        draw([ACROSS], output=output, follow="NODES")
    assert scenes.file_contents() == before
    assert bpy.context.active_object == target


def test_a_drawing_stays_as_it_is_if_something_else_cannot_be_bound_again():
    target = scenes.flat_grid(4)
    scenes.add_hair(target, follow="NODES")
    scenes.activate(target)
    draw([WITHIN], follow="NODES", radius=0.0)
    drawing = bpy.context.active_object
    edited = bmesh.new()
    edited.from_mesh(target.data)
    edited.faces.ensure_lookup_table()
    bmesh.ops.delete(edited, geom=[edited.faces[-1]], context="FACES")
    edited.to_mesh(target.data)
    edited.free()
    bpy.context.view_layer.update()
    before = [drawn.control_points(spline) for spline in drawing.data.splines]
    with pytest.raises(RuntimeError, match="was bound before the faces"):
        draw([ACROSS])
    assert len(drawing.data.splines) == len(before)
    np.testing.assert_array_equal(drawn.control_points(drawing.data.splines[0]), before[0])


def test_a_drawing_without_strokes_is_continued(target):
    draw([ACROSS], follow="NODES", radius=0.0)
    drawing = bpy.context.active_object
    draw([], removed=[{"name": "", "index": 0}])
    assert not drawing.data.splines
    scenes.activate(target)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    scenes.activate(drawing)
    assert draw([WITHIN]) == {"FINISHED"}
    assert bpy.context.active_object == drawing
    np.testing.assert_allclose(
        drawn.evaluated_points(drawing)[0],
        drawn.control_points(drawing.data.splines[0])[0],
        atol=ROUNDING,
    )


def test_strokes_of_a_script_are_mirrored(capfd):
    target = scenes.flat_grid(4)
    for vertex in target.data.vertices:
        vertex.co.x -= 2
    stroke = drawn.Given([0, 0], [(0.2, 0.3), (0.8, 0.6)], [1.0, 0.5])
    assert draw([stroke], use_mirror=True, spline="POLY", radius=0.0) == {"FINISHED"}
    first, second = (drawn.control_points(s) for s in bpy.context.active_object.data.splines)
    np.testing.assert_allclose(first * [-1, 1, 1], second, atol=1e-5)
    radii = [[p.radius for p in s.points] for s in bpy.context.active_object.data.splines]
    np.testing.assert_allclose(radii[0], radii[1], atol=1e-5)
    assert "Warning" not in capfd.readouterr().out
    scenes.activate(target)
    for vertex in target.data.vertices:
        vertex.co.x += 2
    bpy.context.view_layer.update()
    assert draw([stroke], use_mirror=True) == {"FINISHED"}
    assert len(bpy.context.active_object.data.splines) == 1
    assert "1 stroke has no mirror image or only a part of it" in capfd.readouterr().out


@pytest.fixture
def bent():
    """A flat grid, and a shape key that bends it."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=6, y_subdivisions=4)
    ob = bpy.context.active_object
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Bend")
    key.value = 0  # Blender 5.2 begins with 1
    for point in key.data:
        point.co.z += point.co.x**2
    return ob, key


FAR = drawn.Given([0, 18], [(0.5, 0.5), (0.5, 0.5)])
NEAR = drawn.Given([5, 23], [(0.5, 0.5), (0.5, 0.5)])


def test_what_follows_is_changed_only_in_the_pose_of_its_binding(bent):
    _surface, key = bent
    draw([FAR, NEAR], radius=0.0)
    ob = bpy.context.active_object
    at_rest = drawn.evaluated_points(ob)
    key.value = 1
    there = drawn.evaluated_points(ob)
    assert np.abs(there - at_rest).max() > 0.1
    removed = [{"name": "", "index": 0}]
    with pytest.raises(RuntimeError, match="another shape now than when the curve was bound"):
        bpy.ops.view3d.limit_draw(removed=removed)
    with pytest.raises(RuntimeError, match="another shape now than when the curve was bound"):
        draw([NEAR])
    np.testing.assert_array_equal(drawn.evaluated_points(ob), there)
    key.value = 0
    bpy.context.view_layer.update()
    assert bpy.ops.view3d.limit_draw(removed=removed) == {"FINISHED"}
    np.testing.assert_allclose(
        drawn.evaluated_points(ob),
        at_rest[len(at_rest) - len(drawn.evaluated_points(ob)) :],
        atol=1e-6,
    )
    key.value = 1
    np.testing.assert_allclose(
        drawn.evaluated_points(ob), there[len(there) - len(drawn.evaluated_points(ob)) :], atol=1e-5
    )


def test_a_drawing_in_another_pose_is_changed_after_the_advice_was_followed(bent):
    _surface, key = bent
    draw([FAR], radius=0.02)
    ob = bpy.context.active_object
    at_rest = drawn.control_points(ob.data.splines[0])
    key.value = 1
    bpy.context.view_layer.update()
    with pytest.raises(RuntimeError, match="Unbind from Limit Surface with the shape At Rest"):
        draw([NEAR])
    assert bpy.ops.object.limit_unbind(shape="REST") == {"FINISHED"}
    np.testing.assert_array_equal(drawn.control_points(ob.data.splines[0]), at_rest)
    assert draw([NEAR]) == {"FINISHED"}
    assert bpy.context.active_object == ob
    assert len(ob.data.splines) == 2


CLEARS = (bpy.ops.object.location_clear, bpy.ops.object.rotation_clear, bpy.ops.object.scale_clear)


@pytest.mark.parametrize("is_child", [True, False])
def test_the_place_of_a_drawing_that_was_moved_is_named(target, is_child):
    draw([ACROSS], radius=0.0, spline="POLY", follow="NODES")
    ob = bpy.context.active_object
    if not is_child:
        bpy.ops.object.parent_clear(type="CLEAR_KEEP_TRANSFORM")
    shown = scenes.transformed(np.array(ob.matrix_world), drawn.evaluated_points(ob))
    ob.location.x, ob.rotation_euler.z, ob.scale.y = 1, 0.3, 2
    bpy.context.view_layer.update()
    moved = scenes.transformed(np.array(ob.matrix_world), drawn.evaluated_points(ob))
    np.testing.assert_allclose(moved, shown, atol=1e-5)
    advice = "clear the object's location" if is_child else "the same location, rotation and scale"
    with pytest.raises(RuntimeError, match=f"The object {ob.name} was moved.*{advice}"):
        draw([WITHIN])
    if is_child:
        for clear in CLEARS:
            clear()
    else:
        ob.matrix_world = target.matrix_world
    bpy.context.view_layer.update()
    assert draw([WITHIN]) == {"FINISHED"}
    assert len(ob.data.splines) == 2


def test_points_follow_their_own_location_where_another_sheet_is_nearer():
    """Of two sheets 0.05 apart the lower one is drawn on, with an offset that ends at the upper."""
    x, y = np.meshgrid(np.arange(5.0), np.arange(5.0))
    corners = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], 1)
    faces = np.array([[a, a + 1, a + 6, a + 5] for j in range(4) for a in range(5 * j, 5 * j + 4)])
    mesh = bpy.data.meshes.new("Sheets")
    points = np.concatenate([corners, corners + [0, 0, 0.05]])
    mesh.from_pydata(points.tolist(), [], np.concatenate([faces, faces + 25]).tolist())
    ob = bpy.data.objects.new("Sheets", mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Raise")
    key.value = 0  # Blender 5.2 begins with 1
    for point in list(key.data)[25:]:
        point.co.z += 1
    stroke = drawn.Given([5, 6, 10], [(0.3, 0.5), (0.5, 0.5), (0.5, 0.5)])
    draw([stroke], radius=0.0, offset=0.04)
    curve = bpy.context.active_object
    assert np.abs(drawn.evaluated_points(curve)[:, 2] - 0.04).max() < 1e-6
    key.value = 1
    assert np.abs(drawn.evaluated_points(curve)[:, 2] - 0.04).max() < 1e-6


@pytest.mark.parametrize("to", [3, 4])
def test_pieces_are_reported(to, capfd):
    """Faces 0 to 3 are an island, and faces 4 to 7 another one."""
    x, y = (each.ravel() for each in np.meshgrid(np.arange(3.0), np.arange(3.0)))
    corners = np.stack([x, y, 0 * x], 1)
    faces = np.array([[a, a + 1, a + 4, a + 3] for a in (0, 1, 3, 4)])
    mesh = bpy.data.meshes.new("Islands")
    positions = np.concatenate([corners, corners + [4, 0, 0]])
    mesh.from_pydata(positions.tolist(), [], np.concatenate([faces, faces + 9]).tolist())
    ob = bpy.data.objects.new("Islands", mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    draw([drawn.Given([0, to], [(0.5, 0.5), (0.5, 0.5)])])
    is_divided = len(bpy.context.active_object.data.splines) > 1
    assert is_divided == (to == 4)
    assert ("2 pieces were made of 1 stroke," in capfd.readouterr().out) == is_divided


def test_tolerances_below_single_precision_are_not_tried(target):
    draw([WITHIN], tolerance=1e-12)
    finest = len(bpy.context.active_object.data.splines[0].bezier_points)
    bpy.context.view_layer.objects.active = target
    corners = drawn.samples(target)
    draw([WITHIN], tolerance=1e-6 * np.linalg.norm(np.ptp(corners, axis=0)) / 2)
    assert len(bpy.context.active_object.data.splines[0].bezier_points) == finest


def test_a_hidden_mesh_is_not_drawn_on(target):
    target.hide_set(True)
    with pytest.raises(RuntimeError, match="hidden"):
        draw([WITHIN])
