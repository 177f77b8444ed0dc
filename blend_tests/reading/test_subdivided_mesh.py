# SPDX-License-Identifier: GPL-3.0-or-later
"""The place on the cage of each vertex and corner of Blender's subdivided mesh.

Blender itself shows them: Simple subdivision leaves quads flat between their edges, and UVs that
are not smoothed bilinear on each Ptex face, so that positions and UVs identify the place.
"""

import bpy
import numpy as np
import pytest
from figures.parity import zoo as parity_zoo
from limit_surface import ids
from limit_surface.reading import attributes, subdivided_mesh
from scenes import bilinear, ptex_corners


@pytest.mark.parametrize("levels", [1, 2, 3, 4])
@pytest.mark.parametrize("name", ["sheet", "polygons", "prism", "fans", "monkey"])
def test_blender_agrees(name, levels):
    ob = parity_zoo.add(name)
    mesh, subsurf = ob.data, ob.modifiers[0]
    subsurf.subdivision_type, subsurf.uv_smooth, subsurf.levels = "SIMPLE", "NONE", levels
    subsurf.use_limit_surface = False  # with this option, polygons that are not quads are not flat
    _spread_uvs(mesh)
    corner_vertex = attributes.read(mesh, ids.CORNER_VERTEX)
    at_corners = attributes.read(mesh, "position").astype(float)[corner_vertex]
    positions = ptex_corners(ob, at_corners)
    uvs = ptex_corners(ob, attributes.read(mesh, "UV").astype(float))

    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    sizes = attributes.face_sizes(mesh)
    corners = subdivided_mesh.corner_locations(sizes, levels)
    np.testing.assert_allclose(
        bilinear(uvs, *corners), attributes.read(shown, "UV"), atol=1e-5 * np.abs(uvs).max()
    )
    shown_vertex = attributes.read(shown, ids.CORNER_VERTEX)
    vertices = subdivided_mesh.vertex_locations(corners, shown_vertex, len(shown.vertices))
    used = vertices.face >= 0
    assert np.count_nonzero(~used) == (1 if name == "fans" else 0)  # an isolated vertex
    expected = attributes.read(shown, "position")
    np.testing.assert_allclose(
        bilinear(positions, vertices.face[used], vertices.uv[used]), expected[used], atol=1e-5
    )
    # All corners at one vertex are the same place, on whichever face they are.
    np.testing.assert_allclose(bilinear(positions, *corners), expected[shown_vertex], atol=1e-5)


def _spread_uvs(mesh):
    """Moves each polygon to a place of its own, so that no two corners have the same UV."""
    uv = []
    for polygon in mesh.polygons:
        angle = 2 * np.pi * np.arange(polygon.loop_total) / polygon.loop_total
        place = 3 * (polygon.index % 16), 3 * (polygon.index // 16)
        uv.append(np.stack([np.cos(angle), np.sin(angle)], axis=1) + place)
    mesh.uv_layers["UV"].data.foreach_set("uv", np.concatenate(uv).astype(np.float32).ravel())


def test_loose_edges_have_no_place():
    ob = parity_zoo.add("sheet")
    parity_zoo.crease(ob.data, "loose edges")
    ob.modifiers[0].levels = 2
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    sizes = attributes.face_sizes(ob.data)
    corners = subdivided_mesh.corner_locations(sizes, 2)
    shown_vertex = attributes.read(shown, ids.CORNER_VERTEX)
    found = subdivided_mesh.vertex_locations(corners, shown_vertex, len(shown.vertices))
    loose = len(ob.data.vertices) - 30
    assert loose > 3
    assert np.count_nonzero(found.face < 0) == loose * 4  # its end, and three along the edge


def test_level_0_has_no_polygons_of_its_own():
    with pytest.raises(ValueError, match="level 1"):
        subdivided_mesh.corner_locations(np.array([4]), 0)
