# SPDX-License-Identifier: Apache-2.0
"""Results do not depend on the unit of length. When a mesh and all lengths of a call are multiplied
by a power of two, lengths in the result are multiplied by it as well, areas by its square, and so
on, and nothing else changes: not one bit.
"""

import functools

import limitsurf as ls
import numpy as np
import pytest
import shapes

EXPONENTS = (-399, -333, -100, 20, 100, 333, 397)
LIMIT = 400  # coordinates reach 2^LIMIT, and the extent 2^-LIMIT, at most
PLACES = 40
SEED = 5


@functools.cache
def surface(shape: str, exponent: int) -> ls.LimitSurface:
    positions, faces = shapes.ALL[shape]
    # Something of everything: no symmetry, and no plane.
    bent = positions + 0.1 * np.random.default_rng(SEED).normal(size=positions.shape)
    return ls.LimitSurface(ls.ControlMesh.from_faces(np.ldexp(bent, exponent), faces))


@functools.cache
def uv_map(shape: str) -> ls.SurfaceData:
    whole = surface(shape, 0)
    return whole.vertex_data(whole.mesh.positions[:, :2] + 0.25 * whole.mesh.positions[:, 2:])


def places(whole: ls.LimitSurface, count: int = PLACES):
    """On all faces; corners and places beside corners are among them."""
    rng = np.random.default_rng(SEED)
    face = np.resize(np.arange(len(whole.base_face)), count)
    uv = rng.random((count, 2))
    uv[::7] = np.round(uv[::7])
    uv[1::7] *= 2.0 ** -rng.integers(8, 40, (len(uv[1::7]), 1))
    return face, uv


def points_around(whole: ls.LimitSurface, unit: float):
    rng = np.random.default_rng(SEED)
    return unit * rng.uniform(-2, 4, (PLACES, 3)), rng.normal(size=(PLACES, 3))


def path(whole: ls.LimitSurface):
    """Neighbouring places across one face."""
    t = np.linspace(0.1, 0.9, 12)
    return np.zeros(12, int), np.stack([t, 0.5 + 0.3 * np.sin(6 * t)], axis=1)


# Each function calls a part of the interface on a surface whose unit of length is `unit`, and
# returns what it got: pairs of a power of the length, and numbers.


def evaluation(whole, unit, shape):
    e = whole.evaluate(*places(whole), 2)
    return [
        *((1, values) for values in (e.position, e.du, e.dv, e.duu, e.duv, e.dvv)),
        (0, e.normal),
    ]


def frames(whole, unit, shape):
    face, uv = places(whole)
    return [(0, whole.frames(face, uv)), (0, whole.tangent_frames(uv_map(shape), face, uv))]


def map_distortion(whole, unit, shape):
    d = whole.map_distortion(uv_map(shape), *places(whole))
    return [(2, d.area), (1, d.stretch_high), (1, d.stretch_low)]


def curvature(whole, unit, shape):
    c = whole.curvature(*places(whole), irregular="average")
    return [(-2, c.gaussian), (-1, c.mean), (-1, c.k1), (-1, c.k2), (0, c.direction1)]


def hits(found):
    return [(0, found.face), (0, found.uv), (1, found.distance), (1, found.position)]


def closest(whole, unit, shape):
    points, _ = points_around(whole, unit)
    return hits(whole.closest(points)) + hits(whole.closest(points, 1.5 * unit))


def closest_facing(whole, unit, shape):
    points, directions = points_around(whole, unit)
    return hits(whole.closest(points, facing=directions, max_angle=1.0))


def rays(whole, unit, shape):
    points, directions = points_around(whole, unit)
    towards = whole.evaluate(*places(whole)).position - points
    every = whole.ray_cast_all(points, towards)
    return [
        *hits(whole.ray_cast(points, towards)),
        *hits(whole.ray_cast(points, directions, 3 * unit)),
        *hits(every),
        (0, every.offsets),
    ]


