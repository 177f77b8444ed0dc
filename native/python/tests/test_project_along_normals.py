# SPDX-License-Identifier: Apache-2.0
"""Images of another surface along this one's normals; eyes inside surfaces."""

import limitsurf as ls
import numpy as np
import projectors
import pytest
import shapes

TEXEL = (1 / 512, 1 / 256)


@pytest.fixture
def sheet():
    return projectors.sheet(height=0.1)


@pytest.fixture
def curtain():
    """Above the sheet, and curved otherwise."""
    surface, uv_map = projectors.sheet(3, 4, height=-0.15, seed=2)
    surface.set_positions(0.9 * surface.positions + [0.1, 0, 0.5])
    return surface, uv_map


def met(surface, source, source_map, face, uv, sign=1):
    """st by numpy's rays: NaN where missed, and the distances."""
    here = surface.evaluate(face, uv, 1)
    hits = source.ray_cast(here.position, sign * here.normal)
    st = np.full((len(hits), 2), np.nan)
    found = hits.face >= 0
    st[found] = source_map.evaluate(hits.face[found], hits.uv[found]).value
    return st, hits.distance


def test_places_are_where_rays_end(sheet, curtain, anywhere):
    surface, uv_map = sheet
    face, uv = anywhere(surface, 1000)
    st, distance = met(surface, *curtain, face, uv)
    assert 0.5 < np.isfinite(distance).mean() < 1
    outward = surface.project_along_normals(uv_map, face, uv, *curtain, TEXEL, direction="outward")
    np.testing.assert_array_equal(outward.st, st)
    np.testing.assert_array_equal(outward.weight, np.isfinite(distance))
    assert not outward.footprint[np.isnan(distance)].any()

    inward = surface.project_along_normals(uv_map, face, uv, *curtain, TEXEL, direction="inward")
    assert not inward.weight.any()
    both = surface.project_along_normals(uv_map, face, uv, *curtain, TEXEL)
    np.testing.assert_array_equal(both.st, st)

    limit = np.nanmedian(distance) + 1e-9
    near = surface.project_along_normals(uv_map, face, uv, *curtain, TEXEL, max_distance=limit)
    np.testing.assert_array_equal(near.weight, distance <= limit)


def test_the_nearer_way_wins(sheet, curtain, anywhere):
    surface, uv_map = sheet
    source, source_map = curtain
    source.set_positions(source.positions - [0, 0, 0.5])  # through the sheet
    face, uv = anywhere(surface, 1000)
    ways = [met(surface, source, source_map, face, uv, sign) for sign in (1, -1)]
    distances = np.array([np.nan_to_num(distance, nan=np.inf) for _, distance in ways])
    expected = np.where((distances[0] <= distances[1])[:, None], ways[0][0], ways[1][0])
    both = surface.project_along_normals(uv_map, face, uv, source, source_map, TEXEL)
    np.testing.assert_array_equal(both.st, expected)
    assert 0.2 < np.mean(distances[0] < distances[1]) < 0.8


@pytest.mark.parametrize("direction", ["outward", "inward"])
def test_footprints_are_differences_of_places(sheet, curtain, anywhere, direction):
    surface, uv_map = sheet
    source, source_map = curtain
    sign = 1 if direction == "outward" else -1
    source.set_positions(source.positions * [1, 1, sign])
    face, uv = anywhere(surface, 400)
    uv = 0.01 + 0.98 * uv
    seen = surface.project_along_normals(
        uv_map, face, uv, source, source_map, TEXEL, direction=direction
    )
    step = 1e-6
    by_image, by_map = np.empty((400, 2, 2)), np.empty((400, 2, 2))
    for axis in range(2):
        ends = [uv + way * step * np.eye(2)[axis] for way in (1, -1)]
        images = [met(surface, source, source_map, face, end, sign)[0] for end in ends]
        places = [uv_map.evaluate(face, end).value for end in ends]
        by_image[:, :, axis] = (images[0] - images[1]) / (2 * step)
        by_map[:, :, axis] = (places[0] - places[1]) / (2 * step)
    expected = by_image @ np.linalg.inv(by_map) @ np.diag(TEXEL)
    found = np.isfinite(expected).all(axis=(1, 2)) & (seen.weight > 0)
    assert found.sum() > 200
    # Differences across an edge of the source see its second derivatives' jump.
    error = np.linalg.norm(seen.footprint - expected, axis=(1, 2))[found]
    assert np.quantile(error, 0.98) < 1e-5 * np.abs(expected[found]).max()
    assert np.all(error < 1e-3 * np.abs(expected[found]).max())


