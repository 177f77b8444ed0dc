# SPDX-License-Identifier: Apache-2.0
"""Locations and polygons that cover the surface."""

import limitsurf as ls
import numpy as np
import pytest
import shapes


def test_vertex_locations_are_the_vertices(surface, mesh):
    at = surface.vertex_locations()
    assert len(at) == len(mesh.positions)
    assert at.uv.shape == (len(at), 2)
    for vertex, (face, (u, v)) in enumerate(zip(at.face, at.uv, strict=True)):
        sizes = shapes.row_bounds(mesh.face_sizes)
        base = surface.base_face[face]
        corners = mesh.face_vertices[sizes[base] : sizes[base + 1]]
        if len(corners) == 4:
            corner = {(0, 0): 0, (1, 0): 1, (1, 1): 2, (0, 1): 3}[(u, v)]
        else:
            assert (u, v) == (0, 0)
            corner = surface.corner[face]
        assert corners[corner] == vertex


def test_isolated_vertices_have_no_location():
    positions, faces = shapes.cube()
    surface = ls.LimitSurface(
        ls.ControlMesh.from_faces(np.concatenate([positions, [[9, 9, 9]]]), faces)
    )
    at = surface.vertex_locations()
    assert at.face[-1] == -1
    assert np.isnan(at.uv[-1]).all()


@pytest.mark.parametrize("side", [1, 2, 7])
def test_jittered_scatter_is_stratified(surface, side):
    at = surface.scatter_jittered(side, 3)
    assert len(at) == surface.face_count * side**2
    assert ((at.uv >= 0) & (at.uv <= 1)).all()
    np.testing.assert_array_equal(at.face, np.repeat(np.arange(surface.face_count), side**2))
    cell = np.floor(at.uv * side).astype(int)
    keys = (at.face * side + cell[:, 0]) * side + cell[:, 1]
    assert len(np.unique(keys)) == len(at)
    assert np.isfinite(surface.evaluate(at.face, at.uv).position).all()


def test_jittered_scatter_depends_on_the_seed_alone(cube):
    one = cube.scatter_jittered(per_side=9, seed=5, threads=1)
    again = cube.scatter_jittered(9, 5)
    np.testing.assert_array_equal(one.uv, again.uv)
    for seed in (0, 4, 6, 2**64 - 1):
        assert not np.array_equal(one.uv, cube.scatter_jittered(9, seed).uv)


def test_jittered_scatter_does_not_repeat_itself(cube):
    side = 20
    offset = np.modf(cube.scatter_jittered(side, 1).uv * side)[0]
    assert len(np.unique(offset)) == offset.size
    assert abs(np.corrcoef(offset[:, 0], offset[:, 1])[0, 1]) < 0.1
    assert abs(np.corrcoef(offset[:-1, 0], offset[1:, 0])[0, 1]) < 0.1
    assert np.abs(np.histogram(offset, 10, (0, 1))[0] / offset.size - 0.1).max() < 0.02


@pytest.mark.parametrize("side", [0, -1])
def test_silly_scatters_are_refused(cube, side):
    with pytest.raises(ValueError, match=str(side)):
        cube.scatter_jittered(side, 1)


@pytest.mark.parametrize("seed", [-1, 2**64])
def test_seeds_have_64_bits(cube, seed):
    with pytest.raises((TypeError, ValueError, OverflowError)):
        cube.scatter_jittered(2, seed)


def directed_edges(faces):
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)


@pytest.mark.parametrize("levels", [1, 2, 3])
def test_tessellation_is_watertight(surface, mesh, levels):
    t = surface.tessellate(levels)
    assert t.faces.shape[1] == 4
    assert t.positions.shape == t.normals.shape
    assert len(t.locations) == len(t.positions)
    edges = directed_edges(t.faces)
    # Every directed edge occurs once: the two faces of an inner edge have opposite directions.
    assert len(np.unique(edges, axis=0)) == len(edges)
    present = set(map(tuple, edges))
    boundary = sum((b, a) not in present for a, b in present)
    cage_edges = set()
    corners = np.split(mesh.face_vertices, np.cumsum(mesh.face_sizes)[:-1])
    for face in corners:
        cage_edges |= set(zip(face, np.roll(face, -1), strict=True))
    assert boundary == sum((b, a) not in cage_edges for a, b in cage_edges) * 2**levels
    # No point occurs twice, and none is unused.
    assert len(np.unique(t.faces)) == len(t.positions)


def test_tessellation_lies_on_the_surface(surface):
    t = surface.tessellate(2)
    here = surface.evaluate(t.locations.face, t.locations.uv, 1)
    np.testing.assert_allclose(t.positions, here.position, atol=1e-13)
    np.testing.assert_allclose(np.linalg.norm(t.normals, axis=1), 1, atol=1e-12)
    known = ~np.isnan(here.normal[:, 0])
    np.testing.assert_allclose(t.normals[known], here.normal[known], atol=1e-11)


@pytest.mark.parametrize("levels", [-1, 40, 2**31, 2**40])
def test_silly_levels_are_refused(cube, levels):
    with pytest.raises((ValueError, TypeError, OverflowError, MemoryError)):
        cube.tessellate(levels)


def test_area_is_that_of_fine_polygons(cube):
    def polygons(levels):
        t = cube.tessellate(levels)
        p = t.positions[t.faces]
        first = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
        second = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 0])
        return (np.linalg.norm(first, axis=1) + np.linalg.norm(second, axis=1)).sum() / 2

    coarse, fine = polygons(5), polygons(6)
    assert cube.area() == pytest.approx(fine + (fine - coarse) / 3, rel=1e-6)


def test_area_scales(cube):
    area = cube.area()
    cube.set_positions(3 * cube.positions)
    assert cube.area() == pytest.approx(9 * area, rel=1e-12)


def test_area_states_its_error(cube):
    area, error = cube.area(error=True)
    assert area == cube.area() == cube.area(error=False)
    assert 0 < error < 1e-9 * area
    y, x = np.divmod(np.arange(25), 5)
    folded = np.stack([x + 0.7 * (y % 2), y + 0.7 * (x % 2), 0 * x], axis=1)
    faces = [[i, i + 1, i + 6, i + 5] for j in range(4) for i in range(5 * j, 5 * j + 4)]
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(folded, faces))
    area, error = surface.area(error=True)
    assert 0 < error < 1e-4 * area


@pytest.mark.parametrize("scale", [1e-77, 1e-30, 1e30, 1e78])
def test_area_at_any_scale(cube, scale):
    area = cube.area()
    cube.set_positions(scale * cube.positions)
    assert cube.area() / scale / scale == pytest.approx(area, rel=1e-12)


def test_area_of_a_line_is_zero():
    line = np.outer([0, 1, 1.37, 0.37], [0.3, 0.7, 0.11])
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(line, [[0, 1, 2, 3]]))
    area, error = surface.area(error=True)
    assert area <= error < 1e-13


def test_bounds_are_tight(surface):
    low, high = surface.bounds()
    points = surface.tessellate(6).positions
    assert (low <= points.min(axis=0) + 1e-13).all()
    assert (high >= points.max(axis=0) - 1e-13).all()
    np.testing.assert_allclose(low, points.min(axis=0), atol=1e-3)
    np.testing.assert_allclose(high, points.max(axis=0), atol=1e-3)
