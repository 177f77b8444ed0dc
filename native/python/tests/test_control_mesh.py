# SPDX-License-Identifier: Apache-2.0
import limitsurf as ls
import numpy as np
import pytest
import shapes
from hypothesis import given
from hypothesis import strategies as st

POSITIONS, FACES = shapes.grid(2, 1)  # 6 vertices, 2 quads
SIZES = [4, 4]
VERTICES = FACES.ravel()


def test_keeps_what_it_was_given():
    mesh = ls.ControlMesh(POSITIONS, SIZES, VERTICES, boundary="corners", triangles="smooth")
    assert mesh.positions.dtype == np.float64
    np.testing.assert_array_equal(mesh.positions, POSITIONS)
    np.testing.assert_array_equal(mesh.face_sizes, SIZES)
    np.testing.assert_array_equal(mesh.face_vertices, VERTICES)
    assert (mesh.boundary, mesh.triangles) == ("corners", "smooth")
    assert "6 vertices" in repr(mesh)
    assert "2 faces" in repr(mesh)


def test_its_arrays_are_copies():
    mesh = ls.ControlMesh(POSITIONS, SIZES, VERTICES)
    mesh.positions[:] = 7
    mesh.face_vertices[:] = 7
    np.testing.assert_array_equal(mesh.positions, POSITIONS)
    np.testing.assert_array_equal(mesh.face_vertices, VERTICES)


@pytest.mark.parametrize(
    "faces",
    [
        FACES,
        FACES.tolist(),
        tuple(map(tuple, FACES)),
        list(FACES),
        [FACES[0].tolist(), tuple(FACES[1])],
        FACES.astype(np.uint8),
        FACES.astype(np.int16),
        FACES.astype(np.uint64),
        np.asfortranarray(FACES),
        np.repeat(FACES, 2, axis=0)[::2],
    ],
    ids=[
        "array",
        "lists",
        "tuples",
        "arrays",
        "mixed",
        "uint8",
        "int16",
        "uint64",
        "fortran",
        "strided",
    ],
)
def test_from_faces_takes_arrays_and_lists(faces):
    mesh = ls.ControlMesh.from_faces(POSITIONS, faces)
    np.testing.assert_array_equal(mesh.face_sizes, SIZES)
    np.testing.assert_array_equal(mesh.face_vertices, VERTICES)


def test_from_faces_takes_mixed_sizes():
    positions, faces = shapes.house()
    mesh = ls.ControlMesh.from_faces(positions, faces)
    np.testing.assert_array_equal(mesh.face_sizes, [len(face) for face in faces])
    np.testing.assert_array_equal(mesh.face_vertices, np.concatenate(faces))


@pytest.mark.parametrize(
    "positions",
    [
        POSITIONS.astype(np.float32),
        POSITIONS.astype(np.int64),
        POSITIONS.astype(">f8"),
        np.asfortranarray(POSITIONS),
        np.repeat(POSITIONS, 2, axis=0)[::2],
        np.concatenate([POSITIONS, POSITIONS], axis=1)[:, 3:],
        POSITIONS.tolist(),
        memoryview(POSITIONS),
    ],
    ids=["float32", "int", "big-endian", "fortran", "rows", "columns", "list", "memoryview"],
)
def test_positions_come_in_any_type_and_layout(positions):
    mesh = ls.ControlMesh(positions, SIZES, VERTICES)
    np.testing.assert_array_equal(mesh.positions, POSITIONS)


@pytest.mark.parametrize("shape", [(18,), (6, 2), (6, 4), (2, 3, 3), ()])
def test_wrong_shapes_of_positions_are_quoted(shape):
    with pytest.raises(ls.MeshError) as error:
        ls.ControlMesh(np.zeros(shape), SIZES, VERTICES)
    assert str(shape) in str(error.value)
    assert "positions" in str(error.value)


@pytest.mark.parametrize("name", ["face_sizes", "face_vertices"])
@pytest.mark.parametrize("shape", [(1, 8), (4, 2), ()])
def test_wrong_shapes_of_faces_are_quoted(name, shape):
    given = {"face_sizes": SIZES, "face_vertices": VERTICES}
    given[name] = np.zeros(shape, int)
    with pytest.raises(ls.MeshError) as error:
        ls.ControlMesh(POSITIONS, **given)
    assert str(shape) in str(error.value)
    assert name in str(error.value)


