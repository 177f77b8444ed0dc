# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene without objects in which modifiers and drivers find the same settings as in the user's
scene.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from .. import ids
from ..errors import CageError

# In earlier versions a copy of a scene counts itself twice as a user of the objects that it links.
_CAN_COPY = bpy.app.version >= (4, 5)

_CARRIED = {
    "": ("frame_start", "frame_end", "camera", "gravity", "use_gravity"),
    "render": (
        *("fps", "fps_base", "frame_map_old", "frame_map_new"),
        *("use_simplify", "simplify_subdivision"),
    ),
    "unit_settings": ("system", "scale_length", "length_unit", "system_rotation"),
}


_bars: list[Bar] = []


class Bar:
    """`attempts` counts how often a private scene was asked for in vain."""

    def __init__(self) -> None:
        self.attempts = 0


@contextmanager
def barred() -> Iterator[Bar]:
    """Has `like` raise CageError as long as the context lasts. When data are added or removed while
    an exporter is at work, Blender builds its depsgraph again, with all objects of the scene.
    """
    _bars.append(Bar())
    try:
        yield _bars[-1]
    finally:
        _bars.pop()


def is_barred() -> bool:
    return bool(_bars)


@contextmanager
def like(scene: bpy.types.Scene) -> Iterator[bpy.types.Scene]:
    """Yields a private scene that exists as long as the context lasts."""
    if _bars:
        _bars[-1].attempts += 1
        raise CageError("no object can be evaluated on its own while an exporter is at work")
    private = scene.copy() if _CAN_COPY else bpy.data.scenes.new(ids.CAGE_SCENE)
    try:
        private.name = ids.CAGE_SCENE
        if _CAN_COPY:
            _empty(private)
        else:
            _carry_over(scene, private)
        # Assigning the frame also evaluates animation; frame_set would call all frame-change
        # handlers.
        private.frame_float = scene.frame_float
        yield private
    finally:
        _remove(private)


def layer(scene: bpy.types.Scene, shown: bpy.types.ViewLayer) -> bpy.types.ViewLayer:
    """Returns the private scene's counterpart of a view layer."""
    if _CAN_COPY:
        return scene.view_layers[shown.name]
    _carry_properties(shown, scene.view_layers[0])
    return scene.view_layers[0]


def _remove(scene: bpy.types.Scene) -> None:
    if bpy.context.window:
        bpy.data.scenes.remove(scene)
    else:  # Blender on the command line: scenes.remove would crash, because it asks for the window
        bpy.data.batch_remove([scene])


def _empty(scene: bpy.types.Scene) -> None:
    """Removes what would be evaluated with the scene, and keeps the settings that can be read from
    it.
    """
    scene.background_set = None
    scene.sequence_editor_clear()
    if scene.rigidbody_world:
        scene.rigidbody_world.collection = scene.rigidbody_world.constraints = None
    scene.collection.hide_viewport = False
    for child in scene.collection.children.values():
        scene.collection.children.unlink(child)
    for ob in scene.collection.objects.values():
        scene.collection.objects.unlink(ob)


def _carry_over(scene: bpy.types.Scene, private: bpy.types.Scene) -> None:
    for part, names in _CARRIED.items():
        source, target = (getattr(s, part) if part else s for s in (scene, private))
        for name in names:
            setattr(target, name, getattr(source, name))
    _carry_properties(scene, private)


def _carry_properties(source: bpy.types.bpy_struct, target: bpy.types.bpy_struct) -> None:
    for name, value in source.items():
        target[name] = value.to_dict() if hasattr(value, "to_dict") else value
