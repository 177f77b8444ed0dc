# SPDX-License-Identifier: Apache-2.0
"""Tangent frames and distortion of UV maps, compared with differences along the map."""

import limitsurf as ls
import numpy as np
import pytest
import shapes

STEP = 2e-5


@pytest.fixture
def mapped():
    """A bent sheet and a map without overlaps and seams."""
    rng = np.random.default_rng(3)
    positions, faces = shapes.grid(4, 3)
    uv = positions[:, :2] * (0.2, 0.25) + rng.uniform(-0.03, 0.03, (len(positions), 2)) + 0.1
    positions[:, 2] = np.sin(positions[:, 0]) + 0.3 * positions[:, 1] ** 2
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    return surface, surface.face_varying(uv, faces.ravel(), "none")


def along(surface, uv_map, at, axis):
    """dP/dU or dP/dV, from positions at which the map has slightly larger and smaller values."""
    step = STEP * np.eye(2)[axis]
    here = uv_map.evaluate(at.face, at.uv).value
    ends = [uv_map.locate(here + s * step) for s in (1, -1)]
    inside = (ends[0].face >= 0) & (ends[1].face >= 0)
    after, before = (surface.evaluate(e.face[inside], e.uv[inside]).position for e in ends)
    return inside, (after - before) / (2 * STEP)


@pytest.mark.parametrize("mirrored", [False, True])
def test_tangents_point_where_the_map_grows(mapped, mirrored):
    surface, uv_map = mapped
    if mirrored:
        positions, faces = shapes.grid(4, 3)
        values = positions[:, :2] * (-0.2, 0.25) + (0.9, 0.1)
        uv_map = surface.face_varying(values, faces.ravel(), "none")
    at = surface.scatter_jittered(4, 1)
    frames = surface.tangent_frames(uv_map, at.face, at.uv)
    normal = surface.evaluate(at.face, at.uv, 1).normal
    np.testing.assert_allclose(frames[:, :, 2], normal, atol=1e-12)
    for axis in (0, 1):
        inside, moved = along(surface, uv_map, at, axis)
        assert inside.sum() > 100
        if axis == 0:
            unit = moved / np.linalg.norm(moved, axis=1, keepdims=True)
            np.testing.assert_allclose(frames[inside, :, 0], unit, atol=1e-5)
        else:  # on the side of the bitangent
            assert (np.einsum("ni,ni->n", frames[inside, :, 1], moved) > 0).all()
    assert (np.sign(np.linalg.det(frames)) == (-1 if mirrored else 1)).all()


def test_distortion_by_differences(mapped):
    surface, uv_map = mapped
    at = surface.scatter_jittered(4, 2)
    found = surface.map_distortion(uv_map, at.face, at.uv)
    (inside, by_u), (inside_v, by_v) = (along(surface, uv_map, at, axis) for axis in (0, 1))
    both = inside & inside_v
    by_u, by_v = by_u[both[inside]], by_v[both[inside_v]]
    values = np.linalg.svd(np.stack([by_u, by_v], axis=2), compute_uv=False)
    np.testing.assert_allclose(found.stretch_high[both], values[:, 0], rtol=1e-5)
    np.testing.assert_allclose(found.stretch_low[both], values[:, 1], rtol=1e-5)
    area = np.linalg.norm(np.cross(by_u, by_v), axis=1)
    np.testing.assert_allclose(found.area[both], area, rtol=1e-5)


def test_area_ratios_add_up_to_the_area(mapped):
    """The mean area ratio of the map's texels, times their area, is the area of the surface."""
    surface, uv_map = mapped
    texels = uv_map.rasterize(400, 400)
    ratio = surface.map_distortion(uv_map, texels.face, texels.uv).area
    assert ratio.sum() / 400**2 == pytest.approx(surface.area(), rel=5e-3)


def test_always_finite_frames():
    positions, faces = shapes.house()
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    corners = [0, 1]
    face = np.repeat(np.arange(surface.face_count), 4)
    uv = np.tile([[u, v] for u in corners for v in corners], (surface.face_count, 1))
    for uv_map in (
        surface.vertex_data(positions[:, :2]),
        surface.vertex_data(np.zeros((len(positions), 2))),
        surface.varying(positions[:, 1:]),
    ):
        frames = surface.tangent_frames(uv_map, face, uv)
        gram = np.einsum("nji,njk->nik", frames, frames)
        np.testing.assert_allclose(gram, np.broadcast_to(np.eye(3), gram.shape), atol=1e-13)


def test_errors_and_types(mapped):
    surface, uv_map = mapped
    at = surface.scatter_jittered(2, 1)
    with pytest.raises(ValueError, match="uv_map has 3 columns"):
        surface.tangent_frames(surface.vertex_data(surface.positions), at.face, at.uv)
    other = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.cube()))
    with pytest.raises(ValueError, match="uv_map has 12 Ptex faces and the surface 6"):
        other.tangent_frames(uv_map, [0], [[0.5, 0.5]])
    with pytest.raises(ls.LocationError):
        surface.map_distortion(uv_map, [99], [[0, 0]])
    single = surface.tangent_frames(uv_map, at.face, at.uv, dtype="float32")
    assert single.dtype == np.float32
    assert surface.tangent_frames(uv_map, [], np.empty((0, 2))).shape == (0, 3, 3)
    assert surface.map_distortion(uv_map, [], np.empty((0, 2))).area.shape == (0,)
    one, two = (surface.tangent_frames(uv_map, at.face, at.uv, threads=n) for n in (1, 2))
    np.testing.assert_array_equal(one, two)
    with pytest.raises(ValueError, match="threads"):
        surface.map_distortion(uv_map, at.face, at.uv, threads=-1)


def shading(seed, n=200):
    """Interpolated frames, neither of unit length nor orthogonal, with both signs."""
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(n, 3)) * rng.uniform(0.3, 1, (n, 1))
    tangents = np.cross(normals, rng.normal(size=(n, 3))) + 0.1 * rng.normal(size=(n, 3))
    return normals, tangents, rng.choice([-1.0, 1.0], n)


def test_shading_frames_and_back():
    normals, tangents, signs = shading(1)
    rng = np.random.default_rng(2)
    wanted = rng.normal(size=(200, 3))
    wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
    told = ls.into_shading_frames(wanted, normals, tangents, signs)
    np.testing.assert_allclose(np.linalg.norm(told, axis=1), 1, atol=1e-14)
    # The formula of renderers
    across = signs[:, None] * np.cross(normals, tangents)
    found = told[:, :1] * tangents + told[:, 1:2] * across + told[:, 2:] * normals
    found /= np.linalg.norm(found, axis=1, keepdims=True)
    np.testing.assert_allclose(found, wanted, atol=1e-10)
    back = ls.out_of_shading_frames(told, normals, tangents, signs)
    np.testing.assert_allclose(back, wanted, atol=1e-10)


def test_shading_frames_without_volume_and_errors():
    normals, _, signs = shading(3, 4)
    flat = ls.into_shading_frames(normals, normals, normals, signs)
    np.testing.assert_array_equal(flat, np.tile([0, 0, 1.0], (4, 1)))
    with pytest.raises(ValueError, match="tangents has 3 rows; expected 4"):
        ls.into_shading_frames(normals, normals, normals[:3], signs)
    with pytest.raises(ValueError, match=r"vectors has shape \(4, 2\)"):
        ls.out_of_shading_frames(normals[:, :2], normals, normals, signs)
