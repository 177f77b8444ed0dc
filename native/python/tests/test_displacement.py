# SPDX-License-Identifier: Apache-2.0
"""Displacement between surfaces, and the reading of its maps.

Subdivided meshes are made by the rules spelled out in catmull_clark.py.
"""

import catmull_clark
import limitsurf as ls
import numpy as np
import pytest
import shapes

EXACT = 3e-13  # of the diagonal: what displacement promises


def surface_of(positions, faces, **options):
    return ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces, **options))


def diagonal(surface):
    return np.linalg.norm(np.ptp(surface.positions, axis=0))


def sheet_map(surface):
    """A smooth UV map without folds or seams, for sheets: (x, y) bent a little."""
    x, y = surface.positions[:, 0] / 5, surface.positions[:, 1] / 5
    values = np.stack([0.1 + x + 0.05 * np.sin(3 * y), 0.1 + y + 0.04 * np.cos(4 * x)], axis=1)
    return surface.face_varying(values, surface.mesh.face_vertices, "none")


def bent_grid(columns=4, rows=3, seed=5):
    positions, faces = shapes.grid(columns, rows)
    positions = positions + np.random.default_rng(seed).uniform(-0.15, 0.15, positions.shape)
    positions[:, 2] += 0.3 * np.sin(positions[:, 0])
    return positions, faces


def sculpted(positions, amount):
    x, y, z = positions.T
    moves = np.stack([np.sin(3 * y), np.cos(2 * x + z), np.sin(2 * x) + y], axis=1)
    return positions + amount * moves


@pytest.mark.parametrize("levels", [1, 2, 3])
@pytest.mark.parametrize("name", [*sorted(shapes.ALL), "pole"])
def test_what_is_only_subdivided_is_not_displaced(name, levels, anywhere):
    positions, faces = shapes.pole(5) if name == "pole" else shapes.ALL[name]
    base = surface_of(positions, faces)
    target = surface_of(*catmull_clark.subdivided(positions, faces, levels))
    face, uv = anywhere(base, 400)
    uv[:80] = np.round(4 * uv[:80]) / 4
    moved = base.vector_displacement(target, face, uv)
    assert np.abs(moved).max() <= EXACT * diagonal(base)
    found = ls.SubdividedFaces(base.mesh, target.mesh)
    assert found.levels == levels
    assert found.order == ("blender" if levels == 1 else "opensubdiv")


@pytest.mark.parametrize("levels", [0, 1, 2])
@pytest.mark.parametrize("name", ["house", "cube", "boundary fan"])
def test_an_affine_map_displaces_as_it_says(name, levels, anywhere):
    positions, faces = shapes.ALL[name]
    base = surface_of(positions, faces)
    fine, fine_faces = catmull_clark.subdivided(positions, faces, levels)
    matrix, shift = np.array([[1.2, 0.3, 0], [-0.1, 0.8, 0.2], [0.4, 0, 1.5]]), [0.3, -2, 1]
    target = surface_of(fine @ matrix.T + shift, fine_faces)
    face, uv = anywhere(base, 300)
    at = base.evaluate(face, uv).position
    expected = at @ matrix.T + shift - at
    moved = base.vector_displacement(target, face, uv)
    np.testing.assert_allclose(moved, expected, atol=EXACT * 4)


def test_a_sculpted_child_is_found_in_its_quarter():
    """One subdivided face, compared with numbers computed independently."""
    positions, faces = bent_grid()
    base = surface_of(positions, faces)
    fine, fine_faces = catmull_clark.subdivided(positions, faces, 1)
    target = surface_of(sculpted(fine, 0.2), fine_faces)
    rng = np.random.default_rng(3)
    for corner, (right, up) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)]):
        face, inside = rng.integers(0, len(faces), 50), rng.random((50, 2))
        there = target.evaluate(4 * face + corner, inside).position
        uv = (inside + [right, up]) / 2
        moved = base.vector_displacement(target, face, uv)
        here = base.evaluate(face, uv).position
        np.testing.assert_allclose(here + moved, there, atol=1e-12)


