# SPDX-License-Identifier: Apache-2.0
"""Matrices and frames of any size: times a power of two, they give the same directions to the bit,
up to the ends of double's range. Products of three lengths end at its cube root.
"""

import limitsurf as ls
import numpy as np
import projectors
import pytest
import shapes

EXPONENTS = (-1000, -600, -390, -170, 130, 180, 390, 600, 1000)
SEED = 5
TEXEL = (1 / 64, 1 / 32)
SHEAR = np.array([[1, 0.2, 0], [0, 1.1, 0.1], [0.1, 0, 0.7]])
MIRROR = SHEAR @ np.diag([1.0, 1, -1])
EYE = np.array([[1.2, 0.1, 0.3, 0], [-0.2, 1.1, 0.4, 0], [0.1, 0.3, -0.9, 3], [0, 0.1, -1, 6]])

at_all_scales = pytest.mark.parametrize("exponent", EXPONENTS)


def affine(linear, exponent):
    matrix = np.eye(4)
    matrix[:3, :3] = np.ldexp(linear, exponent)
    return matrix


def places(surface, count=60):
    rng = np.random.default_rng(SEED)
    uv = rng.random((count, 2))
    uv[::7] = np.round(uv[::7])
    return np.resize(np.arange(len(surface.base_face)), count), uv


def own_frames():
    return ls.rotation_matrices(np.random.default_rng(SEED).normal(size=(50, 4)))


@at_all_scales
@pytest.mark.parametrize("linear", [SHEAR, MIRROR, np.diag([1.0, 1, 2])])
def test_frames_in_the_world(exponent, linear):
    expected = ls.frames_in_world(own_frames(), linear)
    found = ls.frames_in_world(own_frames(), np.ldexp(linear, exponent))
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("sizes", [(1e200, 1, 1e-100), (1e-200, 1e-200, 1), (1e-160, 1e140, 3)])
@pytest.mark.parametrize("turned", ["before", "after"])
def test_frames_in_a_world_with_axes_of_different_sizes(sizes, turned):
    turn = ls.rotation_matrices([[1.0, 2, 3, 4]])[0]
    squeeze = np.diag(sizes)
    linear = squeeze @ turn if turned == "before" else turn @ squeeze
    tangent, _, normal = np.moveaxis(ls.frames_in_world(own_frames(), linear), 2, 0)
    for unit in (tangent, normal):
        np.testing.assert_allclose(np.linalg.norm(unit, axis=1), 1, atol=1e-15)


def test_a_flat_world_has_no_normals():
    found = ls.frames_in_world(own_frames(), np.diag([1e200, 0, 1]))
    assert np.isfinite(found[:, :, 0]).all()
    assert np.isnan(found[:, :, 2]).all()


@at_all_scales
def test_boxes(exponent):
    normals = np.random.default_rng(SEED).normal(size=(50, 3))
    box, scaled = affine(SHEAR, 0), affine(SHEAR, exponent)
    expected = ls.box_weights(normals, 0.5, box)
    np.testing.assert_array_equal(ls.box_weights(normals, 0.5, scaled), expected)
    sides = ls.box_sides(scaled)
    sides[:, :3, :3] = np.ldexp(sides[:, :3, :3], -exponent)
    np.testing.assert_array_equal(sides, ls.box_sides(box))


def test_boxes_with_sides_of_different_sizes():
    weights = ls.box_weights([[0.0, 0, 1], [0, 1, 1]], 0.5, np.diag([1e200, 1, 1e-100, 1]))
    np.testing.assert_array_equal(weights, [[0, 0, 0, 0, 1, 0]] * 2)
    with pytest.raises(ValueError, match="^matrix is singular$"):
        ls.box_sides(np.diag([1e200, 1, 0, 1]))


def shading(count=50):
    """Vectors, normals, tangents and signs."""
    rng = np.random.default_rng(SEED)
    return *rng.normal(size=(3, count, 3)), np.where(rng.random(count) < 0.5, -1.0, 1.0)


def unit(vectors):
    """For vectors as long as numbers go."""
    vectors = vectors / np.abs(vectors).max(axis=1, keepdims=True)
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


