# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of displacement: their numbers are compared with places that are found by another
method.
"""

import json

import bpy
import limitsurf
import numpy as np
import pytest
import scenes
import sculpts
from limit_surface import ids
from limit_surface.images import image_pixels
from limit_surface.reading import attributes, subdivided_mesh
from mathutils import Matrix

SINGLE = 1e-6  # the rounding error of Blender's coordinates up to 5


def flat_map(at):
    """Adds a UV map inside the first tile, for the meshes of the tests."""
    return at[:, :2] @ np.array([[0.15, 0.03], [-0.02, 0.17]]).T + [0.14, 0.12]


@pytest.fixture
def base():
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    scenes.add_uv_map(ob, flat_map)
    return ob


@pytest.fixture
def sculpt(base):
    return sculpts.reshape(sculpts.subdivided_copy(base, 2), sculpts.ripples)


def bake(ob, target, **properties):
    scenes.activate(ob)
    before = set(bpy.data.images)
    small = {"width": 96, "height": 80, "target": target.name, "reuse": False}
    assert bpy.ops.object.limit_bake_displacement(**small | properties) == {"FINISHED"}
    (made,) = set(bpy.data.images) - before
    return made


def surface(ob):
    return scenes.surface_without_addon(ob)


def there(ob, target, levels, face, uv):
    """Returns points of the subdivided mesh's limit, found polygon by polygon in Blender's
    order.
    """
    finder = subdivided_mesh.PolygonFinder(attributes.face_sizes(ob.data), levels)
    polygon, within = finder.find(face, uv)
    return surface(target).evaluate(polygon, np.clip(within, 0, 1)).position


def texels_of(ob, image, margin=16):
    """Returns the places of the texels, including those of the margin."""
    base = surface(ob)
    corner_vertex = attributes.read(ob.data, ids.CORNER_VERTEX)
    values = flat_map(sculpts.positions(ob))
    uv_map = base.face_varying(values.astype(np.float32), corner_vertex, "boundaries")
    return base, uv_map, uv_map.rasterize(*image.size, margin=margin)


@pytest.mark.parametrize("levels", [1, 2, 3])
@pytest.mark.parametrize("name", scenes.SCENES)
def test_what_blender_only_subdivides_is_not_displaced(name, levels):
    ob = scenes.SCENES[name]()
    scenes.add_subsurf(ob)
    target = sculpts.subdivided_copy(ob, levels)
    image = bake(ob, target, layout_kind="PTEX", face_resolution="8", space="OBJECT")
    pixels = image_pixels.read(image)
    assert np.abs(pixels[..., :3]).max() < SINGLE
    assert (pixels[..., 3] == 1).all()
    moved = sculpts.reshape(target, lambda at: at + [0.25, 0, -1])
    layout = json.loads(image[ids.DISPLACEMENT])
    texels = limitsurf.PtexLayout(layout["face_count"], layout["resolution"]).texels()
    pixels = image_pixels.read(
        bake(ob, moved, layout_kind="PTEX", face_resolution="8", space="OBJECT")
    )
    np.testing.assert_allclose(
        pixels[texels.y, texels.x, :3], np.tile([0.25, 0, -1], (len(texels), 1)), atol=SINGLE
    )


def test_vectors_in_object_space(base, sculpt):
    image = bake(base, sculpt, space="OBJECT")
    pixels = image_pixels.read(image)
    own, _, texels = texels_of(base, image)
    assert len(texels.x) > 3000
    expected = there(base, sculpt, 2, texels.face, texels.uv)
    found = own.evaluate(texels.face, texels.uv).position + pixels[texels.y, texels.x, :3]
    np.testing.assert_allclose(found, expected, atol=3 * SINGLE)
    rest = np.ones(pixels.shape[:2], bool)
    rest[texels.y, texels.x] = False
    assert rest.any()
    assert (pixels[rest] == [0, 0, 0, 1]).all()


def test_vectors_in_tangent_space(base, sculpt):
    image = bake(base, sculpt)
    own, uv_map, texels = texels_of(base, image)
    tangent, bitangent, normal = np.moveaxis(
        own.tangent_frames(uv_map, texels.face, texels.uv), 2, 0
    )
    x, y, z = image_pixels.read(image)[texels.y, texels.x, :3].T.astype(float)
    moved = x[:, None] * tangent + y[:, None] * normal + z[:, None] * bitangent
    expected = there(base, sculpt, 2, texels.face, texels.uv)
    found = own.evaluate(texels.face, texels.uv).position + moved
    np.testing.assert_allclose(found, expected, atol=3 * SINGLE)


def test_a_tile_for_each_face_needs_no_map(sculpt, base):
    base.data.uv_layers.remove(base.data.uv_layers[0])
    image = bake(base, sculpt, layout_kind="PTEX", face_resolution="4", space="OBJECT")
    described = json.loads(image[ids.DISPLACEMENT])
    assert described == {
        "mode": "VECTOR", "space": "OBJECT", "layout": "PTEX",
        "face_count": 18, "resolution": 4, "columns": 5,
    }  # fmt: skip
    assert tuple(image.size) == (25, 20)
    pixels = image_pixels.read(image)
    rng = np.random.default_rng(1)
    own = surface(base)
    for _ in range(60):  # the place of a sample, as the page describes it
        face, i, j = rng.integers(0, 18), *rng.integers(0, 5, 2)
        value = pixels[face // 5 * 5 + j, face % 5 * 5 + i, :3]
        at = np.array([face]), np.array([[i, j]]) / 4
        expected = there(base, sculpt, 2, *at) - own.evaluate(*at).position
        np.testing.assert_allclose(value, expected[0], atol=3 * SINGLE)


STRETCHED = (
    Matrix.Translation((3, -2, 1))
    @ Matrix.Rotation(0.7, 4, (1, 2, 3))
    @ Matrix.Diagonal((2.0, -0.5, 1.3, 1))
)


def test_where_the_sculpted_mesh_lies(base, sculpt):
    plain = image_pixels.read(bake(base, sculpt, space="OBJECT"))
    base.matrix_world = STRETCHED
    bpy.context.view_layer.update()
    own = image_pixels.read(bake(base, sculpt, space="OBJECT", transform="OWN"))
    np.testing.assert_array_equal(own, plain)
    sculpt.matrix_world = STRETCHED
    bpy.context.view_layer.update()
    np.testing.assert_allclose(
        image_pixels.read(bake(base, sculpt, space="OBJECT")), plain, atol=3 * SINGLE
    )
    sculpt.matrix_world = STRETCHED @ Matrix.Translation((0, 0, 1))
    bpy.context.view_layer.update()
    image = bake(base, sculpt, space="OBJECT")
    texels = texels_of(base, image)[2]
    moved = image_pixels.read(image) - plain
    expected = np.tile([0, 0, 1, 0], (len(texels.x), 1))
    np.testing.assert_allclose(moved[texels.y, texels.x], expected, atol=5 * SINGLE)


def test_distances(capfd):
    """A flat sheet lies below a slope that does not cover all of it."""
    ob = scenes.flat_grid(4)
    scenes.add_subsurf(ob)
    scenes.add_uv_map(ob, lambda at: at[:, :2] / 5 + 0.1)
    slope = scenes.add_mesh(
        "Slope", [(-9, -9, 0.5), (2, -9, 0.5), (2, 9, 0.5), (-9, 9, 0.5)], [(0, 1, 2, 3)]
    )
    scenes.add_subsurf(slope).subdivision_type = "SIMPLE"
    sculpts.reshape(slope, lambda at: at + [0, 0, 0.1] * at[:, :1])
    image = bake(ob, slope, mode="SCALAR", width=64, height=64, margin=0)
    said = capfd.readouterr().out
    pixels = image_pixels.read(image)
    y, x = np.mgrid[:64, :64]
    across = ((x + 0.5) / 64 - 0.1) * 5
    inside = (np.abs(x - 31.5) < 14) & (np.abs(y - 31.5) < 14)
    met = inside & (across < 2)
    np.testing.assert_allclose(pixels[met][:, 0], 0.5 + 0.1 * across[met], atol=SINGLE)
    assert (pixels[inside & (across > 2)][:, :3] == 0).all()
    np.testing.assert_array_equal(pixels[..., 0], pixels[..., 1])
    assert "Slope was not found along the normals of 1,352 of 2,704 texels" in said
    assert "these texels hold 0" in said
    missed = "No normal of the surface meets Slope"
    refused(ob, missed, target="Slope", mode="SCALAR", max_distance=0.1)
    refused(ob, missed, target="Slope", mode="SCALAR", direction="INWARD")


def test_polygons_of_multiresolution(base):
    """The polygons are taken as they are shown: vertices stay where they are, whatever their limit
    positions.
    """
    copy = base.copy()
    copy.data = base.data.copy()
    bpy.context.collection.objects.link(copy)
    copy.modifiers.clear()
    multires = copy.modifiers.new("Multires", "MULTIRES")
    with bpy.context.temp_override(object=copy, active_object=copy):
        for _ in range(2):
            bpy.ops.object.multires_subdivide(modifier=multires.name)
    multires.levels = 2
    bpy.context.view_layer.update()
    refused(
        base,
        f"{copy.name} has a Multiresolution modifier: set Sculpted Surface to Polygons",
        target=copy.name,
    )
    image = bake(base, copy, target_shape="POLYGONS", layout_kind="PTEX", face_resolution="4",
                 space="OBJECT")  # fmt: skip
    shown = copy.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    at = subdivided_mesh.corner_locations(attributes.face_sizes(base.data), 2)
    vertex = attributes.read(shown, ids.CORNER_VERTEX)
    expected = attributes.read(shown, ids.POSITION)[vertex]
    expected = expected - surface(base).evaluate(at.face, at.uv).position
    i, j = np.rint(at.uv * 4).astype(int).T
    found = image_pixels.read(image)[at.face // 5 * 5 + j, at.face % 5 * 5 + i, :3]
    np.testing.assert_allclose(found, expected, atol=3 * SINGLE)


def test_creases_that_blender_leaves_on_a_subdivided_mesh(base):
    """Infinitely sharp creases stay so, and the surface is the same."""
    crease = base.data.edge_creases_ensure()
    values = np.zeros(len(base.data.edges), np.float32)
    values[::3] = 1
    crease.data.foreach_set("value", values)
    target = sculpts.subdivided_copy(base, 2)
    pixels = image_pixels.read(bake(base, target, layout_kind="PTEX", space="OBJECT"))
    assert np.abs(pixels[..., :3]).max() < SINGLE


def test_udim_tiles(sculpt, base):
    layer = base.data.uv_layers[0]
    uv = attributes.read(base.data, layer.name)
    layer.data.foreach_set("uv", (uv + [0.6, 0]).astype(np.float32).ravel())
    image = bake(base, sculpt, use_tiles=True, space="OBJECT", width=64, height=64)
    assert image.source == "TILED"
    assert [tile.number for tile in image.tiles] == [1001, 1002]
    left, right = (image_pixels.read(image, tile) for tile in (1001, 1002))
    assert np.abs(left[:, :30, :3]).max() == 0 < np.abs(left[..., :3]).max()
    assert np.abs(right[:, 60:, :3]).max() == 0 < np.abs(right[..., :3]).max()
    alone = image_pixels.read(bake(base, sculpt, space="OBJECT", width=64, height=64))
    np.testing.assert_allclose(alone, left, atol=1e-7)


def test_faces_outside_the_image_are_counted(sculpt, base, capfd):
    layer = base.data.uv_layers[0]
    uv = attributes.read(base.data, layer.name)
    layer.data.foreach_set("uv", (uv + [0.6, 0]).astype(np.float32).ravel())
    bake(base, sculpt, space="OBJECT")
    assert "lie wholly or partly outside tile 1001 on the UV map" in capfd.readouterr().out
    bake(base, sculpt, use_tiles=True, space="OBJECT", reuse=False)
    bake(base, sculpt, layout_kind="PTEX", space="OBJECT", reuse=False)
    assert "outside" not in capfd.readouterr().out


def test_rounding_at_a_border_makes_no_tile(sculpt, base, tmp_path):
    scenes.add_uv_map(base, lambda p: p[:, :2] / p[:, :2].max() * 1.0000002)
    how = {"use_tiles": True, "space": "OBJECT", "uv_map": base.data.uv_layers[-1].name}
    image = bake(base, sculpt, filepath=str(tmp_path / "d.exr"), **how)
    assert image.source == "FILE"
    assert [path.name for path in tmp_path.iterdir()] == ["d.exr"]


def test_the_file_holds_the_numbers(sculpt, base, tmp_path):
    path = tmp_path / "displacement.exr"
    image = bake(base, sculpt, filepath=str(path))
    loaded = bpy.data.images.load(str(path), check_existing=False)
    loaded.colorspace_settings.name = "Non-Color"
    assert loaded.is_float
    plain = image_pixels.read(bake(base, sculpt))
    np.testing.assert_array_equal(image_pixels.read(loaded)[..., :3], plain[..., :3])
    np.testing.assert_array_equal(image_pixels.read(image)[..., :3], plain[..., :3])
    assert image.colorspace_settings.name == "Non-Color"
    assert bpy.path.abspath(image.filepath) == str(path)
    numbered = bake(base, sculpt, filepath=str(tmp_path / "tile.<UDIM>.exr"))
    assert bpy.path.abspath(numbered.filepath) == str(tmp_path / "tile.1001.exr")
    assert sorted(file.name for file in tmp_path.iterdir()) == [path.name, "tile.1001.exr"]


def test_polygons_that_no_viewport_shows(sculpt, base):
    """The polygons of a hidden object are available; those of an object that is not evaluated are
    not.
    """
    sculpt.modifiers.clear()
    shown = image_pixels.read(bake(base, sculpt, target_shape="POLYGONS"))
    sculpt.hide_set(True)
    np.testing.assert_array_equal(
        image_pixels.read(bake(base, sculpt, target_shape="POLYGONS")), shown
    )
    sculpt.hide_viewport = True
    refused(base, "Sculpt is disabled", target="Sculpt", target_shape="POLYGONS")
    sculpt.hide_viewport = False
    bpy.context.collection.objects.unlink(sculpt)
    refused(base, "or is not in this view layer", target="Sculpt", target_shape="POLYGONS")


def test_paths_that_would_not_do(sculpt, base, tmp_path):
    scenes.add_uv_map(base, lambda p: p[:, :2] / (2.5, 4))
    for match, path, properties in (
        ("There is no folder", tmp_path / "no" / "a.exr", {}),
        ("a.png does not end in .exr", tmp_path / "a.png", {}),
        ("which has not been saved: save it first", "//a.exr", {}),
        (
            "Each of the 2 tiles is saved in its own file: a.exr must contain <UDIM>",
            tmp_path / "a.exr",
            {"use_tiles": True, "uv_map": "Flat.001"},
        ),
    ):
        refused(base, match, target="Sculpt", filepath=str(path), **properties)
    assert not list(tmp_path.iterdir())


def refused(ob, match, **properties):
    scenes.activate(ob)
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_bake_displacement(
            **{"width": 32, "height": 32, "reuse": False} | properties
        )
    assert scenes.file_contents() == before
    assert bpy.context.active_object == ob


def test_tiles_in_tangent_space(base, sculpt):
    """Frames are those of the map; along seams each face has its own."""
    image = bake(base, sculpt, layout_kind="PTEX", face_resolution="4")
    texels = limitsurf.PtexLayout(18, 4).texels()
    own, uv_map, _ = texels_of(base, image)
    frames = own.tangent_frames(uv_map, texels.face, texels.uv)
    moved = own.displaced(
        texels.face, texels.uv, image_pixels.read(image)[texels.y, texels.x, :3], frames=frames
    )
    expected = there(base, sculpt, 2, texels.face, texels.uv)
    np.testing.assert_allclose(moved, expected, atol=3 * SINGLE)


def test_refusals(base, sculpt):
    for other in list(bpy.context.selected_objects):
        other.select_set(False)
    refused(base, "No other mesh is selected: select Holes and one sculpted mesh")
    refused(base, "There is no object 'Nobody'", target="Nobody")
    refused(base, "Holes is chosen as its own sculpted mesh", target="Holes")
    light = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    bpy.context.collection.objects.link(light)
    refused(base, "Sun is not a mesh", target="Sun")
    refused(base, "Holes has no UV map 'Other'", target="Sculpt", uv_map="Other")
    refused(base, "the layout UV Map", target="Sculpt", layout_kind="PTEX", create_material=True)
    refused(base, "GiB of memory: turn on Allow Large", target="Sculpt", width=16384, height=16384)
    cross = scenes.cross()
    refused(base, "Structures do not match: the target has 5 faces; the base's 18 become 72",
            target=cross.name)  # fmt: skip
    base.data.uv_layers.remove(base.data.uv_layers[0])
    refused(base, "Holes: there is no UV map", target="Sculpt")
    refused(base, "choose the space Object", target="Sculpt", layout_kind="PTEX")


def test_the_selected_mesh_is_taken(base, sculpt):
    for ob in bpy.context.selected_objects:
        ob.select_set(False)
    sculpt.select_set(True)
    base.select_set(True)
    scenes.activate(base)
    assert bpy.ops.object.limit_bake_displacement(width=32, height=32) == {"FINISHED"}
    scenes.cross().select_set(True)
    refused(base, "2 other meshes are selected")


def test_a_face_order_that_nobody_makes(base, sculpt):
    """Blender's own operator has sorted the faces."""
    scenes.activate(sculpt)
    for ob in bpy.context.selected_objects:
        ob.select_set(ob == sculpt)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.sort_elements(type="REVERSE", elements={"FACE"})
    bpy.ops.object.mode_set(mode="OBJECT")
    refused(base, "Structures do not match: face .* of the target has vertex", target="Sculpt")


def test_maps_that_overlap(base, sculpt):
    layer = base.data.uv_layers[0]
    uv = attributes.read(base.data, layer.name)
    layer.data.foreach_set("uv", (0.2 + 0.5 * np.abs(uv - 0.5)).astype(np.float32).ravel())
    refused(base, "overlaps itself at .* texels", target="Sculpt")
    assert bake(base, sculpt, overlap="ALLOW")
    layer.data.foreach_set("uv", np.full(uv.size, 0.5, np.float32))
    refused(base, "no face has an area on the UV map Flat", target="Sculpt")


def test_undo_takes_the_image_away(base, sculpt):
    bpy.ops.ed.undo_push(message="before")
    bake(base, sculpt)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert "Holes Displacement" not in bpy.data.images
    bpy.ops.ed.redo()
    pixels = image_pixels.read(bpy.data.images["Holes Displacement"])
    assert np.abs(pixels[..., :3]).max() > 0.05
