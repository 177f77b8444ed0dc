# SPDX-License-Identifier: GPL-3.0-or-later
"""The UV maps and texels that operators use which make textures."""

import bpy
import numpy as np
import pytest
from figures.meshes import grids
from limit_surface import native
from limit_surface.errors import RefusalError, TooLargeError
from limit_surface.images import overlap, texel_places


def grid(uv_scale=(1.0, 1.0), uv_offset=(0.0, 0.0), name="UVMap") -> bpy.types.Object:
    """Returns two by two unit quads, and a map of all of them."""
    xy = np.stack(np.meshgrid([0, 1, 2], [0, 1, 2]), axis=-1).reshape(-1, 2)
    faces = grids.grid_faces(2, 2)
    mesh = bpy.data.meshes.new("grid")
    mesh.from_pydata([(*p, 0) for p in xy.tolist()], [], faces.tolist())
    layer = mesh.uv_layers.new(name=name)
    uv = xy[faces.ravel()] / 2 * uv_scale + uv_offset
    layer.uv.foreach_set("vector", uv.astype(np.float32).ravel())
    ob = bpy.data.objects.new("grid", mesh)
    bpy.context.collection.objects.link(ob)
    ob.modifiers.new("Subdivision", "SUBSURF")
    bpy.context.view_layer.objects.active = ob
    return ob


def read(ob, name=""):
    return texel_places.read_cage(ob, bpy.context.evaluated_depsgraph_get(), name)


def mapped(ob):
    found = read(ob)
    return texel_places.uv_data(native.limitsurf.LimitSurface(found.mesh), found, ob.name)


def test_the_named_map_or_the_active_one():
    ob = grid()
    other = ob.data.uv_layers.new(name="Other", do_init=True)
    values = np.empty(32, np.float32)
    other.uv.foreach_get("vector", values)
    other.uv.foreach_set("vector", values / 4)
    assert read(ob).uv_map.name == "UVMap"
    assert read(ob, "Other").uv_map.name == "Other"
    assert read(ob, "Other").uv_map.values.max() == pytest.approx(0.25)


def test_maps_that_are_refused():
    ob = grid()
    with pytest.raises(RefusalError, match="grid has no UV map 'Nothing'"):
        read(ob, "Nothing")
    with pytest.raises(RefusalError, match="no face has an area on the UV map UVMap"):
        read(grid(uv_scale=(1, 0)))
    bare = grid()
    bare.data.uv_layers.remove(bare.data.uv_layers[0])
    with pytest.raises(RefusalError, match="there is no UV map"):
        read(bare)
    wild = grid()
    wild.data.uv_layers[0].uv[3].vector = (np.nan, 0)
    with pytest.raises(RefusalError, match="not finite"):
        read(wild)
    with pytest.raises(RefusalError, match="not finite"):
        read(wild, "UVMap")


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("far", [1e9, 1e30, np.inf])  # Blender stores the last as its largest float
def test_maps_that_reach_too_far_are_refused(far):
    ob = grid()
    ob.data.uv_layers[0].data[3].uv = (far, 0)
    with pytest.raises(RefusalError, match="grid: the UV map UVMap has coordinates up to [0-9.]+e"):
        read(ob)


def test_faces_without_area_are_counted():
    ob = grid()
    assert texel_places.faces_without_area(read(ob)) == 0
    for corner in range(4):
        ob.data.uv_layers[0].uv[corner].vector = (0.5, 0.25 * corner)
    assert texel_places.faces_without_area(read(ob)) == 1


def test_texels_lie_where_the_map_says():
    at = texel_places.texels(mapped(grid()), (16, 8))
    assert at.inside.all()
    found = mapped(grid()).evaluate(at.face, at.uv).value
    np.testing.assert_allclose(found, np.stack([(at.x + 0.5) / 16, (at.y + 0.5) / 8], axis=1))


def test_other_tiles():
    shifted = mapped(grid(uv_offset=(1, 2)))
    assert len(texel_places.texels(shifted, (8, 8)).x) == 0
    assert len(texel_places.texels(shifted, (8, 8), 1022).x) > 20


def test_maps_that_overlap():
    ob = grid()
    layer = ob.data.uv_layers[0]
    for corner in range(4):
        layer.uv[4 + corner].vector = layer.uv[corner].vector
    with pytest.raises(RefusalError, match=r"overlaps itself at \d+ of \d+ texels"):
        texel_places.texels(mapped(ob), (32, 32))
    at = texel_places.texels(mapped(ob), (32, 32), allow_overlap=True)
    assert at.overlap.any()
    assert not at.overlap.all()


def test_folds_are_no_refusal():
    """One face covers only a few texels, all of which another face covers, too."""
    ob = grid()
    layer = ob.data.uv_layers[0]
    for corner, place in enumerate([(0, 0), (0.03, 0), (0.03, 0.03), (0, 0.03)]):
        layer.uv[4 + corner].vector = 0.1 + np.array(place)
    at = texel_places.texels(mapped(ob), (64, 64))
    assert overlap.overlapping(at) == 4
    layer.uv[6].vector = (0.25, 0.25)
    more = mapped(ob)
    with pytest.raises(RefusalError, match=r"overlaps itself at \d+ of [\d,]+ texels"):
        texel_places.texels(more, (64, 64))


def test_large_images_have_to_be_allowed():
    texel_places.check_size(4096, 4096, 1, 6, allow_large=False)
    with pytest.raises(TooLargeError, match=r"8,192 x 8,192 pixels take about \d+\.\d GiB"):
        texel_places.check_size(8192, 8192, 1, 4, allow_large=False)
    texel_places.check_size(8192, 8192, 1, 4, allow_large=True)