@at_all_scales
def test_tangents_of_any_length(exponent):
    vectors, normals, tangents, signs = shading()
    long = np.ldexp(tangents, exponent)
    # What stands for the tangent and the bitangent shrinks as they grow.
    shrink = np.ldexp([1.0, 1, 0], -exponent) + [0, 0, 1]
    expected = unit(shrink * ls.into_shading_frames(vectors, normals, tangents, signs))
    found = ls.into_shading_frames(vectors, normals, long, signs)
    np.testing.assert_allclose(found, expected, rtol=1e-15)
    grow = np.ldexp([1.0, 1, 0], exponent) + [0, 0, 1]
    back = ls.out_of_shading_frames(vectors, normals, long, signs)
    expected = ls.out_of_shading_frames(unit(grow * vectors), normals, tangents, signs)
    np.testing.assert_allclose(back, expected, rtol=1e-12)


@at_all_scales
def test_shading_frames_of_any_size(exponent):
    vectors, normals, tangents, signs = shading()
    frames = (np.ldexp(normals, exponent), np.ldexp(tangents, -exponent), signs)
    there = ls.into_shading_frames(np.ldexp(vectors, exponent), *frames)
    np.testing.assert_allclose(np.linalg.norm(there, axis=1), 1, atol=1e-15)
    back = ls.out_of_shading_frames(there, *frames)
    # The components differ by up to 2^2000: what is smaller than 2^-1022 of the largest is lost.
    if abs(exponent) < 500:
        np.testing.assert_allclose(back, unit(vectors), atol=1e-12)


def same_picture(found, expected):
    for name in ("st", "footprint", "weight"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), name)


@at_all_scales
def test_projections_from_an_eye(exponent):
    surface, uv_map = projectors.sheet(height=0.1)

    def picture(of_matrix, of_world):
        return surface.project(
            uv_map, *places(surface), np.ldexp(EYE, of_matrix), TEXEL, world=affine(SHEAR, of_world)
        )

    expected = picture(0, 0)
    assert 0 < expected.weight.max() <= 1
    same_picture(picture(0, exponent), expected)
    same_picture(picture(exponent, 0), expected)


def along_normals(surface_exponent, source_exponent, world_exponent):
    surface, uv_map = projectors.sheet(height=0.1)
    source, source_map = projectors.sheet(3, 4, height=-0.15, seed=2)
    surface.set_positions(np.ldexp(surface.positions, surface_exponent))
    moved = 0.9 * source.positions + [0.1, 0, 0.5]
    source.set_positions(np.ldexp(moved, source_exponent))
    return surface.project_along_normals(
        uv_map, *places(surface), source, source_map, TEXEL,
        transform=affine(np.eye(3), source_exponent - surface_exponent),
        world=affine(SHEAR, world_exponent),
        max_distance=0.7 * 2.0 ** (surface_exponent + world_exponent),
    )  # fmt: skip


@pytest.mark.parametrize(
    "exponents",
    [
        *((0, 0, exponent) for exponent in EXPONENTS),
        (0, 300, 0), (-300, 300, 0), (390, -390, 0), (-390, 390, 500), (390, -390, -500),
    ],
)  # fmt: skip
def test_projections_along_normals(exponents):
    expected = along_normals(0, 0, 0)
    assert 0.3 < expected.weight.mean() < 1
    same_picture(along_normals(*exponents), expected)


def test_a_transform_that_leads_too_far_is_named():
    surface, uv_map = projectors.sheet()
    with pytest.raises(ValueError, match=r"^transform takes the place \(.*too far from the source"):
        surface.project_along_normals(
            uv_map, [0], [[0.5, 0.5]], surface, uv_map, TEXEL, transform=affine(SHEAR, 1000)
        )


@at_all_scales
@pytest.mark.parametrize("linear", [SHEAR, MIRROR])
def test_posed_strands(exponent, linear):
    positions, faces = shapes.ALL["house"]
    rng = np.random.default_rng(SEED)
    bent = positions + 0.1 * rng.normal(size=positions.shape)
    vectors = rng.normal(size=(60, 3)).astype(np.float32)
    rotations = ls.rotation_matrices(rng.normal(size=(60, 4)))

    def posed(of_surface, of_matrix):
        surface = ls.LimitSurface(ls.ControlMesh.from_faces(np.ldexp(bent, of_surface), faces))
        poser = surface.strand_poser(*places(surface), np.zeros((60, 3)), rotations)
        return [
            function(vectors, affine(linear, of_matrix))
            for function in (poser.pose, poser.pose_vectors)
        ]

    expected = posed(0, 0)
    np.testing.assert_array_equal(posed(0, exponent)[1], expected[1])
    if abs(exponent) < 395:  # as far as coordinates go
        np.testing.assert_array_equal(posed(-exponent, exponent), expected)
