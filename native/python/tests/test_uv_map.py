# SPDX-License-Identifier: Apache-2.0
"""Inverted UV maps: the locations of texels and of points."""

import beside
import ctrl_c
import limitsurf as ls
import numpy as np
import pytest
import shapes

INTERPOLATIONS = ["none", "corners_only", "corners_plus1", "corners_plus2", "boundaries", "all"]
FIELDS = ["x", "y", "face", "uv", "inside", "overlap", "flipped"]


def map_of(positions, faces, interpolation="none"):
    """The surface projected from above, within [0.1, 0.9]^2; the map outlives the surface."""
    mesh = ls.ControlMesh.from_faces(positions, faces)
    values = positions[:, :2] + 0.2 * positions[:, 2:]
    low, high = values.min(axis=0), values.max(axis=0)
    values = 0.1 + 0.8 * (values - low) / (high - low)
    return ls.LimitSurface(mesh).face_varying(values, mesh.face_vertices, interpolation)


@pytest.fixture(params=INTERPOLATIONS)
def uv_map(request):
    positions, faces = shapes.grid(5, 4)
    positions += np.random.default_rng(1).uniform(-0.2, 0.2, positions.shape)
    return map_of(positions, faces, request.param)


def centres(texels, width, height, tile=(0, 0)):
    return tile + np.stack([(texels.x + 0.5) / width, (texels.y + 0.5) / height], axis=1)


def same(a, b):
    return all(getattr(a, name).tobytes() == getattr(b, name).tobytes() for name in FIELDS)


def test_locations_lie_under_the_texels(uv_map):
    texels = uv_map.rasterize(160, 120)
    assert 6_000 < len(texels) < 160 * 120
    assert texels.inside.all()
    assert not texels.overlap.any()
    assert not texels.flipped.any()
    at = uv_map.evaluate(texels.face, texels.uv).value
    assert np.max(np.abs(at - centres(texels, 160, 120))) <= 1e-12
    pixel = texels.y.astype(int) * 160 + texels.x
    assert np.all(np.diff(pixel) > 0)


def test_types_and_shapes(uv_map):
    texels = uv_map.rasterize(20, 10)
    count = len(texels)
    for name in ("x", "y", "face"):
        assert getattr(texels, name).dtype == np.int32
        assert getattr(texels, name).shape == (count,)
    assert texels.uv.dtype == np.float64
    assert texels.uv.shape == (count, 2)
    for name in ("inside", "overlap", "flipped"):
        assert getattr(texels, name).dtype == bool
        assert getattr(texels, name).shape == (count,)
    assert texels.x.min() >= 0
    assert texels.x.max() < 20
    assert texels.y.min() >= 0
    assert texels.y.max() < 10


def test_a_texel_is_what_locate_finds(uv_map):
    texels = uv_map.rasterize(64, 48)
    found = uv_map.locate(centres(texels, 64, 48))
    assert np.array_equal(found.face, texels.face)
    np.testing.assert_allclose(found.uv, texels.uv, atol=1e-9)
    all_x, all_y = np.meshgrid(np.arange(64), np.arange(48))
    everywhere = np.stack([(all_x.ravel() + 0.5) / 64, (all_y.ravel() + 0.5) / 48], axis=1)
    everything = uv_map.locate(everywhere)
    assert np.count_nonzero(everything.face >= 0) == len(texels)
    assert np.all(np.isnan(everything.uv[everything.face < 0]))


def test_locate_is_the_inverse_of_evaluate(uv_map):
    rng = np.random.default_rng(2)
    face, uv = rng.integers(0, 20, 3000), rng.random((3000, 2))
    found = uv_map.locate(uv_map.evaluate(face, uv).value)
    assert np.array_equal(found.face, face)
    np.testing.assert_allclose(found.uv, uv, atol=1e-9)


