# SPDX-License-Identifier: Apache-2.0
"""Projected images: places, footprints and weights, compared with those computed by numpy."""

import limitsurf as ls
import numpy as np
import projectors
import pytest
import shapes

ANY_ANGLE = (np.pi, np.pi)
TEXEL = (1 / 512, 1 / 256)


@pytest.fixture(params=["perspective", "shifted", "orthographic", "skewed"])
def matrix(request):
    view = projectors.looking((1.4, -0.9, 2.1), (0.5, 0.5, 0.0))
    kinds = {
        "perspective": projectors.perspective(),
        "shifted": projectors.perspective(0.3, 0.6, shift=(0.7, -0.4)),
        "orthographic": projectors.orthographic(0.8, 1.1),
        "skewed": np.array([[1, 0.3, 0.4, 0], [0, 1, -0.2, 0.1], [0, 0, -0.1, -1], [0, 0, 0, 1]]),
    }
    return kinds[request.param] @ view


@pytest.fixture
def sheet():
    return projectors.sheet()


def to_eye(matrix, points):
    """Unit vectors towards the eye, computed from the matrix's null vector."""
    null = np.linalg.svd(matrix[[0, 1, 3]])[2][-1]
    if abs(null[3]) > 1e-9:
        out = null[:3] / null[3] - points
    else:
        deeper = matrix[2, :3] @ null[:3] * matrix[3, 3]
        out = np.broadcast_to(-null[:3] * np.sign(deeper), points.shape)
    return out / np.linalg.norm(out, axis=1, keepdims=True)


def test_places_are_where_the_matrix_puts_them(sheet, matrix, anywhere):
    surface, uv_map = sheet
    face, uv = anywhere(surface, 2000)
    seen = surface.project(uv_map, face, uv, matrix, TEXEL, facing=ANY_ANGLE, occlusion=False)
    points = surface.evaluate(face, uv).position
    np.testing.assert_allclose(seen.st, projectors.image_of(matrix, points), atol=1e-13)


def test_footprints_are_differences_of_places(sheet, matrix, anywhere):
    surface, uv_map = sheet
    face, uv = anywhere(surface, 500)
    uv = 0.01 + 0.98 * uv
    seen = surface.project(uv_map, face, uv, matrix, TEXEL, facing=ANY_ANGLE, occlusion=False)
    step = 1e-5
    by_image, by_map = np.empty((500, 2, 2)), np.empty((500, 2, 2))
    for axis in range(2):
        ends = [uv + sign * step * np.eye(2)[axis] for sign in (1, -1)]
        images = [projectors.image_of(matrix, surface.evaluate(face, end).position) for end in ends]
        places = [uv_map.evaluate(face, end).value for end in ends]
        by_image[:, :, axis] = (images[0] - images[1]) / (2 * step)
        by_map[:, :, axis] = (places[0] - places[1]) / (2 * step)
    expected = by_image @ np.linalg.inv(by_map) @ np.diag(TEXEL)
    np.testing.assert_allclose(seen.footprint, expected, atol=1e-6 * np.abs(expected).max())


def test_weight_falls_with_the_angle(sheet, matrix, anywhere):
    surface, uv_map = sheet
    face, uv = anywhere(surface, 3000)
    start, end = 0.6, 1.3
    seen = surface.project(
        uv_map, face, uv, matrix, TEXEL, facing=(start, end), occlusion=False, frame=False
    )
    here = surface.evaluate(face, uv, 1)
    cosine = np.sum(here.normal * to_eye(matrix, here.position), axis=1)
    fall = np.clip((np.arccos(np.clip(cosine, -1, 1)) - start) / (end - start), 0, 1)
    np.testing.assert_allclose(seen.weight, 1 - fall**2 * (3 - 2 * fall), atol=1e-7)
    assert 0 < np.mean(seen.weight == 1) < 1

    both = surface.project(
        uv_map, face, uv, matrix, TEXEL, facing=(start, end), two_sided=True, occlusion=False,
        frame=False,
    )  # fmt: skip
    fall = np.clip((np.arccos(np.clip(np.abs(cosine), 0, 1)) - start) / (end - start), 0, 1)
    np.testing.assert_allclose(both.weight, 1 - fall**2 * (3 - 2 * fall), atol=1e-7)


