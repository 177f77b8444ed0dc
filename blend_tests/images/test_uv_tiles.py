# SPDX-License-Identifier: GPL-3.0-or-later
"""The UDIM tiles of a UV map, and the faces outside of an image's tiles."""

import bpy
import numpy as np
import pytest
from limit_surface.images import texel_places, uv_tiles

SIZE = (8, 8)


def quads(*corners):
    """Returns a cage of separate quads with these lower left and upper right corners on the map."""
    mesh = bpy.data.meshes.new("quads")
    at = [(x, y) for (a, b), (c, d) in corners for x, y in ((a, b), (c, b), (c, d), (a, d))]
    mesh.from_pydata([(x, y, 0) for x, y in at], [], np.arange(len(at)).reshape(-1, 4).tolist())
    mesh.uv_layers.new().uv.foreach_set("vector", np.array(at, np.float32).ravel())
    return cage_of(mesh)


def cage_of(mesh):
    ob = bpy.data.objects.new(mesh.name, mesh)
    bpy.context.collection.objects.link(ob)
    return texel_places.read_cage(ob, bpy.context.evaluated_depsgraph_get())


def tiles(found, size=SIZE):
    def on_limit():
        return texel_places.uv_data(found.surface(), found, "quads")

    return uv_tiles.with_texels(found, on_limit, size)


@pytest.mark.parametrize(
    ("corners", "expected"),
    [
        ([((0, 0), (1, 1))], (1001,)),
        ([((0, 0), (2, 2))], (1001, 1002, 1011, 1012)),
        ([((1, 2), (2, 3))], (1022,)),
        ([((0.5, 0), (1.5, 1))], (1001, 1002)),
        ([((9.2, 99.2), (9.8, 99.8)), ((0.2, 0.2), (0.5, 0.5))], (1001, 2000)),
        ([((10, 0), (11, 1)), ((0, 100), (1, 101)), ((-1, -1), (0, 0))], ()),
        ([((-5e7, -5e7), (5e7, 5e7))], tuple(range(1001, 2001))),  # too many to look at
        ([((-1e-6, 0), (1 + 1e-6, 1 + 1e-6))], (1001,)),  # rounding
        ([((0, 0), (1 + 0.4 / 8, 1))], (1001,)),  # less than half a texel
        ([((0, 0), (1 + 0.6 / 8, 1))], (1001, 1002)),
    ],
)
def test_tiles_that_faces_lie_in(corners, expected):
    assert tiles(quads(*corners)) == expected


def test_a_tip_between_texels_makes_no_tile():
    mesh = bpy.data.meshes.new("tip")
    mesh.from_pydata([(0, 0, 0), (1, 0.5, 0), (0, 1, 0)], [], [(0, 1, 2)])
    uv = np.array([(0.1, 0.2), (1.1, 0.5), (0.1, 0.8)], np.float32)  # no texel's centre is at 0.5
    mesh.uv_layers.new().uv.foreach_set("vector", uv.ravel())
    found = cage_of(mesh)
    assert tiles(found, (8, 8)) == (1001,)
    assert tiles(found, (64, 64)) == (1001, 1002)


@pytest.mark.parametrize(
    ("corner", "outside"),
    [
        ((0.1, 0.1), False),
        ((0.6, 0.1), True),  # partly in tile 1002
        ((2.1, 0.1), False),
        ((-0.5, 0.1), True),
        ((11, 0.1), True),
        ((-900, 4e7), True),
    ],
)
def test_faces_outside_some_tiles(corner, outside):
    other = ((0.2, 0.2), (0.8, 0.8))
    found = quads(other, (corner, np.add(corner, 0.7)))
    assert uv_tiles.faces_outside(found, SIZE, (1001, 1003)) == outside


def test_faces_outside_all_tiles():
    found = quads(
        ((0, 0), (2, 2)),
        ((9, 0), (11, 1)),
        ((9, 99), (10, 100)),
        ((0, -1e-6), (1, 1)),
        ((-3, 0), (-2, 1)),
    )
    assert uv_tiles.faces_outside(found, SIZE) == 2
    assert uv_tiles.faces_outside(found, (2**21, 2**21)) == 3


def test_warnings():
    assert uv_tiles.told(0) == ""
    assert uv_tiles.told(1, (1001,)) == (
        "1 face lies wholly or partly outside tile 1001 on the UV map: what is outside is left out"
    )
    assert "2 faces lie wholly or partly outside the image's tiles" in uv_tiles.told(
        2, (1001, 1002)
    )
    assert "outside the tiles 1001 to 2000" in uv_tiles.told(2)