def test_frames(anywhere):
    positions, faces = bent_grid()
    base = surface_of(positions, faces)
    fine, fine_faces = catmull_clark.subdivided(positions, faces, 2)
    target = surface_of(sculpted(fine, 0.2), fine_faces)
    face, uv = anywhere(base, 500)
    vectors = base.vector_displacement(target, face, uv)
    for frames in (base.tangent_frames(sheet_map(base), face, uv), base.frames(face, uv)):
        along = base.vector_displacement(target, face, uv, frames=frames)
        tangent, bitangent, normal = np.moveaxis(frames, 2, 0)
        expected = [(vectors * axis).sum(axis=1) for axis in (tangent, normal, bitangent)]
        np.testing.assert_allclose(along, np.transpose(expected), atol=1e-14)
        there = base.displaced(face, uv, along, frames=frames)
        np.testing.assert_allclose(there, base.evaluate(face, uv).position + vectors, atol=1e-13)
    np.testing.assert_allclose(base.displaced(face, uv, vectors), there, atol=1e-13)


def test_distances_between_planes(anywhere):
    """Grids that are flat inside: the normal is (0, 0, 1), and the target is z = a x + b y + c."""
    positions, faces = shapes.grid(4, 4)
    base = surface_of(positions, faces)
    wide, wide_faces = shapes.grid(7, 5)
    wide = wide * [3, 4, 0] - [8, 8, 0]
    wide[:, 2] = 0.1 * wide[:, 0] - 0.05 * wide[:, 1] + 0.4
    target = surface_of(wide, wide_faces)
    face, uv = anywhere(base, 400)
    x, y, _ = base.evaluate(face, uv).position.T
    expected = 0.1 * x - 0.05 * y + 0.4
    found = base.scalar_displacement(target, face, uv)
    np.testing.assert_allclose(found, expected, atol=1e-11)
    near = base.scalar_displacement(target, face, uv, 0.5)
    np.testing.assert_array_equal(np.isnan(near), expected > 0.5)
    assert np.isnan(base.scalar_displacement(target, face, uv, direction="inward")).all()
    there = base.displaced(face, uv, found)
    np.testing.assert_allclose(there[:, 2], expected, atol=1e-11)
    np.testing.assert_allclose(there[:, :2], np.stack([x, y], axis=1), atol=1e-13)


def test_the_nearer_of_two_sheets_counts(anywhere):
    positions, faces = shapes.grid(3, 3)
    base = surface_of(positions, faces)
    wide = positions * 3 - [3, 3, 0]
    both = surface_of(
        np.concatenate([wide + [0, 0, 1], wide - [0, 0, 0.5]]),
        np.concatenate([faces, faces + len(positions)]),
    )
    face, uv = anywhere(base, 50)
    for direction, expected in (("both", -0.5), ("inward", -0.5), ("outward", 1.0)):
        found = base.scalar_displacement(both, face, uv, direction=direction)
        np.testing.assert_allclose(found, expected, atol=1e-12)


def test_distances_between_closed_surfaces(anywhere):
    """The nearest of all crossings of the line along the normal that rays find."""
    base = surface_of(*shapes.cube())
    positions, faces = shapes.house()
    around = surface_of((shapes.cube()[0] - 0.5) * 1.3 + 0.55, shapes.cube()[1])
    face, uv = anywhere(base, 300)
    here = base.evaluate(face, uv, 1)
    for other in (surface_of(positions, faces), surface_of(positions + [2, 0, 0], faces), around):
        found = base.scalar_displacement(other, face, uv)
        for sign in (1, -1):
            hits = other.ray_cast_all(here.position, sign * here.normal)
            row = np.repeat(np.arange(len(face)), np.diff(hits.offsets))
            assert (hits.distance >= np.abs(found)[row] - 1e-11).all()
        met = ~np.isnan(found)
        there = base.displaced(face[met], uv[met], found[met])
        assert other.closest(there).distance.max() < 1e-11
        assert met.sum() > 10
        assert met.all() or other is not around


def test_normals_at_irregular_vertices():
    """Corners of four boundary faces have no normal, but a distance is found there as well."""
    base = surface_of(*shapes.fan(5, False))
    at = base.vertex_locations()
    assert np.isnan(base.evaluate(at.face, at.uv, 1).normal).any()
    positions, faces = shapes.grid(3, 3)
    plane = surface_of(positions * 6 - [9, 9, -3], faces)
    assert np.isfinite(base.scalar_displacement(plane, at.face, at.uv)).all()
    assert np.isfinite(base.displaced(at.face, at.uv, np.ones(len(at)))).all()


def test_other_poses_of_both(anywhere):
    positions, faces = shapes.house()
    base = surface_of(positions, faces)
    fine, fine_faces = catmull_clark.subdivided(positions, faces, 1)
    target = surface_of(fine, fine_faces)
    base.set_positions(2 * positions)
    target.set_positions(2 * fine + [1, 2, 3])
    face, uv = anywhere(base, 100)
    moved = base.vector_displacement(target, face, uv)
    np.testing.assert_allclose(moved, np.tile([1.0, 2, 3], (100, 1)), atol=EXACT * 20)
    np.testing.assert_array_equal(base.vector_displacement(base, face, uv), 0)