def test_angles_are_the_worlds(anywhere):
    positions, faces = shapes.cube()
    surface, uv_map = projectors.mapped(positions, faces)
    world = np.array([[1, 0, 0.5, 3], [0, 4, 0, 1], [0, 0, -0.3, 0], [0, 0, 0, 1.0]])
    in_world, map_in_world = projectors.mapped(positions @ world[:3, :3].T + world[:3, 3], faces)
    camera = projectors.perspective() @ projectors.looking((5, -9, 7), (3, 3, 0))
    face, uv = anywhere(surface, 1000)
    options = {"facing": (0.5, 1.2), "frame": False}
    seen = surface.project(uv_map, face, uv, camera @ world, TEXEL, world=world, **options)
    # The normals of the mirrored cage point in the opposite direction.
    expected = in_world.project(
        map_in_world, face, uv, camera, TEXEL, facing=(np.pi - 1.2, np.pi - 0.5), frame=False,
        occlusion=False,
    )  # fmt: skip
    hidden = in_world.project(
        map_in_world, face, uv, camera, TEXEL, facing=ANY_ANGLE, frame=False
    ).weight
    np.testing.assert_allclose(seen.weight, (1 - expected.weight) * hidden, atol=1e-6)
    np.testing.assert_allclose(seen.st, expected.st, atol=1e-12)


def hidden_by(surface, points, towards, distance, start=1e-6):
    """Whether a hit of the whole line is between a point and the eye."""
    hits = surface.ray_cast_all(points, towards)
    row = np.repeat(np.arange(len(points)), np.diff(hits.offsets))
    between = (hits.distance > start) & (hits.distance < distance[row])
    return np.bincount(row[between], minlength=len(points)) > 0


def test_what_is_hidden_has_no_weight(matrix, anywhere):
    surface, uv_map = projectors.sheet(height=1.5)
    face, uv = anywhere(surface, 3000)
    seen = surface.project(
        uv_map, face, uv, matrix, TEXEL, facing=ANY_ANGLE, frame=False, depth=None
    )
    points = surface.evaluate(face, uv).position
    towards = to_eye(matrix, points)
    null = np.linalg.svd(matrix[[0, 1, 3]])[2][-1]
    distance = (
        np.linalg.norm(null[:3] / null[3] - points, axis=1)
        if abs(null[3]) > 1e-9
        else np.full(len(points), np.inf)
    )
    hidden = hidden_by(surface, points, towards, distance)
    assert 0.05 < hidden.mean() < 0.95
    np.testing.assert_array_equal(seen.weight, ~hidden)


def meets_triangles(origins, directions, triangles, least, most):
    """Whether rays meet one of the triangles (Moeller and Trumbore), all against all."""
    a, ab, ac = (
        triangles[:, 0],
        triangles[:, 1] - triangles[:, 0],
        triangles[:, 2] - triangles[:, 0],
    )
    across = np.cross(directions[:, None], ac[None])
    volume = np.sum(ab * across, axis=2)
    from_a = origins[:, None] - a
    with np.errstate(all="ignore"):
        s = np.sum(from_a * across, axis=2) / volume
        up = np.cross(from_a, ab[None])
        t = np.sum(directions[:, None] * up, axis=2) / volume
        distance = np.sum(ac * up, axis=2) / volume
        met = (s >= 0) & (t >= 0) & (s + t <= 1) & (distance > least) & (distance < most[:, None])
    return met.any(axis=1)


def test_a_dense_mesh_hides_the_same(anywhere):
    surface, uv_map = projectors.sheet(height=1.5)
    camera = projectors.perspective() @ projectors.looking((1.4, -0.9, 2.1), (0.5, 0.5, 0.0))
    face, uv = anywhere(surface, 400)
    seen = surface.project(uv_map, face, uv, camera, TEXEL, facing=ANY_ANGLE, frame=False)
    mesh = surface.tessellate(4)
    quads = mesh.positions[mesh.faces]
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    here = surface.evaluate(face, uv, 1)
    towards = to_eye(camera, here.position)
    side = np.sign(np.sum(here.normal * towards, axis=1))[:, None]
    hidden = np.concatenate(
        [
            meets_triangles(p + 2e-3 * n, d, triangles, 0, np.full(len(p), 1e9))
            for p, n, d in zip(
                np.array_split(here.position, 20),
                np.array_split(side * here.normal, 20),
                np.array_split(towards, 20),
                strict=True,
            )
        ]
    )
    # Points within the mesh's error of a silhouette or of the shadow's border are left out.
    assert np.mean(seen.weight != ~hidden) < 0.02


