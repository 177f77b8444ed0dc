# SPDX-License-Identifier: GPL-3.0-or-later
"""Curve objects that follow a deforming surface by Geometry Nodes."""

import bpy
import follow_scenes
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import check_hair, deforming
from limit_surface import ids
from limit_surface.placing.followers import curve_table, surface_of
from limit_surface.reading import attributes
from mathutils import Euler, Matrix

FRAMES = ((1, 0.0), (13, 0.5), (30, 0.0))
KINDS = ("POLY", "NURBS", "BEZIER")
HANDLES = ("co", "handle_left", "handle_right")


def curve(ob: bpy.types.Object, kinds=KINDS, name="Curve") -> bpy.types.Object:
    """Adds splines of these types, of 4, 5, ... points near the mesh, in a space of their own."""
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    made = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(made)
    turned = Euler((0.2, 0.1, 0.4)).to_matrix().to_4x4()
    made.matrix_world = (
        Matrix.Translation((0.3, 0.1, -0.2)) @ turned @ Matrix.Diagonal((1, 2, 0.7, 1))
    )
    bpy.context.view_layer.update()
    rng = np.random.default_rng(2)
    vertices = attributes.read(ob.data, ids.POSITION)
    for i, kind in enumerate(kinds):
        count = 4 + i
        near = vertices[rng.permutation(len(vertices))[:count]] + rng.uniform(0, 0.2, (count, 3))
        world = scenes.transformed(ob.matrix_world, near)
        points = scenes.transformed(made.matrix_world.inverted(), world)
        spline = data.splines.new(kind)
        if kind == "BEZIER":
            spline.bezier_points.add(count - 1)
            for point, co in zip(spline.bezier_points, points, strict=True):
                point.co = co
                point.handle_left_type, point.handle_right_type = "FREE", "FREE"
                point.handle_left = co + rng.uniform(-0.3, 0.3, 3)
                point.handle_right = co + rng.uniform(-0.3, 0.3, 3)
        else:
            spline.points.add(count - 1)
            spline.points.foreach_set(
                "co", np.column_stack([points, rng.uniform(1, 3, count)]).ravel()
            )
            spline.order_u = 3
            spline.use_endpoint_u = True
    return made


def follow(made: bpy.types.Object, ob: bpy.types.Object) -> None:
    for each in bpy.context.selected_objects:
        each.select_set(False)
    made.select_set(True)
    scenes.activate(ob)
    assert bpy.ops.object.limit_follow() == {"FINISHED"}


def control_points(made: bpy.types.Object) -> np.ndarray:
    """Returns for each control point the point itself and its handles (n, 3, 3); points without
    handles three times.
    """
    found = []
    for spline in made.data.splines:
        if spline.type == "BEZIER":
            found += [[getattr(p, name) for name in HANDLES] for p in spline.bezier_points]
        else:
            found += [[p.co[:3]] * 3 for p in spline.points]
    return np.array(found, np.float64)


def outline(made: bpy.types.Object) -> np.ndarray:
    evaluated = made.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    positions = attributes.read(mesh, ids.POSITION).astype(np.float64)
    evaluated.to_mesh_clear()
    return positions


def expected_outline(made: bpy.types.Object, now: follow_truth.Frames) -> np.ndarray:
    """Returns the outline of a copy whose control points are moved by hand."""
    moved = follow_truth.moved(control_points(made), curve_table(made).data, now)
    copy = made.copy()
    copy.data = made.data.copy()
    copy.modifiers.clear()
    bpy.context.collection.objects.link(copy)
    rows = iter(moved)
    for spline in copy.data.splines:
        for point in spline.bezier_points if spline.type == "BEZIER" else spline.points:
            own, left, right = next(rows)
            point.co = own if spline.type == "BEZIER" else (*own, point.co[3])
            if spline.type == "BEZIER":
                point.handle_left, point.handle_right = left, right
    bpy.context.view_layer.update()
    found = outline(copy)
    bpy.data.objects.remove(copy)
    return found


def check(made: bpy.types.Object, ob: bpy.types.Object) -> None:
    relation = np.linalg.inv(np.array(made.matrix_world)) @ np.array(ob.matrix_world)
    scale = max(1, np.abs(relation).max())
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        now = follow_truth.on_surface(ob, curve_table(made).data, relation)
        expected = expected_outline(made, now)
        error = np.abs(outline(made) - expected).max()
        assert error < scale * follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)