def test_threads_change_no_bit(anywhere):
    positions, faces = shapes.house()
    base = surface_of(positions, faces)
    fine, fine_faces = catmull_clark.subdivided(positions, faces, 2)
    target = surface_of(sculpted(fine, 0.1), fine_faces)
    face, uv = anywhere(base, 70_000)
    for measure in (base.vector_displacement, base.scalar_displacement):
        one = measure(target, face, uv, threads=1)
        np.testing.assert_array_equal(one, measure(target, face, uv, threads=3))
        np.testing.assert_array_equal(one[:7], measure(target, face[:7], uv[:7]))


def test_progress(anywhere):
    positions, faces = shapes.cube()
    base = surface_of(positions, faces)
    face, uv = anywhere(base, 140_000)
    for measure in (base.vector_displacement, base.scalar_displacement):
        told = []
        measure(base, face, uv, progress=told.append)
        assert len(told) == 3
        assert told == sorted(told)
        assert told[-1] == 1

    def stop(part):
        raise KeyError(part)

    with pytest.raises(KeyError):
        base.vector_displacement(base, face, uv, progress=stop)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda faces: faces[:-1], r"the target has 159 faces; the base's \d+ become"),
        (lambda faces: [*faces[:-1], np.roll(faces[-1], 1)], r"face 159 of the target has vertex"),
        (lambda faces: [faces[1], faces[0], *faces[2:]], r"of faces\)$|face \d+ of the target"),
        (lambda faces: [*faces[:-1], faces[-1][:3]], r"face 159 of the target has 3 corners"),
    ],
)
def test_structures_that_do_not_match(change, message):
    positions, faces = bent_grid(5, 2)
    base = surface_of(positions, faces)
    fine, fine_faces = catmull_clark.subdivided(positions, faces, 2)
    target = surface_of(fine, [list(face) for face in change(list(fine_faces))])
    with pytest.raises(ls.MeshError, match=f"^structures do not match: .*{message}"):
        base.vector_displacement(target, [0], [[0.5, 0.5]])
    with pytest.raises(ls.MeshError, match="^structures do not match: "):
        ls.SubdividedFaces(base.mesh, target.mesh)


def test_arguments_without_meaning(cube, anywhere):
    face, uv = anywhere(cube, 5)
    with pytest.raises(ValueError, match=r"frames has shape \(4, 3, 3\); expected \(5, 3, 3\)"):
        cube.vector_displacement(cube, face, uv, frames=np.ones((4, 3, 3)))
    with pytest.raises(ValueError, match=r"values has shape \(5, 2\)"):
        cube.displaced(face, uv, np.ones((5, 2)))
    with pytest.raises(ValueError, match="distances along the normals, which need no frames"):
        cube.displaced(face, uv, np.ones(5), frames=np.ones((5, 3, 3)))
    with pytest.raises(ValueError, match="max_distance is -1"):
        cube.scalar_displacement(cube, face, uv, -1)
    with pytest.raises(ValueError, match="direction is 'up'; expected 'both' or 'outward'"):
        cube.scalar_displacement(cube, face, uv, direction="up")
    with pytest.raises(ls.LocationError, match="face 6 is not among the 6"):
        cube.vector_displacement(cube, [6], [[0, 0]])
    with pytest.raises(TypeError):
        cube.vector_displacement(None, face, uv)
    for empty in (
        cube.vector_displacement(cube, [], []),
        cube.displaced([], [], np.empty((0, 3))),
    ):
        assert empty.shape == (0, 3)
    assert cube.scalar_displacement(cube, [], []).shape == (0,)
    with pytest.raises(TypeError, match="never initialised"):
        ls.PtexLayout.__new__(ls.PtexLayout).texels()
    with pytest.raises(TypeError, match="never initialised"):
        ls.SubdividedFaces.__new__(ls.SubdividedFaces).locate([0], [[0, 0]])


def test_holes_in_the_target_are_named(cube):
    positions, faces = shapes.cube()
    target = surface_of(*catmull_clark.subdivided(positions, faces, 1), holes=[5])
    with pytest.raises(ls.MeshError, match="5"):
        cube.vector_displacement(target, [1], [[0.75, 0.25]])
    assert np.isfinite(cube.vector_displacement(target, [1], [[0.25, 0.25]])).all()


