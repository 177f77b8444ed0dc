# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps that were baked into files a second time show after undo and redo what the files hold."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from limit_surface.images import image_files, image_tiles

UNDO, REDO = bpy.ops.ed.undo, bpy.ops.ed.redo


def image() -> bpy.types.Image:
    return bpy.data.images["Grid Position"]


def pixels() -> np.ndarray:
    return image_tiles.read_all(image())[1001]


def after(*steps: Callable[[], set[str]]) -> np.ndarray:
    for step in steps:
        step()
    return pixels()


def bake_twice(folder: Path, form: str) -> list[np.ndarray]:
    """Returns the pixels after each of the bakes, between which the mesh changes."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=3)
    mesh, made = bpy.context.active_object.data, []
    mesh.vertices[10].co.z = 1  # so that the range of heights in PNG files stays the same
    for height in (0.1, 0.3):
        mesh.vertices[5].co.z = height
        mesh.update()
        bpy.ops.ed.undo_push(message="before")
        settings = {"maps": {"POSITION"}, "width": 8, "height": 8, "format": form}
        bpy.ops.object.limit_bake_maps("EXEC_DEFAULT", True, **settings, folder=str(folder))
        made.append(pixels())
    assert np.abs(made[1] - made[0]).max() > 0.01
    return made


@pytest.mark.parametrize("form", image_files.KINDS)
def test_redo_shows_the_files(tmp_path, form):
    first, second = bake_twice(tmp_path, form)
    np.testing.assert_array_equal(after(UNDO), first)
    assert image().is_dirty  # the file holds the second bake
    for steps in ((REDO,), (UNDO, UNDO, REDO, REDO)):
        np.testing.assert_array_equal(after(*steps), second)
        assert not image().is_dirty


def test_a_file_that_was_changed_meanwhile_is_not_shown(tmp_path):
    _, second = bake_twice(tmp_path, "EXR_16")
    UNDO()
    (file,) = tmp_path.iterdir()
    image_files.save_pixels(np.zeros((8, 8, 4), np.float32), file, image_files.EXR_16)
    np.testing.assert_array_equal(after(REDO), second)
    assert image().is_dirty
