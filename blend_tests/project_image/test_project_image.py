# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures into which images are projected, compared with Blender's own fine mesh, rays and UVs."""

from pathlib import Path
from tempfile import TemporaryDirectory

import bpy
import numpy as np
import projection_truth as truth
import pytest
import scenes
from bpy_extras.view3d_utils import location_3d_to_region_2d
from limit_surface.images import image_pixels
from mathutils import Matrix, Vector

TEXTURE = (256, 256)


def project(ob, **properties):
    """Projects, and returns the new or the painted image."""
    scenes.activate(ob)
    before = set(bpy.data.images.keys())
    size = (
        {}
        if properties.get("output") == "EXISTING"
        else dict(zip(("width", "height"), TEXTURE, strict=True))
    )
    assert bpy.ops.object.limit_project_image(**size | properties) == {"FINISHED"}
    new = set(bpy.data.images.keys()) - before
    return bpy.data.images[new.pop() if new else properties["target"]]


def bent_sheet(level=5):
    """Adds an open mesh with extraordinary vertices and holes, whose UVs lie within the image."""
    ob = scenes.grid_with_holes()
    scenes.add_uv_map(ob, lambda p: 0.05 + 0.9 * p[:, :2] / (5, 4))
    truth.fine_subsurf(ob, level)
    return ob


def middle(ob):
    return np.array(ob.matrix_world @ Matrix.Translation((2.5, 2, 0.5)).to_translation())


CAMERAS = {
    "perspective": {"lens": 40.0, "shift_x": 0.05},
    "orthographic": {"type": "ORTHO", "ortho_scale": 9.0},
}


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("name", CAMERAS)
def test_every_place_shows_what_the_camera_shows_there(name, mirrored):
    """The pixels of the image hold their own coordinates: along the camera's rays the texture shows
    these coordinates.
    """
    ob = truth.posed(bent_sheet(), mirrored)
    axis = np.array(ob.matrix_world)[:3, 2]
    away = 7 * axis / np.linalg.norm(axis) + [2, 0, 0]
    target = middle(ob)
    size = (96, 64)
    camera = truth.add_camera(target + away, target, **CAMERAS[name])
    places = truth.image_of_places(size)
    made = project(ob, image=places.name, use_float=True, margin=8, extension="EXTEND")
    st = np.random.default_rng(8).uniform(0.02, 0.98, (4000, 2))
    origins, directions = truth.camera_rays(camera, st, size)
    uv = truth.FineMesh(ob).seen(origins, directions)
    hit = np.isfinite(uv[:, 0])
    assert hit.sum() > 1000
    found = truth.sampled(truth.pixels(made), uv[hit])
    sure = found[:, 3] > 0.999  # away from parts that are hidden or turned away
    assert sure.mean() > 0.8
    off = np.abs(found[sure, :2] - st[hit][sure])
    assert np.median(off) < 2e-4
    assert np.quantile(off, 0.99) < 5e-3


def test_what_is_hidden_is_not_painted():
    """Two sheets lie one above the other and are seen from above: the hidden texels of the lower
    one stay transparent.
    """
    square = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float)
    positions = np.concatenate([3 * square, square + (0, 0, 1)])
    ob = scenes.add_mesh("Sheets", positions, [(0, 1, 2, 3), (4, 5, 6, 7)])
    layer = ob.data.uv_layers.new(name="Map")
    flat = (square[:, :2] + 1) / 2
    uv = np.concatenate([flat * (0.5, 1), flat * (0.5, 1) + (0.5, 0)])
    layer.data.foreach_set("uv", uv.astype(np.float32).ravel())
    subsurf = scenes.add_subsurf(ob)
    subsurf.subdivision_type = "SIMPLE"
    truth.add_camera((0, 0, 9), type="ORTHO", ortho_scale=8)
    places = truth.image_of_places((64, 64))
    made = project(ob, image=places.name, margin=0, use_float=True, occlusion_samples="16")
    alpha = truth.pixels(made)[:, :, 3]
    y, x = (np.mgrid[: TEXTURE[1], : TEXTURE[0]] + 0.5) / TEXTURE[0]
    on_lower = x < 0.5
    at = np.stack([x / 0.5, y]) * 6 - 3  # in the world
    shadowed, lit = (np.abs(at).max(axis=0) < 0.95, np.abs(at).max(axis=0) > 1.05)
    assert (alpha[on_lower & shadowed] == 0).all()
    np.testing.assert_allclose(alpha[on_lower & lit], 1, atol=1e-6)
    np.testing.assert_allclose(alpha[~on_lower], 1, atol=1e-6)
    # The shadow's border is as wide as a texel: 4 x 4 rays for each texel show how much of it is
    # visible.
    assert alpha[on_lower].mean() == pytest.approx(1 - 1 / 9, abs=2e-3)
    everywhere = project(ob, image=places.name, margin=0, use_float=True, occlusion=False)
    np.testing.assert_allclose(truth.pixels(everywhere)[:, :, 3], 1, atol=1e-6)


