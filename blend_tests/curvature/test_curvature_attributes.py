# SPDX-License-Identifier: GPL-3.0-or-later
"""Stored curvature is compared with that of paraboloids: a uniform B-spline whose control points
lie on a quadratic function is that function, up to a constant.
"""

import bpy
import limitsurf
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.curvature import colours, values
from limit_surface.errors import CancelledError
from limit_surface.reading import attributes, cage
from mathutils import Matrix

A, B, C = 0.15, -0.06, 0.04  # z = A x^2 + B y^2 + C x y
SIDE = 8
MATRICES = {
    "as it is": Matrix.Identity(4),
    "stretched": Matrix.Translation((3, -2, 1))
    @ Matrix.Rotation(0.7, 4, (1, 2, 3))
    @ Matrix.Diagonal((2.0, 0.5, 1.3, 1)),
    "mirrored": Matrix.Rotation(0.4, 4, (3, 1, 2)) @ Matrix.Diagonal((-1.5, 1.0, 1.0, 1)),
}
NUMBERS = (ids.CURVATURE_MEAN, ids.CURVATURE_GAUSSIAN, ids.CURVATURE_K1, ids.CURVATURE_K2)
ALL = (*NUMBERS, ids.CURVATURE_DIRECTION1, ids.CURVATURE_DIRECTION2, ids.CURVATURE_IRREGULAR,
       ids.CURVATURE_COLOR)  # fmt: skip


def paraboloid(matrix=MATRICES["as it is"]):
    ob = scenes.flat_grid(SIDE)
    ob.name = "Sheet"
    x, y = (attributes.read(ob.data, ids.POSITION)[:, :2] - SIDE / 2).T
    place = np.stack([x, y, A * x * x + B * y * y + C * x * y], axis=1)
    attributes.write(ob.data, ids.POSITION, "FLOAT_VECTOR", "POINT", place)
    scenes.add_subsurf(ob)
    ob.matrix_world = matrix
    bpy.context.view_layer.update()
    return ob


def expected(xy, matrix):
    """Returns, by textbook formulas, shape operators (n, 3, 3) and normals of the transformed graph
    over (x, y).
    """
    linear = np.array(matrix)[:3, :3]
    x, y = xy.T
    zero, one = np.zeros(len(x)), np.ones(len(x))
    tangents = np.stack(
        [np.stack([one, zero, 2 * A * x + C * y], 1), np.stack([zero, one, 2 * B * y + C * x], 1)],
        axis=2,
    )
    tangents = linear @ tangents
    normal = np.cross(tangents[:, :, 0], tangents[:, :, 1]) * np.sign(np.linalg.det(linear))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    bend = linear @ [0, 0, 1]
    hessian = np.array([[2 * A, C], [C, 2 * B]]) * (normal @ bend)[:, None, None]
    dual = tangents @ np.linalg.inv(np.swapaxes(tangents, 1, 2) @ tangents)
    return dual @ hessian @ np.swapaxes(dual, 1, 2), normal


def check(data, rows, shapes, matrix, atol=1e-5):
    """Checks stored attributes; `matrix` maps the data's space to that of the shape operators."""
    eigenvalues = np.linalg.eigvalsh(shapes)
    pick = np.argsort(-np.abs(eigenvalues), axis=1)[:, :2]  # the third is 0, along the normal
    curvatures = np.sort(np.take_along_axis(eigenvalues, pick, 1), axis=1)
    stored = {name: attributes.read(data, name)[rows].astype(float) for name in ALL}
    np.testing.assert_allclose(stored[ids.CURVATURE_K1], curvatures[:, 1], atol=atol)
    np.testing.assert_allclose(stored[ids.CURVATURE_K2], curvatures[:, 0], atol=atol)
    np.testing.assert_allclose(stored[ids.CURVATURE_MEAN], curvatures.mean(axis=1), atol=atol)
    np.testing.assert_allclose(stored[ids.CURVATURE_GAUSSIAN], curvatures.prod(axis=1), atol=atol)
    for direction, k in (
        (stored[ids.CURVATURE_DIRECTION1], curvatures[:, 1]),
        (stored[ids.CURVATURE_DIRECTION2], curvatures[:, 0]),
    ):
        np.testing.assert_allclose(np.linalg.norm(direction, axis=1), 1, atol=1e-6)
        seen = direction @ np.array(matrix)[:3, :3].T
        turned = np.einsum("nij,nj->ni", shapes, seen)
        np.testing.assert_allclose(turned, k[:, None] * seen, atol=10 * atol)


