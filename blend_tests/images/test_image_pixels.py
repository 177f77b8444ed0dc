# SPDX-License-Identifier: GPL-3.0-or-later
"""Images as arrays of pixels: they are read, written, saved and undone."""

from pathlib import Path

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.errors import RefusalError
from limit_surface.images import image_files, image_pixels, pixel_undo

SIZE = (6, 4)  # width, height


def some_pixels(seed: int, width: int = 6, height: int = 4) -> np.ndarray:
    """Returns multiples of 1/255, opaque, which 8 bits represent exactly."""
    pixels = np.random.default_rng(seed).integers(0, 256, (height, width, 4)).astype(np.float32)
    pixels[:, :, 3] = 255
    return pixels / np.float32(255)


def raw(image: bpy.types.Image) -> np.ndarray:
    flat = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(flat)
    return flat.reshape(image.size[1], image.size[0], -1)


def new_image(kind: str, folder) -> bpy.types.Image:
    """Makes an image: generated, packed or from a file, with 8-bit or float pixels."""
    source, depth = kind.split()
    image = image_pixels.new(kind, *SIZE, is_float=depth == "float", is_data=False)
    image.pixels.foreach_set(some_pixels(0).ravel())
    if source == "packed":
        image.pack()
    if source == "file":
        kind = image_files.EXR_32 if depth == "float" else image_files.PNG_8
        image_pixels.save(image, folder / f"image{kind.suffix}", kind)
    return image


KINDS = [
    f"{source} {depth}" for source in ("generated", "packed", "file") for depth in ("8", "float")
]


@pytest.mark.parametrize("kind", KINDS)
def test_pixels_are_read_and_written(kind, tmp_path):
    image = new_image(kind, tmp_path)
    described = image_pixels.checked(image, to_write=True)
    assert (described.width, described.height, described.channels) == (*SIZE, 4)
    assert described.is_float == kind.endswith("float")
    np.testing.assert_allclose(image_pixels.read(image), some_pixels(0), atol=1e-6)
    image_pixels.write(image, some_pixels(1))
    np.testing.assert_allclose(raw(image), some_pixels(1), atol=1e-6)
    assert image.is_dirty == kind.startswith("file")
    assert bool(image_pixels.unsaved(image)) == kind.startswith("file")
    assert image.colorspace_settings.name == described.colorspace


class Writes(bpy.types.Operator):
    """Write pixels, for the tests"""

    bl_idname = "image.limit_test_write"
    bl_label = "Write"
    bl_options = {"REGISTER", "UNDO"}

    image: bpy.props.StringProperty()
    seed: bpy.props.IntProperty()
    tile: bpy.props.IntProperty(default=1001)

    def execute(self, _context):
        image = bpy.data.images.get(self.image)
        if image is None:
            image = image_pixels.new(self.image, *SIZE, is_float=True, is_data=True)
        image_pixels.write(image, some_pixels(self.seed), self.tile)
        return {"FINISHED"}


@pytest.fixture
def write():
    bpy.utils.register_class(Writes)
    bpy.ops.ed.undo_push(message="before")
    yield lambda name, seed, tile=1001: bpy.ops.image.limit_test_write(
        "EXEC_DEFAULT", True, image=name, seed=seed, tile=tile
    )
    bpy.utils.unregister_class(Writes)


def shows(name: str, seed: int) -> bool:
    return np.allclose(raw(bpy.data.images[name]), some_pixels(seed), atol=1e-6)


@pytest.mark.parametrize("kind", KINDS)
def test_writing_is_undone_and_redone(kind, tmp_path, write):
    new_image(kind, tmp_path)
    bpy.ops.ed.undo_push(message="an image")
    for seed in (1, 2, 3):
        write(kind, seed)
    for seed in (2, 1, 0):
        bpy.ops.ed.undo()
        assert shows(kind, seed)
    for seed in (1, 2, 3):
        bpy.ops.ed.redo()
        assert shows(kind, seed)
    bpy.ops.ed.undo()
    write(kind, 4)
    bpy.ops.ed.undo()
    assert shows(kind, 2)


