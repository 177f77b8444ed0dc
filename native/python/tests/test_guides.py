# SPDX-License-Identifier: Apache-2.0
"""Guides of children, and strands that are shaped by them."""

import limitsurf as ls
import numpy as np
import pytest
import shapes


@pytest.fixture(scope="module")
def sheet():
    return ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(6, 6)))


def places(surface, count, seed):
    at = surface.scatter_uniform(count, seed)
    return at.face, at.uv


def test_flat_distances_are_euclidean(sheet):
    guides, at = places(sheet, 40, 1), places(sheet, 2000, 2)
    found = sheet.guide_weights(*guides, *at)
    assert isinstance(found, ls.GuideWeights)
    assert found.guide.shape == found.weight.shape == found.distance.shape == (2000, 4)
    p, g = sheet.evaluate(*at).position, sheet.evaluate(*guides).position
    truth = np.linalg.norm(p[:, None] - g, axis=2)
    np.testing.assert_allclose(found.distance, np.sort(truth, axis=1)[:, :4], atol=2e-4)
    np.testing.assert_allclose(found.weight.sum(axis=1), 1)
    assert (np.diff(found.distance, axis=1) >= 0).all()


def test_weights_are_continuous(sheet):
    guides = places(sheet, 30, 3)
    t = np.linspace(0, 1, 4001)
    uv = np.stack([0.1 + 0.8 * t, 0.2 + 0.5 * t], axis=1)
    found = sheet.guide_weights(*guides, 14, uv, count=3)
    dense = np.zeros((len(t), 30))
    np.put_along_axis(dense, found.guide, found.weight, axis=1)
    assert np.abs(np.diff(dense, axis=0)).max() < 0.01


def test_at_a_guide_it_counts_alone(sheet):
    face, uv = places(sheet, 20, 4)
    found = sheet.guide_weights(face, uv, face, uv)
    assert (found.guide[:, 0] == np.arange(20)).all()
    np.testing.assert_array_equal(found.weight[:, 0], 1)


def test_cuts_keep_regions_apart(sheet):
    column = np.arange(7) * 7 + 3
    cuts = np.stack([column[:-1], column[1:]], axis=1)
    guides = [0, 5], [[0.5, 0.5], [0.5, 0.5]]
    at = places(sheet, 500, 5)
    left = sheet.evaluate(*at).position[:, 0] < 3
    found = sheet.guide_weights(*guides, *at, 2, cuts=cuts)
    np.testing.assert_array_equal(found.guide[:, 0], np.where(left, 0, 1))
    np.testing.assert_array_equal(found.guide[:, 1], -1)
    assert np.isinf(found.distance[:, 1]).all()
    assert (sheet.guide_weights(*guides, *at, 2).guide >= 0).all()


def test_curves_of_too_many_pieces_are_refused(sheet):
    guide = [0], [[0.5, 0.5]]
    far = [[[0, y, 0], [1e6, y, 0]] for y in np.linspace(0, 6, 200)]
    with pytest.raises(ValueError, match="^cut_points: .* more than 30000000 pieces, .* long$"):
        sheet.guide_weights(
            *guide, *guide, cut_points=np.reshape(far, (-1, 3)), cut_offsets=range(0, 401, 2)
        )


def test_curves_keep_regions_apart(sheet):
    guides = [0, 5, 30], np.full((3, 2), 0.5)
    at = places(sheet, 500, 5)
    x, y = sheet.evaluate(*at).position[:, :2].T
    # two curves: one from border to border, and one from it to the border
    points = [[2.6, -1, 0], [2.6, 7, 0], [2.6, 3.3, 0], [-1, 3.3, 0]]
    found = sheet.guide_weights(*guides, *at, 2, cut_points=points, cut_offsets=[0, 2, 4])
    truth = np.where(x > 2.6, 1, np.where(y > 3.3, 2, 0))
    np.testing.assert_array_equal(found.guide[:, 0], truth)
    np.testing.assert_array_equal(found.guide[:, 1], -1)
    one = sheet.guide_weights(*guides, *at, 3, cut_points=points[:2])
    np.testing.assert_array_equal((one.guide >= 0).sum(axis=1), np.where(x > 2.6, 1, 2))


def test_curves_part_thin_sheets_without_many_samples():
    """Half a side of a square with the same area would be a ten thousandth of a triangle here."""
    across = 1e-7
    positions, faces = shapes.grid(3, 3)
    thin = ls.LimitSurface(ls.ControlMesh.from_faces(positions * [1, across, 1], faces))
    guides, at = ([0, 8], [[0.5, 0.5], [0.5, 0.5]]), ([0, 3, 5, 8], np.full((4, 2), 0.5))
    cut = np.array([[-1, 4, 0], [4, -1, 0]]) * [1, across, 1]
    found = thin.guide_weights(*guides, *at, 2, cut_points=cut)
    np.testing.assert_array_equal(found.guide[:, 0], [0, 0, 1, 1])
    np.testing.assert_array_equal(found.guide[:, 1], -1)


def test_any_number_of_threads_gives_the_same(sheet):
    guides, at = places(sheet, 12, 6), places(sheet, 5000, 7)
    one = sheet.guide_weights(*guides, *at, threads=1)
    all_cores = sheet.guide_weights(*guides, *at)
    for name in ("guide", "weight", "distance"):
        assert getattr(one, name).tobytes() == getattr(all_cores, name).tobytes()


