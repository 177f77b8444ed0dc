# SPDX-License-Identifier: Apache-2.0
"""Uniform and blue-noise scattering by the area of the limit surface."""

import ctrl_c
import limitsurf as ls
import numpy as np
import pytest
import shapes


def bent(surface):
    """The surface in another pose: faces have different sizes, and the area varies within them."""
    p = surface.positions
    x, y = p[:, 0], p[:, 1]
    surface.set_positions(np.stack([x + 0.2 * x**2, y + 0.3 * x, p[:, 2] + 0.3 * y**2], axis=1))
    return surface


def triangle_areas(surface, levels):
    """The area of each Ptex face, from a fine tessellation, which the sampler does not use."""
    mesh = surface.tessellate(levels)
    # No point that a face shares with others tells it: the face is that of a point just inside.
    a, b, c, d = np.moveaxis(mesh.positions[mesh.faces], 1, 0)
    area = (
        np.linalg.norm(np.cross(b - a, c - a), axis=1)
        + np.linalg.norm(np.cross(c - a, d - a), axis=1)
    ) / 2
    inner = surface.closest((a + b + c + d) / 4).face
    return np.bincount(inner, weights=area, minlength=surface.face_count)


def distances(surface, at, radius):
    """The smallest distance of all pairs that see each other, divided by their mean radius."""
    s = surface.evaluate(at.face, at.uv, derivatives=1)
    gaps = np.linalg.norm(s.position[:, None] - s.position[None], axis=2)
    radius = np.broadcast_to(radius, len(at))
    gaps /= (radius[:, None] + radius[None]) / 2
    blind = s.normal @ s.normal.T <= 1e-8
    gaps[blind | np.eye(len(at), dtype=bool)] = np.inf
    return gaps.min()


def same(a, b):
    return np.array_equal(a.face, b.face) and np.array_equal(a.uv, b.uv)


def test_uniform_gives_locations(surface):
    at = surface.scatter_uniform(1000)
    assert isinstance(at, ls.Locations)
    assert at.face.shape == (1000,)
    assert at.face.dtype == np.int32
    assert at.uv.shape == (1000, 2)
    assert at.uv.dtype == np.float64
    assert at.uv.min() >= 0
    assert at.uv.max() <= 1
    assert len(surface.scatter_uniform(0)) == 0


def test_uniform_goes_by_area(surface):
    surface = bent(surface)
    count = 200_000
    expected = triangle_areas(surface, 5)
    expected *= count / expected.sum()
    got = np.bincount(surface.scatter_uniform(count, 5).face, minlength=surface.face_count)
    freedom = surface.face_count - 1
    chi = ((got - expected) ** 2 / expected).sum()
    assert abs(chi - freedom) < 5 * np.sqrt(2 * freedom) + 2


def test_uniform_follows_the_pose(cube):
    before = cube.scatter_uniform(60_000, 1)
    assert np.allclose(np.bincount(before.face), 10_000, atol=500)
    cube.set_positions(cube.positions * [1, 1, 10])
    after = np.bincount(cube.scatter_uniform(60_000, 1).face)
    area = triangle_areas(cube, 5)
    assert area[2] > 1.5 * area[0]
    assert np.allclose(after, 60_000 * area / area.sum(), rtol=0.05)


def test_seeds_and_prefixes(surface):
    for density in (None, np.arange(len(surface.positions)) % 3):
        ten = surface.scatter_uniform(10, 3, density)
        more = surface.scatter_uniform(5000, 3, density, threads=1)
        assert same(ten, ls.Locations(more.face[:10], more.uv[:10]))
        assert not same(ten, surface.scatter_uniform(10, 4, density))
    noise = surface.scatter_blue_noise(count=500, seed=3)
    assert same(noise, surface.scatter_blue_noise(count=500, seed=3, threads=1))
    assert not same(noise, surface.scatter_blue_noise(count=500, seed=4))


UNIFORM_COUNTS = [183, 136, 156, 173, 180, 172]
UNIFORM_FIRST = ["0x1.cc4ce7b01f9bcp-2", "0x1.418c19fb8b42ep-1"]
BLUE_NOISE_COUNTS = [110, 106, 105, 105, 105, 110]
BLUE_NOISE_FIRST = ["0x1.05c52ef45b407p-2", "0x1.5bfeeb76dcf20p-5"]


