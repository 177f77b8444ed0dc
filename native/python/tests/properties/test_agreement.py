# SPDX-License-Identifier: Apache-2.0
"""What different calls say about the same places agrees, and searches agree with dense samples."""

import limitsurf as ls
import numpy as np
from random_meshes import cages, holds_for, kept_faces, one_of, places, seeds, whole

PLACES, DENSE = 60, 24

INTERPOLATIONS = (
    "none", "corners_only", "corners_plus1", "corners_plus2", "boundaries", "all",
)  # fmt: skip


def applied(stencils, weights, values):
    """The weights times the values, row by row."""
    rows = np.repeat(np.arange(len(stencils.offsets) - 1), np.diff(stencils.offsets))
    out = np.zeros((len(stencils.offsets) - 1, values.shape[1]))
    np.add.at(out, rows, weights[:, None] * values[stencils.indices])
    return out


def dense(surface):
    """Places all over the surface, borders of faces included: face, uv, positions."""
    side = np.linspace(0, 1, DENSE + 1)
    uv = np.stack(np.meshgrid(side, side), -1).reshape(-1, 2)
    faces = kept_faces(surface)
    face, uv = np.repeat(faces, len(uv)), np.tile(uv, (len(faces), 1))
    return face, uv, surface.evaluate(face, uv).position


@holds_for(cage=cages(), seed=seeds)
def test_stencils_are_the_evaluation(cage, seed):
    surface = cage.surface()
    at = places(surface, PLACES, seed)
    stencils, e = surface.stencils(*at, 1), surface.evaluate(*at, 1)
    size = np.abs(cage.positions).max()
    for weights, values, total in (
        (stencils.weights, e.position, 1),
        (stencils.du_weights, e.du, 0),
        (stencils.dv_weights, e.dv, 0),
    ):
        found = applied(stencils, weights, cage.positions)
        finite = np.isfinite(values).all(1)
        assert np.array_equal(finite, np.isfinite(found).all(1))
        reach = size + np.abs(values[finite]).max(initial=0)
        assert np.abs(found - values)[finite].max(initial=0) <= 1e-12 * reach
        sums = applied(stencils, weights, np.ones((len(cage.positions), 1)))[finite, 0]
        assert np.abs(sums - total).max(initial=0) <= 1e-12 * (
            1 + np.abs(values[finite]).max(initial=0) / cage.diagonal()
        )


@holds_for(cage=cages(), seed=seeds)
def test_vertex_data_are_the_stencils(cage, seed):
    surface = cage.surface()
    at = places(surface, PLACES, seed)
    values = np.random.default_rng(seed).normal(size=(len(cage.positions), 4))
    stencils, e = surface.stencils(*at, 1), surface.vertex_data(values).evaluate(*at, 1)
    for weights, found in ((stencils.weights, e.value), (stencils.du_weights, e.du)):
        expected = applied(stencils, weights, values)
        finite = np.isfinite(expected).all(1)
        wrong = np.abs(found - expected)[finite]
        assert wrong.max(initial=0) <= 1e-11 * (1 + np.abs(expected[finite]).max(initial=0))


@holds_for(cage=cages(), seed=seeds)
def test_varying_data_are_bilinear(cage, seed):
    surface = cage.surface()
    face, uv = places(surface, PLACES, seed)
    values = np.random.default_rng(seed).normal(size=(len(cage.positions), 2))
    found = surface.varying(values).evaluate(face, uv).value
    for row, ptex in enumerate(face):
        own = values[cage.faces[surface.base_face[ptex]]]
        if len(own) != 4:
            i = int(surface.corner[ptex])
            own = np.stack(
                [
                    own[i],
                    (own[i] + own[(i + 1) % len(own)]) / 2,
                    own.mean(0),
                    (own[i - 1] + own[i]) / 2,
                ]
            )
        (u, v) = uv[row]
        expected = (1 - v) * ((1 - u) * own[0] + u * own[1]) + v * ((1 - u) * own[3] + u * own[2])
        assert np.abs(found[row] - expected).max() <= 1e-13 * np.abs(values).max()


