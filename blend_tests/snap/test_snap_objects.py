# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects snapped to the limit surface: places, rotations, parents, and obstacles."""

import bpy
import numpy as np
import pytest
import scenes
from mathutils import Matrix, Vector
from snap_truth import (
    Truth,
    add_object,
    mirrored,
    near,
    refused_and_unchanged,
    snap,
    stretched,
    world_locations,
)

EXACT = 1e-6  # the error of single precision for objects some units away from the origin


@pytest.mark.parametrize("scene", ["cross", "grid with holes", "mixed polygons"])
@pytest.mark.parametrize("placed", [stretched, mirrored])
def test_nearest_in_world_space(scene, placed):
    target = placed(scenes.SCENES[scene]())
    points = near(target, 12, 0.4)
    things = [add_object(point) for point in points]
    truth = Truth(target)
    before = world_locations(things)
    snap(target)
    after = world_locations(things)
    np.testing.assert_allclose(truth.distances(after), 0, atol=EXACT)
    moved = np.linalg.norm(after - before, axis=1)
    np.testing.assert_allclose(moved, truth.distances(before), atol=EXACT)


def test_snapping_twice_is_snapping_once():
    target = stretched(scenes.mixed_polygons())
    things = [add_object(point) for point in near(target, 12, 0.4)]
    for properties in ({}, {"offset": 0.05, "align": "NORMAL_DU"}, {"mode": "AXIS"}):
        snap(target, **properties)
        once = np.array([thing.matrix_world for thing in things])
        snap(target, **properties)
        twice = np.array([thing.matrix_world for thing in things])
        np.testing.assert_allclose(twice[:, :3, 3], once[:, :3, 3], atol=EXACT)
        # Next to corners a small move turns the frame by a large angle.
        np.testing.assert_allclose(twice, once, atol=1e-4)


@pytest.mark.parametrize("placed", [stretched, mirrored])
def test_offset_along_the_outward_normal(placed):
    target = placed(scenes.cross())
    things = [add_object(point) for point in near(target, 8, 0.2)]
    snap(target)
    on_surface = world_locations(things)
    normals = Truth(target).normals_at(on_surface)
    snap(target, offset=0.25)
    np.testing.assert_allclose(world_locations(things), on_surface + 0.25 * normals, atol=1e-5)


ORIENTATIONS = {
    "GLOBAL": lambda _thing: np.eye(3),
    "LOCAL": lambda thing: np.array(thing.matrix_world.to_3x3().normalized()),
    "VIEW": lambda _thing: np.array(VIEW.to_3x3()).T,
}
VIEW = Matrix.Rotation(0.3, 4, "X") @ Matrix.Translation((1, 2, -20))


@pytest.mark.every(4)
@pytest.mark.parametrize("orientation", ORIENTATIONS)
@pytest.mark.parametrize("axis", "XYZ")
def test_along_an_axis(orientation, axis):
    target = stretched(scenes.monkey())
    things = [add_object(point) for point in near(target, 6, 0.3)]
    for i, thing in enumerate(things):
        thing.rotation_euler = (i, 2 * i, 3 * i)
    before = world_locations(things)
    directions = np.array(
        [ORIENTATIONS[orientation](thing)[:, "XYZ".index(axis)] for thing in things]
    )
    truth = Truth(target)
    bpy.ops.object.select_all(action="SELECT")
    snap(
        target,
        mode="AXIS",
        axis=axis,
        orientation=orientation,
        view_matrix=VIEW,
    )
    after = world_locations(things)
    check_along_lines(truth, before, after, directions)


def check_along_lines(truth, before, after, directions):
    """Each moved object is on the surface and has moved along its line, and nothing on the line is
    closer.
    """
    moved = np.linalg.norm(after - before, axis=1) > 0
    assert moved.any()
    for start, end, direction, did in zip(before, after, directions, moved, strict=True):
        crossings = np.abs(crossed(truth, start, direction))
        if not did:
            assert not len(crossings)
            continue
        np.testing.assert_allclose(np.cross(end - start, direction), 0, atol=EXACT)
        assert truth.closest(end)[2] < EXACT
        # The polygons through the samples are a little off the surface.
        assert np.linalg.norm(end - start) < crossings.min(initial=np.inf) + 0.02


