# SPDX-License-Identifier: Apache-2.0
import catmull_clark
import limitsurf as ls
import numpy as np
import pytest
import shapes


def dot(a, b):
    return np.einsum("ni,ni->n", a, b)


def test_is_how_the_normal_turns(surface):
    """By differences of the normal along the principal directions: dn = -k ds."""
    rng = np.random.default_rng(0)
    n = 200
    face = rng.integers(0, surface.face_count, n)
    uv = rng.uniform(0.2, 0.8, (n, 2))
    here, curvature = surface.evaluate(face, uv, 1), surface.curvature(face, uv)
    tangents = np.stack([here.du, here.dv], axis=2)
    sound = np.linalg.norm(np.cross(here.du, here.dv), axis=1) > 0.05
    h = 1e-5
    for k, direction in (
        (curvature.k1, curvature.direction1),
        (curvature.k2, curvature.direction2),
    ):
        step = np.einsum("nij,nj->ni", np.linalg.pinv(tangents), direction)
        after = surface.evaluate(face, np.clip(uv + h * step, 0, 1), 1).normal
        before = surface.evaluate(face, np.clip(uv - h * step, 0, 1), 1).normal
        turned = (after - before) / (2 * h)
        inside = (np.abs(h * step) < 0.1).all(axis=1) & sound
        expected = -k[:, None] * direction
        error = np.linalg.norm(turned - expected, axis=1)[inside]
        assert error.max() < 1e-5 * max(1, np.abs(k[inside]).max()) ** 3


def test_fields_belong_together(surface, anywhere):
    face, uv = anywhere(surface, 100)
    c = surface.curvature(face, uv)
    assert (c.k1 >= c.k2).all()
    scale = np.abs(c.k1) + np.abs(c.k2) + 1e-300
    assert (np.abs(c.mean - (c.k1 + c.k2) / 2) <= 1e-12 * scale).all()
    assert (np.abs(c.gaussian - c.k1 * c.k2) <= 1e-12 * scale**2).all()
    normal = surface.evaluate(face, uv, 1).normal
    for direction in (c.direction1, c.direction2):
        assert direction.shape == (100, 3)
        np.testing.assert_allclose(np.linalg.norm(direction, axis=1), 1, atol=1e-12)
        np.testing.assert_allclose(dot(direction, normal), 0, atol=1e-9)
    np.testing.assert_allclose(dot(c.direction1, c.direction2), 0, atol=1e-9)


def test_of_something_like_a_sphere_is_that_of_its_radius():
    """A finely refined sphere's cage has a limit surface close to a sphere."""
    positions, faces = shapes.cube()
    for _ in range(4):
        surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
        finer = surface.tessellate(1)
        positions, faces = finer.positions, finer.faces
        positions = positions - positions.mean(axis=0)
        positions /= np.linalg.norm(positions, axis=1, keepdims=True)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    rng = np.random.default_rng(0)
    face, uv = rng.integers(0, surface.face_count, 500), rng.uniform(0.1, 0.9, (500, 2))
    radius = np.linalg.norm(surface.evaluate(face, uv).position, axis=1)
    c = surface.curvature(face, uv)
    assert np.median(np.abs(c.mean * radius + 1)) < 0.02
    assert np.median(np.abs(c.gaussian * radius**2 - 1)) < 0.02
    assert (c.k1 < 0).all()


def test_is_missing_at_irregular_vertices_alone(cube):
    at = cube.curvature(np.arange(6), np.zeros((6, 2)))
    assert np.isnan(at.mean).all()
    assert at.irregular.all()
    near = cube.curvature(np.arange(6), np.full((6, 2), 2.0**-30))
    assert np.isfinite(near.mean).all()
    assert not near.irregular.any()
    flat = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(4, 4)))
    np.testing.assert_allclose(flat.curvature(5, [[0, 0], [1, 1], [0.5, 1]]).k1, 0, atol=1e-14)


CORNERS = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
SIDES = np.array([[1, 0.25], [1, 0.75], [0.75, 1], [0.25, 1]])


def seen_from(corner, uv):
    """(u, v) of a quad's places given as seen from one of its corners."""
    for _ in range(corner):
        uv = np.stack([1 - uv[:, 1], uv[:, 0]], axis=1)
    return uv