def run(ob, **properties):
    scenes.activate(ob)
    assert bpy.ops.object.limit_curvature(**properties) == {"FINISHED"}
    return ob.data


def inner(ob):
    """Returns the rows, and the (x, y), of vertices that are not on the border, where the surface
    would depend on points beyond it.
    """
    xy = attributes.read(ob.data, ids.POSITION)[:, :2].astype(float)
    rows = np.flatnonzero((np.abs(xy) < SIDE / 2 - 0.5).all(axis=1))
    return rows, xy[rows]


@pytest.mark.parametrize("space", ["WORLD", "LOCAL"])
@pytest.mark.parametrize("name", MATRICES)
def test_on_the_control_mesh(name, space):
    ob = paraboloid(MATRICES[name])
    data = run(ob, space=space)
    rows, xy = inner(ob)
    matrix = MATRICES[name] if space == "WORLD" else Matrix.Identity(4)
    check(data, rows, expected(xy, matrix)[0], matrix)
    assert not attributes.read(data, ids.CURVATURE_IRREGULAR)[rows].any()
    assert data.attributes[ids.CURVATURE_MEAN].domain == "POINT"
    assert data.color_attributes.active_color.name == ids.CURVATURE_COLOR


def test_on_a_new_mesh():
    ob = paraboloid(MATRICES["stretched"])
    before = scenes.file_contents()
    run(ob, on="TESSELLATION", levels=2)
    made = bpy.context.active_object
    after = scenes.file_contents()
    assert {k: sorted(set(after[k]) - set(before[k])) for k in after if after[k] != before[k]} == {
        "objects": [made.name], "meshes": [made.data.name]
    }  # fmt: skip
    assert made.parent == ob
    np.testing.assert_allclose(made.matrix_world, ob.matrix_world, atol=1e-6)
    assert len(made.data.polygons) == SIDE**2 * 16
    place = attributes.read(made.data, ids.POSITION).astype(float)
    x, y = place[:, :2].T
    rows = np.flatnonzero((np.abs(place[:, :2]) < SIDE / 2 - 1.01).all(axis=1))
    lifted = (place[:, 2] - (A * x * x + B * y * y + C * x * y))[rows]
    np.testing.assert_allclose(lifted, (A + B) / 3, atol=1e-5)
    shapes, normal = expected(place[rows, :2], MATRICES["stretched"])
    check(made.data, rows, shapes, MATRICES["stretched"], atol=1e-4)
    normals = np.empty((len(place), 3), np.float32)
    made.data.vertices.foreach_get("normal", normals.ravel())
    seen = normals[rows] @ np.linalg.inv(np.array(ob.matrix_world)[:3, :3])
    assert ((seen * normal).sum(axis=1) > 0).all()
    assert not ob.data.attributes.get(ids.CURVATURE_MEAN)


@pytest.mark.parametrize("space", ["WORLD", "LOCAL"])
@pytest.mark.parametrize("add", [scenes.add_hair, scenes.add_points])
def test_at_roots(add, space):
    ob = paraboloid(MATRICES["mirrored"])
    things = add(ob, per_side=2)
    things.parent = None if things.type == "CURVES" else ob
    things.matrix_world = MATRICES["stretched"]
    bpy.context.view_layer.update()
    data = run(things, on="ROOTS", space=space)
    face, uv = scenes.locations(data)
    surface = limitsurf.LimitSurface(cage.read(ob, bpy.context.evaluated_depsgraph_get()).mesh)
    xy = surface.evaluate(face, uv).position[:, :2]
    rows = np.flatnonzero((np.abs(xy) < SIDE / 2 - 1.01).all(axis=1))
    matrix = MATRICES["mirrored"] if space == "WORLD" else Matrix.Identity(4)
    to_it = things.matrix_world
    if space == "LOCAL":
        to_it = MATRICES["mirrored"].inverted() @ to_it
    shapes = expected(xy[rows], matrix)[0]
    # Directions are unit vectors in the space of the objects themselves.
    stored = attributes.read(data, ids.CURVATURE_DIRECTION1)[rows].astype(float)
    assert np.abs(np.linalg.norm(stored, axis=1) - 1).max() < 1e-6
    check(data, rows, shapes, to_it, atol=1e-4)