def test_spaces_of_both_objects(sheet, curtain, anywhere):
    surface, uv_map = sheet
    source, source_map = curtain
    face, uv = anywhere(surface, 500)
    world = np.array([[2, 0.4, 0, 1], [0, 0.7, 0.1, 2], [0.2, 0, 1.5, -3], [0, 0, 0, 1]])
    source_world = np.array([[0.3, 0, 0.1, 0], [0, -2, 0, 5], [0, 0.5, 1, 0], [0, 0, 0, 1]])

    def moved(surface, matrix):
        return surface.positions @ matrix[:3, :3].T + matrix[:3, 3]

    # Both as the world sees them, and each in a space of its own.
    mesh, other = surface.mesh, source.mesh
    in_world = ls.LimitSurface(mesh)
    in_world.set_positions(moved(surface, world))
    source_in_world = ls.LimitSurface(other)
    source_in_world.set_positions(moved(source, world))
    own = ls.LimitSurface(other)
    own.set_positions(moved(source_in_world, np.linalg.inv(source_world)))

    limit = 0.9
    expected = in_world.project_along_normals(
        uv_map, face, uv, source_in_world, source_map, TEXEL, max_distance=limit
    )
    seen = surface.project_along_normals(
        uv_map,
        face,
        uv,
        own,
        source_map,
        TEXEL,
        transform=np.linalg.inv(source_world) @ world,
        world=world,
        max_distance=limit,
    )
    assert 0.1 < expected.weight.mean() < 0.9
    np.testing.assert_array_equal(seen.weight, expected.weight)
    np.testing.assert_allclose(seen.st, expected.st, atol=1e-11)
    np.testing.assert_allclose(seen.footprint, expected.footprint, atol=1e-11)


def test_a_surface_meets_itself_where_rays_begin(sheet, anywhere):
    surface, uv_map = sheet
    face, uv = anywhere(surface, 500)
    seen = surface.project_along_normals(uv_map, face, uv, surface, uv_map, TEXEL)
    np.testing.assert_allclose(seen.st, uv_map.evaluate(face, uv).value, atol=1e-10)
    np.testing.assert_allclose(
        seen.footprint, np.broadcast_to(np.diag(TEXEL), (500, 2, 2)), atol=1e-10
    )


@pytest.mark.parametrize(
    ("message", "options"),
    [
        ("max_distance is nan", {"max_distance": np.nan}),
        ("max_distance is -1", {"max_distance": -1}),
        ("direction is 'up'", {"direction": "up"}),
        ("transform has shape", {"transform": np.eye(3)}),
        ("transform is singular", {"transform": np.diag([1, 1, 0, 1])}),
        ("world has nan", {"world": np.full((4, 4), np.nan)}),
    ],
)
def test_options_without_meaning(sheet, message, options):
    surface, uv_map = sheet
    with pytest.raises(ValueError, match=message):
        surface.project_along_normals(uv_map, [0], [[0, 0]], surface, uv_map, TEXEL, **options)


def camera_at(eye, projection=None):
    toward = np.asarray(eye) + [0.3, 0.5, 0.2]
    projection = projectors.perspective() if projection is None else projection
    return projection @ projectors.looking(eye, toward)


def test_eyes_inside_closed_surfaces():
    cube = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.cube()))
    rng = np.random.default_rng(3)
    eyes = rng.uniform(-0.2, 1.2, (100, 3))
    # The limit of a cube is convex and its closest point tells the side.
    hits = cube.closest(eyes)
    inside = np.sum((eyes - hits.position) * hits.normal, axis=1) < 0
    assert 0.1 < inside.mean() < 0.9
    answers = [cube.eye_is_inside(camera_at(eye)) for eye in eyes]
    np.testing.assert_array_equal(answers, inside)
    middle = (0.5, 0.5, 0.5)
    assert not cube.eye_is_inside(camera_at(middle, projectors.orthographic()))

    positions, faces = shapes.cube()
    room = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces[:, ::-1]))
    assert not room.eye_is_inside(camera_at(middle))


def test_eyes_in_open_surfaces():
    positions, faces = shapes.cube()
    bowl = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces[1:]))
    assert not bowl.eye_is_inside(camera_at((0.5, 0.5, 0.5)))
    sheet, _ = projectors.sheet()
    assert not sheet.eye_is_inside(camera_at((0.5, 0.5, 2)))
    with pytest.raises(ValueError, match="singular"):
        sheet.eye_is_inside(np.zeros((4, 4)))