def ptex_corners(faces):
    """For every corner of every face: its Ptex face and the corner of that; and whether it is a
    quad."""
    result, first = {}, 0
    for f, face in enumerate(faces):
        for c in range(len(face)):
            quad = len(face) == 4
            result[f, c] = (first, c, True) if quad else (first + c, 0, False)
        first += 1 if len(face) == 4 else len(face)
    return result


def sectors(faces, cuts=()):
    """Corners (face, corner) around vertices, as far as edges link them that are not cut."""
    faces = [list(map(int, face)) for face in faces]
    beside, cuts = {}, {frozenset(cut) for cut in cuts}
    for f, face in enumerate(faces):
        for c, vertex in enumerate(face):
            for other in (face[(c + 1) % len(face)], face[c - 1]):
                if frozenset((vertex, other)) not in cuts:
                    beside.setdefault((vertex, other), []).append((f, c))
    parent = {(f, c): (f, c) for f, face in enumerate(faces) for c in range(len(face))}

    def root(at):
        return at if parent[at] == at else root(parent[at])

    for linked in beside.values():
        for at in linked[1:]:
            parent[root(at)] = root(linked[0])
    groups = {}
    for at in parent:
        groups.setdefault(root(at), []).append(at)
    return list(groups.values())


def turned_into(normal, there, tensor):
    """The tensor of the plane with one normal, turned into that with another (Rodrigues)."""
    axis, cosine = np.cross(there, normal), there @ normal
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation = np.eye(3) + cross + cross @ cross / (1 + cosine)
    return rotation @ tensor @ rotation.T


def mean_by_hand(surface, corners, radius):
    """Of a sector's faces, given as (Ptex face, corner, whether a quad), from other places."""
    tensors, normals, areas = [], [], []
    for face, corner, quad in corners:
        uv = seen_from(corner, SIDES * (radius if quad else 2 * radius))
        k, here = surface.curvature(face, uv), surface.evaluate(face, uv, 1)
        for i in range(4):
            one, other = k.direction1[i], k.direction2[i]
            tensors.append(k.k1[i] * np.outer(one, one) + k.k2[i] * np.outer(other, other))
            normals.append(here.normal[i])
            area = np.linalg.norm(np.cross(here.du[i], here.dv[i]))
            areas.append(area if quad else 4 * area)
    face, corner, _ = corners[0]
    normal = surface.evaluate(face, CORNERS[[corner]], 1).normal[0]
    if np.isnan(normal).any():
        normal = np.average(normals, axis=0, weights=areas)
        normal /= np.linalg.norm(normal)
    turned = [turned_into(normal, n, t) for n, t in zip(normals, tensors, strict=True)]
    return np.average(turned, axis=0, weights=areas), normal


def sharp(edges=(), vertices=()):
    edges, vertices = np.reshape(list(edges), (-1, 2)).astype(int), np.array(vertices, int)
    return {
        "edge_sharpness": (edges, np.full(len(edges), np.inf)),
        "vertex_sharpness": (vertices, np.full(len(vertices), np.inf)),
    }


def rough(shape, seed=3):
    positions, faces = shape
    return positions + np.random.default_rng(seed).uniform(-0.1, 0.1, positions.shape), faces


CAGES = {
    "cube": (rough(shapes.cube()), (), ()),
    "house": (rough(shapes.house()), (), ()),
    "creased house": (rough(shapes.house()), [(0, 4), (4, 5), (8, 9)], ()),
    "cube with a dart and a cone": (rough(shapes.cube()), [(0, 1)], (7,)),
    "cube with a pinned corner": (rough(shapes.cube()), [(0, 1), (0, 2), (0, 4)], ()),
    "smooth corner": (shapes.fan(1, False), (), ()),
    "boundary of 2 faces": (shapes.fan(2, False), (), ()),
    "boundary of 6 faces": (shapes.fan(6, False), (), ()),
    "interior of 7 faces": (shapes.fan(7, True), (), ()),
    "pole": (shapes.pole(40), (), ()),
}


def made(name):
    (positions, faces), edges, vertices = CAGES[name]
    mesh = ls.ControlMesh.from_faces(positions, list(faces), **sharp(edges, vertices))
    return ls.LimitSurface(mesh), faces, edges


