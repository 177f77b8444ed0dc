# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair, points, images and meshes exactly on the limit surface of subdivided meshes."""

import atexit

import bpy

from . import (
    attach,
    bake_displacement,
    bake_frames,
    bake_maps,
    children,
    curvature,
    draw,
    follow,
    hair,
    limit_mesh,
    particles,
    points,
    preferences,
    project_image,
    report,
    sampling,
    snap,
    snap_modal,
    ui,
)
from .follow import stale
from .images import pixel_undo
from .placing import live_count
from .tasks import running

_parts = (
    preferences,
    hair,
    children,
    points,
    snap,
    snap_modal,
    draw,
    ui,
    particles,
    report,
    curvature,
    follow,
    attach,
    sampling,
    limit_mesh,
    bake_maps,
    bake_displacement,
    bake_frames,
    project_image,
)

# The bpy module hangs at the interpreter's exit if classes are still registered.
_is_module = not bpy.app.binary_path


def register() -> None:
    for part in _parts:
        for cls in part.classes:
            if issubclass(cls, bpy.types.Operator):
                # tooltips would show line breaks
                cls.bl_description = " ".join(cls.__doc__.split())
            bpy.utils.register_class(cls)
    snap.attach_settings()
    live_count.attach_handlers()
    pixel_undo.attach_handlers()
    follow.attach_handlers()
    stale.attach_handlers()  # it reports what could not be posed in a file that was loaded
    bake_frames.attach_command()
    sampling.attach_library()
    ui.append_menus()
    ui.attach_presets()
    if _is_module:
        atexit.register(unregister)


def unregister() -> None:
    atexit.unregister(unregister)
    running.end_all()
    ui.detach_presets()
    ui.remove_menus()
    sampling.detach_library()
    bake_frames.detach_command()
    stale.detach_handlers()
    follow.detach_handlers()
    pixel_undo.detach_handlers()
    live_count.detach_handlers()
    snap.detach_settings()
    for part in reversed(_parts):
        for cls in reversed(part.classes):
            bpy.utils.unregister_class(cls)