def test_bilinear():
    """Values are compared with those computed from the four pixels around."""
    rng = np.random.default_rng(2)
    pixels = rng.random((5, 7, 3)).astype(np.float32)
    st = rng.uniform(-0.2, 1.2, (200, 2))
    x = np.clip(st[:, 0] * 7 - 0.5, 0, 6)
    y = np.clip(st[:, 1] * 5 - 0.5, 0, 4)
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    right, above = np.minimum(i + 1, 6), np.minimum(j + 1, 4)
    a, b = (x - i)[:, None], (y - j)[:, None]
    values = pixels.astype(float)
    expected = (1 - b) * ((1 - a) * values[j, i] + a * values[j, right]) + b * (
        (1 - a) * values[above, i] + a * values[above, right]
    )
    np.testing.assert_allclose(ls.bilinear(pixels, st), expected, atol=1e-15)
    with pytest.raises(ValueError, match=r"row 1: st \(nan, 0\) is not finite"):
        ls.bilinear(pixels, [[0, 0], [np.nan, 0]])
    with pytest.raises(ValueError, match=r"pixels has shape \(5, 7\)"):
        ls.bilinear(pixels[..., 0], st)


@pytest.mark.parametrize(("faces", "resolution"), [(1, 1), (5, 4), (24, 8), (7, 16)])
def test_tiles(faces, resolution):
    layout = ls.PtexLayout(faces, resolution)
    texels = layout.texels()
    side = resolution + 1
    assert len(texels) == faces * side**2
    assert layout.columns == int(np.ceil(np.sqrt(faces)))
    assert (layout.width, layout.height) == (
        layout.columns * side,
        -(-faces // layout.columns) * side,
    )
    assert len(np.unique(texels.y * layout.width + texels.x)) == len(texels)
    assert texels.x.max() < layout.width
    assert texels.y.max() < layout.height
    column, row = texels.face % layout.columns, texels.face // layout.columns
    inside = np.stack([texels.x - side * column, texels.y - side * row], axis=1)
    np.testing.assert_array_equal(inside / resolution, texels.uv)
    # A texel is read at its centre.
    at = layout.map_coordinates(texels.face, texels.uv) * [layout.width, layout.height]
    np.testing.assert_allclose(at, np.stack([texels.x, texels.y], axis=1) + 0.5, atol=1e-9)


def test_tiles_are_read_without_their_neighbours(anywhere):
    """What is bilinear on every face comes back, though all else is poisoned."""
    layout = ls.PtexLayout(6, 4)
    texels = layout.texels()
    rng = np.random.default_rng(8)
    corners = rng.random((6, 2, 2))

    def value(face, uv):
        u, v = uv.T
        c = corners[face]
        low = (1 - u) * c[:, 0, 0] + u * c[:, 0, 1]
        return (1 - v) * low + v * ((1 - u) * c[:, 1, 0] + u * c[:, 1, 1])

    pixels = np.full((layout.height, layout.width, 1), 1e6, np.float32)
    pixels[texels.y, texels.x, 0] = value(texels.face, texels.uv)
    face, uv = rng.integers(0, 6, 500), rng.random((500, 2))
    uv[:100] = np.round(uv[:100])
    found = ls.bilinear(pixels, layout.map_coordinates(face, uv))[:, 0]
    np.testing.assert_allclose(found, value(face, uv), atol=1e-6)


def test_layouts_without_meaning():
    assert ls.PtexLayout(1_000_000, 64).width == 65_000
    for faces, resolution, message in (
        (0, 4, "face_count is 0"),
        (5, 3, "resolution is 3; expected a power of two"),
        (5, 8192, "resolution is 8192"),
        (1_100_000, 64, "1100000 faces at a resolution of 64 need an image 68185 pixels wide"),
    ):
        with pytest.raises(ValueError, match=message):
            ls.PtexLayout(faces, resolution)


def map_error(base, target, size, face, uv):
    """The error of the points that a map of size x size texels, in tangent space, leads to."""
    uv_map = sheet_map(base)
    texels = uv_map.rasterize(size, size, margin=3)
    frames = base.tangent_frames(uv_map, texels.face, texels.uv)
    pixels = np.zeros((size, size, 3), np.float32)
    pixels[texels.y, texels.x] = base.vector_displacement(
        target, texels.face, texels.uv, frames=frames
    )
    values = ls.bilinear(pixels, uv_map.evaluate(face, uv).value)
    frames = base.tangent_frames(uv_map, face, uv)
    there = base.displaced(face, uv, values, frames=frames)
    at = ls.SubdividedFaces(base.mesh, target.mesh).locate(face, uv)
    truth = target.evaluate(at.face, at.uv).position
    return np.linalg.norm(there - truth, axis=1) / diagonal(base)


def test_maps_give_the_target_back(anywhere):
    """With twice as many texels along a side the error is a quarter."""
    positions, faces = bent_grid()
    base = surface_of(positions, faces)
    fine, fine_faces = catmull_clark.subdivided(positions, faces, 2)
    target = surface_of(sculpted(fine, 0.1), fine_faces)
    face, uv = anywhere(base, 4000, seed=4)
    errors = [map_error(base, target, size, face, uv) for size in (64, 128, 256, 512)]
    middle = inner_rows(base, face, uv)
    assert 100 < middle.sum() < len(face)
    worst = np.array([error[middle].max() for error in errors])
    rms = np.array([np.sqrt((error[middle] ** 2).mean()) for error in errors])
    orders = np.log2(worst[:-1] / worst[1:]), np.log2(rms[:-1] / rms[1:])
    assert (np.abs(np.array(orders) - 2) < 0.3).all(), orders
    assert worst[-1] < 2e-5
    assert errors[-1].max() < 1e-3  # at the border, where texels end


def inner_rows(base, face, uv):
    """Whether locations are well within the sheet, for any resolution."""
    columns, rows = 4, 3
    i, j = face % columns + uv[:, 0], face // columns + uv[:, 1]
    return (np.abs(i - columns / 2) < columns / 2 - 0.5) & (np.abs(j - rows / 2) < rows / 2 - 0.5)


def shared_sides(base, count=37, halves=False):
    """The sides at which two Ptex faces meet, each as places in the same order. With `halves`, the
    halves of sides that are whole sides of other faces.
    """
    t = np.linspace(0, 1, count)
    parts = [(t, False), (t / 2, True), (t / 2 + 0.5, True)]
    ends = {}
    for face in range(base.face_count):
        for part, is_half in parts if halves else parts[:1]:
            zero, one = np.zeros(count), np.ones(count)
            for u, v in ((part, zero), (one, part), (part[::-1], one), (zero, part[::-1])):
                side = np.stack([u, v], axis=1)
                points = base.evaluate(face, side).position
                middle = tuple(np.round(points[count // 2], 8))
                ends.setdefault(middle, []).append((face, side, points, is_half))
    for meeting in ends.values():
        if len(meeting) == 2:
            (f, side, points, is_half), (g, other, others, other_is_half) = meeting
            turned = np.abs(points - others).max() > 1e-9
            if (is_half != other_is_half) == halves:
                yield (f, side), (g, other[::-1] if turned else other)


def test_tiles_give_the_target_back_without_seams(anywhere):
    """Displacement in object space, on a closed mesh of n-gons without a UV map."""
    positions, faces = shapes.house()
    base = surface_of(positions, faces)
    fine, fine_faces = catmull_clark.subdivided(positions, faces, 2)
    target = surface_of(sculpted(fine, 0.1), fine_faces)
    face, uv = anywhere(base, 3000, seed=6)
    at = ls.SubdividedFaces(base.mesh, target.mesh).locate(face, uv)
    truth = target.evaluate(at.face, at.uv).position
    worst = []
    for resolution in (16, 32, 64):
        layout = ls.PtexLayout(base.face_count, resolution)
        texels = layout.texels()
        pixels = np.zeros((layout.height, layout.width, 3), np.float32)
        pixels[texels.y, texels.x] = base.vector_displacement(target, texels.face, texels.uv)

        def read(face, uv, layout=layout, pixels=pixels):
            return ls.bilinear(pixels, layout.map_coordinates(face, uv))

        there = base.displaced(face, uv, read(face, uv))
        worst.append(np.linalg.norm(there - truth, axis=1).max() / diagonal(base))
        for (f, side), (g, other) in shared_sides(base):
            one, two = read(np.full(len(side), f), side), read(np.full(len(side), g), other)
            assert np.abs(one - two).max() < 1e-6
        beside = list(shared_sides(base, resolution // 2 + 1, halves=True))
        assert len(beside) == 16  # halves of sides of quads beside triangles and pentagons
        for (f, side), (g, other) in beside:  # at the texels of the quad
            one, two = read(np.full(len(side), f), side), read(np.full(len(side), g), other)
            assert np.abs(one - two).max() < 1e-6
    assert worst[0] / worst[1] > 3
    assert worst[1] / worst[2] > 3