def test_irregular_vertices_and_polygons():
    for name in sorted(shapes.ALL):
        uv_map = map_of(*shapes.ALL[name])
        texels = uv_map.rasterize(90, 90)
        at = uv_map.evaluate(texels.face, texels.uv).value
        assert np.max(np.abs(at - centres(texels, 90, 90))) <= 1e-12, name


@pytest.mark.parametrize(
    ("faces", "is_closed", "interpolation"),
    [(1, False, "none"), (3, False, "none"), (8, True, "none")],
)
def test_vertices_of_maps_that_neither_fold_nor_flip(faces, is_closed, interpolation):
    """At the vertex itself the directions of its edges become parallel, or nearly so."""
    positions, corners = shapes.fan(faces, is_closed, 0)
    mesh = ls.ControlMesh.from_faces(positions, corners)
    surface = ls.LimitSurface(mesh)
    uv_map = surface.face_varying(positions[:, :2], mesh.face_vertices, interpolation)
    at = surface.vertex_locations()
    beside = uv_map.locate(uv_map.evaluate(np.arange(faces), np.full((faces, 2), 2.0**-9)).value)
    assert not beside.flipped.any()
    found = uv_map.locate(uv_map.evaluate(at.face, at.uv).value)
    assert (found.face >= 0).all()
    assert not found.overlap.any()
    assert not found.flipped.any()


@pytest.mark.parametrize("exponent", [100, -200, -540, -900])
def test_points_of_maps_of_any_size(exponent):
    positions, faces = shapes.pole(5)
    mesh = ls.ControlMesh.from_faces(positions, faces)
    plane = positions[:, :2] + 0.2 * positions[:, 2:]
    points = plane.mean(0) + 0.3 * np.random.default_rng(2).normal(size=(300, 2))
    maps = [ls.LimitSurface(mesh).vertex_data(s * plane) for s in (1, 2.0**exponent)]
    found, scaled = maps[0].locate(points), maps[1].locate(2.0**exponent * points)
    assert (found.face >= 0).sum() > 20
    for name in ("face", "uv", "overlap", "flipped"):
        np.testing.assert_array_equal(getattr(scaled, name), getattr(found, name))


def test_stacked_and_mirrored_islands():
    positions, faces = shapes.grid(2, 2)
    mesh = ls.ControlMesh.from_faces(positions, faces)
    corners = positions[np.ravel(faces), :2] / 2
    corners[8:12] = corners[:4, ::-1]  # the third face on the first, mirrored
    surface = ls.LimitSurface(mesh)
    uv_map = surface.face_varying(corners, np.arange(16), "all")
    texels = uv_map.rasterize(40, 40)
    assert len(texels) == 1200
    first = (texels.x < 20) & (texels.y < 20)
    assert np.array_equal(texels.overlap, first)
    assert np.all(texels.face[first] == 0)
    assert not texels.flipped.any()
    corners[:4] = corners[:4, ::-1]
    uv_map.set_values(corners)
    again = uv_map.rasterize(40, 40)
    assert np.array_equal(again.overlap, first)
    assert np.array_equal(again.flipped, first)


def test_set_values_is_heard(uv_map):
    before = uv_map.rasterize(32, 32)
    values = np.zeros(uv_map.shape)
    uv_map.set_values(values + 5)
    assert len(uv_map.rasterize(32, 32)) == 0
    assert uv_map.locate([[0.5, 0.5]]).face[0] == -1
    assert len(before) > 0


def test_tiles(uv_map):
    whole = uv_map.rasterize(100, 100)
    values = np.random.default_rng(0).random(uv_map.shape)
    uv_map.set_values(values + [3, -2])
    assert len(uv_map.rasterize(100, 100)) == 0
    texels = uv_map.rasterize(100, 100, tile=(3, -2))
    at = uv_map.evaluate(texels.face, texels.uv).value
    assert np.max(np.abs(at - centres(texels, 100, 100, (3, -2)))) <= 5e-12
    assert len(texels) > 0
    assert len(whole) > 0