def test_the_same_on_every_machine(cube):
    # These values are fixed: a seed gives these places on every machine.
    at = cube.scatter_uniform(1000, 2**64 - 1)
    assert np.bincount(at.face).tolist() == UNIFORM_COUNTS
    assert [x.hex() for x in at.uv[0]] == UNIFORM_FIRST
    noise = cube.scatter_blue_noise(radius=0.05, seed=7)
    assert np.bincount(noise.face).tolist() == BLUE_NOISE_COUNTS
    assert [x.hex() for x in noise.uv[0]] == BLUE_NOISE_FIRST


@pytest.mark.parametrize("count", [1, 2, 17, 1000])
def test_blue_noise_of_a_count(surface, count):
    noise = bent(surface).scatter_blue_noise(count=count, seed=2)
    assert isinstance(noise, ls.BlueNoise)
    assert isinstance(noise, ls.Locations)
    assert len(noise) == count
    assert noise.uv.shape == (count, 2)
    assert isinstance(noise.radius, float)
    assert noise.radius > 0
    assert distances(surface, noise, noise.radius) >= 1
    assert np.all(np.diff(noise.face) >= 0)


def test_blue_noise_of_a_radius_is_maximal(surface):
    surface = bent(surface)
    radius = np.sqrt(0.7 * surface.area() / 400)
    noise = surface.scatter_blue_noise(radius=radius)
    assert noise.radius == radius
    assert distances(surface, noise, radius) >= 1
    points = surface.evaluate(noise.face, noise.uv, derivatives=1)
    trials = surface.scatter_jittered(60, 9)
    tried = surface.evaluate(trials.face, trials.uv, derivatives=1)
    for rows in np.array_split(np.arange(len(trials)), 1 + len(trials) // 2000):
        gap = np.linalg.norm(tried.position[rows, None] - points.position[None], axis=2)
        sees = tried.normal[rows] @ points.normal.T > -0.01
        assert np.all(((gap < radius * (1 + 1 / 512)) & sees).any(axis=1))


def test_blue_noise_of_none(cube):
    noise = cube.scatter_blue_noise(count=0)
    assert len(noise) == 0
    assert noise.radius == np.inf


def test_density_by_vertex_weights(cube):
    weights = np.zeros(8)
    weights[[0, 1, 2, 3]] = 1  # the bottom face
    at = cube.scatter_uniform(60_000, density=weights)
    got = np.bincount(at.face, minlength=6)
    assert got[1] == 0
    # Beside the bottom the weight is linear; by symmetry it covers half of a face's area there.
    assert np.isclose(got[0] / got[2:].mean(), 2, rtol=0.05)
    noise = cube.scatter_blue_noise(count=3000, density=weights)
    weight = cube.varying(weights).evaluate(noise.face, noise.uv).value[:, 0]
    assert weight.min() > 0
    assert distances(cube, noise, noise.radius / np.sqrt(weight)) >= 1


def test_density_by_function(cube):
    def density(face, uv):
        assert face.dtype == np.int32
        assert uv.dtype == np.float64
        assert uv.shape == (len(face), 2)
        return (face == 2) * uv[:, 0] > 0.5

    for at in (
        cube.scatter_uniform(5000, density=density),
        cube.scatter_blue_noise(count=2000, density=density),
        cube.scatter_blue_noise(radius=0.03, density=density),
    ):
        assert len(at) > 20
        assert np.all(at.face == 2)
        assert at.uv[:, 0].min() > 0.5
        assert at.uv[:, 0].max() > 0.9
    mean = cube.scatter_uniform(100_000, density=lambda face, uv: 3 * uv[:, 1] ** 2).uv.mean(axis=0)
    assert np.isclose(mean[0], 0.5, atol=0.01)
    assert 0.68 < mean[1] < 0.75


def test_limits_save_candidates_of_a_function(cube):
    asked = []

    def density(face, uv):
        asked.append(len(face))
        return ((face == 2) & (np.abs(uv - 0.5).max(axis=1) < 0.125)).astype(float)

    limits = np.zeros((cube.face_count, 4, 4))
    limits[2, 1:3, 1:3] = 1
    at = cube.scatter_uniform(3000, 4, density, density_limits=limits)
    assert sum(asked) < 20_000
    assert (density(at.face, at.uv) == 1).all()
    # The face is symmetric, and so are the counts in the quarters of the spot.
    quarter = (at.uv > 0.5) @ [1, 2]
    assert np.abs(np.bincount(quarter) - 750).max() < 5 * np.sqrt(750)
    few = cube.scatter_uniform(10, 4, density, density_limits=limits)
    assert (few.uv == at.uv[:10]).all()


@pytest.mark.parametrize(
    ("density", "limits", "message"),
    [
        (None, np.ones(6), "density is not a function"),
        (np.ones(8), np.ones(6), "density is not a function"),
        (lambda f, _uv: np.ones(len(f)), np.ones((6, 2)), r"has shape \(6, 2\)"),
        (lambda f, _uv: np.ones(len(f)), np.ones((6, 3, 3)), "3 squares .* power of two"),
        (lambda f, _uv: np.ones(len(f)), np.ones(5), "5 faces; the surface has 6"),
        (
            lambda f, _uv: np.ones(len(f)),
            [1, 1, -1, 1, 1, 1],
            "density_limits is -1 at face 2, row 0, column 0",
        ),
        (lambda f, _uv: np.ones(len(f)), np.zeros(6), "density is 0 (everywhere|at all of)"),
        (lambda f, _uv: f * 1.0, np.full(6, 4.5), r"density is 5 at face 5, .* limit .* is 4\.5"),
    ],
)
def test_limits_are_checked(cube, density, limits, message):
    with pytest.raises(ValueError, match=message):
        cube.scatter_uniform(100, 1, density, density_limits=limits)
    with pytest.raises(ValueError, match=message):
        cube.scatter_blue_noise(count=100, density=density, density_limits=limits)


def test_interpolated_weights_round(cube):
    sheet = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.grid(3, 3)))
    weights = np.random.default_rng(3).random(16)
    weights[np.random.default_rng(3).random(16) < 0.5] = 0
    data = sheet.varying(weights)
    lowest = []

    def density(face, uv):
        values = data.evaluate(face, uv).value[:, 0]
        lowest.append(values.min())
        return values

    found = sheet.scatter_blue_noise(radius=0.1, density=density)
    assert min(lowest) < 0  # or these weights test nothing
    assert (data.evaluate(found.face, found.uv).value > 0).all()

    cube.scatter_uniform(1000, density=lambda face, _uv: np.where(face > 0, 1.0, -1e-13))
    with pytest.raises(ValueError, match="density is -1e-11 at face 0"):
        cube.scatter_uniform(1000, density=lambda face, _uv: np.where(face > 0, 1.0, -1e-11))