def flat_square():
    """Adds a square from (0, 0) to (1, 1) at z = 0 with the same UVs."""
    ob = scenes.add_mesh("Square", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    ob.data.uv_layers.new(name="Map").data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1])
    scenes.add_subsurf(ob).subdivision_type = "SIMPLE"
    return ob


def empty(**settings):
    ob = bpy.data.objects.new("Empty", None)
    for name, value in settings.items():
        setattr(ob, name, value)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.update()
    return ob


def filled(name, values, is_float=False, is_data=False):
    values = np.asarray(values, np.float32)
    image = bpy.data.images.new(
        name, values.shape[1], values.shape[0], alpha=True, float_buffer=is_float, is_data=is_data
    )
    image.pixels.foreach_set(values.ravel())
    return image


def noise(size, seed=3, alpha=True):
    values = np.random.default_rng(seed).random((*size, 4)).astype(np.float32)
    if not alpha:
        values[..., 3] = 1
    return values


def test_pixels_that_lie_on_texels_come_through_unchanged():
    """A planar image is as large as the square, with 8 bits and the color space of the texture."""
    ob = flat_square()
    frame = empty(location=(0.5, 0.5, 1), empty_display_size=0.5)
    shown = filled("Shown", noise((64, 64), alpha=False))
    for name, properties in (
        ("plain", {}),
        ("from behind", {"two_sided": True}),
    ):
        if properties:
            frame.rotation_euler.y = np.pi
            bpy.context.view_layer.update()
        made = project(
            ob, source="PLANAR", image="Shown", empty=frame.name, width=64, height=64, **properties
        )
        expected = truth.pixels(shown)
        if properties:
            expected = expected[:, ::-1]
        np.testing.assert_allclose(truth.pixels(made), expected, atol=1.01 / 255, err_msg=name)


def test_a_flat_surface_may_lie_in_the_plane_of_the_empty():
    """New objects are all added at the same place."""
    ob = flat_square()
    frame = empty(location=(0.5, 0.5, 0), empty_display_size=0.5)
    shown = filled("Shown", noise((64, 64), alpha=False))
    common = {"source": "PLANAR", "image": "Shown", "empty": frame.name}
    made = project(ob, width=64, height=64, **common)
    np.testing.assert_allclose(truth.pixels(made), truth.pixels(shown), atol=1.01 / 255)
    result = bpy.ops.object.limit_project_image(mode="DECAL", decal_resolution=4, **common)
    assert result == {"FINISHED"}
    assert len(bpy.context.active_object.data.polygons) == 16


def test_one_side_only():
    ob = flat_square()
    frame = empty(location=(0.5, 0.5, -1), empty_display_size=0.5, rotation_euler=(np.pi, 0, 0))
    filled("Shown", noise((8, 8)))
    refused(ob, "may face away from the empty", source="PLANAR", empty=frame.name)


