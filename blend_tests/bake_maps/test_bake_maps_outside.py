# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of meshes whose UV map does not lie within the tiles that are baked."""

import warnings

import bpy
import numpy as np
import pytest

SIZE = {"width": 8, "height": 8}


@pytest.fixture
def mesh():
    """Three by three faces, whose UV map fills one tile."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=3)
    return bpy.context.active_object


def move_uv(ob, of_u):
    layer = ob.data.uv_layers[0]
    uv = np.empty((len(layer.data), 2), np.float32)
    layer.uv.foreach_get("vector", uv.ravel())
    uv[:, 0] = of_u(uv[:, 0])
    layer.uv.foreach_set("vector", uv.ravel())


def bake(**how):
    assert bpy.ops.object.limit_bake_maps(maps={"POSITION"}, **SIZE, **how) == {"FINISHED"}
    return bpy.data.images["Grid Position"]


def test_faces_outside_the_first_tile_are_counted(mesh, capfd):
    bake()
    assert "outside" not in capfd.readouterr().out
    move_uv(mesh, lambda u: 2 * u)
    bake()
    told = "6 faces lie wholly or partly outside tile 1001 on the UV map: what is outside is left"
    assert told in capfd.readouterr().out
    bake(tiles="ALL", reuse=False)
    assert "outside" not in capfd.readouterr().out


@pytest.mark.parametrize("by", [10, -1])
def test_faces_outside_all_tiles_are_counted(mesh, capfd, by):
    def move(u):
        u[:4] += by
        return u

    move_uv(mesh, move)
    bake(tiles="ALL")
    assert "1 face lies wholly or partly outside the tiles 1001 to 2000" in capfd.readouterr().out


def test_rounding_at_a_border_makes_no_tile(mesh, capfd):
    move_uv(mesh, lambda u: u * np.float32(1.0000002))
    image = bake(tiles="ALL")
    assert image.source == "FILE"
    bake(tiles="ALL")
    assert "outside" not in capfd.readouterr().out


@pytest.mark.parametrize("far", [1e30, 3e38, np.inf])
@pytest.mark.parametrize("tiles", ["FIRST", "ALL"])
def test_a_map_that_reaches_too_far(mesh, far, tiles):
    mesh.data.uv_layers[0].data[3].uv = (far, 0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(RuntimeError, match="the UV map UVMap has coordinates up to"):
            bake(tiles=tiles)
    assert not bpy.data.images


def test_operators_that_read_such_a_map_warn_of_nothing(mesh):
    mesh.data.uv_layers[0].data[3].uv = (3e38, -3e38)
    mesh.data.uv_layers[0].data[4].uv = (-3e38, 3e38)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert bpy.ops.object.limit_hair_add(per_side=2) == {"FINISHED"}
        bpy.context.view_layer.objects.active = mesh
        assert bpy.ops.object.limit_mesh() == {"FINISHED"}
