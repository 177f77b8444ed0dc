# SPDX-License-Identifier: GPL-3.0-or-later
"""Images that change together: if one of them cannot be changed, all show what they showed."""

import numpy as np
import pytest
from limit_surface.errors import RefusalError
from limit_surface.images import image_files, image_pixels

KINDS = ("packed", "generated", "file", "tiled", "tiled files")


def pixels(value):
    return np.full((4, 6, 4), value, np.float32)


def image(kind, folder, value):
    if kind.startswith("tiled"):
        tiles = {1001: pixels(value), 1002: pixels(value)}
        made = image_pixels.new_tiled(kind, tiles, is_float=True, is_data=True)
        if kind == "tiled files":
            image_pixels.save(made, folder / "tiles.<UDIM>.exr", image_files.EXR_32)
        return made
    made = image_pixels.new(kind, 6, 4, is_float=True, is_data=True)
    made.pixels.foreach_set(pixels(value).ravel())
    made.update()
    if kind == "packed":
        made.pack()
    if kind == "file":
        image_pixels.save(made, folder / "image.exr", image_files.EXR_32)
    return made


def state(of):
    return of.source, len(of.packed_files), of.filepath_raw, of.alpha_mode, of.use_fake_user


@pytest.mark.parametrize("kind", KINDS)
def test_an_error_takes_the_change_back(kind, tmp_path):
    changed = image(kind, tmp_path, 0.25)
    before = state(changed)
    written = {tile: pixels(0.5) for tile in image_pixels.checked(changed).tiles}

    def change():
        with image_pixels.written(changed, written):
            for tile in written:
                np.testing.assert_array_equal(image_pixels.read(changed, tile), 0.5)
            raise RefusalError("later")

    with pytest.raises(RefusalError, match="later"):
        change()
    assert state(changed) == before
    for tile in written:
        np.testing.assert_array_equal(image_pixels.read(changed, tile), 0.25)
    if changed.packed_files:
        changed.reload()
        np.testing.assert_array_equal(image_pixels.read(changed), 0.25)
