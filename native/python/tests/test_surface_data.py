# SPDX-License-Identifier: Apache-2.0
"""Face-varying, vertex and varying data: SurfaceData."""

import pickle
import textwrap

import ctrl_c
import limitsurf as ls
import numpy as np
import pytest
import shapes
from hypothesis import given
from hypothesis import strategies as st

INTERPOLATIONS = ["none", "corners_only", "corners_plus1", "corners_plus2", "boundaries", "all"]
FIELDS = ["value", "du", "dv", "duu", "duv", "dvv"]


def corners_of(mesh):
    """The vertex at each face corner."""
    return np.asarray(mesh.face_vertices)


def bilinear(surface, corner_values, face, uv):
    """Values at the face corners, carried bilinearly over each Ptex face, at locations."""
    starts, sizes = shapes.row_bounds(surface.mesh.face_sizes), np.asarray(surface.mesh.face_sizes)
    result = []
    for ptex, (u, v) in zip(face, uv, strict=True):
        base, i = surface.base_face[ptex], surface.corner[ptex]
        own = corner_values[starts[base] : starts[base + 1]]
        n = sizes[base]
        if n != 4:
            after, before = own[(i + 1) % n], own[(i - 1) % n]
            own = [own[i], (own[i] + after) / 2, own.mean(axis=0), (own[i] + before) / 2]
        a, b, c, d = own
        result.append((1 - u) * (1 - v) * a + u * (1 - v) * b + u * v * c + (1 - u) * v * d)
    return np.array(result)


def seamed(mesh, seed=0):
    """Indices with seams: each face picks one of two values of each of its vertices."""
    rng = np.random.default_rng(seed)
    charts = np.repeat(rng.integers(0, 2, len(mesh.face_sizes)), mesh.face_sizes)
    return 2 * corners_of(mesh) + charts


@pytest.fixture
def house():
    return ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.house()))


@pytest.mark.parametrize("dtype", ["float64", "float32"])
@pytest.mark.parametrize("columns", [1, 2, 3, 5])
@pytest.mark.parametrize("interpolation", INTERPOLATIONS)
def test_shapes_and_types(surface, anywhere, interpolation, columns, dtype):
    values = np.random.default_rng(1).random((2 * len(surface.positions), columns))
    fv = surface.face_varying(values, seamed(surface.mesh), interpolation)
    assert isinstance(fv, ls.SurfaceData)
    assert fv.shape == values.shape
    face, uv = anywhere(surface, 40)
    for derivatives, wanted in enumerate([1, 3, 6]):
        got = fv.evaluate(face, uv, derivatives, dtype=dtype)
        assert isinstance(got, ls.DataEvaluation)
        for name in FIELDS[:wanted]:
            assert getattr(got, name).shape == (40, columns)
            assert getattr(got, name).dtype == dtype
            assert np.isfinite(getattr(got, name)).all()
        assert all(getattr(got, name) is None for name in FIELDS[wanted:])


def test_vertex_data_are_evaluated_as_positions_are(surface, anywhere):
    data = surface.vertex_data(surface.positions)
    face, uv = anywhere(surface, 200)
    expected, got = surface.evaluate(face, uv, 2), data.evaluate(face, uv, 2)
    np.testing.assert_array_equal(got.value, expected.position)
    for name in FIELDS[1:]:
        np.testing.assert_array_equal(getattr(got, name), getattr(expected, name))


@pytest.mark.parametrize("interpolation", INTERPOLATIONS)
def test_a_closed_mesh_without_seams_is_smooth(cube, anywhere, interpolation):
    if interpolation == "all":
        return
    fv = cube.face_varying(cube.positions, corners_of(cube.mesh), interpolation)
    face, uv = anywhere(cube, 100)
    np.testing.assert_allclose(
        fv.evaluate(face, uv).value, cube.evaluate(face, uv).position, atol=1e-15
    )


