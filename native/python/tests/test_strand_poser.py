# SPDX-License-Identifier: Apache-2.0
"""Strands that follow the surface, against evaluate() and frames() in a few lines of numpy."""

import gc
import pickle

import ctrl_c
import limitsurf as ls
import numpy as np
import pytest
import shapes

POINTS = 5


def matrix_of(quaternion):
    w, x, y, z = (quaternion / np.linalg.norm(quaternion, axis=-1, keepdims=True)).T
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    ).transpose(2, 0, 1)


def unit(rows):
    return rows / np.linalg.norm(rows, axis=-1, keepdims=True)


class Hair:
    """A house with strands of POINTS points; every ninth is not bound."""

    def __init__(self, count=500):
        self.cage, faces = shapes.house()
        self.surface = ls.LimitSurface(ls.ControlMesh.from_faces(self.cage, faces))
        rng = np.random.default_rng(1)
        self.face = rng.integers(0, self.surface.face_count, count)
        self.uv = rng.random((count, 2))
        self.uv[::50] = 0  # at vertices, of which some are extraordinary
        self.roots = rng.normal(size=(count, 3)).astype(np.float32)
        self.rotations = rng.normal(size=(count, 4)).astype(np.float32)
        self.rotations[::9] = 0
        self.bound = np.arange(count) % 9 != 0
        self.points = rng.normal(size=(POINTS * count, 3)).astype(np.float32)
        self.offsets = np.arange(count + 1) * POINTS

    def poser(self, **changes):
        given = {
            "face": np.where(self.bound, self.face, -7),
            "uv": self.uv,
            "rest_roots": self.roots,
            "rest_rotations": self.rotations,
            "offsets": self.offsets,
        }
        return self.surface.strand_poser(**{**given, **changes})

    def turns(self, matrix):
        """Positions of the roots, and rotations from the rest shape."""
        frames = self.surface.frames(self.face, self.uv)
        linear = matrix[:3, :3]
        tangent = unit(frames[:, :, 0] @ linear.T)
        normal = unit(frames[:, :, 2] @ np.linalg.inv(linear))
        carried = np.stack([tangent, np.cross(normal, tangent), normal], 2)
        position = self.surface.evaluate(self.face, self.uv).position @ linear.T + matrix[:3, 3]
        with np.errstate(invalid="ignore"):
            return position, carried @ matrix_of(self.rotations.astype(float)).transpose(0, 2, 1)

    def expected(self, matrix):
        position, turn = self.turns(matrix)
        points = self.points.reshape(-1, POINTS, 3).astype(float)
        moved = position[:, None] + np.einsum("nij,npj->npi", turn, points - self.roots[:, None])
        return np.where(self.bound[:, None, None], moved, points).reshape(-1, 3)


@pytest.fixture
def hair():
    return Hair()


MATRICES = {
    "none": np.eye(4),
    "moved": np.array([[0, -2, 0, 5], [2, 0, 0, 0], [0, 0, 2, 1], [0, 0, 0, 1.0]]),
    "mirrored": np.diag([1, -1, 0.5, 1.0]),
}


@pytest.mark.parametrize("name", MATRICES)
def test_follow_positions_and_frames(hair, name):
    matrix = MATRICES[name]
    poser = hair.poser()
    assert (len(poser), poser.bound_count, poser.point_count) == (500, 444, 2500)
    for stretch in (1, 1.5):
        hair.surface.set_positions(hair.cage * [1, stretch, 1])
        posed = poser.pose(hair.points, None if name == "none" else matrix)
        assert posed.dtype == np.float32
        np.testing.assert_allclose(posed, hair.expected(matrix), rtol=3e-7, atol=3e-7)


@pytest.mark.parametrize("name", MATRICES)
def test_positions_give_what_a_posed_surface_gives(hair, name):
    matrix, positions = MATRICES[name], hair.cage * [1, 1.5, 1.2]
    poser, points = hair.poser(), hair.points.copy()
    posed = poser.pose(hair.points, matrix, positions=positions)
    has_changed, numbers = poser.repose(hair.points, points, matrix, positions=positions)
    np.testing.assert_array_equal(points, posed)
    assert has_changed
    assert not poser.repose(hair.points, points, matrix, positions=positions)[0]
    np.testing.assert_array_equal(numbers, poser.fingerprints(posed))
    back = poser.unpose(posed, matrix, positions=positions)
    np.testing.assert_allclose(back, hair.points, atol=2e-5)
    assert 100 < poser.irregular_count <= poser.bound_count  # a house has few regular faces
    single = hair.poser(offsets=None)
    vectors = single.pose_vectors(hair.roots, matrix, positions=positions)
    rotations = single.pose_rotations(hair.rotations, matrix, positions=positions)
    np.testing.assert_array_equal(hair.surface.positions, hair.cage)

    hair.surface.set_positions(positions)
    np.testing.assert_allclose(posed, hair.expected(matrix), rtol=3e-7, atol=3e-7)
    np.testing.assert_allclose(vectors, single.pose_vectors(hair.roots, matrix), atol=1e-6)
    np.testing.assert_allclose(rotations, single.pose_rotations(hair.rotations, matrix), atol=1e-6)


