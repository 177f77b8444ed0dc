# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Subdivision Surface at its best quality shows the surface that we evaluate."""

import bpy
import numpy as np
import parity_zoo
import pytest
from limit_surface import attributes, rules
from parity_measure import Comparison

BEST = 10
BOUND = 1e-6  # of the diagonal, or on the UV map; Blender computes in single precision
LEVELS = 3
CREASED = [kind for kind in parity_zoo.CREASES if kind not in ("none", "sharp edges")]


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
    # That is not because nothing could be seen:
    assert np.nanmax(found.positions(1)) > 1e-3


@pytest.mark.parametrize("boundary", rules.BOUNDARIES)
@pytest.mark.parametrize("kind", CREASED)
@pytest.mark.parametrize("name", parity_zoo.MESHES)
def test_creases(name, kind, boundary):
    found = Comparison(subdivided(name, kind, boundary), LEVELS)
    lagging, _ = found.lagging()
    assert np.nanmax(found.positions(BEST)[~lagging]) <= BOUND
    check_shrinking([found.positions(quality)[lagging] for quality in (6, 8, 10)])


def check_shrinking(distances):
    """By half with each step of quality at least, until rounding is all that is left."""
    for before, after in zip(distances[:-1], distances[1:], strict=True):
        assert np.all(after <= np.maximum(before / 3, BOUND))


def test_creases_matter():
    """Each kind makes another surface than no creases."""
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
    # With its limit surface Blender rounds the inside of polygons that are no quads.
    quads_alone = all(polygon.loop_total == 4 for polygon in ob.data.polygons)
    found = Comparison(ob, LEVELS, use_limit_surface=quads_alone)
    assert np.nanmax(found.positions(BEST)) <= BOUND