def test_varying_is_bilinear(surface, anywhere):
    values = np.random.default_rng(2).random((len(surface.positions), 2))
    face, uv = anywhere(surface, 200)
    truth = bilinear(surface, values[corners_of(surface.mesh)], face, uv)
    got = surface.varying(values).evaluate(face, uv, 2)
    np.testing.assert_allclose(got.value, truth, atol=1e-15)
    np.testing.assert_allclose(got.duu, 0, atol=1e-14)
    np.testing.assert_allclose(got.dvv, 0, atol=1e-14)


def test_all_is_bilinear_between_the_values_of_the_corners(surface, anywhere):
    indices = seamed(surface.mesh)
    values = np.random.default_rng(3).random((2 * len(surface.positions), 3))
    face, uv = anywhere(surface, 200)
    got = surface.face_varying(values, indices, "all").evaluate(face, uv)
    truth = bilinear(surface, values[indices], face, uv)
    np.testing.assert_allclose(got.value, truth, atol=1e-15)


def test_boundaries_are_straight_along_seams(house):
    indices = seamed(house.mesh, 5)
    values = np.random.default_rng(4).random((2 * len(house.positions), 2))
    fv = house.face_varying(values, indices, "boundaries")
    t = np.linspace(0, 1, 9)[:, None]
    starts, sizes = shapes.row_bounds(house.mesh.face_sizes), house.mesh.face_sizes
    vertices = corners_of(house.mesh)
    sides = {}
    for f in range(len(sizes)):
        for i in range(sizes[f]):
            a, b = starts[f] + i, starts[f] + (i + 1) % sizes[f]
            sides.setdefault(frozenset((vertices[a], vertices[b])), []).append((f, i, a, b))
    checked = 0
    for beside in sides.values():
        picked = {frozenset((indices[a], indices[b])) for _, _, a, b in beside}
        if len(beside) == 2 and len(picked) == 1:
            continue  # no seam
        for f, i, a, b in beside:
            if sizes[f] != 4:
                continue
            ptex = np.flatnonzero(house.base_face == f)[0]
            corner = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
            uv = (1 - t) * corner[i] + t * corner[(i + 1) % 4]
            truth = (1 - t) * values[indices[a]] + t * values[indices[b]]
            np.testing.assert_allclose(fv.evaluate(ptex, uv).value, truth, atol=1e-15)
            checked += 1
    assert checked > 4


def test_corners_stay_and_smooth_seams_round_them():
    """Each face of a grid has values of its own: four corners each."""
    positions, faces = shapes.grid(2, 2)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    values = np.random.default_rng(6).random((16, 2))
    corners = [[0, 0], [1, 0], [1, 1], [0, 1]]
    for interpolation in INTERPOLATIONS:
        fv = surface.face_varying(values, np.arange(16), interpolation)
        for face in range(4):
            own = values[4 * face : 4 * face + 4]
            got = fv.evaluate(face, corners).value
            if interpolation == "none":  # the limit of a B-spline curve
                own = (np.roll(own, 1, axis=0) + 4 * own + np.roll(own, -1, axis=0)) / 6
            np.testing.assert_allclose(got, own, atol=1e-15)


def test_seams_are_sharp_where_edges_are():
    """A channel without seams is sharp where the surface is."""
    positions, faces = shapes.cube()
    sharp = ([[0, 1], [1, 3], [3, 2], [2, 0]], [np.inf] * 4)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces, edge_sharpness=sharp))
    fv = surface.face_varying(positions, faces.ravel(), "corners_plus2")
    uv = np.random.default_rng(7).random((50, 2))
    for face in range(6):
        np.testing.assert_allclose(
            fv.evaluate(face, uv).value, surface.evaluate(face, uv).position, atol=1e-15
        )


def test_values_of_one_dimension_are_one_column(house):
    values = np.arange(len(house.positions))
    for make in (house.vertex_data, house.varying):
        assert make(values).shape == (len(values), 1)
        assert make(values).evaluate(0, [[0.5, 0.5]]).value.shape == (1, 1)
        np.testing.assert_array_equal(
            make(values).evaluate(0, [[0.5, 0.25]]).value,
            make(values[:, None]).evaluate(0, [[0.5, 0.25]]).value,
        )