def test_positions_are_checked(hair):
    poser, before = hair.poser(), hair.points.copy()
    bad = hair.cage.copy()
    bad[2, 1] = np.nan
    with pytest.raises(ls.MeshError, match="vertex 2 .*nan"):
        poser.repose(hair.points.copy(), hair.points, positions=bad)
    with pytest.raises(ls.MeshError, match=f"expected .{len(hair.cage)}, 3"):
        poser.repose(hair.points.copy(), hair.points, positions=hair.cage[1:])
    np.testing.assert_array_equal(hair.points, before)


def test_unpose_is_the_inverse(hair):
    poser = hair.poser()
    posed = poser.pose(hair.points, MATRICES["moved"])
    back = poser.unpose(posed, MATRICES["moved"])
    np.testing.assert_allclose(back, hair.points, atol=1e-5)
    only = np.zeros(500, bool)
    only[[3, 4, 99]] = True
    some = np.full_like(posed, 7)
    assert poser.unpose(posed, MATRICES["moved"], some, only=only) is some
    chosen = np.repeat(only, POINTS)
    np.testing.assert_array_equal(some[chosen], back[chosen])
    assert (some[~chosen] == 7).all()


def test_vectors_and_rotations_turn_with_the_strand(hair):
    poser = hair.poser(offsets=None)
    rng = np.random.default_rng(2)
    vectors, rotations = rng.normal(size=(500, 3)), rng.normal(size=(500, 4))
    _, turn = hair.turns(MATRICES["mirrored"])
    moved = poser.pose_vectors(vectors, MATRICES["mirrored"])
    expected = np.where(hair.bound[:, None], np.einsum("nij,nj->ni", turn, vectors), vectors)
    np.testing.assert_allclose(moved, expected, atol=2e-6)
    posed = poser.pose_rotations(rotations, MATRICES["mirrored"])
    bound = hair.bound
    np.testing.assert_allclose(
        matrix_of(posed[bound].astype(float)), (turn @ matrix_of(rotations))[bound], atol=1e-6
    )
    np.testing.assert_array_equal(posed[~bound], rotations[~bound].astype(np.float32))


def test_rest_rotations_may_be_matrices(hair):
    matrices = np.zeros((500, 3, 3))
    matrices[hair.bound] = matrix_of(hair.rotations[hair.bound].astype(float))
    poser = hair.poser(rest_rotations=matrices)
    assert poser.bound_count == 444
    np.testing.assert_allclose(
        poser.pose(hair.points), hair.poser().pose(hair.points), rtol=1e-6, atol=2e-6
    )


def test_results_may_not_overlap_the_input_in_part(hair):
    poser = hair.poser(offsets=None)
    for call, columns in ((poser.pose, 3), (poser.unpose, 3), (poser.pose_vectors, 3),
                          (poser.pose_rotations, 4)):  # fmt: skip
        rows = np.random.default_rng(3).normal(size=(1001, columns)).astype(np.float32)
        given, beside = rows[:500], rows[500:1000]
        expected = call(given.copy())
        for shift in (1, 499):
            with pytest.raises(ValueError, match=r"^out overlaps \w+ in part"):
                call(rows[shift:][:500], out=given)
            with pytest.raises(ValueError, match=r"^out overlaps \w+ in part"):
                call(given, out=rows[shift:][:500])
        np.testing.assert_array_equal(call(given, out=beside), expected)
        np.testing.assert_array_equal(call(given, out=given), expected)
    rows = np.zeros((501, 3), np.float32)
    with pytest.raises(ValueError, match=r"^points overlaps rest_points in part"):
        poser.repose(rows[1:], rows[:-1])


def test_masked_results_are_refused(hair):
    poser = hair.poser()
    with pytest.raises(TypeError, match=r"^out is a masked array"):
        poser.pose(hair.points, out=np.ma.masked_array(hair.points.copy()))


def test_results_may_replace_the_input(hair):
    poser = hair.poser()
    expected = poser.pose(hair.points)
    given = hair.points.copy()
    assert poser.pose(given, out=given) is given
    np.testing.assert_array_equal(given, expected)


def test_reposing_moves_points_in_place_and_tells_whether_they_changed(hair):
    poser, points = hair.poser(), hair.points.copy()
    posed = poser.pose(hair.points, MATRICES["mirrored"])
    for expected in (True, False):
        has_changed, numbers = poser.repose(hair.points, points, MATRICES["mirrored"])
        assert has_changed is expected
        np.testing.assert_array_equal(points, posed)
        np.testing.assert_array_equal(numbers, poser.fingerprints(posed))