def test_roots_of_everything_that_stands_on_the_active_mesh():
    ob, other = paraboloid(), scenes.cross()
    scenes.add_subsurf(other)
    here = [scenes.add_hair(ob, per_side=1), scenes.add_points(ob, per_side=1)]
    elsewhere = scenes.add_hair(other, per_side=1)
    for thing in bpy.context.selected_objects:
        thing.select_set(False)
    run(ob, on="ROOTS")
    assert all(ids.CURVATURE_MEAN in thing.data.attributes for thing in here)
    assert ids.CURVATURE_MEAN not in elsewhere.data.attributes
    assert ids.CURVATURE_MEAN not in ob.data.attributes


def test_strands_that_are_nowhere_have_none():
    hair = scenes.add_hair(paraboloid(), per_side=1)
    face = attributes.read(hair.data, ids.FACE)
    face[:3] = -1
    attributes.write(hair.data, ids.FACE, "INT", "CURVE", face)
    data = run(hair, on="ROOTS")
    assert np.isnan(attributes.read(data, ids.CURVATURE_MEAN)[:3]).all()
    assert np.isfinite(attributes.read(data, ids.CURVATURE_MEAN)[3:]).all()
    np.testing.assert_array_equal(attributes.read(data, ids.CURVATURE_DIRECTION1)[:3], 0)


@pytest.mark.parametrize("radius", [1 / 64, 0.25])
def test_irregular_vertices_are_averaged_and_flagged(radius):
    ob = scenes.mixed_polygons()
    scenes.add_subsurf(ob)
    data = run(ob, radius=radius)
    surface = scenes.surface_without_addon(ob)
    at = surface.vertex_locations()
    plain = surface.curvature(at.face, at.uv)
    flags = attributes.read(data, ids.CURVATURE_IRREGULAR)
    np.testing.assert_array_equal(flags, np.isnan(plain.mean))
    assert flags.any()
    average = surface.curvature(at.face, at.uv, irregular="average", radius=radius)
    for name, of in zip(NUMBERS, ("mean", "gaussian", "k1", "k2"), strict=True):
        np.testing.assert_allclose(attributes.read(data, name), getattr(average, of), rtol=1e-4)


def test_vertices_without_a_surface_have_none(capfd):
    ob = scenes.add_mesh("Loose", [(0, 0, 0), (1, 0, 0), (1, 1, 0.3), (0, 1, 0), (5, 5, 5)],
                         [(0, 1, 2, 3)])  # fmt: skip
    data = run(ob)
    assert np.isnan(attributes.read(data, ids.CURVATURE_MEAN)).tolist() == 4 * [False] + [True]
    color = attributes.read(data, ids.CURVATURE_COLOR)[4]
    np.testing.assert_allclose(color, [0.1, 0.1, 0.1, 1], rtol=1e-6)
    assert "1 of 5 vertices has no curvature" in capfd.readouterr().out


def test_a_sphere_from_outside_is_negative_and_blue():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=2)
    ob = bpy.context.active_object
    data = run(ob, color="MEAN")
    mean = attributes.read(data, ids.CURVATURE_MEAN)
    assert (mean < 0).all()
    middle = np.abs(attributes.read(data, ids.POSITION)[:, 2]) < 1.2  # away from the triangles
    np.testing.assert_allclose(mean[middle], -0.5, rtol=0.05)
    color = attributes.read(data, ids.CURVATURE_COLOR)
    assert (color[:, 2] > color[:, 0]).all()
    ob.scale = (-1, 1, 1)
    bpy.context.view_layer.update()
    assert (attributes.read(run(ob), ids.CURVATURE_MEAN) < 0).all()