def edges(whole, unit, shape):
    which = [[0, 1], [1, 2]] if shape == "grid" else "boundary"
    curves = whole.edge_curves(which)
    if not len(curves):
        return [(1, curves.lengths)]
    by_count = whole.scatter_along(curves, count=20, jitter=0.5, seed=3)
    by_spacing = whole.scatter_along(
        curves, spacing=0.3 * unit, rows=2, row_distance=0.1 * unit, seed=3
    )
    found = [(1, curves.lengths), (1, curves.edge_lengths)]
    for along in (by_count, by_spacing):
        found += [(0, along.face), (0, along.uv), (1, along.arc), (0, along.outward)]
    return found


def curve_directions(whole, unit, shape):
    face, uv = places(whole)
    position = whole.evaluate(*path(whole)).position
    return [(0, whole.curve_directions(position, [0, len(position)], face, uv))]


def paths(whole, unit, shape):
    face, uv = path(whole)
    points = whole.evaluate(face, uv).position
    laid = whole.lay_path(points, tolerance=1e-3 * unit)
    fit = whole.fit_path(face, uv, tolerance=1e-2 * unit)
    smooth = whole.smooth_path(face, uv, np.ones(len(face)))
    even = whole.even_path(face, uv, 9)
    return [
        *((0, laid.face), (0, laid.uv), (1, laid.position), (1, laid.deviation)),
        *((0, fit.rows), (1, fit.handle_left), (1, fit.deviation), (1, fit.error)),
        *((0, smooth.uv), (0, even.uv)),
    ]


def random_places(whole, unit, shape):
    found = [whole.scatter_uniform(50, seed=3), whole.scatter_jittered(2, seed=3)]
    return [pair for at in found for pair in ((0, at.face), (0, at.uv))]


def blue_noise(whole, unit, shape):
    by_count = whole.scatter_blue_noise(count=40, seed=3)
    by_radius = whole.scatter_blue_noise(radius=0.3 * unit, seed=3)
    return [
        *((0, by_count.face), (0, by_count.uv), (1, by_count.radius)),
        *((0, by_radius.face), (0, by_radius.uv)),
    ]


def guides(whole, unit, shape):
    face, uv = places(whole)
    found = whole.guide_weights(face[1:5], uv[1:5], face, uv, 3)
    cut = whole.mesh.positions[[0, -1]]
    parted = whole.guide_weights(face[1:5], uv[1:5], face, uv, 3, cut_points=cut)
    return [
        *((0, found.guide), (0, found.weight), (1, found.distance)),
        *((0, parted.guide), (0, parted.weight), (1, parted.distance)),
    ]


def polygons(whole, unit, shape):
    within = whole.levels_within(0.01 * unit)
    of_length = whole.levels_of_length(0.2 * unit)
    made = whole.tessellate(of_length.levels)
    return [
        *((0, within.levels), (1, within.measure), (0, of_length.levels), (1, of_length.measure)),
        *((1, made.positions), (0, made.normals), (0, made.faces)),
    ]


def whole_surface(whole, unit, shape):
    area, error = whole.area(error=True)
    return [(2, area), (2, error), (1, whole.bounds())]


def displacement(whole, unit, shape):
    face, uv = places(whole)
    values = np.random.default_rng(SEED).normal(size=(len(face), 3))
    moved = whole.displaced(face, uv, 0.1 * unit * values)
    other = ls.LimitSurface(whole.mesh)
    other.set_positions(whole.mesh.positions + 0.05 * unit)
    return [
        (1, moved),
        (1, whole.vector_displacement(other, face, uv)),
        (1, whole.scalar_displacement(other, face, uv)),
    ]