def test_depth_of_planar_projections():
    ob = flat_square()
    ob.rotation_euler.x = np.pi / 4  # z = y
    frame = empty(location=(0.5, 0.35, 1), empty_display_size=2)
    filled("Shown", np.ones((8, 8, 4)))
    made = project(
        ob, source="PLANAR", image="Shown", empty=frame.name, use_depth=True, depth=(0.5, 0.8),
        margin=0,
    )  # fmt: skip
    alpha = truth.pixels(made)[:, :, 3]
    z = (np.arange(TEXTURE[1]) + 0.5) / TEXTURE[1] / np.sqrt(2)
    inside = (z > 0.2) & (z < 0.5)
    np.testing.assert_array_equal(alpha > 0.5, np.broadcast_to(inside[:, None], alpha.shape))


def linear(values):
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def coded(values):
    return np.where(values <= 0.0031308, values * 12.92, 1.055 * values ** (1 / 2.4) - 0.055)


@pytest.mark.parametrize("opacity", [1.0, 0.25])
@pytest.mark.parametrize("below_is_float", [False, True])
@pytest.mark.parametrize("above_is_float", [False, True])
def test_images_are_blended_in_linear_light(above_is_float, below_is_float, opacity):
    """Colors are blended by alpha over (Porter and Duff) in linear light. Float images in Blender
    hold colors that are multiplied by alpha.
    """
    size = (16, 16)
    above, below = noise(size, 3), noise(size, 4)
    kept = [v.copy() for v in (above, below)]
    for is_float, values in ((above_is_float, kept[0]), (below_is_float, kept[1])):
        if is_float:
            values[..., :3] *= values[..., 3:]
        else:
            values[...] = np.rint(values * 255) / 255
    filled("Above", kept[0], above_is_float)
    target = filled("Below", kept[1], below_is_float)
    light = [
        values[..., :3] / np.where(values[..., 3:] > 0, values[..., 3:], 1) if is_float
        else linear(values[..., :3])
        for values, is_float in zip(kept, (above_is_float, below_is_float), strict=True)
    ]  # fmt: skip
    a, b = opacity * kept[0][..., 3:], kept[1][..., 3:]
    alpha = a + b * (1 - a)
    color = (a * light[0] + b * (1 - a) * light[1]) / alpha
    ob = flat_square()
    frame = empty(location=(0.5, 0.5, 1), empty_display_size=0.5)
    project(
        ob, source="PLANAR", image="Above", empty=frame.name, output="EXISTING", target="Below",
        opacity=opacity, facing=(0.1, 0.1),
    )  # fmt: skip
    found = truth.pixels(target)
    np.testing.assert_allclose(found[..., 3:], alpha, atol=2 / 255)
    expected = color * alpha if below_is_float else coded(color)
    tolerance = 1e-5 if above_is_float and below_is_float else 2 / 255
    visible = np.broadcast_to(alpha > 0.05, color.shape)
    np.testing.assert_allclose(found[..., :3][visible], expected[visible], atol=tolerance)


def test_data_is_taken_as_it_is():
    values = noise((16, 16), alpha=False)
    values = np.rint(values * 255) / 255
    filled("Shown", values, is_data=True)
    target = filled("Data", np.zeros((16, 16, 4)), is_data=True)
    frame = empty(location=(0.5, 0.5, 1), empty_display_size=0.5)
    project(
        flat_square(), source="PLANAR", image="Shown", empty=frame.name, output="EXISTING",
        target="Data",
    )  # fmt: skip
    np.testing.assert_allclose(truth.pixels(target), values, atol=0.51 / 255)


def test_only_what_is_painted_changes():
    """All other pixels keep their values, and margins around unpainted texels do, too."""
    ob = flat_square()
    before = noise((64, 64))
    target = filled("Below", before, is_float=True)
    before = truth.pixels(target)
    frame = empty(location=(0.5, 0.5, 1), empty_display_size=0.25)
    filled("Above", np.ones((8, 8, 4)))
    project(ob, source="PLANAR", image="Above", empty=frame.name, output="EXISTING", target="Below")
    found = truth.pixels(target)
    inside = np.zeros((64, 64), bool)
    inside[16:48, 16:48] = True
    np.testing.assert_array_equal(found[~inside], before[~inside])
    np.testing.assert_allclose(found[inside], 1, atol=1e-6)