@pytest.mark.parametrize(("scale", "offset"), [(1e-3, 0), (1, 0), (1e4, 0), (1, 1e7), (1, 1e8)])
def test_convex_surfaces_do_not_shade_themselves(scale, offset, anywhere):
    positions, faces = shapes.cube()
    middle = offset * np.array([1, -0.7, 0.3])
    surface, uv_map = projectors.mapped(scale * positions + middle, faces)
    face, uv = anywhere(surface, 40_000)
    here = surface.evaluate(face, uv, 1)
    away = scale * np.array([3, 2, 2.5])
    for projection, towards in (
        (projectors.perspective(), middle + away - here.position),
        (projectors.orthographic(), np.broadcast_to(away, here.position.shape)),
    ):
        camera = projection @ projectors.looking(middle + away, middle)
        seen = surface.project(
            uv_map, face, uv, camera, TEXEL, facing=(np.pi / 2, np.pi / 2), frame=False, depth=None
        )
        cosine = np.sum(here.normal * towards, axis=1) / np.linalg.norm(towards, axis=1)
        assert np.all(seen.weight[cosine > 1e-6] == 1)
        assert np.all(seen.weight[cosine < -1e-6] == 0)
        assert np.mean(seen.weight) > 0.2


@pytest.mark.parametrize("thickness", [1e-2, 1e-6, 1e-8])
def test_thin_sheets_do_not_leak(thickness, anywhere):
    positions, faces = shapes.cube()
    edges = {tuple(sorted((f[i], f[(i + 1) % 4]))) for f in faces for i in range(4)}
    surface, uv_map = projectors.mapped(
        positions * [1, 1, thickness], faces, edge_sharpness=(list(edges), np.full(12, 10.0))
    )
    face, uv = anywhere(surface, 20_000)
    uv = 1e-3 + 0.998 * uv
    camera = projectors.perspective() @ projectors.looking((2, 1.5, 0.7), (0.5, 0.5, 0))
    seen = surface.project(
        uv_map, face, uv, camera, TEXEL, two_sided=True, facing=(1.56, 1.57), frame=False
    )
    normal = surface.evaluate(face, uv, 1).normal
    flat = np.abs(normal[:, 2]) > 0.5
    np.testing.assert_array_equal(seen.weight[flat], normal[flat, 2] > 0)


def test_near_and_far_planes(anywhere):
    low, uv_map = projectors.plane()
    positions, faces = shapes.grid(1, 1)
    layers = np.concatenate([positions, positions + [0, 0, 1.0], positions + [0, 0, 2.0]])
    surface, uv_map = projectors.mapped(
        layers, np.concatenate([faces, faces + 4, faces + 8]), scheme="bilinear"
    )
    face, uv = np.repeat([0, 1, 2], 100), np.random.default_rng(1).random((300, 2))

    def weights(depth, near=0.5, far=2.5, kind=projectors.orthographic):
        camera = kind(near=near, far=far) @ projectors.looking(
            (0.5, 0.5, 3.5), (0.5, 0.5, 0), (0, 1, 0)
        )
        seen = surface.project(uv_map, face, uv, camera, TEXEL, frame=False, depth=depth)
        return seen.weight.reshape(3, 100).mean(axis=1)

    for kind in (projectors.orthographic, projectors.perspective):
        # Layers are 3.5, 2.5 and 1.5 below the eye.
        np.testing.assert_array_equal(weights((-1, 1), 0.5, 9, kind), [0, 0, 1])
        np.testing.assert_array_equal(weights((-1, 1), 2.0, 9, kind)[1:], [1, 0])
        np.testing.assert_array_equal(weights((-1, 1), 3.0, 9, kind)[[0, 1, 2]] > 0, [1, 0, 0])
        np.testing.assert_array_equal(weights((-1, 1), 3.0, 3.2, kind), [0, 0, 0])
        np.testing.assert_array_equal(weights(None, 3.0, 3.2, kind), [0, 0, 1])


def test_nothing_behind_the_eye(sheet, anywhere):
    surface, uv_map = sheet
    face, uv = anywhere(surface, 100)
    camera = projectors.perspective() @ projectors.looking((0.5, 0.5, 5), (0.5, 0.5, 9), (0, 1, 0))
    for depth in (None, (-1, 1)):
        seen = surface.project(uv_map, face, uv, camera, TEXEL, facing=ANY_ANGLE, depth=depth)
        assert np.isnan(seen.st).all()
        assert not seen.footprint.any()
        assert not seen.weight.any()