def projections(whole, unit, shape):
    face, uv = places(whole)
    texel, uvs = (1 / 64, 1 / 32), uv_map(shape)
    to_unit = np.diag([1 / unit, 1 / unit, 1 / unit, 1.0])
    eye = np.array([[1.2, 0.1, 0.3, 0], [-0.2, 1.1, 0.4, 0], [0.1, 0.3, -0.9, 3], [0, 0.1, -1, 6]])
    from_eye = whole.project(uvs, face, uv, eye @ to_unit, texel, samples=4)
    parallel = np.diag([0.2, 0.3, 0.1, 1.0]) @ to_unit
    from_far = whole.project(uvs, face, uv, parallel, texel, two_sided=True)
    source = ls.LimitSurface(whole.mesh)
    source.set_positions(whole.mesh.positions + [0.02 * unit, 0.01 * unit, -0.03 * unit])
    from_other = whole.project_along_normals(
        uvs, face, uv, source, uvs, texel, max_distance=0.5 * unit
    )
    return [
        (0, values)
        for found in (from_eye, from_far, from_other)
        for values in (found.st, found.footprint, found.weight)
    ]


def weights(whole, unit, shape):
    face, uv = places(whole)
    inside = np.clip(uv, 0.01, 0.99)
    tiles = whole.tiles(face, inside)
    stencils = whole.stencils(face, inside, 1)
    return [(0, tiles.points_weights), (0, stencils.weights), (0, stencils.du_weights)]


def strands(whole, unit, shape):
    face, uv = places(whole)
    # Strands keep single precision.
    if not 2.0**-90 < unit < 2.0**90:
        return []
    roots = whole.evaluate(face, uv).position
    turns = ls.quaternions(whole.frames(face, uv))
    poser = whole.strand_poser(face, uv, roots, turns)
    moved = whole.mesh.positions @ np.diag([1.0, 2.0, 0.5])
    whole.set_positions(moved)
    posed = poser.pose(roots.astype(np.float32))
    whole.set_positions(whole.mesh.positions)
    return [(1, posed)]


CALLS = (
    evaluation, frames, map_distortion, curvature, closest, closest_facing, rays, edges,
    curve_directions, paths, random_places, blue_noise, guides, polygons, whole_surface,
    displacement, projections, weights, strands,
)  # fmt: skip


@functools.cache
def at_unit_scale(call, shape):
    return call(surface(shape, 0), 1.0, shape)


@pytest.mark.parametrize("exponent", EXPONENTS)
@pytest.mark.parametrize("call", CALLS, ids=lambda call: call.__name__)
@pytest.mark.parametrize("shape", shapes.ALL)
def test_results_do_not_depend_on_the_unit(shape, call, exponent):
    expected = at_unit_scale(call, shape)
    found = call(surface(shape, exponent), 2.0**exponent, shape)
    for i, ((power, want), (_, got)) in enumerate(zip(expected, found, strict=False)):
        got = np.ldexp(np.asarray(got, float), -power * exponent) if power else np.asarray(got)
        np.testing.assert_array_equal(got, want, err_msg=f"result {i}")


@pytest.mark.parametrize("call", CALLS, ids=lambda call: call.__name__)
def test_the_results_are_not_empty(call):
    results = [np.asarray(values, float) for _, values in at_unit_scale(call, "house")]
    assert any(np.isfinite(values).any() for values in results)


@pytest.mark.parametrize(
    ("scale", "reason"),
    [(2.0**401, "coordinates may be at most 2.58"), (2.0**-410, "it must measure at least 3.87")],
)
def test_a_mesh_beyond_the_limits_is_refused(scale, reason):
    positions, faces = shapes.cube()
    with pytest.raises(ls.MeshError, match=reason):
        ls.ControlMesh.from_faces(scale * positions, faces)
    whole = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    with pytest.raises(ls.MeshError, match=reason):
        whole.set_positions(scale * positions)
    assert whole.area() == ls.LimitSurface(whole.mesh).area()


def test_a_mesh_without_extent_is_accepted():
    positions, faces = shapes.cube()
    whole = ls.LimitSurface(ls.ControlMesh.from_faces(0 * positions + 2.0**LIMIT, faces))
    assert (whole.evaluate([0], [[0.5, 0.5]]).position == 2.0**LIMIT).all()