def test_soft_edges_and_angles():
    ob = flat_square()
    frame = empty(location=(0.5, 0.5, 1), empty_display_size=0.5)
    filled("Shown", np.ones((64, 64, 4)))
    common = {"source": "PLANAR", "image": "Shown", "empty": frame.name, "use_float": True}
    soft = truth.pixels(project(ob, soft_edge=0.25, **common))[:, :, 3]
    row = soft[TEXTURE[1] // 2]
    assert (np.diff(row[: TEXTURE[0] // 2]) >= -1e-6).all()
    assert row[0] < 0.02
    assert row[TEXTURE[0] // 8] == pytest.approx(0.5, abs=0.02)
    np.testing.assert_allclose(row[TEXTURE[0] // 4 + 2 : TEXTURE[0] // 2], 1, atol=1e-6)
    ob.rotation_euler.x = np.radians(60)
    frame.empty_display_size = 4
    full, half, none = (
        truth.pixels(project(ob, facing=np.radians(angles), **common))[:, :, 3].mean()
        for angles in ((70, 80), (50, 70), (58, 62))
    )
    assert full == pytest.approx(1, abs=1e-6)
    assert 0.3 < half < 0.7
    assert 0.3 < none < 0.7
    with pytest.raises(RuntimeError, match="No part of the image"):
        project(ob, facing=np.radians((40, 59)), **common)


@pytest.mark.parametrize(("extension", "expected"), [
    ("EXTEND", [0, 0, 0, 1, 2, 3, 3, 3]), ("REPEAT", [2, 3, 0, 1, 2, 3, 0, 1]),
    ("MIRROR", [1, 0, 0, 1, 2, 3, 3, 2]),
])  # fmt: skip
def test_outside_the_image(extension, expected):
    steps = np.arange(4) / 4
    values = np.stack([np.broadcast_to(steps, (4, 4))] * 3 + [np.ones((4, 4))], axis=-1)
    filled("Steps", values, is_data=True)
    target = filled("Row", np.zeros((8, 8, 4)), is_data=True)
    frame = empty(location=(0.5, 0.5, 1), empty_display_size=0.25)
    project(
        flat_square(), source="PLANAR", image="Steps", empty=frame.name, output="EXISTING",
        target="Row", extension=extension,
    )  # fmt: skip
    found = truth.pixels(target)[4, :, 0]
    np.testing.assert_allclose(found, steps[expected], atol=1 / 255)


def test_boxes_project_from_six_sides():
    """An empty surrounds a cube: on each wall the image is upright, and not mirrored."""
    bpy.ops.mesh.primitive_cube_add(size=2)
    ob = bpy.context.active_object
    scenes.add_subsurf(ob).subdivision_type = "SIMPLE"
    frame = empty(empty_display_size=1.0)
    places = truth.image_of_places()
    made = project(ob, source="BOX", image=places.name, empty=frame.name, use_float=True, blend=0.0)
    values = truth.pixels(made)
    layer = ob.data.uv_layers.active.data
    seen = set()
    for polygon in ob.data.polygons:
        normal = np.array(polygon.normal)
        up = np.array((0, 0, 1.0) if abs(normal[2]) < 0.5 else (0, 1.0, 0))
        if normal[2] < -0.5:
            up = None  # the image may be turned there, but it is not mirrored
        corners = np.array([ob.data.vertices[v].co for v in polygon.vertices])
        uv = np.array([layer[i].uv for i in polygon.loop_indices])
        centre, uv_centre = corners.mean(axis=0), uv.mean(axis=0)
        for corner, at in zip(corners, uv, strict=True):
            place = truth.sampled(values, (0.9 * at + 0.1 * uv_centre)[None])[0]
            assert place[3] == pytest.approx(1, abs=1e-6)
            if up is not None:
                right = np.cross(up, normal)
                local = 0.9 * (corner - centre)
                expected = np.array([local @ right, local @ up]) / 2 + 0.5
                np.testing.assert_allclose(place[:2], expected, atol=1e-3)
        seen.add(tuple(np.rint(normal).astype(int)))
    assert len(seen) == 6


def test_along_normals_from_another_surface():
    """A copy of the sheet has the image: each place shows what lies above it."""
    ob = flat_square()
    carrier = ob.copy()
    carrier.data = ob.data.copy()
    bpy.context.collection.objects.link(carrier)
    carrier.location.z = 0.3
    carrier.scale = (2, 2, 1)
    carrier.location.x = -0.5
    shown = truth.image_of_places()
    common = {"source": "NORMALS", "image": shown.name, "from_object": carrier.name}
    made = project(ob, use_float=True, **common)
    y, x = (np.mgrid[: TEXTURE[1], : TEXTURE[0]] + 0.5) / TEXTURE[0]
    expected = np.stack([(x + 0.5) / 2, y / 2], axis=-1)
    found = truth.pixels(made)
    sure = (expected > 0.01).all(axis=-1)
    np.testing.assert_allclose(found[sure][:, :2], expected[sure], atol=1e-4)
    refused(ob, "No part of the image", direction="INWARD", **common)
    refused(ob, "No part of the image", max_distance=0.2, **common)
    project(ob, max_distance=0.4, direction="OUTWARD", **common)


def test_views_project_what_they_show():
    window = bpy.context.window_manager.windows[0]
    area = next(a for a in window.screen.areas if a.type == "VIEW_3D")
    region = next(r for r in area.regions if r.type == "WINDOW")
    shown = area.spaces.active.region_3d
    ob = flat_square()
    places = truth.image_of_places((80, 60))
    with bpy.context.temp_override(window=window, area=area, region=region):
        made = project(
            ob, source="VIEW", image=places.name, use_float=True, two_sided=True, facing=(1.5, 1.5)
        )
    y, x = (np.mgrid[: TEXTURE[1], : TEXTURE[0]] + 0.5) / TEXTURE[0]
    points = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)[::37]
    pixels = np.array([location_3d_to_region_2d(region, shown, Vector(p)) for p in points])
    room, size = np.array([region.width, region.height]), np.array([80, 60])
    expected = (pixels - room / 2) / (min(room / size) * size) + 0.5
    found = truth.pixels(made).reshape(-1, 4)[::37]
    assert found[:, 3].min() > 0.99
    np.testing.assert_allclose(found[:, :2], expected, atol=1e-4)


def test_tiles():
    """One image covers two of the tiles; the third stays as it was."""
    ob = scenes.add_mesh("Long", [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    ob.data.uv_layers.new(name="Map").data.foreach_set("uv", [0, 0, 2, 0, 2, 1, 0, 1])
    scenes.add_subsurf(ob).subdivision_type = "SIMPLE"
    blank = np.full((32, 32, 4), 0.5, np.float32)
    target = image_pixels.new_tiled(
        "Tiles", dict.fromkeys((1001, 1002, 1011), blank), is_float=False, is_data=True
    )
    values = noise((32, 64), alpha=False)
    filled("Shown", values, is_data=True)
    frame = empty(location=(1, 0.5, 1), empty_display_size=1)
    planar = {"source": "PLANAR", "image": "Shown", "empty": frame.name}
    project(ob, output="EXISTING", target="Tiles", margin=0, **planar)
    values = truth.pixels(bpy.data.images["Shown"])
    for tile, expected in ((1001, values[:, :32]), (1002, values[:, 32:]), (1011, blank)):
        np.testing.assert_allclose(image_pixels.read(target, tile), expected, atol=1.01 / 255)
    refused(ob, "The image Tiles is tiled", **planar | {"image": "Tiles"})


def state():
    """Returns all names, and all pixels."""
    images = {image.name: truth.pixels(image).tobytes() for image in bpy.data.images}
    objects = {ob.name: [slot.name for slot in ob.material_slots] for ob in bpy.data.objects}
    return scenes.file_contents(), images, objects


def refused(ob, match, **properties):
    scenes.activate(ob)
    before = state()
    given = {"image": "Shown", "width": 32, "height": 32} | properties
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_project_image(**given)
    assert state() == before


def test_refusals_about_images():
    ob, _ = flat_square(), truth.add_camera((0.5, 0.5, 3))
    filled("Shown", noise((8, 8)))
    filled("Target", noise((8, 8)))
    refused(ob, "Opacity is 0", opacity=0)
    missing = bpy.data.images.new("Missing", 8, 8)
    missing.source = "FILE"
    missing.filepath = "//nowhere.png"
    refused(ob, "Choose an image to project", image="")
    refused(ob, "There is no image 'nothing'", image="nothing")
    refused(ob, "The image Missing has no pixels", image="Missing")
    existing = {"output": "EXISTING"}
    refused(ob, "Choose an image to paint into", **existing)
    refused(ob, "There is no image 'nothing' to paint into", target="nothing", **existing)
    refused(ob, "The image Missing has no pixels", target="Missing", **existing)
    refused(ob, "Shown cannot be painted into itself", target="Shown", **existing)
    bpy.data.images["Target"].colorspace_settings.name = "AgX Base sRGB"
    refused(ob, "Target has the color space AgX Base sRGB", target="Target", **existing)
    refused(ob, "GiB of memory: turn on Allow Large Images", width=16384, height=16384)
    endless = np.ones((8, 8, 4))
    endless[2, 3, 1] = np.inf
    filled("Endless", endless, is_float=True)
    refused(ob, "The image Endless has values that are not finite", image="Endless")
    bpy.data.images["Shown"].source = "SEQUENCE"
    refused(ob, "The image Shown is an image sequence")


def test_refusals_about_uv_maps():
    truth.add_camera((0.5, 0.5, 3))
    filled("Shown", noise((8, 8)))
    bare = scenes.add_mesh("Bare", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    refused(bare, "Bare: there is no UV map")
    bare.data.uv_layers.new(name="Zero").data.foreach_set("uv", [0.5] * 8)
    refused(bare, "Bare: no face has an area on the UV map Zero")
    ob = flat_square()
    refused(ob, "Square has no UV map 'Other'", uv_map="Other")
    twice = scenes.flat_grid(2)
    twice.data.uv_layers.new(name="Twice").data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1] * 4)
    refused(twice, "The UV map overlaps itself at")
    assert project(twice, image="Shown", overlap="ALLOW")


def test_refusals_about_sources():
    ob = flat_square()
    filled("Shown", noise((8, 8)))
    refused(ob, "There is no camera")
    refused(ob, "There is no 3D view to project from", source="VIEW")
    refused(ob, "No empty is chosen", source="PLANAR")
    refused(ob, "There is no empty 'Square'", source="BOX", empty="Square")
    refused(ob, "No mesh is chosen", source="NORMALS")
    camera = truth.add_camera((0.5, 0.5, -3), (0.5, 0.5, -9))
    refused(ob, "No part of the image Shown reaches the surface")
    refused(ob, "There is no mesh 'Camera'", source="NORMALS", from_object=camera.name)
    refused(ob, "Full Up To is larger than", facing=(1.5, 1.0))


def test_cameras_inside_are_refused():
    bpy.ops.mesh.primitive_cube_add(size=2)
    ob = bpy.context.active_object
    truth.fine_subsurf(ob, 2)
    filled("Shown", noise((8, 8)))
    truth.add_camera((0, 0, 0), (1, 0, 0))
    for mode in ("TEXTURE", "DECAL"):
        refused(ob, "The camera Camera is inside the surface", mode=mode)


def test_materials_are_made_if_asked_for():
    ob = flat_square()
    truth.add_camera((0.5, 0.5, 3))
    filled("Shown", noise((8, 8)))
    made = project(ob, image="Shown")
    assert not ob.material_slots
    made = project(ob, image="Shown", create_material=True, target="Painted")
    material = ob.active_material
    assert linked_image(material) == made
    again = project(ob, image="Shown", create_material=True, target="Second")
    assert len(ob.material_slots) == 1
    assert linked_image(material) == again
    count = len(material.node_tree.nodes)
    project(ob, image="Shown", create_material=True, output="EXISTING", target="Second")
    assert len(material.node_tree.nodes) == count  # it is shown already


@pytest.mark.parametrize("use_float", [False, True])
def test_materials_keep_their_color_where_nothing_is_projected(use_float):
    """Cycles renders the square, of which the image covers half."""
    ob = flat_square()
    own = bpy.data.materials.new("Own")
    own.use_nodes = True
    own.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0, 1, 0, 1)
    ob.data.materials.append(own)
    camera = truth.add_camera((0.5, 0.5, 3), (0.5, 0.5, 0))
    filled("Shown", np.tile(np.float32([1, 0, 0, 1]), (8, 8, 1)))
    camera.location.x += 3 * np.tan(camera.data.angle / 2)
    bpy.context.view_layer.update()
    project(ob, image="Shown", create_material=True, use_float=use_float)
    camera.location.x = 0.5
    left, right = rendered_colors(own)
    assert np.abs(left - [0, 1, 0]).max() < 0.02
    assert np.abs(right - [1, 0, 0]).max() < 0.02


def rendered_colors(material):
    """Returns the base colors that are seen on the left and on the right."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    light = nodes.new("ShaderNodeEmission")
    links.new(nodes["Principled BSDF"].inputs["Base Color"].links[0].from_socket, light.inputs[0])
    links.new(light.outputs[0], nodes["Material Output"].inputs["Surface"])
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples = "CYCLES", 4
    scene.render.resolution_x = scene.render.resolution_y = 32
    scene.view_settings.view_transform = "Standard"
    with TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder, "shown.png"))
        bpy.ops.render.render(write_still=True)
        pixels = truth.pixels(bpy.data.images.load(scene.render.filepath))
    row = pixels.reshape(32, 32, 4)[16, :, :3]
    return row[12], row[20]


def test_linked_meshes_get_no_material(tmp_path):
    ob = flat_square()
    bpy.data.libraries.write(str(tmp_path / "library.blend"), {ob})
    bpy.data.objects.remove(ob)
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (there, linked):
        linked.objects = there.objects
    (ob,) = linked.objects
    bpy.context.collection.objects.link(ob)
    truth.add_camera((0.5, 0.5, 3))
    filled("Shown", noise((8, 8)))
    refused(ob, f"{ob.name} cannot be given a material: its mesh", create_material=True)
    project(ob, image="Shown")


def linked_image(material):
    """Returns the topmost image, which is mixed in by its alpha."""
    shader = next(n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    mix = shader.inputs["Base Color"].links[0].from_node
    texture = _links(mix, "B_Color")[0].from_node
    assert [link.from_socket.name for link in _links(mix, "Factor_Float")] == ["Alpha"]
    assert texture.inputs["Vector"].links[0].from_node.uv_map == "Map"
    return texture.image


def _links(node, identifier):
    return next(s for s in node.inputs if s.identifier == identifier).links


def test_undo_brings_the_pixels_back():
    ob = flat_square()
    truth.add_camera((0.5, 0.5, 3))
    filled("Shown", noise((8, 8)))
    target = filled("Target", noise((64, 64), 9))
    before = truth.pixels(target).copy()
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="Before")
    project(ob, image="Shown", output="EXISTING", target="Target")
    bpy.ops.ed.undo_push(message="Projected")
    after = truth.pixels(bpy.data.images["Target"]).copy()
    assert np.abs(after - before).max() > 0.1
    bpy.ops.ed.undo()
    np.testing.assert_array_equal(truth.pixels(bpy.data.images["Target"]), before)
    bpy.ops.ed.redo()
    np.testing.assert_array_equal(truth.pixels(bpy.data.images["Target"]), after)