def texels(side):
    """The locations of the centres of a plane's side x side texels."""
    y, x = np.mgrid[0:side, 0:side]
    places = (np.stack([x, y], -1).reshape(-1, 2) + 0.5) / side
    cells = np.minimum((4 * places).astype(int), 3)
    return cells[:, 0] + 4 * cells[:, 1], 4 * places - cells


def test_weights_at_the_frame_are_areas():
    surface, uv_map = projectors.plane()
    side = 64
    face, uv = texels(side)
    camera = projectors.orthographic(0.2, 0.3) @ projectors.looking(
        (0.517, 0.481, 3), (0.517, 0.481, 0), (0, 1, 0)
    )
    seen = surface.project(uv_map, face, uv, camera, (1 / side, 1 / side))
    np.testing.assert_allclose(seen.weight.sum() / side**2, 0.4 * 0.6, rtol=1e-12)
    partial = (seen.weight > 0) & (seen.weight < 1)
    assert 100 < partial.sum() < 200

    whole = surface.project(uv_map, face, uv, camera, (1 / side, 1 / side), frame=False)
    assert np.all(whole.weight == 1)

    soft = surface.project(uv_map, face, uv, camera, (1 / side, 1 / side), soft_edge=0.25)
    border = np.minimum(seen.st, 1 - seen.st)
    rise = np.clip(border / 0.25, 0, 1)
    expected = np.prod(rise**2 * (3 - 2 * rise), axis=1) * seen.weight
    np.testing.assert_allclose(soft.weight, expected, atol=1e-12)


@pytest.mark.parametrize("samples", [4, 16])
def test_samples_make_borders_of_shadows_smooth(samples):
    low, faces = shapes.grid(4, 4)
    lid = np.array([[0.23, 0.31, 1], [0.71, 0.37, 1], [0.66, 0.79, 1], [0.29, 0.68, 1]])
    positions = np.concatenate([low / [4, 4, 1], lid])
    all_faces = np.concatenate([faces, [[25, 26, 27, 28]]])
    mesh = ls.ControlMesh.from_faces(positions, all_faces, scheme="bilinear")
    surface = ls.LimitSurface(mesh)
    uv_map = surface.face_varying(positions[:, :2], all_faces.ravel(), "all")
    camera = projectors.orthographic() @ projectors.looking((0.7, 0.4, 5), (0.5, 0.5, 0), (0, 1, 0))
    side, per_side = 40, int(np.sqrt(samples))
    face, uv = texels(side)
    seen = surface.project(
        uv_map, face, uv, camera, (1 / side, 1 / side), samples=samples, frame=False
    )
    # The map's texels are squares on the planes, so the result is that of as many smaller texels.
    small_face, small_uv = texels(side * per_side)
    small = surface.project(uv_map, small_face, small_uv, camera, (1, 1), frame=False).weight
    expected = small.reshape(side, per_side, side, per_side).mean(axis=(1, 3)).ravel()
    np.testing.assert_array_equal(seen.weight, expected)
    assert 20 < np.sum((expected > 0) & (expected < 1)) < 200


@pytest.mark.parametrize("shape", sorted(shapes.ALL))
def test_everywhere_there_is_a_finite_answer(shape):
    surface, uv_map = projectors.mapped(*shapes.ALL[shape])
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0], [0, 0.25]], float)
    face = np.repeat(np.arange(surface.face_count), len(corners))
    uv = np.tile(corners, (surface.face_count, 1))
    camera = projectors.perspective() @ projectors.looking((3, -5, 6), (0.5, 0.5, 0))
    seen = surface.project(uv_map, face, uv, camera, TEXEL, facing=ANY_ANGLE)
    beside = surface.project(
        uv_map, face, uv + (0.5 - uv) / 1024, camera, TEXEL, facing=ANY_ANGLE, occlusion=False
    )
    for values in (seen.st, seen.footprint, seen.weight):
        assert np.isfinite(values).all()
    size = np.linalg.norm(beside.footprint, axis=(1, 2))
    change = np.linalg.norm(seen.footprint - beside.footprint, axis=(1, 2))
    assert np.all(change <= 0.05 * size)

    along = surface.project_along_normals(uv_map, face, uv, surface, uv_map, TEXEL)
    assert np.isfinite(along.st).all()
    assert np.isfinite(along.footprint).all()