@pytest.mark.every(3)
@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("kinds", [(kind,) for kind in KINDS] + [KINDS])
def test_splines_follow(kinds, mirrored):
    ob = deforming("grid with holes", mirrored)
    made = curve(ob, kinds)
    before = control_points(made)
    at_rest = outline(made)
    follow(made, ob)
    np.testing.assert_array_equal(control_points(made), before)
    np.testing.assert_allclose(outline(made), at_rest, atol=1e-5)
    check(made, ob)
    assert np.abs(outline(made) - at_rest).max() > 0.1


def test_places_are_the_closest_ones():
    ob = deforming("cross")
    made = curve(ob)
    follow(made, ob)
    surface = scenes.surface_without_addon(ob)
    world = scenes.transformed(ob.matrix_world, surface.positions)
    surface.set_positions(world)
    points = scenes.transformed(made.matrix_world, control_points(made)[:, 0])
    face, uv = scenes.locations(curve_table(made).data)
    own = np.linalg.norm(surface.evaluate(face, uv).position - points, axis=1)
    np.testing.assert_allclose(own, surface.closest(points).distance, atol=1e-5)


def test_several_curves_and_hair_share_the_tables():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NODES")
    first, second = curve(ob, ("POLY",), "A"), curve(ob, ("BEZIER",), "B")
    follow(first, ob)
    follow(second, ob)
    assert len([o for o in bpy.data.objects if o.name.startswith(ids.TILES_TABLE)]) == 1
    assert len([o for o in bpy.data.objects if o.name.startswith(ids.CURVE_TABLE)]) == 2
    check(first, ob)
    check(second, ob)
    bpy.context.scene.frame_set(30)
    now = follow_truth.on_surface(ob, hair.data)
    expected = follow_truth.moved(scenes.strands(hair), hair.data, now)
    bound = follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    assert np.abs(follow_truth.shown_strands(hair) - expected).max() < bound


def test_another_number_of_points_stays_at_rest_until_it_is_bound_anew():
    ob = deforming("cross")
    made = curve(ob, ("POLY",))
    follow(made, ob)
    made.data.splines[0].points.add(1)
    bpy.context.scene.frame_set(30)
    np.testing.assert_allclose(outline(made), control_points(made)[:, 0], atol=1e-6)
    follow(made, ob)
    assert len([o for o in bpy.data.objects if o.name.startswith(ids.CURVE_TABLE)]) == 1
    check(made, ob)


@pytest.mark.parametrize("method", ["CLOSEST", "UV", "FACE"])
def test_it_is_bound_again_after_a_change(method):
    ob = deforming("grid with holes")
    made = curve(ob)
    follow(made, ob)
    before = control_points(made)
    if method == "FACE":
        ob.modifiers["Subdivision"].boundary_smooth = "PRESERVE_CORNERS"
    else:
        mirror = ob.modifiers.new("Mirror", "MIRROR")
        ob.modifiers.move(ob.modifiers.find(mirror.name), 0)
    scenes.activate(made)
    assert bpy.ops.object.limit_rebind(method=method) == {"FINISHED"}
    np.testing.assert_array_equal(control_points(made), before)
    check(made, ob)


def test_added_control_points_are_bound_with_the_others():
    ob = deforming("cross")
    made = curve(ob, ("POLY",))
    follow(made, ob)
    made.data.splines[0].points.add(1)
    scenes.activate(made)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    check(made, ob)


def test_it_plays_after_a_reload(tmp_path):
    ob = deforming("cross")
    follow(curve(ob), ob)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    check(bpy.data.objects["Curve"], bpy.data.objects["Cross"])


def bevelled(made: bpy.types.Object) -> None:
    made.data.bevel_depth = 0.1


def flat(made: bpy.types.Object) -> None:
    made.data.dimensions = "2D"


def emptied(made: bpy.types.Object) -> None:
    made.data.splines.clear()


def scaled_to_nothing(made: bpy.types.Object) -> None:
    made.scale = (1, 0, 1)
    bpy.context.view_layer.update()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (bevelled, "Curve has a bevel or is extruded"),
        (flat, "Curve is a 2D curve"),
        (emptied, "Curve has no control points"),
        (scaled_to_nothing, "scale of 0"),
    ],
)
def test_refusals(change, message):
    ob = deforming("cross")
    made = curve(ob, ("POLY",))
    change(made)
    contents = scenes.file_contents()
    with pytest.raises(RuntimeError, match=message):
        follow(made, ob)
    assert scenes.file_contents() == contents
    assert not made.modifiers