def test_layouts_do_not_matter(house, anywhere):
    rng = np.random.default_rng(8)
    values = np.asfortranarray(rng.random((2 * len(house.positions), 4)))
    indices = seamed(house.mesh)
    face, uv = anywhere(house, 50)
    truth = house.face_varying(values.copy(order="C"), indices, "none").evaluate(face, uv).value
    doubled = np.repeat(values, 2, axis=1)[:, ::2]
    strided = np.repeat(indices.astype(np.int16), 3)[::3]
    for other_values, other_indices in [
        (values, strided),
        (doubled, list(map(int, indices))),
        (values.astype(">f8"), indices.astype(np.uint64)),
    ]:
        got = house.face_varying(other_values, other_indices, "none").evaluate(face, uv)
        np.testing.assert_array_equal(got.value, truth)


def test_values_can_be_set_again(house, anywhere):
    rng = np.random.default_rng(9)
    before, after = rng.random((2, 2 * len(house.positions), 2))
    indices = seamed(house.mesh)
    fv = house.face_varying(before, indices, "corners_only")
    face, uv = anywhere(house, 50)
    truth = house.face_varying(after, indices, "corners_only").evaluate(face, uv, 2)
    first = fv.evaluate(face, uv).value
    for bad in (after[1:], after[:, :1], np.full_like(after, np.nan)):
        with pytest.raises(ls.MeshError):
            fv.set_values(bad)
    np.testing.assert_array_equal(fv.evaluate(face, uv).value, first)
    fv.set_values(after)
    got = fv.evaluate(face, uv, 2)
    for name in FIELDS:
        np.testing.assert_array_equal(getattr(got, name), getattr(truth, name))


def test_data_do_not_follow_the_surface_and_outlive_it(anywhere):
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.cube()))
    face, uv = anywhere(surface, 20)
    data = surface.vertex_data(surface.positions)
    truth = data.evaluate(face, uv).value
    surface.set_positions(2 * surface.positions)
    np.testing.assert_array_equal(data.evaluate(face, uv).value, truth)
    del surface
    np.testing.assert_array_equal(data.evaluate(face, uv).value, truth)


@given(st.integers(0, 2**32), st.sampled_from(INTERPOLATIONS), st.integers(2, 4))
def test_affine_maps_of_values_are_affine_maps_of_data(seed, interpolation, charts):
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.house()))
    rng = np.random.default_rng(seed)
    indices = charts * corners_of(surface.mesh) + rng.integers(
        0, charts, len(corners_of(surface.mesh))
    )
    values = rng.random((charts * len(surface.positions), 2))
    matrix, shift = rng.normal(size=(2, 3)), rng.normal(size=3)
    face, uv = rng.integers(0, surface.face_count, 30), rng.random((30, 2))
    plain = surface.face_varying(values, indices, interpolation).evaluate(face, uv).value
    mapped = surface.face_varying(values @ matrix + shift, indices, interpolation)
    np.testing.assert_allclose(mapped.evaluate(face, uv).value, plain @ matrix + shift, atol=1e-13)
    # and between the least and the largest value
    assert (plain >= values.min(axis=0) - 1e-14).all()
    assert (plain <= values.max(axis=0) + 1e-14).all()


@pytest.mark.parametrize(
    ("values", "match"),
    [
        (np.full((22, 2), np.nan), "row 0"),
        (np.where(np.arange(44).reshape(22, 2) == 31, np.inf, 0.0), "row 15.*inf.*column 1"),
        (np.zeros((22, 0)), "no columns"),
        (np.zeros((2, 22, 2)), r"\(2, 22, 2\)"),
        (np.float64(1), r"\(\)"),
    ],
)
def test_bad_values_are_named(house, values, match):
    with pytest.raises(ls.MeshError, match=match):
        house.face_varying(values, seamed(house.mesh), "none")


def test_values_at_vertices_are_as_many(house):
    count = len(house.positions)
    for make in (house.vertex_data, house.varying):
        with pytest.raises(ls.MeshError, match=f"{count + 1} rows; the mesh has {count} vertices"):
            make(np.zeros((count + 1, 2)))
        with pytest.raises(TypeError, match="values"):
            make(np.full((count, 2), "x"))