@pytest.mark.parametrize("kind", KINDS)
def test_pixels_outlast_the_undo_of_something_else(kind, tmp_path, write):
    """Blender drops unsaved pixels at later undo steps, once a write has been undone and redone."""
    scenes.monkey()
    new_image(kind, tmp_path)
    bpy.ops.ed.undo_push(message="an image")
    write(kind, 1)
    bpy.ops.ed.undo()
    bpy.ops.ed.redo()
    bpy.ops.object.select_all("EXEC_DEFAULT", True, action="SELECT")
    bpy.ops.object.duplicate("EXEC_DEFAULT", True)
    for step in (bpy.ops.ed.undo, bpy.ops.ed.redo, bpy.ops.ed.undo):
        step()
        assert shows(kind, 1)


def test_several_writes_are_undone_at_once(tmp_path, write):
    new_image("generated 8", tmp_path)
    bpy.ops.ed.undo_push(message="an image")
    for seed in (1, 2, 3):
        write("generated 8", seed)
    bpy.ops.ed.undo_push(message="something else")
    bpy.ops.ed.undo_history(item=2)
    seed = next(s for s in range(4) if shows("generated 8", s))
    assert seed < 2  # versions of Blender count their undo steps differently
    bpy.ops.ed.undo_history(item=4)
    assert shows("generated 8", seed + 2)


def kept_files() -> set[str]:
    return {file.name for file in Path(bpy.app.tempdir).glob("limit_surface_*.npy")}


@pytest.mark.parametrize("kind", KINDS)
def test_pixels_between_two_writes_are_stored_once(kind, tmp_path, write):
    new_image(kind, tmp_path)
    bpy.ops.ed.undo_push(message="an image")
    before = kept_files()
    for i, seed in enumerate((1, 2, 3)):
        write(kind, seed)
        assert len(kept_files() - before) == i + 2
    for seed in (2, 1, 0):
        bpy.ops.ed.undo()
        assert shows(kind, seed)


@pytest.mark.parametrize("depth", ["8", "float"])
def test_pixels_painted_between_two_writes_come_back(depth, tmp_path, write):
    kind = f"generated {depth}"
    image = new_image(kind, tmp_path)
    bpy.ops.ed.undo_push(message="an image")
    write(kind, 1)
    painted = some_pixels(1)
    painted[2, 3, :3] = 0
    bpy.data.images[kind].pixels.foreach_set(painted.ravel())
    write(kind, 2)
    bpy.ops.ed.undo()
    np.testing.assert_allclose(raw(bpy.data.images[kind]), painted, atol=1e-6)
    del image


def test_the_oldest_pixels_are_dropped_and_shared_ones_are_kept(tmp_path, write, monkeypatch):
    new_image("generated float", tmp_path)
    bpy.ops.ed.undo_push(message="an image")
    write("generated float", 1)
    monkeypatch.setattr(
        pixel_undo,
        "MOST_KEPT",
        2
        * sum(Path(bpy.app.tempdir, name).stat().st_size for name in kept_files())
        // len(kept_files()),
    )
    before = kept_files()
    for seed in (2, 3):
        write("generated float", seed)
    assert len(kept_files() - before) == 2
    assert not before & kept_files()
    bpy.ops.ed.undo()
    assert shows("generated float", 2)
    bpy.ops.ed.redo()
    assert shows("generated float", 3)


def test_a_new_image_comes_back(write):
    write("made", 1)
    bpy.ops.ed.undo()
    assert "made" not in bpy.data.images
    bpy.ops.ed.redo()
    assert shows("made", 1)


def test_new_images_are_kept_in_the_file(tmp_path):
    for is_float in (True, False):
        image = image_pixels.new("new", *SIZE, is_float=is_float, is_data=True)
        pixels = some_pixels(0)
        if is_float:
            pixels[0, 0, :3] = (-3, 1e-4, 7.5)
        image_pixels.write(image, pixels, is_new=True)
        image.colorspace_settings.name = "Non-Color"  # Blender reads the pixels again
        np.testing.assert_allclose(raw(image), pixels, rtol=1e-7, atol=1e-7)
        bpy.data.images.remove(image)


