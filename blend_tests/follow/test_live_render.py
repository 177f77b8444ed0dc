# SPDX-License-Identifier: GPL-3.0-or-later
"""Live hair in renders: every frame shows its own pose, and motion is blurred."""

import bpy
import live_scenes
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from live_scenes import follow

SIDE = 64
WORLD = 4.0  # the width of the picture in the scene


def bar(with_garment: bool = False) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Adds a sheet that moves by 1 in each frame along x, by a shape key, and live hair on it: one
    thick strand, which the camera looks at. A garment is a mesh between them that follows live.
    """
    ob = scenes.flat_grid(4)
    positions = attributes.read(ob.data, ids.POSITION) - [2, 2, 0]
    attributes.write(ob.data, ids.POSITION, "FLOAT_VECTOR", "POINT", positions)
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Moved", from_mix=False)
    key.slider_min, key.slider_max = -10, 10
    key.data.foreach_set("co", (positions + [1, 0, 0]).astype(np.float32).ravel())
    key.driver_add("value").driver.expression = "frame - 1"
    bpy.context.scene.frame_set(1)
    scenes.add_subsurf(ob)
    if with_garment:
        ob.hide_render = True
        assert bpy.ops.object.limit_mesh(levels=1, follow="NONE", store_locations=True) == {
            "FINISHED"
        }
        ob = bpy.context.object
        ob.name = "A surface that Blender lists first"
        follow(ob)
    shape = {"length": 0.5, "points": 4, "radius": 0.12}
    hair = scenes.add_hair(ob, distribution="UNIFORM", count=1, follow="NONE", **shape)
    bpy.context.scene.camera.location.x = float(scenes.strands(hair)[0, 0, 0]) + 0.5
    follow(hair)
    ob.hide_render = True
    return ob, hair


@pytest.fixture
def camera():
    scene = bpy.context.scene
    data = bpy.data.cameras.new("Camera")
    data.type, data.ortho_scale = "ORTHO", WORLD
    camera = bpy.data.objects.new("Camera", data)
    scene.collection.objects.link(camera)
    camera.location, camera.rotation_euler = (0.5, -10, 0.25), (np.pi / 2, 0, 0)
    scene.camera = camera
    scene.world = bpy.data.worlds.new("White")
    scene.world.use_nodes = True
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 16, False
    scene.cycles.device = "CPU"
    scene.render.film_transparent = True
    scene.render.resolution_x = scene.render.resolution_y = SIDE
    scene.render.image_settings.color_mode = "RGBA"
    return scene


def coverage(path) -> np.ndarray:
    """Returns how much of each column of pixels the hair covers, at half of its length."""
    image = bpy.data.images.load(str(path))
    pixels = np.empty(SIDE * SIDE * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(SIDE, SIDE, 4)[SIDE // 2, :, 3]


def middle(alpha: np.ndarray) -> float:
    x = (np.arange(SIDE) + 0.5) / SIDE * WORLD - WORLD / 2
    x += bpy.context.scene.camera.location.x
    return float(np.average(x, weights=alpha))


def width(alpha: np.ndarray) -> float:
    return float((alpha > 0.02).sum() / SIDE * WORLD)


@pytest.mark.parametrize("with_garment", [False, True])
def test_every_frame_of_an_animation_shows_its_own_pose(camera, tmp_path, with_garment):
    _, hair = bar(with_garment)
    camera.frame_set(1)
    start = float(scenes.strands(hair)[0, 0, 0])
    camera.frame_start, camera.frame_end = 1, 2
    camera.render.filepath = str(tmp_path / "frame")
    bpy.ops.render.render(animation=True)
    for frame in (1, 2):
        alpha = coverage(tmp_path / f"frame{frame:04}.png")
        assert abs(middle(alpha) - (start + frame - 1)) < 0.05
        assert width(alpha) < 0.5


def test_a_garment_with_a_modifier_of_renders(camera, tmp_path):
    """The garment is moved up by 1 in renders only, and its hair with it."""
    _, hair = bar(with_garment=True)
    garment = hair.data.surface
    modifier = garment.modifiers.new("Raised", "DISPLACE")
    modifier.direction, modifier.strength, modifier.mid_level = "Z", 1.0, 0.0
    modifier.show_viewport = False
    garment.modifiers.move(garment.modifiers.find("Raised"), 0)
    camera.frame_set(1)
    start = float(scenes.strands(hair)[0, 0, 0])
    camera.camera.location.z += 1
    camera.frame_start, camera.frame_end = 1, 2
    camera.render.filepath = str(tmp_path / "frame")
    bpy.ops.render.render(animation=True)
    for frame in (1, 2):
        assert abs(middle(coverage(tmp_path / f"frame{frame:04}.png")) - (start + frame - 1)) < 0.05


def test_motion_is_blurred(camera, tmp_path):
    _, hair = bar()
    camera.frame_set(1)
    start = float(scenes.strands(hair)[0, 0, 0])
    camera.render.use_motion_blur, camera.render.motion_blur_shutter = True, 1.0
    camera.cycles.samples = 64
    camera.render.filepath = str(tmp_path / "blurred.png")
    bpy.ops.render.render(write_still=True)
    alpha = coverage(tmp_path / "blurred.png")
    assert abs(middle(alpha) - start) < 0.1
    assert 0.9 < width(alpha) < 1.5  # the shutter's way of 1, and the strand's width


def test_a_still_shows_the_frame_that_it_is_rendered_at(camera, tmp_path):
    _, hair = bar()
    camera.frame_set(1)
    start = float(scenes.strands(hair)[0, 0, 0])
    camera.frame_current = 2  # a script may do so without an update
    camera.render.filepath = str(tmp_path / "still.png")
    bpy.ops.render.render(write_still=True)
    assert abs(middle(coverage(tmp_path / "still.png")) - (start + 1)) < 0.05


def test_linked_hair_follows(tmp_path):
    ob = live_scenes.deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (there, here):
        here.objects = [name for name in there.objects if name in ("Cross", ids.HAIR_OBJECT)]
    for linked in here.objects:
        bpy.context.scene.collection.objects.link(linked)
    ob, hair = bpy.data.objects["Cross"], bpy.data.objects[ids.HAIR_OBJECT]
    for frame in (30, 7):
        bpy.context.scene.frame_set(frame)
        check_linked(hair, path, frame)


def check_linked(hair: bpy.types.Object, path: str, frame: int) -> None:
    """Compares with the frame in the library's own file, which a process of its own would show."""
    shown = live_scenes.follow_truth.shown_strands(hair).copy()
    at_rest = live_scenes.rest(hair)
    assert np.abs(shown - at_rest).max() > 0.01 or frame == 1
    limit = live_scenes.limit_of(hair)
    at = limit.evaluate(*scenes.locations(hair.data)).position
    assert np.abs(shown[:, 0] - at).max() < 2e-5


def test_an_override_follows(tmp_path):
    ob = live_scenes.deforming("cross")
    hair = scenes.add_hair(ob, follow="NONE")
    follow(hair)
    collection = bpy.data.collections.new("Asset")
    bpy.context.scene.collection.children.link(collection)
    for thing in (ob, hair):
        collection.objects.link(thing)
        bpy.context.scene.collection.objects.unlink(thing)
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (_, here):
        here.collections = ["Asset"]
    layer = bpy.context.view_layer
    bpy.data.collections["Asset"].override_hierarchy_create(
        bpy.context.scene, layer, do_fully_editable=True
    )
    hair = next(o for o in bpy.context.scene.objects if o.type == "CURVES" and not o.library)
    surface = next(o for o in bpy.context.scene.objects if o.type == "MESH" and not o.library)
    surface.location.x += 3
    for frame in (30, 7):
        bpy.context.scene.frame_set(frame)
        live_scenes.check_hair(surface, hair)
