# SPDX-License-Identifier: GPL-3.0-or-later
"""Images as they were before a change of their pixels failed, but for the pixels themselves, which
`pixel_undo` restores.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy


@contextmanager
def settings_restored(image: bpy.types.Image) -> Iterator[None]:
    """Restores the image's settings if a change of its pixels fails, before the pixels that it
    showed are restored.
    """
    source, alpha_mode, was_packed = image.source, image.alpha_mode, bool(image.packed_files)
    try:
        yield
    except BaseException:
        if image.source != "TILED":
            if image.packed_files and not was_packed:
                image.unpack(method="REMOVE")
            if image.source != source:
                image.source = source
        if image.alpha_mode != alpha_mode:
            image.alpha_mode = alpha_mode
        raise


@contextmanager
def packing_restored(image: bpy.types.Image, is_kept: bool) -> Iterator[None]:
    """Has the .blend file hold what it held of the image, if a change of its pixels fails and they
    have been restored. `is_kept` tells whether the change packs the pixels of an image without
    tiles.
    """
    was_packed = bool(image.packed_files)
    try:
        yield
    except BaseException:
        if is_kept and was_packed:
            image.pack()
        elif image.source == "TILED" and image.packed_files and not was_packed:
            image.unpack(method="REMOVE")
            image.reload()
        raise