@pytest.mark.parametrize("count", [3, 5000])
@pytest.mark.parametrize("limit", [1e12, 1e308])
def test_limits_far_above_the_density(cube, count, limit):
    def density(face, uv):
        return np.full(len(face), 0.25)

    with pytest.raises(ValueError, match="^density_limits go up to 1[e0].* up to 0.25, "):
        cube.scatter_uniform(count, 1, density, density_limits=np.full(6, limit))


def test_a_density_that_is_small_nearly_everywhere(cube):
    def density(face, uv):
        return np.where((face == 4) & (uv == 0.5).all(1), 1e12, 1.0)

    with pytest.raises(ValueError, match="^density is too small on nearly all of the surface"):
        cube.scatter_uniform(3, 1, density)


def test_only_ratios_of_densities_matter(cube):
    weights = np.arange(8.0)
    expected = cube.scatter_uniform(50, 1, weights)
    for unit in (2.0**-1000, 2.0**1000):
        np.testing.assert_array_equal(cube.scatter_uniform(50, 1, unit * weights).uv, expected.uv)
    assert len(cube.scatter_blue_noise(count=10, density=np.full(8, 1e308)).face) == 10


def test_limits_do_not_change_blue_noise(cube):
    asked = []

    def density(face, uv):
        asked.append(len(face))
        return np.where(face == 2, uv[:, 0], 0.0)

    without = cube.scatter_blue_noise(count=300, density=density)
    before = sum(asked)
    limits = np.zeros((cube.face_count, 2, 2))
    limits[2] = [0.5, 1]
    found = cube.scatter_blue_noise(count=300, density=density, density_limits=limits)
    assert (found.uv == without.uv).all()
    assert found.radius == without.radius
    assert sum(asked) - before < before / 3


def test_a_density_may_evaluate_the_surface(cube):
    def upwards(face, uv):
        return np.maximum(cube.evaluate(face, uv, derivatives=1).normal[:, 2], 0)

    for at in (
        cube.scatter_uniform(20_000, density=upwards),
        cube.scatter_blue_noise(count=1000, density=upwards),
    ):
        assert np.all(cube.evaluate(at.face, at.uv, derivatives=1).normal[:, 2] > 0)


