# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's answers, found by brute force, and its table."""

import bench_blender
import bench_blender_truth as truth
import bpy
import limitsurf
import numpy as np
import pytest
from limit_surface.reading import cage
from mathutils.bvhtree import BVHTree


@pytest.fixture
def sheet():
    ob = truth.add_sheet(12)
    ob.modifiers[0].levels = 4
    found = cage.read(ob, bpy.context.evaluated_depsgraph_get())
    return ob, found, limitsurf.LimitSurface(found.mesh)


def fine_tree(surface):
    fine = surface.tessellate(6)
    return BVHTree.FromPolygons(
        np.asarray(fine.positions).tolist(), np.asarray(fine.faces).tolist()
    )


@pytest.mark.slow
def test_rays_are_steeper_than_the_surface(sheet):
    _, _, surface = sheet
    rng = np.random.default_rng(1)
    at = rng.integers(0, surface.face_count, 20_000), rng.random((20_000, 2))
    normal = surface.frames(*at)[:, :, 2]
    assert (np.linalg.norm(normal[:, :2], axis=1) / normal[:, 2]).max() < truth.SLOPE
    rays = truth.rays(surface, 300)
    steepness = -rays.direction[:, 2] / np.linalg.norm(rays.direction[:, :2], axis=1)
    assert steepness.min() > truth.SLOPE
    tree = fine_tree(surface)
    for origin, direction, hit in zip(*rays, strict=True):
        np.testing.assert_allclose(tree.ray_cast(origin, direction)[0], hit, atol=1e-3)


@pytest.mark.slow
def test_brute_force_finds_the_nearest_points(sheet):
    ob, found, surface = sheet
    points = truth.points_nearby(surface, 100)
    tree = BVHTree.FromObject(ob, bpy.context.evaluated_depsgraph_get())
    nearest = truth.nearest(surface, found.face_sizes, tree, points)
    distance = np.linalg.norm(nearest - points, axis=1)
    fine = fine_tree(surface)
    expected = np.array([fine.find_nearest(point)[3] for point in points.tolist()])
    np.testing.assert_allclose(distance, expected, atol=1e-4)
    on_surface = [fine.find_nearest(point)[3] for point in nearest.tolist()]
    assert max(on_surface) < 1e-4


@pytest.mark.slow
def test_table(capsys):
    bench_blender.main(["--faces", "150", "--queries", "1000", "--tree-queries", "600"])
    printed = capsys.readouterr().out
    rows = [line.split("|")[1:-1] for line in printed.splitlines() if line.startswith("|")]
    largest = [(row[0].strip(), float(row[3])) for row in rows if "e-" in row[3]]
    assert [name for name, _ in largest] == 2 * [
        "limit surface, one core",
        "limit surface, all cores",
        "BVHTree, level 1",
        "BVHTree, level 4",
    ]
    for name, error in largest:
        assert (error < 1e-12) if "limit" in name else (error > 1e-7)
    assert "missed" not in printed.split("rays")[1].split("BVHTree")[0]