def nearest_distance(points, cloud, reach):
    """The distance of each point from the cloud; inf where it is more than ``reach``."""
    cloud = cloud[np.argsort(cloud[:, 1])]
    result = np.full(len(points), np.inf)
    for y in np.unique(points[:, 1]):
        first, last = np.searchsorted(cloud[:, 1], (y - reach, y + reach))
        strip = cloud[first:last]
        for i in np.flatnonzero(points[:, 1] == y):
            near = strip[np.abs(strip[:, 0] - points[i, 0]) <= reach]
            if len(near):
                result[i] = np.sqrt(np.min(np.sum((near - points[i]) ** 2, axis=1)))
    return np.where(result <= reach, result, np.inf)


def test_margins(uv_map):
    size, margin = 48, 3.5
    texels = uv_map.rasterize(size, size, margin=margin)
    inside = uv_map.rasterize(size, size)
    assert np.array_equal(texels.x[texels.inside], inside.x)
    assert np.array_equal(texels.uv[texels.inside], inside.uv)
    u = np.linspace(0, 1, 80)
    grid = np.stack(np.meshgrid(u, u), axis=-1).reshape(-1, 2)
    face = np.repeat(np.arange(20), len(grid))
    cloud = size * uv_map.evaluate(face, np.tile(grid, (20, 1))).value
    outside = ~texels.inside
    point = np.stack([texels.x, texels.y], axis=1)[outside] + 0.5
    at = size * uv_map.evaluate(texels.face[outside], texels.uv[outside]).value
    distance = np.linalg.norm(at - point, axis=1)
    assert np.all(distance <= margin)
    assert np.all(distance <= nearest_distance(point, cloud, margin + 1) + 1 / 64)
    missing = np.ones((size, size), bool)
    missing[texels.y, texels.x] = False
    y, x = np.nonzero(missing)
    left_out = nearest_distance(np.stack([x, y], axis=1) + 0.5, cloud, margin + 1)
    assert np.all(left_out > margin - 1 / 64)


def test_threads_and_bits(uv_map):
    one = uv_map.rasterize(300, 200, margin=2, threads=1)
    assert same(one, uv_map.rasterize(300, 200, margin=2, threads=3))
    points = np.random.default_rng(5).random((1000, 2))
    a, b = uv_map.locate(points, threads=1), uv_map.locate(points)
    assert a.uv.tobytes() == b.uv.tobytes()
    assert a.face.tobytes() == b.face.tobytes()
    assert uv_map.locate(points[17:18]).uv.tobytes() == a.uv[17:18].tobytes()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"width": 0, "height": 4}, "width is 0; it must be 1 to 65536"),
        ({"width": 4, "height": 70_000}, "height is 70000"),
        ({"width": 4, "height": 4, "margin": -1}, "margin is -1"),
        ({"width": 4, "height": 4, "margin": np.nan}, "margin is nan"),
        ({"width": 4, "height": 4, "threads": -1}, "threads is -1"),
    ],
)
def test_refusals(uv_map, arguments, message):
    with pytest.raises(ValueError, match=message):
        uv_map.rasterize(**arguments)


def test_refused_types(uv_map):
    for arguments in [(4.5, 4), (4, 4, 7), (4, 4, (1, 2, 3)), ("a", 4)]:
        with pytest.raises(TypeError):
            uv_map.rasterize(*arguments)
    with pytest.raises(TypeError):
        uv_map.rasterize(4, 4, progress=3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"tile": (0.5, 0)}, "tile is (0.5, 0); expected two integers"),
        ({"tile": (1, 2, 3)}, "tile is (1, 2, 3); expected two integers"),
        ({"width": 1.5}, "width is 1.5; expected an integer"),
        ({"height": "a"}, "height is 'a'; expected an integer"),
        ({"width": 2**40}, "width is 1099511627776; expected an integer below 2147483648"),
        ({"threads": 1.5}, "threads is 1.5; expected an integer"),
        ({"margin": "x"}, "margin is 'x'; expected a number"),
    ],
)
def test_errors_name_the_argument_of_a_wrong_type(uv_map, arguments, message):
    with pytest.raises(TypeError) as error:
        uv_map.rasterize(**{"width": 4, "height": 4, **arguments})
    assert str(error.value) == message