@pytest.mark.parametrize("color", ["MEAN", "GAUSSIAN", "K1", "K2"])
def test_colors_show_what_is_asked_for(color):
    ob = paraboloid()
    data = run(ob, color=color, full_color=0.2)
    shown = attributes.read(data, f"limit_curvature_{color.lower()}")
    srgb = np.array([[5, 48, 97], [247, 247, 247], [103, 0, 31]]) / 255
    linear = ((srgb + 0.055) / 1.055) ** 2.4
    linear[srgb <= 0.04045] = (srgb / 12.92)[srgb <= 0.04045]
    found = attributes.read(data, ids.CURVATURE_COLOR)[:, :3]
    for sign, of in ((-1, linear[0]), (1, linear[2])):
        full = sign * shown >= 0.2
        np.testing.assert_allclose(found[full], np.tile(of, (full.sum(), 1)), atol=1e-6)
    assert (np.abs(shown) >= 0.2).any() or color == "GAUSSIAN"
    weak = np.abs(shown) < 0.001
    np.testing.assert_allclose(found[weak], np.tile(linear[1], (weak.sum(), 1)), atol=0.02)
    redder = found[:, 0] > found[:, 2]
    np.testing.assert_array_equal(redder[np.abs(shown) > 1e-4], (shown > 0)[np.abs(shown) > 1e-4])


def test_the_fullest_color_leaves_a_twentieth():
    numbers = np.r_[np.linspace(-2, 2, 401), np.nan]
    assert colours.full_of(numbers) == pytest.approx(1.9, abs=0.02)
    assert colours.full_of(np.array([np.nan])) == 0
    assert colours.full_of(np.zeros(3)) == 0
    assert np.isfinite(colours.of_values(np.zeros(3), 0)).all()


def test_report_tells_ranges_and_counts(capfd):
    ob = scenes.mixed_polygons()
    data = run(ob)
    said = capfd.readouterr().out
    mean = attributes.read(data, ids.CURVATURE_MEAN)
    irregular = attributes.read(data, ids.CURVATURE_IRREGULAR)
    assert f"mean {mean.min():.4g} to {mean.max():.4g}" in said
    assert (
        f"{irregular.sum()} at irregular vertices, averaged at a distance of 0.01562 edges" in said
    )


def test_undo_takes_it_back():
    paraboloid()
    bpy.ops.ed.undo_push(message="before")
    run(bpy.context.active_object)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert not set(ALL) & set(bpy.data.objects["Sheet"].data.attributes.keys())


def test_again_overwrites():
    ob = paraboloid()
    run(ob)
    ob.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    first = attributes.read(ob.data, ids.CURVATURE_MEAN)
    np.testing.assert_allclose(attributes.read(run(ob), ids.CURVATURE_MEAN), first / 2, rtol=1e-5)


def check_refused(match, **properties):
    before = scenes.file_contents()
    kept = {m.name: sorted(m.attributes.keys()) for m in bpy.data.meshes}
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_curvature(**properties)
    assert scenes.file_contents() == before
    assert {m.name: sorted(m.attributes.keys()) for m in bpy.data.meshes} == kept


def test_other_attributes_of_these_names():
    ob = paraboloid()
    ob.data.attributes.new(ids.CURVATURE_K1, "FLOAT", "CORNER")
    check_refused("limit_curvature_k1 of another type or domain .FLOAT on CORNER")
    ob.data.attributes.remove(ob.data.attributes[ids.CURVATURE_K1])
    ob.vertex_groups.new(name=ids.CURVATURE_MEAN)
    check_refused("vertex group limit_curvature_mean")
    bpy.ops.object.limit_curvature(on="TESSELLATION", levels=1)


def test_vertices_that_only_modifiers_make():
    ob = paraboloid()
    array = ob.modifiers.new("Array", "ARRAY")
    ob.modifiers.move(ob.modifiers.find(array.name), 0)
    check_refused("cannot be stored on the control mesh: modifiers before the subdivision")
    bpy.ops.object.limit_curvature(on="TESSELLATION", levels=1)
    assert len(bpy.context.active_object.data.polygons) == 2 * SIDE**2 * 4