@holds_for(cage=cages(sharp=False), seed=seeds, interpolation=one_of(INTERPOLATIONS))
def test_face_varying_data_without_seams_are_vertex_data(cage, seed, interpolation):
    """On a closed mesh; at boundaries the two have rules of their own."""
    surface = cage.surface()
    at = places(surface, PLACES, seed)
    values = np.random.default_rng(seed).normal(size=(len(cage.positions), 2))
    indices = [vertex for face in cage.faces for vertex in face]
    data = surface.face_varying(values, indices, interpolation)
    if interpolation == "all":
        expected = surface.varying(values).evaluate(*at).value
    elif len(surface.edge_curves()) == 0 or (
        interpolation == "none" and cage.rules["boundary"] == "smooth"
    ):
        expected = surface.vertex_data(values).evaluate(*at).value
    else:
        return
    assert np.abs(data.evaluate(*at).value - expected).max() <= 1e-12 * np.abs(values).max()


@holds_for(cage=cages(), seed=seeds)
def test_no_sample_is_closer_than_the_closest_point(cage, seed):
    surface = cage.surface()
    rng = np.random.default_rng(seed)
    at = places(surface, 20, seed, inside=True)
    points = np.concatenate(
        [
            surface.evaluate(*at).position + rng.normal(0, 0.05, (20, 3)) * cage.diagonal(),
            cage.positions.mean(0) + rng.normal(size=(20, 3)) * cage.diagonal(),
        ]
    )
    hits = surface.closest(points)
    _, _, samples = dense(surface)
    nearest = np.linalg.norm(points[:, None] - samples, axis=2).min(1)
    assert (hits.distance <= nearest + 1e-12 * cage.diagonal()).all()
    here = surface.evaluate(hits.face, hits.uv).position
    np.testing.assert_allclose(here, hits.position, rtol=0, atol=1e-12 * cage.diagonal())
    np.testing.assert_allclose(
        np.linalg.norm(here - points, axis=1),
        hits.distance,
        rtol=1e-12,
        atol=1e-12 * cage.diagonal(),
    )


def crossings(origin, direction, samples):
    """The distances at which a ray crosses the triangles between dense samples, but for grazing."""
    grid = samples.reshape(-1, DENSE + 1, DENSE + 1, 3)
    a, b, c, d = grid[:, :-1, :-1], grid[:, :-1, 1:], grid[:, 1:, 1:], grid[:, 1:, :-1]
    corners = np.concatenate([np.stack(t, -2).reshape(-1, 3, 3) for t in ((a, b, c), (a, c, d))])
    edge1, edge2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    across = np.cross(direction, edge2)
    determinant = (edge1 * across).sum(1)
    with np.errstate(all="ignore"):
        from_corner = origin - corners[:, 0]
        s = (from_corner * across).sum(1) / determinant
        turned = np.cross(from_corner, edge1)
        t = turned @ direction / determinant
        distance = (edge2 * turned).sum(1) / determinant
    grazing = np.abs(determinant) < 0.2 * np.linalg.norm(np.cross(edge1, edge2), axis=1)
    inside = (s >= 0) & (t >= 0) & (s + t <= 1)
    return distance[inside & ~grazing]


@holds_for(cage=cages(), seed=seeds)
def test_rays_hit_what_dense_triangles_say(cage, seed):
    surface = cage.surface()
    rng = np.random.default_rng(seed)
    at = places(surface, 12, seed, inside=True)
    towards = surface.evaluate(*at).position
    origins = cage.positions.mean(0) + 2 * cage.diagonal() * rng.normal(size=(12, 3))
    directions = towards - origins
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    hits, every = surface.ray_cast(origins, directions), surface.ray_cast_all(origins, directions)
    reach = np.linalg.norm(towards - origins, axis=1)
    assert (hits.face >= 0).all(), "a ray to a point of the surface hits it"
    assert (hits.distance <= reach + 1e-9 * cage.diagonal()).all()
    here = surface.evaluate(hits.face, hits.uv).position
    off = here - origins - hits.distance[:, None] * directions
    assert np.abs(off).max() <= 1e-10 * (cage.diagonal() + reach.max())
    _, _, samples = dense(surface)
    step = 0.05 * cage.diagonal()
    for row in range(12):
        own = every.distance[every.offsets[row] : every.offsets[row + 1]]
        assert np.isclose(own[0], hits.distance[row], rtol=0, atol=1e-9 * cage.diagonal())
        assert (np.diff(own) >= 0).all()
        expected = crossings(origins[row], directions[row], samples)
        for distance in expected[expected > 0]:
            assert np.abs(own - distance).min() <= step, "a triangle is hit where nothing else is"


