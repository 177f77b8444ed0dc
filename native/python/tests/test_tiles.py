# SPDX-License-Identifier: Apache-2.0
"""Tiles, evaluated by a few lines of numpy, against values of independent subdivision."""

import golden
import limitsurf as ls
import numpy as np
import pytest
import shapes

POSITION_ERROR, DERIVATIVE_ERROR = 1e-14, 1e-12


def cubic(t):
    s = 1 - t
    return np.stack([s**3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3], 1) / 6


def cubic_slope(t):
    s = 1 - t
    return np.stack([-(s**2), 3 * t**2 - 4 * t, -3 * t**2 + 2 * t + 1, t**2], 1) / 2


def evaluated(tiles, cage):
    """Positions, derivatives by tile_uv, and the sizes of the tiles."""
    rows = np.repeat(np.arange(len(tiles.points_offsets) - 1), np.diff(tiles.points_offsets))
    refined = np.zeros((len(tiles.points_offsets) - 1, 3))
    np.add.at(refined, rows, tiles.points_weights[:, None] * cage[tiles.points_indices])
    p = np.concatenate([cage, refined])
    control = p[tiles.tile_points] - p[tiles.tile_base][:, None]
    size = np.linalg.norm(np.ptp(control, axis=1), axis=1)[tiles.tile]
    control = control.reshape(-1, 4, 4, 3)[tiles.tile]
    (s, t), anchor = tiles.tile_uv.T, p[tiles.tile_anchor][tiles.tile]
    position = anchor + np.einsum("nx,ny,nyxc->nc", cubic(s), cubic(t), control)
    by_s = np.einsum("nx,ny,nyxc->nc", cubic_slope(s), cubic(t), control)
    by_t = np.einsum("nx,ny,nyxc->nc", cubic(s), cubic_slope(t), control)
    return position, (by_s, by_t), size


def length(rows):
    return np.linalg.norm(rows, axis=1)


def surface_of(truth):
    return ls.LimitSurface(
        ls.ControlMesh.from_faces(
            truth.positions,
            truth.faces,
            boundary=truth.boundary,
            creasing=truth.creasing,
            triangles=truth.triangles,
            edge_sharpness=(truth.sharp_edges, truth.edge_values),
            vertex_sharpness=(truth.sharp_vertices, truth.vertex_values),
        )
    )


@pytest.mark.parametrize("name", golden.names())
def test_give_the_values_of_independent_subdivision(name):
    truth = golden.read_golden(golden.path_of(name))
    surface = surface_of(truth)
    tiles = surface.tiles(truth.face, truth.uv, max_depth=64)
    position, slopes, size = evaluated(tiles, truth.positions)
    there = ~tiles.moved
    assert there.sum() >= 20
    diagonal = np.linalg.norm(np.ptp(truth.positions, axis=0))
    error = length(position - truth.values["position"])[there].max() / diagonal
    assert error <= POSITION_ERROR
    for axis, quantity in enumerate(("du", "dv")):
        expected = truth.values[quantity] / tiles.scale[:, [axis]]
        known = there & np.isfinite(expected).all(axis=1)
        assert known.sum() >= 20
        allowed = DERIVATIVE_ERROR * np.maximum(size, length(expected))
        assert (length(slopes[axis] - expected)[known] / allowed[known]).max() <= 1


def near_vertices(surface, exponents):
    """Places near all corners of all faces, and whether they are exactly at them."""
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    inward = np.array([[0.3, 0.7], [0.6, 0.1], [0.0, 1.0]])
    uv = np.concatenate(
        [np.abs(corner - inward * 2.0**-n) for corner in corners for n in exponents]
    )
    face = np.repeat(np.arange(surface.face_count), len(uv))
    return face, np.tile(uv, (surface.face_count, 1))


def meshes():
    yield "house", ls.ControlMesh.from_faces(*shapes.house())
    yield "cube", ls.ControlMesh.from_faces(*shapes.cube())
    yield "pole", ls.ControlMesh.from_faces(*shapes.pole(9))
    yield "open fan", ls.ControlMesh.from_faces(*shapes.fan(6, False), boundary="corners")
    positions, faces = shapes.grid(5, 4)
    rng = np.random.default_rng(5)
    positions = positions + rng.uniform(-0.3, 0.3, positions.shape)
    edges = np.array([[7, 8], [8, 9], [9, 15], [13, 14], [14, 15], [20, 21]])
    for value in (0.3, 1.0, 2.6, 5.5, 9.9, 10.0):
        yield (
            f"sharpness {value}",
            ls.ControlMesh.from_faces(
                positions, faces, edge_sharpness=(edges, np.full(len(edges), value))
            ),
        )
    yield "bilinear", ls.ControlMesh.from_faces(*shapes.house(), scheme="bilinear")