def test_none(sheet):
    guides = places(sheet, 5, 1)
    assert sheet.guide_weights(*guides, [], []).guide.shape == (0, 4)
    lonely = sheet.guide_weights([], [], *places(sheet, 3, 0))
    assert (lonely.guide == -1).all()
    assert (lonely.weight == 0).all()


def test_progress_is_told_and_ends_the_call(sheet):
    parts = []
    sheet.guide_weights(*places(sheet, 12, 6), *places(sheet, 200_000, 7), progress=parts.append)
    assert parts == sorted(parts)
    assert parts[-1] == 1

    def stop(part):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sheet.guide_weights(*places(sheet, 5, 6), *places(sheet, 50, 7), progress=stop)


def test_errors(sheet):
    at = [0], [[0.5, 0.5]]
    with pytest.raises(ls.MeshError, match="row 1: vertices 0 and 9"):
        sheet.guide_weights(*at, *at, cuts=[[0, 1], [0, 9]])
    with pytest.raises(ls.MeshError, match="cuts has shape"):
        sheet.guide_weights(*at, *at, cuts=[0, 1])
    with pytest.raises(ls.LocationError, match="face 36"):
        sheet.guide_weights([36], [[0, 0]], *at)
    with pytest.raises(ValueError, match="cut_points has shape"):
        sheet.guide_weights(*at, *at, cut_points=[0, 1])
    with pytest.raises(ValueError, match=r"row 1: cut_points is \(nan, 0, 0\), .* not finite"):
        sheet.guide_weights(*at, *at, cut_points=[[0, 0, 0], [np.nan, 0, 0]])
    with pytest.raises(ValueError, match="number of rows of cut_points, 2"):
        sheet.guide_weights(*at, *at, cut_points=np.zeros((2, 3)), cut_offsets=[0, 1])
    for count in (0, 17):
        with pytest.raises(ValueError, match=f"count is {count}"):
            sheet.guide_weights(*at, *at, count)


def test_resampled_strands_have_equal_steps():
    points = [[0, 0, 0], [1, 0, 0], [1, 3, 0], [5, 5, 5], [5, 5, 6]]
    made = ls.resample_strands(points, [0, 3, 5], 5)
    np.testing.assert_allclose(
        made[0], [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 2, 0], [1, 3, 0]], atol=1e-15
    )
    np.testing.assert_allclose(made[1, :, 2], [5, 5.25, 5.5, 5.75, 6])
    for size in (2.0**530, 2.0**-560):  # the squares of lengths overflow, or vanish
        scaled = ls.resample_strands(size * np.array(points), [0, 3, 5], 5)
        np.testing.assert_array_equal(scaled, size * made)
    single = ls.resample_strands([[1, 2, 3]], [0, 1], 3)
    np.testing.assert_array_equal(single, np.full((1, 3, 3), [1, 2, 3]))


def test_resampling_refuses():
    with pytest.raises(ValueError, match="strand 1 has no points"):
        ls.resample_strands(np.zeros((2, 3)), [0, 2, 2], 3)
    with pytest.raises(ValueError, match="number of points, 2"):
        ls.resample_strands(np.zeros((2, 3)), [0, 3], 3)
    with pytest.raises(ValueError, match="count is 1"):
        ls.resample_strands(np.zeros((2, 3)), [0, 2], 1)


GUIDES = np.array([[[0, 0, 0], [0, 0, 1], [0, 1, 1]], [[9, 9, 9], [9, 9, 11], [9, 9, 13]]], float)
UP = np.array([[0, 0, 1], [0, 0, 1]], float)


def test_children_stand_on_their_roots_and_have_blended_lengths():
    rng = np.random.default_rng(0)
    weight = rng.random((50, 2))
    weight /= weight.sum(axis=1, keepdims=True)
    roots, normals = rng.normal(size=(50, 3)), rng.normal(size=(50, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    made = ls.child_strands(GUIDES, UP, np.tile([0, 1], (50, 1)), weight, roots, normals)
    assert made.dtype == np.float32
    np.testing.assert_array_equal(made[:, 0], roots.astype(np.float32))
    lengths = np.linalg.norm(np.diff(made.astype(float), axis=1), axis=2).sum(axis=1)
    np.testing.assert_allclose(lengths, weight @ [2, 4], rtol=1e-5)


def test_a_single_guide_is_turned_by_the_smallest_rotation():
    made = ls.child_strands(GUIDES, UP, [[0, -1]], [[1, 0]], [[5, 0, 0]], [[1, 0, 0]])
    np.testing.assert_allclose(made[0], [[5, 0, 0], [6, 0, 0], [6, 1, 0]], atol=1e-6)
    same = ls.child_strands(GUIDES, UP, [[1]], [[1]], [[0, 0, 0]], UP[:1])
    np.testing.assert_allclose(same[0], GUIDES[1] - 9, atol=1e-6)


def test_child_strands_refuse():
    ones = [[0, 0, 0]], [[0, 0, 1]]
    with pytest.raises(ValueError, match="row 0: guide 2 is not among the 2 guides"):
        ls.child_strands(GUIDES, UP, [[2]], [[1]], *ones)
    with pytest.raises(ValueError, match="row 0: guide -1"):
        ls.child_strands(GUIDES, UP, [[-1]], [[0.5]], *ones)
    with pytest.raises(ValueError, match=r"expected \(n, k\)"):
        ls.child_strands(GUIDES, UP, [[0]], [[1, 0]], *ones)
    with pytest.raises(ValueError, match="guide_normals has 1 row; expected 2"):
        ls.child_strands(GUIDES, UP[:1], [[0]], [[1]], *ones)
