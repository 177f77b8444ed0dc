# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Subdivision Surface at its best quality shows the surface that limitsurf evaluates."""

import bpy
import numpy as np
import pytest
import scenes
from figures.parity import zoo as parity_zoo
from figures.parity.distances import Comparison
from limit_surface import ids
from limit_surface.reading import attributes, rules, uv_map

BEST = 10
BOUND = 1e-6  # as a share of the diagonal, or on the UV map; Blender computes in single precision
LEVELS = 3
#: The monkey, the largest mesh, is among the slow tests where many settings are tried.
FAST = [*(name for name in parity_zoo.MESHES if name != "monkey"), *scenes.slow("monkey")]
CREASED = [kind for kind in parity_zoo.CREASES if kind != "none"]


def subdivided(name, kind="none", boundary="ALL", **settings):
    ob = parity_zoo.add(name)
    parity_zoo.crease(ob.data, kind)
    ob.modifiers[0].boundary_smooth = boundary
    for key, value in settings.items():
        setattr(ob.modifiers[0], key, value)
    return ob


@pytest.mark.parametrize("boundary", rules.BOUNDARIES)
@pytest.mark.parametrize("name", parity_zoo.MESHES)
def test_smooth_meshes(name, boundary):
    found = Comparison(subdivided(name, boundary=boundary), LEVELS)
    distance = found.positions(BEST)
    assert np.count_nonzero(np.isnan(distance)) == (1 if name == "fans" else 0)  # isolated
    assert np.nanmax(distance) <= BOUND
    # The test can fail, because the effect is large enough to be seen:
    assert np.nanmax(found.positions(1)) > 1e-3


@pytest.mark.every(5)
@pytest.mark.parametrize("boundary", rules.BOUNDARIES)
@pytest.mark.parametrize("kind", CREASED)
@pytest.mark.parametrize("name", FAST)
def test_creases(name, kind, boundary):
    found = Comparison(subdivided(name, kind, boundary), LEVELS)
    lagging, _ = found.lagging()
    assert np.nanmax(found.positions(BEST)[~lagging]) <= BOUND


# Meshes and creases with darts, or with smooth corners that are semi-sharp
LAGGING = (
    *((name, "sharp edges", "PRESERVE_CORNERS") for name in ("sheet", "prism", "fin", "monkey")),
    *((name, "fractional edges", "ALL") for name in ("cross", "polygons", "fans")),
    *((name, "vertices", "ALL") for name in ("cross", "sheet", "fans", "fin")),
    *((name, "edges and vertices", "ALL") for name in ("cross", "polygons", "fans")),
)


@pytest.mark.parametrize(("name", "kind", "boundary"), LAGGING)
def test_darts_and_decaying_corners_are_approached(name, kind, boundary):
    found = Comparison(subdivided(name, kind, boundary), LEVELS)
    lagging, _ = found.lagging()
    assert np.count_nonzero(lagging) <= len(found.cage.mesh.positions) / 2
    check_shrinking([found.positions(quality)[lagging] for quality in (6, 8, 10)])


@pytest.mark.parametrize("kind", ["none", "sharp loops", "loose edges"])
def test_nothing_else_is_left_out(kind):
    for name in parity_zoo.MESHES:
        found = Comparison(subdivided(name, kind, uv_smooth="SMOOTH_ALL"), LEVELS)
        assert not any(lagging.any() for lagging in found.lagging())


def check_shrinking(distances):
    """The distance shrinks from each quality to the next, until only rounding errors are left."""
    assert distances[0].size
    assert distances[0].max() > BOUND  # otherwise nothing would have to shrink
    for before, after in zip(distances[:-1], distances[1:], strict=True):
        assert np.all(after <= np.maximum(before / 2, BOUND))


def test_creases_matter():
    """Each kind of crease gives another surface than no creases."""
    shown = {}
    for kind in parity_zoo.CREASES:
        ob = subdivided("sheet", kind)
        mesh = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        shown[kind] = attributes.read(mesh, "position")[:30]
    for kind in CREASED:
        assert np.abs(shown[kind] - shown["none"]).max() > 0.05, kind


def test_use_creases_off():
    ob = subdivided("sheet", "edges and vertices", use_creases=False)
    assert np.nanmax(Comparison(ob, LEVELS).positions(BEST)) <= BOUND


