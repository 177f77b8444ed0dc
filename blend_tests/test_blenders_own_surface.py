# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Subdivision Surface at its best quality shows the surface that we evaluate.

Its first vertices are the cage's, moved to the limit, in the cage's order.
"""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import attributes
from scenes import add_subsurf, surface_without_addon


@pytest.mark.parametrize("boundary", scenes.BOUNDARIES)
@pytest.mark.parametrize("scene", scenes.SCENES)
def test_vertices_agree(scene, boundary):
    ob = scenes.SCENES[scene]()
    subsurf = add_subsurf(ob, boundary)
    subsurf.use_limit_surface, subsurf.quality, subsurf.levels = True, 10, 1
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    blender = attributes.read(shown, "position")[: len(ob.data.vertices)]

    surface = surface_without_addon(ob, boundary)
    at = surface.vertex_locations()
    used = at.face >= 0
    assert used.all()
    difference = np.abs(surface.evaluate(at.face, at.uv).position - blender).max()
    diagonal = np.linalg.norm(np.ptp(attributes.read(ob.data, "position"), axis=0))
    assert difference <= 1e-6 * diagonal