@holds_for(cage=cages(), seed=seeds, level=whole(1, 5))
def test_polygons_have_the_positions_of_their_locations(cage, seed, level):
    surface = cage.surface()
    rng = np.random.default_rng(seed)
    made = surface.tessellate(rng.integers(1, level + 1, len(cage.faces)))
    if not len(made.positions):
        return
    at = made.locations
    here = surface.evaluate(at.face, at.uv).position
    assert np.abs(here - made.positions).max() <= 1e-13 * cage.diagonal()
    assert made.face_sizes.sum() == len(made.face_vertices)


@holds_for(cage=cages(), seed=seeds, edges=one_of(["boundary", "creases"]))
def test_curves_of_edges_lie_on_the_surface(cage, seed, edges):
    surface = cage.surface()
    curves = surface.edge_curves(edges)
    if not len(curves):
        return
    along = surface.scatter_along(curves, count=30, jitter=0.5, seed=seed % 1000)
    assert (along.arc >= 0).all()
    assert (along.arc <= curves.lengths[along.curve] * (1 + 1e-12)).all()
    position = surface.evaluate(along.face, along.uv).position
    border = np.minimum(along.uv, 1 - along.uv).min(1)
    assert (border <= 1e-12).all(), "a location of a curve is on a side of its face"
    # What the two sides of an inner edge say is the same place.
    if edges == "creases":
        other = curves.at(along.curve, along.arc, "right")
        there = surface.evaluate(other.face, other.uv).position
        assert np.abs(there - position).max() <= 1e-9 * cage.diagonal()
    # An arc is at least as long as its chord.
    for curve in range(len(curves)):
        own = np.flatnonzero(along.curve == curve)
        own = own[np.argsort(along.arc[own])]
        chords = np.linalg.norm(np.diff(position[own], axis=0), axis=1)
        assert (chords <= np.diff(along.arc[own]) + 1e-9 * cage.diagonal()).all()


@holds_for(cage=cages(), seed=seeds)
def test_maps_are_inverted(cage, seed):
    surface = cage.surface()
    rng = np.random.default_rng(seed)
    values = cage.positions[:, :2] + 0.1 * rng.normal(size=(len(cage.positions), 2))
    data = surface.vertex_data(values)
    at = places(surface, PLACES, seed, inside=True)
    points = data.evaluate(*at).value
    found = data.locate(points)
    # Faces whose image has no area cover nothing.
    covered = found.face >= 0
    assert covered.mean() > 0.9
    again = data.evaluate(found.face[covered], found.uv[covered]).value
    extent = np.linalg.norm(np.abs(values).max(0)) * 2
    assert np.abs(again - points[covered]).max() <= 1e-12 * extent
    assert (found.face[covered] <= at[0][covered]).all()


@holds_for(cage=cages(), seed=seeds)
def test_tiles_are_the_evaluation(cage, seed):
    surface = cage.surface()
    face, uv = places(surface, PLACES, seed, inside=True)
    tiles = surface.tiles(face, uv)
    own = ls.Stencils(tiles.points_offsets, tiles.points_indices, tiles.points_weights, None, None)
    points = np.concatenate([cage.positions, applied(own, tiles.points_weights, cage.positions)])
    s = tiles.tile_uv
    cubic = np.array([[1, -3, 3, -1], [4, 0, -6, 3], [1, 3, 3, -3], [0, 0, 0, 1]]) / 6
    bu, bv = (np.stack([x**0, x, x**2, x**3], 1) @ cubic.T for x in (s[:, 0], s[:, 1]))
    weights = (bv[:, :, None] * bu[:, None, :]).reshape(-1, 16)
    nets = points[tiles.tile_points[tiles.tile]] - points[tiles.tile_base[tiles.tile]][:, None]
    found = points[tiles.tile_anchor[tiles.tile]] + (weights[:, :, None] * nets).sum(1)
    expected = surface.evaluate(face, uv).position
    assert np.abs(found - expected)[~tiles.moved].max(initial=0) <= 1e-12 * np.abs(points).max()