@pytest.mark.parametrize("faces", [VERTICES, FACES[None], np.array(3)])
def test_from_faces_refuses_other_shapes(faces):
    with pytest.raises(ls.MeshError) as error:
        ls.ControlMesh.from_faces(POSITIONS, faces)
    assert str(faces.shape) in str(error.value)


@pytest.mark.parametrize("dtype", [float, np.float32, bool, complex, str, object, "datetime64[s]"])
def test_indices_are_integers(dtype):
    vertices = VERTICES.astype(dtype) if dtype is not object else np.array([None] * 8)
    with pytest.raises(TypeError):
        ls.ControlMesh(POSITIONS, SIZES, vertices)
    if dtype is not object:
        with pytest.raises(TypeError):
            ls.ControlMesh.from_faces(POSITIONS, FACES.astype(dtype))


@pytest.mark.parametrize("dtype", [complex, str, "datetime64[s]"])
def test_positions_are_real(dtype):
    with pytest.raises(TypeError):
        ls.ControlMesh(POSITIONS.astype(int).astype(dtype), SIZES, VERTICES)


@pytest.mark.parametrize("bad", [-1, 6, 2**31, 2**32, 2**40, 2**63 - 1, -(2**63), -(2**40)])
def test_indices_out_of_range_are_named(bad):
    vertices = VERTICES.astype(np.int64)
    vertices[6] = bad
    with pytest.raises(ls.MeshError, match="face 1") as error:
        ls.ControlMesh(POSITIONS, SIZES, vertices)
    assert str(bad) in str(error.value)
    with pytest.raises(ls.MeshError, match="face 1"):
        ls.ControlMesh.from_faces(POSITIONS, vertices.reshape(2, 4))
    with pytest.raises(ls.MeshError, match="face 1"):
        ls.ControlMesh.from_faces(POSITIONS, vertices.reshape(2, 4).tolist())


@pytest.mark.parametrize("bad", [2**63, 2**64 - 1, 2**64, 2**100, -(2**64)])
def test_indices_beyond_64_bits_are_errors(bad):
    faces = FACES.tolist()
    faces[1][2] = bad
    # numpy makes floats of a list that no integer type holds.
    with pytest.raises((ls.MeshError, OverflowError, TypeError)):
        ls.ControlMesh.from_faces(POSITIONS, faces)


@given(st.integers(0, 7), st.integers(-(2**63), 2**64 - 1).filter(lambda i: not 0 <= i < 6))
def test_no_index_gets_past_the_check(place, bad):
    vertices = VERTICES.tolist()
    vertices[place] = bad
    dtype = np.int64 if bad < 2**63 else np.uint64
    named = f"face {place // 4} names vertex {bad}"
    if bad >= 2**63:
        named = rf"face_vertices\[{place}\] is {bad}"
    with pytest.raises(ls.MeshError, match=named):
        ls.ControlMesh(POSITIONS, SIZES, np.array(vertices, dtype))


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_positions_are_finite(bad):
    positions = POSITIONS.copy()
    positions[4, 1] = bad
    with pytest.raises(ls.MeshError, match="vertex 4"):
        ls.ControlMesh(positions, SIZES, VERTICES)


@pytest.mark.parametrize("sizes", [[4, 3], [4, 4, 4], [], [2**62] * 4 + [4, 4], [8], [-4, 12]])
def test_sizes_that_do_not_fit_are_refused(sizes):
    sizes = np.array(sizes, dtype=np.int64)
    if sizes.tolist() == [8]:
        positions = np.random.default_rng(0).random((8, 3))
        ls.ControlMesh(positions, sizes, np.arange(8))  # an octagon is fine
        return
    with pytest.raises(ls.MeshError):
        ls.ControlMesh(POSITIONS, sizes, VERTICES)


@pytest.mark.parametrize("size", [0, 1, 2])
def test_faces_have_three_vertices(size):
    with pytest.raises(ls.MeshError, match="face 1"):
        ls.ControlMesh(POSITIONS, [8 - size, size], VERTICES)


@pytest.mark.parametrize("option", ["boundary", "creasing", "triangles", "scheme"])
def test_unknown_options_are_quoted(option):
    with pytest.raises(ValueError, match="sharp-ish") as error:
        ls.ControlMesh(POSITIONS, SIZES, VERTICES, **{option: "sharp-ish"})
    assert option in str(error.value)