def crossed(truth, start, direction):
    """Returns where the line meets the triangles through the samples."""
    side = int(np.sqrt(len(truth.samples) // truth.surface.face_count))
    grid = truth.samples.reshape(-1, side, side, 3)
    a, b, c, d = grid[:, :-1, :-1], grid[:, :-1, 1:], grid[:, 1:, 1:], grid[:, 1:, :-1]
    triangles = np.concatenate(
        [np.stack([a, b, c], axis=-2).reshape(-1, 3, 3), np.stack([a, c, d], -2).reshape(-1, 3, 3)]
    )
    p, e, f = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    across = np.cross(direction, f)
    determinant = (e * across).sum(axis=1)
    with np.errstate(all="ignore"):
        u = ((start - p) * across).sum(axis=1) / determinant
        other = np.cross(start - p, e)
        v = (other @ direction) / determinant
        t = (f * other).sum(axis=1) / determinant
    return t[(u >= 0) & (v >= 0) & (u + v <= 1) & np.isfinite(t)]


def test_along_the_line_of_sight():
    target = stretched(scenes.cross())
    eye = np.array(target.location) + (0.1, 0.2, 9)
    view = Matrix.Translation(eye).inverted()
    things = [add_object(point) for point in near(target, 6, 0.2)]
    before, truth = world_locations(things), Truth(target)
    snap(
        target,
        mode="AXIS",
        orientation="VIEW",
        view_matrix=view,
        view_is_perspective=True,
    )
    sight = eye - before
    sight /= np.linalg.norm(sight, axis=1, keepdims=True)
    check_along_lines(truth, before, world_locations(things), sight)


def test_without_a_viewport_there_is_no_view():
    target = scenes.cross()
    thing = add_object((0, 0, 1))
    with pytest.raises(RuntimeError, match="no 3D viewport"):
        snap(target, mode="AXIS", orientation="VIEW")
    assert tuple(thing.location) == (0, 0, 1)


def test_one_way_along_the_own_normal():
    target = scenes.flat_grid(4)
    above, below = add_object((2, 2.2, 1)), add_object((2, 1.8, -1))
    snap(target, mode="NORMAL", direction="POSITIVE")
    np.testing.assert_allclose(
        world_locations([above, below]), [(2, 2.2, 1), (2, 1.8, 0)], atol=1e-6
    )
    snap(target, mode="NORMAL", direction="NEGATIVE")
    np.testing.assert_allclose(
        world_locations([above, below]), [(2, 2.2, 0), (2, 1.8, 0)], atol=1e-6
    )


def test_an_object_on_the_surface_stays_there_whichever_way(capfd):
    """This holds on the border, too, where a line might miss the surface."""
    target = stretched(scenes.mixed_polygons())
    things = [add_object(point) for point in near(target, 30, 0.5)]
    snap(target)
    before = world_locations(things)
    for direction in ("POSITIVE", "NEGATIVE", "BOTH"):
        snap(target, mode="AXIS", axis="Z", direction=direction)
        np.testing.assert_allclose(world_locations(things), before, atol=EXACT)
    assert capfd.readouterr().out.count("30 of 30 objects snapped") == 4


def test_maximum_distance_and_report(capfd):
    target = scenes.flat_grid(4)
    things = [add_object((2, 2, height)) for height in (0.5, 1.0, 3.0)]
    snap(target, max_distance=2)
    np.testing.assert_allclose([t.location.z for t in things], [0, 0, 3], atol=1e-6)
    said = capfd.readouterr().out
    assert "2 of 3 objects snapped, moved by 0.75 on average, 1 at most (to Flat)" in said
    assert "1 object could not be snapped: no surface was found within 2 (1)" in said


@pytest.mark.parametrize("side", [1, -1])
def test_facing(side):
    """Two sheets face each other: the closer one is skipped if it faces away. A mirrored object has
    the same two sheets.
    """
    y, x = np.mgrid[:5, :5].reshape(2, -1)
    sheet = np.stack([x, y, 0 * x], axis=1).astype(float)
    first = (np.arange(4) * 5)[:, None] + np.arange(4)
    up = (first.reshape(-1, 1) + [0, 1, 6, 5]).tolist()
    down = [[25 + i for i in reversed(face)] for face in up]
    target = scenes.add_mesh("Sheets", np.concatenate([sheet, sheet + (0, 0, 1)]), up + down)
    target.scale.x, target.location.x = side, 4 * (side < 0)
    thing = add_object((2, 2.3, 0.7))
    snap(target, use_facing=True, max_angle=1.0)
    np.testing.assert_allclose(thing.location, (2, 2.3, 0), atol=1e-6)
    for all_directions in ({}, {"use_facing": True, "max_angle": np.pi}):
        thing.location.z = 0.7
        snap(target, **all_directions)
        np.testing.assert_allclose(thing.location, (2, 2.3, 1), atol=1e-6)


@pytest.mark.every(5)
@pytest.mark.parametrize("mode", ["XYZ", "ZXY", "QUATERNION", "AXIS_ANGLE"])
@pytest.mark.parametrize("align", ["NORMAL", "NORMAL_DU"])
@pytest.mark.parametrize("placed", [stretched, mirrored])
def test_align(mode, align, placed):
    target = placed(scenes.mixed_polygons())
    truth = Truth(target)
    points = near(target, 6, 0.2)
    things = [add_object(point) for point in points]
    for i, thing in enumerate(things):
        thing.rotation_mode = mode
        thing.rotation_euler = (i, 1, 2)
        thing.rotation_quaternion = (0.5, i, 0.1, 0.3)
        thing.rotation_axis_angle = (i, 0.6, 0, 0.8)
        thing.delta_rotation_euler = (0.1 * i, 0.2, 0.3)
        thing.scale = (1, 2, -1 if i % 2 else 1)
        thing.delta_scale = (1, 1, 0.5)
        thing.delta_location = (0.1, 0.2, 0.3)
    bpy.context.view_layer.update()
    before = np.array([thing.matrix_world.to_3x3() for thing in things])
    scales = [thing.scale.copy() for thing in things]
    snap(target, align=align)
    after = world_locations(things)
    np.testing.assert_allclose(truth.distances(after), 0, atol=EXACT)
    matrix = np.array([thing.matrix_world.to_3x3() for thing in things])
    axes = matrix / np.linalg.norm(matrix, axis=1, keepdims=True)
    normals = truth.normals_at(after)
    np.testing.assert_allclose(axes[:, :, 2], normals, atol=1e-5)
    assert [thing.scale for thing in things] == scales
    if align == "NORMAL_DU":
        found = [truth.closest(point) for point in after]
        frames = truth.surface.frames([f for f, _, _ in found], [uv for _, uv, _ in found])
        tangent = frames[:, :, 0] @ truth.matrix[:3, :3].T
        tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
        np.testing.assert_allclose(axes[:, :, 0], tangent, atol=1e-4)
    else:
        # With the smallest angle, the direction at right angles to both normals does not change.
        was = before[:, :, 2] / np.linalg.norm(before[:, :, 2], axis=1, keepdims=True)
        for old, new, a, b in zip(before, matrix, was, normals, strict=True):
            turn = np.array(Vector(a).rotation_difference(Vector(b)).to_matrix())
            np.testing.assert_allclose(new, turn @ old, atol=1e-5)


def family():
    """Adds a stretched and turned parent with a rotated child, both away from the target."""
    parent = add_object((0.3, 0.2, 0.8), name="Parent")
    parent.scale, parent.rotation_euler = (2, 1, 0.5), (0.2, 0.3, 0.4)
    child = add_object((0.2, 0.1, 0.6), name="Child")
    child.parent, child.rotation_euler = parent, (1, 0.5, 0.2)
    child.matrix_parent_inverse = Matrix.Translation((0.1, 0, 0)) @ Matrix.Rotation(0.5, 4, "Z")
    bpy.context.view_layer.update()
    return parent, child


@pytest.mark.parametrize("align", ["NONE", "NORMAL", "NORMAL_DU"])
def test_parent_and_child_both_snapped(align, capfd):
    target = stretched(scenes.cross())
    truth = Truth(target)
    parent, child = family()
    parent.location = target.location + Vector((0.2, 0.1, 0.5))
    before = world_locations([parent, child])
    snap(target, align=align)
    after = world_locations([parent, child])
    np.testing.assert_allclose(truth.distances(after), 0, atol=1e-5)
    moved = np.linalg.norm(after - before, axis=1)
    np.testing.assert_allclose(moved, truth.distances(before), atol=1e-5)
    reported = f"moved by {moved.mean():.4g} on average, {moved.max():.4g} at most"
    assert reported in capfd.readouterr().out
    if align != "NONE":
        z = np.array([ob.matrix_world.to_3x3().col[2].normalized() for ob in (parent, child)])
        np.testing.assert_allclose(z, truth.normals_at(after), atol=1e-4)


def test_children_come_along():
    target = scenes.cross()
    parent, child = family()
    child.select_set(False)
    relative = parent.matrix_world.inverted() @ child.matrix_world
    snap(target, align="NORMAL")
    now = parent.matrix_world.inverted() @ child.matrix_world
    np.testing.assert_allclose(now, relative, atol=1e-5)


@pytest.mark.parametrize("parent_type", ["OBJECT", "VERTEX"])
def test_children_stay(parent_type):
    target = scenes.cross()
    parent, child = family()
    if parent_type == "VERTEX":
        mesh = bpy.data.meshes.new("Parent")
        mesh.from_pydata([(1, 2, 3)], [], [])
        parent = add_object((0.3, 0.2, 0.8), mesh)
        parent.rotation_euler = (0.2, 0.3, 0.4)
        child.parent = parent
        child.parent_type, child.parent_vertices = "VERTEX", (0, 0, 0)
    child.lock_location = (True, True, True)
    child.select_set(False)
    bpy.context.view_layer.update()
    before, channels = np.array(child.matrix_world), child.matrix_basis.copy()
    was = world_locations([parent])
    snap(target, align="NORMAL", children="KEEP")
    assert np.linalg.norm(world_locations([parent]) - was) > 0.1
    np.testing.assert_allclose(child.matrix_world, before, atol=1e-5)
    assert child.matrix_basis == channels


def test_locked_channels():
    target = scenes.flat_grid(4)
    thing = add_object((2, 2.2, 1))
    thing.lock_location[2] = True
    refused_and_unchanged(target, thing, "the location or rotation is locked")
    thing.lock_location = (True, True, False)
    snap(target)  # straight down, which is free
    np.testing.assert_allclose(thing.location, (2, 2.2, 0), atol=1e-6)
    thing.rotation_euler, thing.lock_rotation = (0.5, 0, 0), (True, False, False)
    refused_and_unchanged(target, thing, "the location or rotation is locked", align="NORMAL")


def test_constraints_and_drivers():
    target = scenes.flat_grid(4)
    other = add_object((5, 5, 5), name="Other")
    other.select_set(False)
    thing = add_object((2, 2.2, 1))
    thing.constraints.new("COPY_LOCATION").target = other
    refused_and_unchanged(target, thing, "constraints or drivers hold the object elsewhere")
    thing.constraints.clear()
    thing.driver_add("location", 2).driver.expression = "1.5"
    refused_and_unchanged(target, thing, "constraints or drivers hold the object elsewhere")


@pytest.mark.parametrize("rotation", [(0, 0, 0), (0.3, 0.2, 0.9)])
@pytest.mark.parametrize("scale", [(0, 0, 0), (1, 1, 0)])
@pytest.mark.parametrize("own", [(1, 1, 1), (0, 0, 0)])
@pytest.mark.parametrize("depth", [1, 2])
def test_a_child_of_a_parent_without_extent(depth, own, scale, rotation):
    """It is not said that constraints or drivers hold it, because it has none."""
    target = scenes.flat_grid(4)
    thing = add_object((1, 1, 1), name="Flat")
    thing.rotation_euler, thing.scale = rotation, scale
    for _ in range(depth):
        thing.select_set(False)
        child = add_object((0.2, 0.1, 0.4), name="Child")
        child.parent, child.scale = thing, own
        thing = child
    reason = "a parent has a scale of 0 in the direction of the move"
    refused_and_unchanged(target, thing, reason)


def test_a_constraint_in_the_plane_of_a_flat_parent():
    target = scenes.flat_grid(4)
    parent = add_object((1, 1, 0), name="Flat")
    parent.scale.z = 0
    other = add_object((5, 5, 0), name="Other")
    thing = add_object((0.2, 0.1, 0), name="Child")
    thing.parent = parent
    thing.constraints.new("COPY_LOCATION").target = other
    for ob in (parent, other):
        ob.select_set(False)
    bpy.context.view_layer.update()
    refused_and_unchanged(target, thing, "constraints or drivers hold the object elsewhere")


@pytest.mark.parametrize("scale", [(0, 0, 0), (1, 0, 2)])
def test_a_child_without_extent(scale):
    target = scenes.flat_grid(4)
    parent = add_object((1, 1, 3), name="Parent")
    parent.rotation_euler, parent.scale = (0.3, 0.2, 0.9), (2, 2, 3)
    parent.select_set(False)
    thing = add_object((2, 2.2, 1))
    thing.parent = parent
    thing.scale = scale
    bpy.context.view_layer.update()
    x, y, _z = world_locations([thing])[0]
    snap(target)
    expected = (np.clip(x, 0, 4), np.clip(y, 0, 4), 0)
    np.testing.assert_allclose(world_locations([thing])[0], expected, atol=1e-5)
    assert tuple(thing.scale) == scale


def test_those_that_can_be_moved_are(capfd):
    target = scenes.flat_grid(4)
    free, held = add_object((2, 2.2, 1)), add_object((2, 2.2, 1))
    held.lock_location = (True, True, True)
    snap(target)
    assert [round(ob.location.z, 6) for ob in (free, held)] == [0, 1]
    said = capfd.readouterr().out
    assert "1 object could not be snapped: the location or rotation is locked (1)" in said


def test_what_carries_the_target():
    target = scenes.flat_grid(4)
    carrier = add_object((0, 0, 1))
    target.parent = carrier
    refused_and_unchanged(target, carrier, "Flat is parented to the object and would move with it")


def test_a_target_that_comes_along(capfd):
    target = scenes.cross()
    thing = add_object((3, 4, 5))
    follow = target.constraints.new("COPY_LOCATION")
    follow.target, follow.use_offset = thing, True
    snap(target)
    assert "Cross moved with the snapped elements" in capfd.readouterr().out


def test_a_target_that_is_reshaped(capfd):
    target = scenes.cross()
    mirror = target.modifiers.new("Mirror", "MIRROR")
    mirror.mirror_object = add_object((3, 4, 5))
    snap(target)
    assert "Cross moved with the snapped elements" in capfd.readouterr().out


def test_a_target_that_stays_is_not_warned_about(capfd):
    target = stretched(scenes.cross())
    target.modifiers.new("Mirror", "MIRROR")
    add_object((3, 4, 5))
    snap(target)
    assert "Warning" not in capfd.readouterr().out


def test_linked_objects(tmp_path):
    thing = add_object((2, 2, 1), name="Linked")
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {thing})
    bpy.data.objects.remove(thing)
    target = scenes.flat_grid(4)
    with bpy.data.libraries.load(path, link=True) as (_, found):
        found.objects = ["Linked"]
    linked = found.objects[0]
    bpy.context.collection.objects.link(linked)
    linked.select_set(True)
    refused_and_unchanged(target, linked, "the object is linked from another file")


@pytest.mark.parametrize("kind", ["VIEWPORT", "RENDER"])
def test_on_the_polygons_that_are_shown(kind):
    target = stretched(scenes.cross())
    subsurf = scenes.add_subsurf(target)
    subsurf.levels, subsurf.render_levels = 1, 2
    things = [add_object(point) for point in near(target, 10, 0.2)]
    truth = Truth(target)
    snap(target, target=kind)
    subsurf.levels = 1 if kind == "VIEWPORT" else 2
    bpy.context.view_layer.update()
    shown = target.evaluated_get(bpy.context.evaluated_depsgraph_get())
    to_world, to_shown = shown.matrix_world, shown.matrix_world.inverted()
    after = world_locations(things)
    off = []
    for location in after:
        _, close, _, _ = shown.closest_point_on_mesh(to_shown @ Vector(location))
        off.append((to_world @ close - Vector(location)).length)
    np.testing.assert_allclose(off, 0, atol=1e-5)
    assert truth.distances(after).max() > 1e-3