@pytest.mark.parametrize("name", ["cross", "sheet", "polygons", "monkey"])
def test_simple_subdivision(name):
    ob = subdivided(name, "edges and vertices", subdivision_type="SIMPLE")
    # With its limit surface option Blender smooths the UVs inside polygons that are not quads.
    quads_alone = all(polygon.loop_total == 4 for polygon in ob.data.polygons)
    found = Comparison(ob, LEVELS, use_limit_surface=quads_alone)
    assert np.nanmax(found.positions(BEST)) <= BOUND


@pytest.mark.parametrize("uv_smooth", rules.UV_INTERPOLATIONS)
@pytest.mark.parametrize("name", ["sheet", "polygons"])
def test_uvs_of_simple_subdivision(name, uv_smooth):
    ob = subdivided(name, subdivision_type="SIMPLE", uv_smooth=uv_smooth)
    found = Comparison(ob, LEVELS, use_limit_surface=name == "sheet")
    assert np.nanmax(found.uvs(BEST)) <= BOUND


@pytest.mark.every(7)
@pytest.mark.parametrize("kind", ["none", "edges and vertices", "sharp edges"])
@pytest.mark.parametrize("uv_smooth", rules.UV_INTERPOLATIONS)
@pytest.mark.parametrize("name", FAST)
def test_uvs(name, uv_smooth, kind):
    found = Comparison(subdivided(name, kind, uv_smooth=uv_smooth), LEVELS)
    _, lagging = found.lagging()
    assert np.nanmax(found.uvs(BEST)[~lagging]) <= BOUND
    assert lagging.any() == (uv_smooth == "SMOOTH_ALL" and kind == "edges and vertices")


@pytest.mark.every(3)
@pytest.mark.parametrize("kind", ["vertices", "edges and vertices"])
@pytest.mark.parametrize("name", parity_zoo.MESHES)
def test_uvs_at_decaying_corners_are_approached(name, kind):
    found = Comparison(subdivided(name, kind, uv_smooth="SMOOTH_ALL"), LEVELS)
    _, lagging = found.lagging()
    assert np.count_nonzero(lagging) < len(lagging) / 20
    check_shrinking([found.uvs(quality)[lagging] for quality in (6, 8, 10)])


def test_every_setting_of_uv_smooth_is_another_map():
    """So no setting can be mistaken for another."""
    shown = []
    for uv_smooth in rules.UV_INTERPOLATIONS:
        ob = subdivided("monkey", uv_smooth=uv_smooth)
        mesh = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        shown.append(attributes.read(mesh, "UV"))
    for i, one in enumerate(shown):
        for other in shown[:i]:
            assert np.abs(one - other).max() > 1e-3


def set_uvs(ob, uv):
    ob.data.uv_layers["UV"].data.foreach_set("uv", uv.astype(np.float32).ravel())


@pytest.mark.parametrize("seed", range(3))
def test_uvs_that_almost_meet(seed):
    """The corners at a vertex differ by steps of 0.6e-4, so that some of them are one corner to
    Blender and some are not. Which of their values Blender takes for all depends on its threads, so
    this tests only which corners belong together. If this were wrong, a seam would be missing or
    added, and the map would be off by several per cent.
    """
    ob = subdivided("monkey", uv_smooth="SMOOTH_ALL")
    corner_vertex = attributes.read(ob.data, ids.CORNER_VERTEX)
    rng = np.random.default_rng(seed)
    at_vertex = rng.random((len(ob.data.vertices), 2))
    steps = rng.integers(-2, 3, (len(corner_vertex), 2))
    set_uvs(ob, at_vertex[corner_vertex] + 0.6e-4 * steps)
    between_values = np.sqrt(2) * 2 * float(uv_map.LIMIT)
    assert np.nanmax(Comparison(ob, LEVELS).uvs(BEST)) <= between_values


def test_faces_mirrored_on_the_map():
    """Mirrored faces share no value with faces that are not mirrored."""
    ob = subdivided("sheet", uv_smooth="SMOOTH_ALL")
    corner_vertex = attributes.read(ob.data, ids.CORNER_VERTEX)
    flat = attributes.read(ob.data, "position")[corner_vertex, :2] / 8
    right = flat[:, 0] > 2.5 / 8
    flat[right, 0] = 5 / 8 - flat[right, 0]  # folded over along the third column of vertices
    set_uvs(ob, flat)
    found = Comparison(ob, LEVELS)
    assert np.nanmax(found.uvs(BEST)) <= BOUND


def test_a_map_without_area():
    ob = subdivided("polygons", uv_smooth="SMOOTH_ALL")
    set_uvs(ob, np.full((len(ob.data.loops), 2), 0.25))
    assert np.nanmax(Comparison(ob, LEVELS).uvs(BEST)) <= BOUND