@pytest.mark.parametrize("index", [22, -1, 2**40, 2**80])
def test_indices_out_of_range_are_named(house, index):
    indices = seamed(house.mesh).astype(object)
    indices[shapes.row_bounds(house.mesh.face_sizes)[3] + 2] = index
    with pytest.raises(ls.MeshError, match=str(index)) as error:
        house.face_varying(np.zeros((22, 2)), indices, "none")
    if index < 2**63:
        assert "corner 2 of face 3" in str(error.value)


def test_indices_are_integers_one_for_each_corner(house):
    indices = seamed(house.mesh)
    values = np.zeros((22, 2))
    with pytest.raises(ls.MeshError, match=f"{len(indices) - 1}.*{len(indices)} face corners"):
        house.face_varying(values, indices[1:], "none")
    with pytest.raises(ls.MeshError, match="indices has shape"):
        house.face_varying(values, indices[None], "none")
    with pytest.raises(TypeError, match="indices"):
        house.face_varying(values, indices.astype(float), "none")


def test_interpolations_are_known(house):
    with pytest.raises(ls.MeshError, match="'smooth'; expected 'none' or .*'all'"):
        house.face_varying(np.zeros((22, 2)), seamed(house.mesh), "smooth")


def test_locations_are_checked_as_the_surfaces(house):
    data = house.varying(house.positions)
    with pytest.raises(ls.LocationError, match="row 1: face 99"):
        data.evaluate([0, 99], [[0, 0], [0, 0]])
    with pytest.raises(ls.LocationError, match="row 0.*-0.5"):
        data.evaluate(0, [[-0.5, 0]])
    with pytest.raises(TypeError, match="face"):
        data.evaluate([0.0], [[0, 0]])
    with pytest.raises(ValueError, match="derivatives is 3"):
        data.evaluate(0, [[0, 0]], 3)
    with pytest.raises(ValueError, match="threads is -1"):
        data.evaluate(0, [[0, 0]], threads=-1)
    with pytest.raises(TypeError, match="float64 or float32"):
        data.evaluate(0, [[0, 0]], dtype=int)
    assert data.evaluate([], []).value.shape == (0, 3)


def test_faces_without_a_surface_have_no_data():
    positions, faces = shapes.grid(3, 3)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces, holes=[4]))
    for data in (
        surface.vertex_data(positions),
        surface.varying(positions),
        *(surface.face_varying(positions, faces.ravel(), rule) for rule in INTERPOLATIONS),
    ):
        with pytest.raises(ls.MeshError, match="row 1: Ptex face 4.*hole"):
            data.evaluate([0, 4], [[0.5, 0.5]] * 2)
        assert np.isfinite(data.evaluate([0, 1, 8], [[0.5, 0.5]] * 3).value).all()


def test_faces_beside_chaikin_creases_that_meet_at_a_seam_have_data():
    positions, faces = shapes.grid(6, 2)
    mesh = ls.ControlMesh.from_faces(
        positions, faces, edge_sharpness=([[1, 8], [7, 8]], [3.0, 1.5]), creasing="chaikin"
    )
    surface = ls.LimitSurface(mesh)
    indices = faces + 21 * (np.arange(12) >= 6)[:, None]
    values = np.random.default_rng(0).random((42, 2))
    for rule in INTERPOLATIONS:
        data = surface.face_varying(values, indices.ravel(), rule)
        value = data.evaluate(np.arange(12), np.full((12, 2), 0.5)).value
        assert np.isfinite(value).all()