def test_a_curve_without_a_surface_is_refused():
    ob = deforming("cross")
    made = curve(ob)
    scenes.activate(made)
    ob.select_set(False)
    with pytest.raises(RuntimeError, match="Curve has no surface"):
        bpy.ops.object.limit_follow()


def test_a_copy_keeps_its_places():
    ob = deforming("cross")
    made = curve(ob, ("POLY",))
    follow(made, ob)
    twin = made.copy()
    twin.data = made.data.copy()
    bpy.context.collection.objects.link(twin)
    made.location.x += 0.05
    bpy.context.view_layer.update()
    follow(made, ob)
    assert curve_table(made) != curve_table(twin)
    check(made, ob)
    check(twin, ob)


def test_a_curve_goes_back_to_rest():
    ob = deforming("cross")
    made = curve(ob, ("POLY",))
    objects = set(bpy.data.objects)
    follow(made, ob)
    bpy.context.scene.frame_set(30)
    ob.select_set(False)
    scenes.activate(made)
    with pytest.raises(RuntimeError, match="Curve is a Curve object, which cannot store the shape"):
        bpy.ops.object.limit_unbind(shape="SHOWN")
    assert bpy.ops.object.limit_unbind(shape="REST") == {"FINISHED"}
    assert set(bpy.data.objects) == objects
    assert not made.modifiers
    assert [m.type for m in ob.modifiers] == ["WAVE", "SUBSURF"]
    np.testing.assert_allclose(outline(made), control_points(made)[:, 0], atol=1e-6)


def test_curves_are_rebound_at_their_closest_places():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, per_side=2, follow="NODES")
    first, second = curve(ob, ("POLY",), "A"), curve(ob, ("BEZIER",), "B")
    follow(first, ob)
    follow(second, ob)
    bpy.context.scene.frame_set(1)
    for modifier in ob.modifiers:  # another control mesh: the faces of before do not hold
        modifier.show_viewport = modifier.type != "WAVE"
    ob.shape_key_clear()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    follow_truth.animate(ob)
    ob.modifiers.move(len(ob.modifiers) - 1, 0)
    for each in bpy.context.selected_objects:
        each.select_set(False)
    scenes.activate(ob)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    check(first, ob)
    check(second, ob)
    check_hair(ob, hair)


def test_a_curve_that_follows_is_bound_at_its_new_places_when_it_is_snapped():
    ob = deforming("cross")
    made = curve(ob, ("POLY",))
    follow(made, ob)
    bpy.context.scene.limit_surface.target = ob
    ob.select_set(False)
    scenes.activate(made)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curve.select_all(action="SELECT")
    assert bpy.ops.object.limit_snap() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    relation = np.linalg.inv(np.array(made.matrix_world)) @ np.array(ob.matrix_world)
    places = follow_truth.on_surface(ob, curve_table(made).data, relation)
    np.testing.assert_allclose(control_points(made)[:, 0], places.position, atol=1e-5)
    check(made, ob)


def test_a_curve_whose_table_was_deleted_is_named_until_it_follows_again():
    ob = deforming("cross")
    made = curve(ob)
    follow(made, ob)
    bpy.data.objects.remove(curve_table(made))
    scenes.activate(ob)
    with pytest.raises(RuntimeError, match="Curve follows Cross, but its places .* deleted"):
        bpy.ops.object.limit_hair_add(follow="NODES")
    follow(made, ob)
    assert bpy.ops.object.limit_hair_add(follow="NODES") == {"FINISHED"}
    check(made, ob)


@pytest.mark.parametrize("change", ["rebind", "add hair"])
def test_changes_of_a_copy_leave_the_original(change):
    """Copies of a curve read the same hidden table."""
    ob = deforming("grid with holes")
    made = curve(ob)
    follow(made, ob)
    for each in bpy.context.selected_objects:
        each.select_set(False)
    made.select_set(True)
    ob.select_set(True)
    bpy.ops.object.duplicate()
    (copy,) = [each for each in bpy.context.selected_objects if each.type == "MESH"]
    scenes.activate(copy)
    if change == "rebind":
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide()
        bpy.ops.object.mode_set(mode="OBJECT")
        assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    else:
        assert bpy.ops.object.limit_hair_add(follow="NODES") == {"FINISHED"}
    assert follow_scenes.look(ob) == []
    assert follow_scenes.look(copy) == []
    check(made, ob)
    (of_copy,) = [o for o in bpy.data.objects if o.type == "CURVE" and surface_of(o) == copy]
    check(of_copy, copy)