@pytest.mark.parametrize("mesh", [pytest.param(mesh, id=name) for name, mesh in meshes()])
def test_agree_with_evaluation_at_any_depth(mesh):
    surface = ls.LimitSurface(mesh)
    rng = np.random.default_rng(3)
    face, uv = near_vertices(surface, (1, 3, 6, 12, 20, 40))
    face = np.concatenate([face, rng.integers(surface.face_count, size=3000)])
    uv = np.concatenate([uv, rng.random((3000, 2))])
    pose = surface.positions + rng.uniform(-0.2, 0.2, surface.positions.shape)
    tiles = surface.tiles(face, uv, max_depth=100)
    assert not tiles.moved.any()
    surface.set_positions(pose)
    here = surface.evaluate(face, uv, derivatives=1)
    position, slopes, size = evaluated(tiles, pose)
    diagonal = np.linalg.norm(np.ptp(pose, axis=0))
    assert length(position - here.position).max() <= POSITION_ERROR * diagonal
    for axis, derivative in enumerate((here.du, here.dv)):
        expected = derivative / tiles.scale[:, [axis]]
        allowed = DERIVATIVE_ERROR * np.maximum(size, length(expected))
        assert (length(slopes[axis] - expected) / allowed).max() <= 1


def test_at_a_vertex_and_too_near_to_it_are_moved():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.fan(5, True)))
    uv = np.array(
        [[0, 0], [2.0**-30, 2.0**-31], [2.0**-25, 0], [2.0**-24, 0], [0.3, 0.2], [1, 0.5]]
    )
    tiles = surface.tiles(0, uv)
    assert tiles.moved.tolist() == [True, True, True, False, False, False]
    position, slopes, _ = evaluated(tiles, surface.positions)
    moved_to = np.array([[2.0**-24, 2.0**-24], [2.0**-24, 2.0**-25], [2.0**-24, 0]])
    expected = surface.evaluate(0, np.concatenate([moved_to, uv[3:]]), derivatives=1)
    np.testing.assert_allclose(position, expected.position, rtol=0, atol=1e-14)
    np.testing.assert_allclose(
        slopes[0] * tiles.scale[:, :1], expected.du, rtol=0, atol=1e-11 * np.abs(expected.du).max()
    )
    assert tiles.scale.max() == 2.0**24
    # The face is split once, as its opposite corner is irregular, too; its tiles are a step deeper.
    for depth in (1, 2):
        shallow = surface.tiles(0, uv, max_depth=depth)
        assert shallow.moved.tolist() == [True, True, True, True, False, False]
        assert shallow.scale.max() == 4


def test_regular_faces_use_the_vertices_themselves():
    positions, faces = shapes.grid(4, 4)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    tiles = surface.tiles(5, [[0.25, 0.5], [1, 1]])
    assert tiles.tile.tolist() == [0, 0]
    assert len(tiles.points_offsets) == 1
    assert sorted(tiles.tile_points[0]) == sorted(set(faces[[0, 2, 8, 10]].ravel()))
    assert tiles.tile_anchor[0] == tiles.tile_base[0] == faces[5][0]
    np.testing.assert_array_equal(tiles.tile_uv, [[0.25, 0.5], [1, 1]])
    np.testing.assert_array_equal(tiles.scale, np.ones((2, 2)))


def test_keep_their_digits_in_single_precision():
    """Deep tiles of a mesh far from the origin: the base takes the offset away before it rounds."""
    positions, faces = shapes.fan(5, True)
    positions = positions + [100, 200, 300]
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    uv = 2.0**-20 * np.random.default_rng(1).uniform(0.5, 1, (200, 2))
    tiles = surface.tiles(0, uv)
    rows = np.repeat(np.arange(len(tiles.points_offsets) - 1), np.diff(tiles.points_offsets))
    sums = np.zeros(len(tiles.points_offsets) - 1)
    np.add.at(sums, rows, tiles.points_weights)
    anchors = tiles.tile_anchor - len(positions)
    is_anchor = np.isin(np.arange(len(sums)), anchors)
    np.testing.assert_allclose(sums[is_anchor], 1, atol=1e-14)
    assert np.abs(sums[~is_anchor]).max() <= 1e-15 * np.abs(tiles.points_weights).max()
    near = positions.astype(np.float32) - positions[0].astype(np.float32)
    _, slopes, _ = evaluated(tiles, near.astype(float))
    expected = surface.evaluate(0, uv, derivatives=1)
    single = [(slope.astype(np.float32) * tiles.scale[:, [i]]) for i, slope in enumerate(slopes)]
    normal = np.cross(single[0], single[1])
    normal /= length(normal)[:, None]
    assert length(normal - expected.normal).max() < 1e-4