def test_linked_meshes(tmp_path):
    paraboloid()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "library.blend"))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.meshes = ["Flat"]
    ob = bpy.data.objects.new("Local", wanted.meshes[0])
    bpy.context.collection.objects.link(ob)
    scenes.activate(ob)
    check_refused("is linked from another file")


def test_overridden_hair(tmp_path):
    """Blender does not save attributes that are written to it."""
    hair = scenes.add_hair(paraboloid(), per_side=1)
    hair, _surface = scenes.overridden(tmp_path, hair, hair.parent)
    scenes.activate(hair)
    check_refused("Limit Hair is a library override", on="ROOTS")


def test_edit_mode_and_other_objects():
    ob = paraboloid()
    bpy.ops.object.mode_set(mode="EDIT")
    check_refused("Only available in Object Mode")
    bpy.ops.object.mode_set(mode="OBJECT")
    scenes.add_hair(ob, per_side=1)
    check_refused("Make a mesh object active first")
    bpy.context.collection.objects.link(bpy.data.objects.new("Empty", None))
    scenes.activate(bpy.data.objects["Empty"])
    check_refused("Make a mesh object active first", on="ROOTS")


def test_surfaces_that_are_flattened():
    ob = paraboloid()
    ob.scale = (1, 0, 1)
    bpy.context.view_layer.update()
    check_refused("has a scale of 0")
    run(ob, space="LOCAL")


def test_too_many_polygons():
    paraboloid()
    check_refused("allow_large", on="TESSELLATION", levels=12)


def test_roots_of_nothing():
    ob = paraboloid()
    check_refused("has the attributes limit_face and limit_uv", on="ROOTS")
    hair = scenes.add_hair(ob, per_side=1)
    hair.data.surface, hair.parent = None, None
    check_refused("Limit Hair has no surface", on="ROOTS")


def test_tables_are_not_taken_for_roots(capfd):
    """The mesh Limit Faces has the attributes of places too, on its faces and corners."""
    ob = paraboloid()
    assert bpy.ops.object.limit_sample_tables() == {"FINISHED"}
    check_refused("has the attributes limit_face and limit_uv", on="ROOTS")
    hair = scenes.add_hair(ob, per_side=1)
    capfd.readouterr()
    run(ob, on="ROOTS")
    assert ids.CURVATURE_MEAN in hair.data.attributes
    assert "left out" not in capfd.readouterr().out


def test_roots_of_another_mesh():
    ob, other = paraboloid(), scenes.cross()
    hair, more = scenes.add_hair(ob, per_side=1), scenes.add_hair(ob, per_side=1)
    hair.data.surface = other
    for thing in (ob, other, more):
        thing.select_set(False)
    scenes.activate(hair)
    check_refused("stands on faces that Cross does not have", on="ROOTS")
    more.select_set(True)
    assert bpy.ops.object.limit_curvature(on="ROOTS") == {"FINISHED"}
    assert ids.CURVATURE_MEAN in more.data.attributes
    assert ids.CURVATURE_MEAN not in hair.data.attributes


@pytest.mark.parametrize(("u", "said"), [(float("nan"), "nan"), (3, "3")])
def test_locations_that_are_none_are_named(u, said):
    ob = paraboloid()
    hair = scenes.add_hair(ob, per_side=1)
    hair.data.attributes[ids.UV].data[1].vector = (u, 0.5)
    reason = f"A place of {hair.name} has u = {said} and v = 0.5, which must be 0 to 1"
    check_refused(f"{reason}: the attribute limit_uv was changed", on="ROOTS")


def test_measuring_stops_where_it_is_cancelled(monkeypatch):
    monkeypatch.setattr(values, "PART", 16)
    found = cage.read(paraboloid(), bpy.context.evaluated_depsgraph_get())
    on, told = values.CurvedSurface(found, in_world=True, radius=1 / 64), []

    def progress(part):
        told.append(part)
        if len(told) == 2:
            raise CancelledError("Cancelled")

    at = on.surface.vertex_locations()
    with pytest.raises(CancelledError):
        on.values(at.face, at.uv, found.matrix, progress)
    assert told == [16 / 81, 32 / 81]