def test_new_images_that_nothing_uses_outlast_saving(tmp_path):
    image_pixels.write(
        image_pixels.new("one", *SIZE, is_float=True, is_data=True), some_pixels(1), is_new=True
    )
    tiles = {1001: some_pixels(2), 1002: some_pixels(3)}
    image_pixels.new_tiled("tiled", tiles, is_float=True, is_data=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "saved.blend"))
    assert shows("one", 1)
    for tile, pixels in tiles.items():
        found = image_pixels.read(bpy.data.images["tiled"], tile)
        np.testing.assert_allclose(found, pixels, atol=1e-6)


def numbers(image: bpy.types.Image) -> np.ndarray:
    """Returns pixels as the image can hold them, partly transparent."""
    pixels = np.random.default_rng(9).integers(1, 255, (SIZE[1], SIZE[0], 4)).astype(np.float32)
    if image.is_float:
        pixels[0, 0] = 51, 12.75, 0, 1e-4
    return pixels / np.float32(255)


@pytest.mark.parametrize("is_new", [True, False], ids=["new", "existing"])
@pytest.mark.parametrize("space", ["sRGB", "Linear Rec.709", "Non-Color"])
@pytest.mark.parametrize("depth", ["8", "float"])
def test_pixels_that_the_file_holds_outlast_saving(depth, space, is_new, tmp_path):
    """Whatever alpha means, unless Blender converts the pixels of packed images."""
    expected = {}
    for alpha_mode in ("STRAIGHT", "PREMUL", "CHANNEL_PACKED"):
        for source in ("generated", "packed"):
            is_float = depth == "float"
            name = f"{source} {alpha_mode}"
            if is_new:
                image = image_pixels.new(name, *SIZE, is_float=is_float, is_data=False)
            else:
                image = bpy.data.images.new(name, *SIZE, alpha=True, float_buffer=is_float)
                image.use_fake_user = True
                image.alpha_mode = alpha_mode
            if not is_float or space != "sRGB":
                image.colorspace_settings.name = space
            if source == "packed":
                image.pack()
            image_pixels.write(image, numbers(image), is_new=is_new)
            is_converted = depth == "8" and image.alpha_mode == "PREMUL" and space != "Non-Color"
            assert bool(image_pixels.unsaved(image)) == is_converted
            if not is_converted:
                expected[name] = raw(image)
                np.testing.assert_allclose(expected[name], numbers(image), rtol=1e-6)
    assert len(expected) >= 4
    path = str(tmp_path / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    for name, pixels in expected.items():
        np.testing.assert_array_equal(raw(bpy.data.images[name]), pixels)


def test_a_write_that_fails_leaves_the_pixels(tmp_path):
    image = new_image("generated 8", tmp_path)
    with pytest.raises(ValueError, match="expected"):
        image_pixels.write(image, some_pixels(1, width=5))
    np.testing.assert_allclose(raw(image), some_pixels(0), atol=1e-6)
    assert not image.keys()


@pytest.mark.parametrize("name", sorted(image_files.KINDS))
def test_data_are_saved_as_they_are(name, tmp_path):
    kind = image_files.KINDS[name]
    image = image_pixels.new("data", *SIZE, is_float=True, is_data=True)
    pixels = some_pixels(0)
    pixels[0, 0] = (0.1, 0.2, 0.3, 1)
    if kind.is_float:
        pixels[1, 1, :3] = (-3, 7.5, 1000)
    image_pixels.write(image, pixels)
    image_pixels.save(image, tmp_path / f"data{kind.suffix}", kind)
    step = {"EXR_32": 0, "EXR_16": 5e-4, "PNG_16": 0.6 / 65535, "PNG_8": 0.6 / 255}[name]
    np.testing.assert_allclose(raw(image), pixels, rtol=5e-4 if name == "EXR_16" else 0, atol=step)
    assert image.colorspace_settings.name == "Non-Color"
    assert not image.is_dirty
    again = bpy.data.images.load(str(tmp_path / f"data{kind.suffix}"))
    again.colorspace_settings.name = "Non-Color"
    np.testing.assert_allclose(raw(again), raw(image))
    assert again.is_float == (name != "PNG_8")


def test_colours_are_saved_in_their_space(tmp_path):
    image = new_image("generated 8", tmp_path)
    image_pixels.save(image, tmp_path / "colour.png", image_files.PNG_8)
    np.testing.assert_allclose(raw(image), some_pixels(0), atol=1e-6)
    image = new_image("generated float", tmp_path)
    image_pixels.save(image, tmp_path / "colour.exr", image_files.EXR_32)
    np.testing.assert_allclose(raw(image), some_pixels(0), atol=1e-6)


def test_a_tiled_image(tmp_path, write):
    tiles = {1001: some_pixels(0), 1002: some_pixels(5), 1011: some_pixels(6, 3, 2)}
    image = image_pixels.new_tiled("tiled", tiles, is_float=False, is_data=True)
    assert image_pixels.checked(image).tiles == {1001: SIZE, 1002: SIZE, 1011: (3, 2)}
    bpy.ops.ed.undo_push(message="an image")
    write("tiled", 7, 1002)
    image = bpy.data.images["tiled"]
    for number, seed in ((1001, 0), (1002, 7)):
        np.testing.assert_allclose(image_pixels.read(image, number), some_pixels(seed), atol=1e-6)
    np.testing.assert_allclose(image_pixels.read(image, 1011), tiles[1011], atol=1e-6)
    bpy.ops.ed.undo()
    np.testing.assert_allclose(
        image_pixels.read(bpy.data.images["tiled"], 1002), some_pixels(5), atol=1e-6
    )
    bpy.ops.ed.redo()
    image = bpy.data.images["tiled"]
    np.testing.assert_allclose(image_pixels.read(image, 1002), some_pixels(7), atol=1e-6)
    image_pixels.save(image, tmp_path / "saved.<UDIM>.png", image_files.PNG_8)
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        f"saved.{number}.png" for number in sorted(tiles)
    ]
    np.testing.assert_allclose(image_pixels.read(image, 1002), some_pixels(7), atol=1e-6)
    image_pixels.write(image, some_pixels(8), 1001)
    file = bpy.data.images.load(str(tmp_path / "saved.1001.png"))
    file.colorspace_settings.name = "Non-Color"
    np.testing.assert_allclose(raw(file), some_pixels(0), atol=1e-6)
    np.testing.assert_allclose(image_pixels.read(image), some_pixels(8), atol=1e-6)