def test_footprints_where_the_map_has_no_area_are_0(anywhere):
    surface, _ = projectors.sheet()
    corners = surface.mesh.face_vertices
    flat = surface.face_varying(np.zeros((1, 2)), np.zeros(len(corners), int), "all")
    camera = projectors.perspective() @ projectors.looking((0.5, 0.5, 3), (0.5, 0.5, 0), (0, 1, 0))
    face, uv = anywhere(surface, 50)
    seen = surface.project(flat, face, uv, camera, TEXEL)
    assert not seen.footprint.any()
    np.testing.assert_array_equal(
        seen.st, surface.project(projectors.sheet()[1], face, uv, camera, TEXEL).st
    )


def test_long_footprints_are_shortened():
    surface, uv_map = projectors.plane()
    face, uv = texels(8)
    camera = projectors.orthographic(1e-3, 1e-3) @ projectors.looking(
        (0, 0, 1), (0, 0, 0), (0, 1, 0)
    )
    seen = surface.project(uv_map, face, uv, camera, (1 / 8, 1 / 8))
    np.testing.assert_allclose(seen.footprint, np.broadcast_to(4 * np.eye(2), (64, 2, 2)))


def test_matrices_in_single_precision_do(sheet, anywhere):
    surface, uv_map = sheet
    face, uv = anywhere(surface, 500)
    for projection in (
        projectors.perspective(near=1e-6, far=1e6),
        projectors.orthographic(near=1e-6, far=1e6),
    ):
        camera = projection @ projectors.looking((40, 30, 20), (0.5, 0.5, 0))
        exact = surface.project(uv_map, face, uv, camera, TEXEL, frame=False, depth=None)
        rounded = surface.project(
            uv_map, face, uv, camera.astype(np.float32), TEXEL, frame=False, depth=None
        )
        np.testing.assert_allclose(rounded.st, exact.st, atol=2e-5)
        np.testing.assert_allclose(rounded.weight, exact.weight, atol=1e-3)


def test_threads_and_company_change_no_bit(sheet, matrix, anywhere):
    surface, uv_map = sheet
    face, uv = anywhere(surface, 3000)
    for call in (
        lambda rows, **more: surface.project(
            uv_map, face[rows], uv[rows], matrix, TEXEL, samples=4, **more
        ),
        lambda rows, **more: surface.project_along_normals(
            uv_map, face[rows], uv[rows], surface, uv_map, TEXEL, **more
        ),
    ):
        all_rows, some = slice(None), slice(100, 111)
        one = call(all_rows, threads=1)
        for name in ("st", "footprint", "weight"):
            bits = getattr(one, name).tobytes()
            assert getattr(call(all_rows), name).tobytes() == bits
            assert getattr(call(some), name).tobytes() == getattr(one, name)[some].tobytes()


def test_empty_batches(sheet, matrix):
    surface, uv_map = sheet
    none = np.zeros((0, 2))
    for seen in (
        surface.project(uv_map, [], none, matrix, TEXEL),
        surface.project_along_normals(uv_map, [], none, surface, uv_map, TEXEL),
    ):
        assert len(seen) == 0
        assert seen.st.shape == (0, 2)
        assert seen.footprint.shape == (0, 2, 2)


def test_progress_is_told_and_may_end_the_call(sheet, matrix, anywhere):
    surface, uv_map = sheet
    face, uv = anywhere(surface, 150_000)
    parts = []
    surface.project(uv_map, face, uv, matrix, TEXEL, progress=parts.append, occlusion=False)
    assert parts == sorted(parts)
    assert len(parts) == 3
    assert parts[-1] == 1

    def stop(part):
        uv_map.set_values(np.zeros(uv_map.shape))  # nothing is held meanwhile
        raise KeyError(part)

    with pytest.raises(KeyError):
        surface.project(uv_map, face, uv, matrix, TEXEL, progress=stop, occlusion=False)


BAD_OPTIONS = {
    "matrix has nan in row 1, column 1": {"matrix": np.diag([1, np.nan, 1, 1])},
    "matrix has inf": {"matrix": np.full((4, 4), np.inf)},
    "matrix is singular": {"matrix": np.ones((4, 4))},
    "matrix has shape": {"matrix": np.eye(3)},
    "world is singular": {"world": np.diag([1, 0, 1, 1])},
    "world is not affine": {"world": np.diag([1, 1, 1, 2.0])},
    "texel has the size 0": {"texel": (0, 1)},
    "texel has the size nan": {"texel": (1, np.nan)},
    r"facing\[0\] is 1": {"facing": (1, 0.5)},
    r"facing\[1\] is 4": {"facing": (1, 4)},
    "samples is 3": {"samples": 3},
    "bias is -1": {"bias": -1},
    "soft_edge is 0.6": {"soft_edge": 0.6},
    r"depth\[0\] is 1": {"depth": (1, -1)},
    "threads is -1": {"threads": -1},
}  # fmt: skip