def test_varying_data_on_faces_that_touch_a_crease_of_others():
    positions, faces = [[0, 0, 0], [-1, 0, 0], [1, 0, 0]], []
    for angle in 2 * np.pi / 3 * np.arange(3):  # three sheets on one line
        first = len(positions)
        positions += [[x, np.cos(angle), np.sin(angle)] for x in (-1, 0, 1)]
        faces += [[1, 0, first + 1, first], [0, 2, first + 2, first + 1]]
    first = len(positions)  # a pyramid with its apex on the line
    positions += [[0.3, 0.3, 0.5], [-0.3, 0.3, 0.5], [-0.3, -0.3, 0.5], [0.3, -0.3, 0.5]]
    faces += [[0, first + k, first + (k + 1) % 4] for k in range(4)]
    positions = np.array(positions, float)
    pinned = ls.LimitSurface(
        ls.ControlMesh.from_faces(positions, faces, vertex_sharpness=([0], [10.0]))
    )
    assert not pinned.refused
    face = int(np.flatnonzero(pinned.base_face == 6)[0])
    corner = pinned.varying(positions).evaluate(face, [[0.0, 0.0]]).value
    assert np.array_equal(corner, positions[:1])
    # Not pinned, the apex follows the line, as the sheets do.
    positions[1] += [0, 0.3, 0.6]
    following = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    assert not following.refused
    apex = following.evaluate([face, 1], [[0.0, 0.0], [0.0, 0.0]]).position
    np.testing.assert_allclose(apex, [(positions[1] + positions[2]) / 6] * 2, atol=1e-15)
    flat = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces, scheme="bilinear"))
    assert not flat.refused
    assert np.array_equal(flat.evaluate(face, [[0.0, 0.0]]).position, positions[:1])


@pytest.mark.parametrize("columns", [1, 2, 4])
@pytest.mark.parametrize("side", [1, 3])
def test_bounds_hold_on_their_squares(surface, anywhere, columns, side):
    values = np.random.default_rng(side).random((len(surface.positions), columns))
    data = surface.vertex_data(values)
    boxes = data.bounds(side)
    assert boxes.shape == (surface.face_count, side, side, 2, columns)
    face, uv = anywhere(surface, 300)
    row, column = np.minimum((uv * side).astype(int), side - 1).T[::-1]
    found, box = data.evaluate(face, uv).value, boxes[face, row, column]
    assert (box[:, 0] <= found).all()
    assert (found <= box[:, 1]).all()
    for wrong in (0, 1025):
        with pytest.raises(ValueError, match=rf"side is {wrong}; it must be 1 to 1024"):
            data.bounds(wrong)


def test_threads_do_not_matter(house, anywhere):
    fv = house.face_varying(np.random.default_rng(1).random((22, 5)), seamed(house.mesh), "none")
    face, uv = anywhere(house, 20_000)
    truth = fv.evaluate(face, uv, 1, threads=1)
    for threads in (0, 2, 5):
        got = fv.evaluate(face, uv, 1, threads=threads)
        np.testing.assert_array_equal(got.value, truth.value)
        np.testing.assert_array_equal(got.du, truth.du)


def test_data_without_a_surface_are_errors():
    blank = ls.SurfaceData.__new__(ls.SurfaceData)
    for use in (
        lambda: blank.shape,
        lambda: blank.evaluate(0, [[0, 0]]),
        lambda: blank.set_values([[0.0]]),
        lambda: repr(blank),
    ):
        with pytest.raises(TypeError, match="never initialised"):
            use()
    with pytest.raises(TypeError):
        ls.SurfaceData()


def test_data_do_not_pickle_but_results_do(house):
    data = house.vertex_data(house.positions)
    with pytest.raises(TypeError, match="pickle"):
        pickle.dumps(data)
    assert repr(data) == f"SurfaceData({len(house.positions)} values of 3 columns)"
    here = data.evaluate(0, [[0.5, 0.5]], 1)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(here)).du, here.du)


def test_ctrl_c_ends_evaluations():
    program = textwrap.dedent("""
        import numpy as np, limitsurf as ls
        square = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
        surface = ls.LimitSurface(ls.ControlMesh.from_faces(square, [[0, 1, 2, 3]]))
        data = surface.vertex_data(np.random.rand(4, 30))
        uv = np.random.rand(300_000, 2)
        print("ready", flush=True)
        while True:
            data.evaluate(0, uv, 2)
    """)
    assert "KeyboardInterrupt" in ctrl_c.errors_of(program)