def test_sharpness_and_scheme_reach_the_surface():
    """Positions at the end of the edge that the two squares have in common."""
    bent = POSITIONS.copy()
    bent[1, 2] = 1

    def corner(**options):
        mesh = ls.ControlMesh(bent, SIZES, VERTICES, **options)
        return ls.LimitSurface(mesh).evaluate(0, [[1, 0]]).position[0]

    np.testing.assert_allclose(corner(), [1, 0, 2 / 3], atol=1e-15)
    np.testing.assert_array_equal(corner(scheme="bilinear"), bent[1])
    np.testing.assert_array_equal(corner(vertex_sharpness=([1], [np.inf])), bent[1])
    np.testing.assert_array_equal(corner(edge_sharpness=([[1, 4]], [np.inf])), bent[1])
    assert corner()[2] < corner(edge_sharpness=([[1, 4]], [0.5]))[2] < 1
    assert corner()[2] < corner(vertex_sharpness=([1], [2.5]))[2] < 1


@pytest.mark.parametrize(
    "edges",
    [
        ([[1, 4]], [-1.0]),
        ([[1, 4]], [np.nan]),
        ([[0, 4]], [0.0]),
        ([[0, 6]], [0.0]),
        ([[-1, 0]], [0.0]),
        ([[2**40, 0]], [0.0]),
        ([[1, 4]], [0.0, 0.0]),
        ([1, 4], [0.0]),
        ([[1, 4, 5]], [0.0]),
        ([[1, 4]], [[0.0]]),
        ([[1, 4]],),
    ],
)
def test_bad_edge_sharpness_is_refused(edges):
    with pytest.raises(ls.MeshError):
        ls.ControlMesh(POSITIONS, SIZES, VERTICES, edge_sharpness=edges)


@pytest.mark.parametrize(
    "vertices",
    [
        ([1], [-1.0]),
        ([1], [np.nan]),
        ([6], [0.0]),
        ([-1], [0.0]),
        ([1], [0.0, 0.0]),
        ([[1]], [0.0]),
    ],
)
def test_bad_vertex_sharpness_is_refused(vertices):
    with pytest.raises(ls.MeshError):
        ls.ControlMesh(POSITIONS, SIZES, VERTICES, vertex_sharpness=vertices)


def test_sharpness_of_zero_is_accepted():
    ls.ControlMesh(
        POSITIONS,
        SIZES,
        VERTICES,
        edge_sharpness=([[4, 1]], [0]),
        vertex_sharpness=([1], [0]),
    )


@pytest.mark.parametrize("empty", [([], []), [], (), np.zeros((2, 0))])
def test_no_sharpness_is_given(empty):
    mesh = ls.ControlMesh(POSITIONS, SIZES, VERTICES, edge_sharpness=empty, vertex_sharpness=empty)
    assert not len(mesh.edge_sharpness[0])
    assert not len(mesh.vertex_sharpness[0])


@pytest.mark.parametrize("holes", [[2], [-1], [2**40], [[0]]])
def test_bad_holes_are_refused(holes):
    with pytest.raises(ls.MeshError):
        ls.ControlMesh(POSITIONS, SIZES, VERTICES, holes=holes)


def test_holes_are_integers():
    with pytest.raises(TypeError):
        ls.ControlMesh(POSITIONS, SIZES, VERTICES, holes=[0.0])


def test_a_mesh_says_what_it_was_made_of():
    positions, faces = np.eye(4)[:, :3], [[0, 1, 2, 3]]
    mesh = ls.ControlMesh.from_faces(
        positions,
        faces,
        edge_sharpness=([[1, 0]], [np.inf]),
        vertex_sharpness=([2], [0.5]),
        creasing="chaikin",
        scheme="bilinear",
        holes=[0],
    )
    assert (mesh.creasing, mesh.scheme, mesh.boundary) == ("chaikin", "bilinear", "smooth")
    edges, values = mesh.edge_sharpness
    assert edges.tolist() == [[1, 0]]
    assert values.tolist() == [np.inf]
    vertices, values = mesh.vertex_sharpness
    assert vertices.tolist() == [2]
    assert values.tolist() == [0.5]
    assert mesh.holes.tolist() == [0]
    again = ls.ControlMesh(
        mesh.positions,
        mesh.face_sizes,
        mesh.face_vertices,
        mesh.edge_sharpness,
        mesh.vertex_sharpness,
        mesh.boundary,
        mesh.creasing,
        mesh.triangles,
        mesh.scheme,
        mesh.holes,
    )
    assert again.scheme == "bilinear"
    assert again.holes.tolist() == [0]