@pytest.mark.parametrize("name", CAGES)
@pytest.mark.parametrize("radius", [0.5, 0.3, 1 / 64])
def test_average_is_that_of_places_around_the_vertex(name, radius):
    surface, faces, cuts = made(name)
    ptex, irregular = ptex_corners(faces), 0
    groups = [[ptex[at] for at in sector] for sector in sectors(faces, cuts)]
    for f, face in enumerate(faces):
        if len(face) != 4:
            groups.append([(ptex[f, c][0], 2, False) for c in range(len(face))])
    for corners in groups:
        face = [at[0] for at in corners]
        uv = CORNERS[[at[1] for at in corners]]
        c = surface.curvature(face, uv, irregular="average", radius=radius)
        assert c.irregular.all() or not c.irregular.any()
        if not c.irregular[0]:
            plain = surface.curvature(face, uv)
            np.testing.assert_array_equal(c.k1, plain.k1)
            continue
        irregular += 1
        expected, normal = mean_by_hand(surface, corners, radius)
        size = np.abs(expected).max()
        for of in (c.k1, c.k2, c.mean, c.gaussian, c.direction1, c.direction2):
            assert (of == of[0]).all(), "all faces give the same bits"
        got = c.k1[0] * np.outer(c.direction1[0], c.direction1[0])
        got += c.k2[0] * np.outer(c.direction2[0], c.direction2[0])
        np.testing.assert_allclose(got, expected, rtol=0, atol=1e-8 * size)
        assert c.k1[0] >= c.k2[0]
        assert c.mean[0] == pytest.approx((c.k1[0] + c.k2[0]) / 2, abs=1e-12 * size)
        assert c.gaussian[0] == pytest.approx(c.k1[0] * c.k2[0], abs=1e-12 * size**2)
        np.testing.assert_allclose(
            np.cross(c.direction1[0], c.direction2[0]), normal, rtol=0, atol=1e-9
        )
    assert irregular > 0


@pytest.mark.parametrize("shape", ["cube", "house", "boundary fan", "corner"])
def test_average_of_a_subdivided_mesh_is_the_same_at_twice_the_radius(shape):
    positions, faces = rough(shapes.ALL[shape])
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, list(faces)))
    finer = ls.LimitSurface(ls.ControlMesh.from_faces(*catmull_clark.subdivided(positions, faces)))
    ptex, child, checked = ptex_corners(faces), 0, 0
    for f, face in enumerate(faces):
        for c in range(len(face)):
            at, corner, quad = ptex[f, c]
            places = [(corner, corner)] if quad else [(0, 0), (2, 2)]  # the vertex, the centre
            for own, finer_corner in places:
                options = {"irregular": "average"}
                one = surface.curvature(at, CORNERS[[own]], **options, radius=0.1)
                two = finer.curvature(child, CORNERS[[finer_corner]], **options, radius=0.2)
                assert one.irregular == two.irregular
                checked += int(one.irregular[0])
                size = np.abs([one.k1[0], one.k2[0]]).max()
                np.testing.assert_allclose(
                    [one.k1, one.k2], [two.k1, two.k2], rtol=0, atol=1e-9 * size
                )
            child += 1
    assert checked > 0


def test_average_around_a_mirrored_vertex_has_the_other_sign():
    for closed, count in ((True, 5), (False, 5), (False, 1)):
        positions, faces = shapes.fan(count, closed)
        there = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
        back = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces[:, [0, 3, 2, 1]]))
        a, b = (s.curvature(0, [[0, 0]], irregular="average") for s in (there, back))
        np.testing.assert_allclose([a.k1, a.k2], [-b.k2, -b.k1], rtol=1e-9)
        np.testing.assert_allclose(a.gaussian, b.gaussian, rtol=1e-9)
        assert abs(dot(a.direction1, b.direction2)) == pytest.approx(1)


def test_average_does_not_depend_on_how_vertices_are_numbered():
    positions, faces = rough(shapes.cube())
    rng = np.random.default_rng(5)
    order, new = rng.permutation(8), rng.permutation(6)
    mixed = np.array([np.roll(np.argsort(order)[face], rng.integers(4)) for face in faces[new]])
    one = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    other = ls.LimitSurface(ls.ControlMesh.from_faces(positions[order], mixed))
    at, there = one.vertex_locations(), other.vertex_locations()
    a = one.curvature(at.face, at.uv, irregular="average")
    b = other.curvature(there.face, there.uv, irregular="average")
    for name in ("k1", "k2"):
        np.testing.assert_allclose(getattr(a, name)[order], getattr(b, name), rtol=1e-9)


