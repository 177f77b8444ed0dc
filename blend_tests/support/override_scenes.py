# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces with hair in a library, linked and overridden in another file."""

from collections.abc import Callable
from pathlib import Path

import bpy
import follow_scenes
import live_scenes
import scenes
from follow_scenes import FRAMES, deforming
from limit_surface.placing.followers import live_modifier_of


def followed(follow: str = "NODES", **properties: object) -> tuple[bpy.types.Object, ...]:
    ob = deforming("grid with holes")
    return ob, scenes.add_hair(ob, tilt=(0.4, 0.2), follow=follow, **properties)


def check_frames(ob: bpy.types.Object, hair: bpy.types.Object) -> None:
    follows_live = live_modifier_of(hair) is not None
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        if follows_live:
            live_scenes.check_hair(ob, hair)
        else:
            follow_scenes.check_hair(ob, hair)


def save(folder: Path) -> str:
    path = str(folder / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return path


def save_collection(
    folder: Path, make: Callable[..., object] = followed, **properties: object
) -> str:
    """Saves what `make` makes in a collection, with nothing else, and returns the path."""
    groom = bpy.data.collections.new("Groom")
    bpy.context.scene.collection.children.link(groom)
    layer = bpy.context.view_layer.layer_collection.children["Groom"]
    bpy.context.view_layer.active_layer_collection = layer
    make(**properties)
    for each in list(bpy.context.scene.objects):
        if each.name not in groom.objects:
            groom.objects.link(each)
    path = save(folder)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return path


def append_collection(path: str, link: bool) -> bpy.types.Collection:
    with bpy.data.libraries.load(path, link=link) as (there, here):
        here.collections = [name for name in there.collections if name == "Groom"]
    return here.collections[0]


def override(path: str) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Overrides the collection, and returns the surface and its hair, whose tables are overrides,
    too.
    """
    linked = append_collection(path, link=True)
    bpy.context.scene.collection.children.link(linked)
    linked.override_hierarchy_create(
        bpy.context.scene, bpy.context.view_layer, do_fully_editable=True
    )
    return overridden()


def overridden() -> tuple[bpy.types.Object, bpy.types.Object]:
    """Returns the overrides of the surface and of the hair."""
    own = [ob for ob in bpy.data.objects if ob.override_library]
    ob = next(ob for ob in own if ob.name.startswith("Holes"))
    return ob, next(ob for ob in own if ob.type == "CURVES")


def reopen(folder: Path) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Saves the file, opens it again, and returns the overrides."""
    path = str(folder / "shot.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    return overridden()