def test_the_number_of_threads_gives_the_same_bits():
    hair = Hair(40_000)
    poser = hair.poser()
    for positions in (None, hair.cage):
        results = {
            poser.pose(hair.points, positions=positions, threads=n).tobytes() for n in (0, 1, 2)
        }
        assert len(results) == 1
    numbers = {poser.fingerprints(hair.points, threads=n).tobytes() for n in (0, 1, 2)}
    assert len(numbers) == 1


def test_fingerprints_tell_which_strands_were_edited(hair):
    poser = hair.poser()
    before = poser.fingerprints(hair.points)
    assert before.dtype == np.int32
    assert before.all()
    hair.points[POINTS * 17 + 2, 1] += 1e-3
    np.testing.assert_array_equal(np.flatnonzero(poser.fingerprints(hair.points) != before), [17])


def test_empty_batches():
    surface = Hair(1).surface
    poser = surface.strand_poser([], [], [], [])
    assert len(poser) == 0
    assert poser.pose([]).shape == (0, 3)
    assert poser.pose_rotations([]).shape == (0, 4)
    assert poser.fingerprints([]).shape == (0,)


def test_a_poser_keeps_its_surface(hair):
    poser, expected = hair.poser(), hair.poser().pose(hair.points)
    points = hair.points
    hair.surface = None
    gc.collect()
    np.testing.assert_array_equal(poser.pose(points), expected)


def test_bad_input_is_named(hair):
    face = hair.face.copy()
    face[4] = 10_000
    with pytest.raises(ls.LocationError, match="row 4: face 10000"):
        hair.poser(face=face)
    uv = hair.uv.copy()
    uv[5, 1] = np.nan
    with pytest.raises(ls.LocationError, match="row 5.*nan"):
        hair.poser(uv=uv)
    roots = hair.roots.copy()
    roots[8] = np.inf
    with pytest.raises(ValueError, match="row 8: rest_roots is .inf"):
        hair.poser(rest_roots=roots)
    with pytest.raises(ValueError, match=r"rest_rotations has shape \(500, 3\)"):
        hair.poser(rest_rotations=hair.roots)
    with pytest.raises(ValueError, match="499 rows; expected 500"):
        hair.poser(rest_roots=hair.roots[:-1])
    for offsets, message in (
        (hair.offsets[:-1], "500 offsets for 500 strands"),
        (hair.offsets + 1, r"offsets\[0\] is 1"),
        (-hair.offsets, r"offsets\[1\] is -5, less than the one before it, 0"),
        ([], "offsets is empty"),
    ):
        with pytest.raises(ValueError, match=message):
            hair.poser(offsets=offsets)
    with pytest.raises(TypeError, match="offsets"):
        hair.poser(offsets=hair.offsets.astype(float))

    poser, points = hair.poser(), hair.points
    with pytest.raises(ValueError, match="2499 rows; expected 2500"):
        poser.pose(points[:-1])
    with pytest.raises(ValueError, match="nan in row 0, column 3"):
        poser.pose(points, np.eye(4) + [0, 0, 0, np.nan])
    with pytest.raises(ValueError, match=r"matrix has shape \(3, 3\)"):
        poser.pose(points, np.eye(3))
    with pytest.raises(TypeError, match="out is no contiguous array of float32"):
        poser.pose(points, out=points.astype(float))
    with pytest.raises(TypeError, match="out is no contiguous array of float32"):
        poser.pose(points, out=np.repeat(points, 2, 1)[:, ::2])
    with pytest.raises(ValueError, match=r"out has shape \(2499, 3\)"):
        poser.pose(points, out=points[:-1].copy())
    points.flags.writeable = False
    with pytest.raises(TypeError, match="read-only"):
        poser.pose(points, out=points)
    with pytest.raises(TypeError, match="only has dtype float64; expected booleans"):
        poser.unpose(points, out=points.copy(), only=np.zeros(500))
    with pytest.raises(ValueError, match="only needs out"):
        poser.unpose(points, only=np.zeros(500, bool))
    with pytest.raises(ValueError, match="threads is -1"):
        poser.pose(points, threads=-1)


def test_cannot_be_made_or_pickled_alone(hair):
    with pytest.raises(TypeError):
        ls.StrandPoser()
    with pytest.raises(TypeError, match="never initialised"):
        ls.StrandPoser.__new__(ls.StrandPoser).pose([])
    with pytest.raises(TypeError):
        pickle.dumps(hair.poser())


POSING = """
import ctrl_c, limitsurf as ls, numpy as np, shapes
surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.pole(200)))
count = 2_000_000  # a minute
poser = surface.strand_poser(
    0, np.tile([[1e-4, 2e-4]], (count, 1)), np.zeros((count, 3)), np.tile([1, 0, 0, 0], (count, 1))
)
points = np.zeros((count, 3), np.float32)
ctrl_c.interrupt(lambda: poser.pose(points))
ctrl_c.interrupt(lambda: poser.pose(points, positions=surface.positions))
print(surface.evaluate(0, [[0.5, 0.5]]).position.shape)
"""


def test_ctrl_c_ends_the_call():
    assert ctrl_c.output_of(POSING) == ["interrupted", "interrupted", "(1, 3)"]