def test_positional_arguments_of_a_wrong_type_are_named_too(uv_map):
    with pytest.raises(TypeError, match=r"^height is 4\.5; expected an integer$"):
        uv_map.rasterize(4, 4.5)
    with pytest.raises(TypeError, match=r"^threads is 1\.5; expected an integer$"):
        uv_map.locate([[0, 0]], threads=1.5)


def test_refused_points(uv_map):
    for value, text in [(np.nan, "nan"), (np.inf, "inf")]:
        with pytest.raises(ValueError, match=f"row 1: points is .*{text}.* is not finite"):
            uv_map.locate([[0, 0], [0.5, value]])
    with pytest.raises(ValueError, match=r"too far away; coordinates must be at most 1e\+150"):
        uv_map.locate([[1e200, 0]])
    with pytest.raises(ValueError, match=r"points has shape \(2, 3\)"):
        uv_map.locate(np.zeros((2, 3)))
    assert len(uv_map.locate([])) == 0


def test_other_numbers_of_columns_are_refused():
    positions, faces = shapes.grid(2, 2)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    for columns in (1, 3, 5):
        data = surface.vertex_data(np.zeros((9, columns)))
        with pytest.raises(ValueError, match=f"{columns} columns; a UV map has 2"):
            data.rasterize(8, 8)
        with pytest.raises(ValueError, match=f"{columns} columns"):
            data.locate([[0, 0]])


def test_vertex_data_and_varying_can_be_inverted():
    positions, faces = shapes.grid(3, 3)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    for data in (surface.vertex_data(positions[:, :2] / 3), surface.varying(positions[:, :2] / 3)):
        texels = data.rasterize(30, 30)
        at = data.evaluate(texels.face, texels.uv).value
        assert np.max(np.abs(at - centres(texels, 30, 30))) <= 1e-12
        assert len(texels) > 700


def test_progress_is_told_and_can_end_the_work(uv_map):
    told = []
    uv_map.rasterize(2048, 2048, progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1
    assert len(told) > 1
    assert all(0 < part <= 1 for part in told)

    def stop(part):
        raise KeyError("enough")

    with pytest.raises(KeyError):
        uv_map.rasterize(2048, 2048, progress=stop)
    with pytest.raises(KeyError):
        uv_map.locate(np.zeros((10, 2)), progress=stop)


def test_progress_is_told_often_where_many_faces_lie_on_each_other():
    positions, faces = shapes.grid(8, 8)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    uv_map = surface.face_varying(np.tile(square, (64, 1)), np.arange(256), "all")
    told = []
    texels = uv_map.rasterize(512, 256, progress=told.append)
    assert texels.overlap.all()
    assert len(texels.x) == 512 * 256
    assert len(told) >= 2
    assert np.max(np.diff([0, *told])) <= 0.5


def test_progress_may_read_but_not_set(uv_map):
    uv_map.locate([[0.5, 0.5]], progress=lambda part: uv_map.locate([[0.2, 0.2]]))
    values = np.zeros(uv_map.shape)
    with pytest.raises(RuntimeError, match="wait for itself"):
        uv_map.locate([[0.5, 0.5]], progress=lambda part: uv_map.set_values(values))


def test_other_threads_run_meanwhile(uv_map):
    beside.assert_python_goes_on(lambda: uv_map.rasterize(1000, 1000))


def test_ctrl_c_ends_it():
    errors = ctrl_c.errors_of("""
import limitsurf as ls, shapes
positions, faces = shapes.grid(3, 3)
mesh = ls.ControlMesh.from_faces(positions, faces)
uv_map = ls.LimitSurface(mesh).face_varying(positions[:, :2] / 3, faces.ravel(), "none")
print("ready", flush=True)
for _ in range(1000):
    uv_map.rasterize(4096, 4096)
""")
    assert "KeyboardInterrupt" in errors