@pytest.mark.parametrize("far", [0, 1e7, 1e9, 1e12])
def test_surfaces_far_beside_what_a_projector_shows(far):
    positions, faces = shapes.grid(20, 20)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions + far, faces))
    uv_map = surface.vertex_data(positions[:, :2] / 20)
    matrix = np.diag([0.025, 0.025, -0.005, 1])
    seen = surface.project(uv_map, [0, 200], [[0.5, 0.5]] * 2, matrix, TEXEL)
    assert (seen.weight > 0).all() == (far == 0)


@pytest.mark.parametrize("message", sorted(BAD_OPTIONS))
def test_options_without_meaning(sheet, message):
    surface, uv_map = sheet
    options = {"matrix": np.eye(4), "texel": TEXEL} | BAD_OPTIONS[message]
    with pytest.raises(ValueError, match=message):
        surface.project(uv_map, [0], [[0.5, 0.5]], **options)


def test_maps_of_other_surfaces(sheet):
    surface, uv_map = sheet
    cube, cube_map = projectors.mapped(*shapes.cube())
    heights = surface.vertex_data(surface.positions[:, 2])
    with pytest.raises(ValueError, match="uv_map has 1 columns"):
        surface.project(heights, [0], [[0, 0]], np.eye(4), TEXEL)
    with pytest.raises(ValueError, match="uv_map has 6 Ptex faces and the surface 30"):
        surface.project(cube_map, [0], [[0, 0]], np.eye(4), TEXEL)
    with pytest.raises(ValueError, match="source_map has 30 Ptex faces"):
        surface.project_along_normals(uv_map, [0], [[0, 0]], cube, uv_map, TEXEL)
    with pytest.raises(ls.LocationError, match="row 1"):
        surface.project(uv_map, [0, 99], np.zeros((2, 2)), np.eye(4), TEXEL)


def test_checker_seen_from_its_camera_is_straight_to_a_texel():
    """Project, store in a texture, look at it from the same camera: every border of a square is
    within a texel of where it should be."""
    surface, uv_map = projectors.sheet(height=0.25)
    camera = projectors.perspective(0.3, 0.3) @ projectors.looking((0.9, -0.8, 2.4), (0.5, 0.5, 0))
    side = 192
    at = uv_map.rasterize(side, side)
    seen = surface.project(
        uv_map, at.face, at.uv, camera, (1 / side, 1 / side), facing=(np.pi / 2, np.pi / 2)
    )
    y, x = np.mgrid[0:800, 0:800]
    checker = ((x // 100 + y // 100) % 2).astype(np.float32)[..., None]
    colours = ls.FilteredImage(checker, "extend").sample(seen.st, seen.footprint)[:, 0]
    texture = np.full((side, side), np.nan)
    texture[at.y, at.x] = np.where(seen.weight == 1, colours, np.nan)
    size = np.full((side, side), np.nan)
    size[at.y, at.x] = np.linalg.norm(seen.footprint, axis=(1, 2))

    # The camera's own picture: places on the limit surface in view, through the texture.
    rng = np.random.default_rng(5)
    face = rng.integers(0, surface.face_count, 60_000)
    uv = rng.random((60_000, 2))
    direct = surface.project(uv_map, face, uv, camera, (1 / side, 1 / side))
    place = uv_map.evaluate(face, uv).value * side - 0.5
    corner = np.floor(place).astype(int)
    a, b = (place - corner).T
    inside = np.all((corner >= 0) & (corner < side - 1), axis=1)
    i, j = np.where(inside[:, None], corner, 0).T
    value = (1 - b) * ((1 - a) * texture[j, i] + a * texture[j, i + 1]) + b * (
        (1 - a) * texture[j + 1, i] + a * texture[j + 1, i + 1]
    )
    looked = inside & np.isfinite(value) & (direct.weight > 0)
    assert looked.sum() > 10_000
    squares = direct.st[looked] * 8
    expected = np.floor(squares).sum(axis=1) % 2
    to_border = np.abs(squares - np.round(squares)).min(axis=1) / 8
    wrong = (value[looked] > 0.5) != (expected > 0.5)
    texel = np.linalg.norm(direct.footprint[looked], axis=(1, 2))
    assert np.all(to_border[wrong] < texel[wrong])
    assert np.mean(to_border[wrong] < 0.5 * texel[wrong]) > 0.9