def test_what_is_refused(tmp_path):
    def refused(image, message, **how):
        with pytest.raises(RefusalError, match=message):
            image_pixels.checked(image, **how)

    refused(None, "No image")
    missing = image_pixels.new("missing", *SIZE, is_float=False, is_data=False)
    missing.source, missing.filepath = "FILE", str(tmp_path / "nothing.png")
    refused(missing, "missing has no pixels: check that its file exists")
    movie = bpy.data.images.new("movie", 2, 2)
    movie.source = "MOVIE"
    refused(movie, "movie is a movie")
    image = new_image("generated 8", tmp_path)
    with pytest.raises(RefusalError, match="no tile 1002"):
        image_pixels.read(image, 1002)
    with pytest.raises(RefusalError, match="no folder"):
        image_pixels.save(image, tmp_path / "nowhere" / "a.png", image_files.PNG_8)
    assert image.source == "GENERATED"


def test_images_of_several_layers_are_refused_at_once(tmp_path):
    scene = bpy.context.scene
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.resolution_x = scene.render.resolution_y = 4
    bpy.context.view_layer.use_pass_z = True
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):  # from Blender 5.0 on
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.filepath = str(tmp_path / "layers.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    with pytest.raises(RefusalError, match="layers.exr has several layers"):
        image_pixels.checked(image)


def test_linked_images_are_read_but_not_written(tmp_path):
    new_image("packed 8", tmp_path)
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {bpy.data.images["packed 8"]})
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (_, to):
        to.images = ["packed 8"]
    image = bpy.data.images["packed 8"]
    np.testing.assert_allclose(image_pixels.read(image), some_pixels(0), atol=1e-6)
    with pytest.raises(RefusalError, match="linked"):
        image_pixels.checked(image, to_write=True)


def test_nothing_is_left_behind(tmp_path, write):
    new_image("packed 8", tmp_path)
    write("packed 8", 1)
    assert not [i for i in bpy.data.images if i.name.startswith(".")]
    assert [s.name for s in bpy.data.scenes] == ["Scene"]
