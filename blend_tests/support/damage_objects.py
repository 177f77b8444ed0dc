# SPDX-License-Identifier: GPL-3.0-or-later
"""Damage to objects and to whole files: transforms, modifiers, collections, libraries, images."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from damage_kinds import NAN, Damage, DoesNotApplyError, needs
from limit_surface import ids


def placed(name: str, value: tuple[float, ...]) -> Damage:
    def damage(ob: bpy.types.Object, _folder: Path) -> None:
        setattr(ob, name, value)

    return damage


def parent_of_scale_0(ob: bpy.types.Object, _folder: Path) -> None:
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    parent.scale = (0, 0, 0)
    ob.parent = parent


def keyframed(ob: bpy.types.Object, _folder: Path) -> None:
    for frame, scale in ((1, 0), (10, 1)):
        ob.scale = (scale,) * 3
        ob.keyframe_insert("scale", frame=frame)
    bpy.context.scene.frame_set(1)


def driven_to_nan(ob: bpy.types.Object, _folder: Path) -> None:
    ob.driver_add("location", 0).driver.expression = "sqrt(0) * float('nan')"


def shared_data(ob: bpy.types.Object, _folder: Path) -> None:
    if ob.data is None:
        raise DoesNotApplyError
    other = ob.copy()
    bpy.context.collection.objects.link(other)
    other.select_set(True)


def modifier_before(kind: str, **settings: object) -> Damage:
    def damage(ob: bpy.types.Object, _folder: Path) -> None:
        needs(ob, "MESH")
        modifier = ob.modifiers.new("Before", kind)
        for name, value in settings.items():
            setattr(modifier, name, value)
        if kind != "MULTIRES":  # which must be the first one
            ob.modifiers.move(len(ob.modifiers) - 1, 0)

    return damage


def nothing_by_nodes(ob: bpy.types.Object, _folder: Path) -> None:
    """A modifier whose nodes give no geometry at all."""
    if ob.type not in ("MESH", "CURVES", "CURVE"):
        raise DoesNotApplyError
    modifier = ob.modifiers.new("Nothing", "NODES")
    tree = bpy.data.node_groups.new("Nothing", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    tree.nodes.new("NodeGroupOutput")
    modifier.node_group = tree
    ob.modifiers.move(len(ob.modifiers) - 1, 0)


def no_modifiers(ob: bpy.types.Object, _folder: Path) -> None:
    ob.modifiers.clear()


def modifiers_disabled(ob: bpy.types.Object, _folder: Path) -> None:
    for modifier in ob.modifiers:
        modifier.show_viewport = modifier.show_render = False


def groups_removed(_ob: bpy.types.Object, _folder: Path) -> None:
    if not bpy.data.node_groups:
        raise DoesNotApplyError
    bpy.data.batch_remove(list(bpy.data.node_groups))


def groups_emptied(_ob: bpy.types.Object, _folder: Path) -> None:
    if not bpy.data.node_groups:
        raise DoesNotApplyError
    for group in bpy.data.node_groups:
        group.nodes.clear()
        group.interface.clear()


def tables_removed(ob: bpy.types.Object, _folder: Path) -> None:
    """Hidden tables are in no collection."""
    tables = [each for each in bpy.data.objects if each.name not in bpy.context.scene.objects]
    if not tables:
        raise DoesNotApplyError
    bpy.data.batch_remove(tables)


def tables_emptied(ob: bpy.types.Object, _folder: Path) -> None:
    tables = [each for each in bpy.data.objects if each.name not in bpy.context.scene.objects]
    if not tables:
        raise DoesNotApplyError
    for table in tables:
        if table.type == "MESH":
            table.data.clear_geometry()


def strings_for_properties(ob: bpy.types.Object, _folder: Path) -> None:
    """Custom properties hold something else than the extension has stored."""
    for block in (*bpy.data.objects, *bpy.data.meshes, *bpy.data.hair_curves, *bpy.data.curves):
        for name in (ids.SIGNATURE, ids.OFFSET, ids.FACE, ids.UV, ids.CHILDREN_SETTINGS,
                     ids.LIVE_WRITTEN, ids.ALL_TILES_MARK, ids.FACES_MARK,
                     ids.CHILDREN_GUIDES, ids.REPORT):  # fmt: skip
            block[name] = "text"


def hidden(ob: bpy.types.Object, _folder: Path) -> None:
    ob.hide_set(True)


def disabled(ob: bpy.types.Object, _folder: Path) -> None:
    ob.hide_viewport = ob.hide_render = ob.hide_select = True


def in_no_collection(ob: bpy.types.Object, _folder: Path) -> None:
    for collection in ob.users_collection:
        collection.objects.unlink(ob)


def in_an_excluded_collection(ob: bpy.types.Object, folder: Path) -> None:
    in_no_collection(ob, folder)
    collection = bpy.data.collections.new("Excluded")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(ob)
    bpy.context.view_layer.layer_collection.children["Excluded"].exclude = True


def removed(ob: bpy.types.Object, _folder: Path) -> None:
    bpy.data.objects.remove(ob)


def data_removed(ob: bpy.types.Object, _folder: Path) -> None:
    if ob.data is None:
        raise DoesNotApplyError
    bpy.data.batch_remove([ob.data])


def mode(name: str) -> Damage:
    def damage(ob: bpy.types.Object, _folder: Path) -> None:
        bpy.context.view_layer.objects.active = ob
        try:
            bpy.ops.object.mode_set(mode=name)
        except (RuntimeError, TypeError) as error:
            raise DoesNotApplyError from error

    return damage


def nothing_active(_ob: bpy.types.Object, _folder: Path) -> None:
    bpy.context.view_layer.objects.active = None


def nothing_selected(_ob: bpy.types.Object, _folder: Path) -> None:
    for ob in bpy.context.selected_objects:
        ob.select_set(False)


def everything_selected(_ob: bpy.types.Object, _folder: Path) -> None:
    for kind, data in (
        ("Light", bpy.data.lights.new("Light", "POINT")),
        ("Text", bpy.data.curves.new("Text", "FONT")),
        ("Lattice", bpy.data.lattices.new("Lattice")),
        ("Surface", bpy.data.curves.new("Surface", "SURFACE")),
        ("Meta", bpy.data.metaballs.new("Meta")),
        ("Armature", bpy.data.armatures.new("Armature")),
        ("Speaker", bpy.data.speakers.new("Speaker")),
        ("Volume", bpy.data.volumes.new("Volume")),
        ("Cloud", bpy.data.pointclouds.new("Cloud")),
        ("Curves", bpy.data.hair_curves.new("Curves")),
        ("Empty curve", bpy.data.curves.new("Empty curve", "CURVE")),
        ("Empty mesh", bpy.data.meshes.new("Empty mesh")),
    ):
        bpy.context.collection.objects.link(bpy.data.objects.new(kind, data))
    for ob in bpy.context.view_layer.objects:
        ob.select_set(True)


def linked(ob: bpy.types.Object, folder: Path) -> None:
    _through_library(ob, folder)


def linked_and_overridden(ob: bpy.types.Object, folder: Path) -> None:
    again = _through_library(ob, folder)
    made = again.override_create(remap_local_usages=True)
    if made is None:
        raise DoesNotApplyError
    if made.name not in bpy.context.collection.objects:
        bpy.context.collection.objects.link(made)


def _through_library(ob: bpy.types.Object, folder: Path) -> bpy.types.Object:
    """Moves an object into another file, from which it is linked."""
    file = folder / f"library {ob.name}.blend"
    name, was_selected = ob.name, ob.select_get()
    was_active = bpy.context.view_layer.objects.active == ob
    bpy.data.libraries.write(str(file), {ob}, fake_user=True)
    with bpy.data.libraries.load(str(file), link=True) as (_, found):
        found.objects = [name]
    again = found.objects[0]
    ob.user_remap(again)
    bpy.data.objects.remove(ob)
    if again.name not in bpy.context.collection.objects:
        bpy.context.collection.objects.link(again)
    again.select_set(was_selected)
    if was_active:
        bpy.context.view_layer.objects.active = again
    return again


def picture_without_pixels(_ob: bpy.types.Object, _folder: Path) -> None:
    image = _picture()
    image.source, image.filepath = "FILE", "//missing.png"
    image.reload()


def picture_not_finite(_ob: bpy.types.Object, _folder: Path) -> None:
    _picture()
    bpy.data.images.remove(bpy.data.images["Picture"])
    image = bpy.data.images.new("Picture", 4, 4, float_buffer=True)
    image.pixels.foreach_set(np.full(64, NAN, np.float32))


def picture_movie(_ob: bpy.types.Object, _folder: Path) -> None:
    image = _picture()
    image.filepath, image.source = "//missing.avi", "MOVIE"


def picture_tiled(_ob: bpy.types.Object, _folder: Path) -> None:
    _picture()
    bpy.data.images.remove(bpy.data.images["Picture"])
    bpy.data.images.new("Picture", 4, 4, tiled=True)


def picture_removed(_ob: bpy.types.Object, _folder: Path) -> None:
    bpy.data.images.remove(_picture())


def _picture() -> bpy.types.Image:
    image = bpy.data.images.get("Picture")
    if image is None:
        raise DoesNotApplyError
    return image