def test_a_density_cannot_repose_the_surface(cube):
    def density(face, uv):
        cube.set_positions(cube.positions)
        return uv[:, 0]

    for scatter in (cube.scatter_uniform, cube.scatter_blue_noise):
        with pytest.raises(RuntimeError, match="in use by a call that has itself called"):
            scatter(count=10, density=density)
    cube.set_positions(2 * cube.positions)  # afterwards it can be


@pytest.mark.parametrize("call", ["scatter_uniform", "scatter_blue_noise"])
class TestErrors:
    def scatter(self, surface, call, **more):
        return getattr(surface, call)(**{"count": 100, **more})

    @pytest.mark.parametrize(
        ("density", "text"),
        [
            (np.ones(7), "7 weights; the mesh has 8 vertices"),
            (np.ones((8, 1)), r"shape \(8, 1\)"),
            (-np.ones(8), "density is -1 at vertex 0"),
            ([0, 1, 1, 1, 1, 1, np.nan, 1], "density is nan at vertex 6"),
            ([0, 1, 1, 1, 1, np.inf, 1, 1], "density is inf at vertex 5"),
            (np.zeros(8), "density is 0 everywhere"),
            (lambda face, uv: 0 * uv[:, 0], "density is 0"),
            (lambda face, uv: uv[:, 0] - 2, r"density is -2 at face 0, \(u, v\) = \(0, 0\)"),
            (lambda face, uv: uv, r"density returned shape \(\d+, 2\)"),
            (lambda face, uv: 1.0, r"density returned shape \(\)"),
        ],
    )
    def test_densities(self, cube, call, density, text):
        with pytest.raises(ValueError, match=text):
            self.scatter(cube, call, density=density)

    def test_types(self, cube, call):
        with pytest.raises(TypeError, match="density"):
            self.scatter(cube, call, density="dense")
        with pytest.raises(TypeError, match="density's result"):
            self.scatter(cube, call, density=lambda face, uv: ["dense"] * len(face))
        with pytest.raises(TypeError, match="progress is not callable"):
            self.scatter(cube, call, progress=3)
        with pytest.raises(TypeError):
            self.scatter(cube, call, count=2.5)

    def test_numbers(self, cube, call):
        with pytest.raises(ValueError, match="count is -1"):
            self.scatter(cube, call, count=-1)
        with pytest.raises(ValueError, match="threads is -1"):
            self.scatter(cube, call, threads=-1)

    def test_what_a_function_raises(self, cube, call):
        def density(face, uv):
            raise KeyError("lost")

        with pytest.raises(KeyError, match="lost"):
            self.scatter(cube, call, density=density)

    def test_no_area(self, call):
        positions, faces = shapes.grid(2, 2)
        flat = ls.LimitSurface(ls.ControlMesh.from_faces(0 * positions, faces))
        with pytest.raises(ValueError, match="no area"):
            self.scatter(flat, call)

    def test_progress(self, cube, call):
        told = []
        self.scatter(cube, call, count=60_000, progress=told.append)
        assert len(told) > 1
        assert told[-1] == 1
        assert all(0 <= a <= b <= 1 for a, b in zip(told, told[1:], strict=False))

        def stop(part):
            if part > 0.2:
                raise RuntimeError("enough")

        with pytest.raises(RuntimeError, match="enough"):
            self.scatter(cube, call, count=60_000, progress=stop)


def test_blue_noise_takes_a_count_or_a_radius(cube):
    for numbers in ({}, {"count": 3, "radius": 0.1}):
        with pytest.raises(ValueError, match="exactly one of count and radius"):
            cube.scatter_blue_noise(**numbers)
    for radius in (0, -1, np.nan, np.inf):
        with pytest.raises(ValueError, match="radius is"):
            cube.scatter_blue_noise(radius=radius)
    with pytest.raises(ValueError, match="about .* points would come out"):
        cube.scatter_blue_noise(radius=1e-6)


@pytest.mark.parametrize(
    "call",
    [
        "scatter_uniform(2 * 10**7)",
        pytest.param("scatter_blue_noise(count=3 * 10**6)", marks=pytest.mark.slow),
        "scatter_uniform(10**7, density=lambda face, uv: 1e-9 + (face == 7))",
    ],
)
def test_ctrl_c_ends_it(call):
    program = f"""
import limitsurf as ls, shapes
surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.cube()))
surface.scatter_uniform(1)
print("ready", flush=True)
surface.{call}
"""
    assert "KeyboardInterrupt" in ctrl_c.errors_of(program)