def test_average_on_a_plane_is_nothing():
    """There the irregular vertices have a limit."""
    for shape in (shapes.pole(5), shapes.fan(3, True), shapes.fan(5, False), shapes.fan(1, False)):
        positions = shape[0] * [1, 1, 0]
        surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, list(shape[1])))
        for radius in (0.5, 1 / 64, 2**-20):
            c = surface.curvature(0, [[0, 0]], irregular="average", radius=radius)
            assert c.irregular.all()
            np.testing.assert_array_equal([c.k1, c.k2], 0)
            np.testing.assert_array_equal(np.cross(c.direction1, c.direction2), [[0, 0, 1]])


def test_average_is_finite_everywhere_but_on_singular_surfaces():
    for shape in (shapes.pole(1000), shapes.fan(300, False), shapes.house()):
        surface = ls.LimitSurface(ls.ControlMesh.from_faces(shape[0], list(shape[1])))
        at = surface.vertex_locations()
        c = surface.curvature(at.face, at.uv, irregular="average")
        for name in ("k1", "k2", "mean", "gaussian", "direction1", "direction2"):
            assert np.isfinite(getattr(c, name)).all()
    flat = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    pillow = ls.LimitSurface(ls.ControlMesh.from_faces(flat, [[0, 1, 2, 3], [3, 2, 1, 0]]))
    c = pillow.curvature([0, 1], CORNERS[[0, 2]], irregular="average")
    np.testing.assert_allclose([c.k1, c.k2], 0, atol=1e-12)
    point = ls.LimitSurface(ls.ControlMesh.from_faces(np.zeros((8, 3)), shapes.cube()[1]))
    c = point.curvature([0, 1], [[0, 0], [0.5, 0.5]], irregular="average")
    assert np.isnan(c.k1).all()
    assert c.irregular.tolist() == [True, False]


@pytest.mark.parametrize("scale", [2.0**-200, 2.0**200])
def test_average_is_that_of_any_scale(scale):
    positions, faces = rough(shapes.cube())
    for name in ("k1", "k2"):
        one, other = (
            getattr(
                ls.LimitSurface(ls.ControlMesh.from_faces(at, faces)).curvature(
                    0, [[0, 0]], irregular="average"
                ),
                name,
            )
            for at in (positions, scale * positions)
        )
        np.testing.assert_allclose(other * scale, one, rtol=1e-12)


def test_average_of_faces_that_have_no_surface_is_that_of_the_others():
    positions, faces = rough(shapes.cube())
    holed = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces, holes=[0]))
    groups = [[at for at in sector if at[0] != 0] for sector in sectors(faces)]
    for sector in groups:
        corners = [(f, c, True) for f, c in sector]
        c = holed.curvature(corners[0][0], CORNERS[[corners[0][1]]], irregular="average")
        expected, _ = mean_by_hand(holed, corners, 1 / 64)
        assert c.mean[0] == pytest.approx(np.trace(expected) / 2)


@pytest.mark.parametrize("radius", [0, -0.1, 0.5000001, np.inf, np.nan])
@pytest.mark.parametrize("irregular", ["none", "average"])
def test_other_radii_are_value_errors(cube, irregular, radius):
    for uv in ([[0, 0]], np.zeros((0, 2))):
        with pytest.raises(ValueError, match="radius is"):
            cube.curvature(0, uv, irregular=irregular, radius=radius)


def test_other_rules_are_errors(cube):
    with pytest.raises(ls.MeshError, match="'none' or 'average'"):
        cube.curvature(0, [[0, 0]], irregular="nearest")


def test_averages_are_the_same_on_any_number_of_threads():
    surface, _, _ = made("house")
    at = surface.vertex_locations()
    one = surface.curvature(at.face, at.uv, irregular="average", threads=1)
    for threads in (0, 2):
        many = surface.curvature(at.face, at.uv, irregular="average", threads=threads)
        np.testing.assert_array_equal(one.k1, many.k1)
        np.testing.assert_array_equal(one.direction2, many.direction2)
    for i in range(len(at.face)):
        alone = surface.curvature(at.face[i], at.uv[[i]], irregular="average")
        np.testing.assert_array_equal(alone.k1, one.k1[[i]])