def test_equal_rows_are_stored_once():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.house()))
    at = surface.scatter_jittered(20, seed=2)
    tiles = surface.tiles(at.face, at.uv)
    rows = {
        (
            tiles.points_indices[begin:end].tobytes(),
            tiles.points_weights[begin:end].tobytes(),
        )
        for begin, end in zip(tiles.points_offsets[:-1], tiles.points_offsets[1:], strict=True)
    }
    assert len(rows) == len(tiles.points_offsets) - 1
    assert len({row.tobytes() for row in tiles.tile_points}) == len(tiles.tile_points)
    assert set(tiles.tile) == set(range(len(tiles.tile_points)))


def test_depend_neither_on_threads_nor_on_the_batch():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.house()))
    at = surface.scatter_jittered(40, seed=2)
    one, two = (surface.tiles(at.face, at.uv, threads=threads) for threads in (1, 2))
    for field in one.__dataclass_fields__:
        np.testing.assert_array_equal(getattr(one, field), getattr(two, field))
    alone = surface.tiles(at.face[7:8], at.uv[7:8])
    pose = surface.positions
    np.testing.assert_array_equal(evaluated(alone, pose)[0][0], evaluated(one, pose)[0][7])


def test_an_empty_batch_has_no_tiles(surface):
    tiles = surface.tiles([], np.empty((0, 2)))
    assert len(tiles) == 0
    assert tiles.tile_points.shape == (0, 16)
    assert tiles.points_offsets.tolist() == [0]


@pytest.mark.parametrize("depth", [0, -1, 257, 2**40])
def test_depths_out_of_range_are_refused(surface, depth):
    with pytest.raises((ValueError, TypeError), match="max_depth|incompatible"):
        surface.tiles([0], [[0.5, 0.5]], max_depth=depth)


def test_locations_are_checked(surface):
    with pytest.raises(ls.LocationError, match="row 1"):
        surface.tiles([0, 0], [[0, 0], [0, 1.5]])
    with pytest.raises(ls.LocationError, match="row 0"):
        surface.tiles([10**6], [[0, 0]])


def tiles_by_quadtree(tree, face, uv):
    """The tile of each location, and the place in it, as the documentation says."""
    node, rest = face.copy(), uv.copy()
    for _ in range(tree.levels):
        below, upper = tree.child[node], (rest >= 0.5).astype(float)
        splits = below >= 0
        node = np.where(splits, below + (upper @ [1, 2]).astype(int), node)
        rest = np.where(splits[:, None], 2 * rest - upper, rest)
    tile = -1 - tree.child[node]
    scale = np.zeros_like(tree.origin)
    scale[tree.tiles.tile] = tree.tiles.scale
    return tile, ((uv - tree.origin[tile]) * scale[tile]).clip(0, 1)


@pytest.mark.parametrize("shape", [shapes.house(), shapes.fan(5, False), shapes.cube()])
def test_quadtrees_lead_to_the_tiles(shape):
    positions, faces = shape
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    tree = surface.tile_quadtree(20)
    rng = np.random.default_rng(2)
    face = rng.integers(surface.face_count, size=3000)
    uv = rng.uniform(0.001, 0.999, (3000, 2))
    tile, in_tile = tiles_by_quadtree(tree, face, uv)
    stored = {key: getattr(tree.tiles, key) for key in ls.Tiles.__slots__}
    found = ls.Tiles(**stored | {"tile": tile, "tile_uv": in_tile})
    position, _slopes, _size = evaluated(found, positions)
    error = length(position - surface.evaluate(face, uv).position)
    assert error.max() < POSITION_ERROR * np.linalg.norm(np.ptp(positions, axis=0))


def test_quadtrees_of_faces_without_a_surface():
    positions, faces = shapes.cube()
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces, holes=[1]))
    tree = surface.tile_quadtree()
    assert tree.child[1] == -(2**23)
    assert (tree.child[[0, 2, 3, 4, 5]] > -(2**23)).all()
    with pytest.raises(ValueError, match="max_depth is 0; expected 1 to 48"):
        surface.tile_quadtree(0)


def test_quadtrees_grow_evenly_with_depth():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.cube()))
    nodes = [len(surface.tile_quadtree(depth).child) for depth in (12, 24, 36, 48)]
    assert len(set(np.diff(nodes))) == 1
    with pytest.raises(ValueError, match="max_depth is 49; expected 1 to 48"):
        surface.tile_quadtree(49)
