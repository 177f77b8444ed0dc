# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that an object's place and shape depend on, and the collections that it shows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import bpy

from ..nodes import groups


def needed_by(ob: bpy.types.Object) -> set[bpy.types.Object]:
    """Returns the objects that this one depends on, also by way of others: by parents, modifiers,
    constraints and drivers. Those that are named by a collection are the objects in it and in its
    children.
    """
    return {item for item in _reached(ob, _direct) if isinstance(item, bpy.types.Object)}


def collections_shown_by(
    item: bpy.types.Object | bpy.types.Collection,
) -> set[bpy.types.Collection]:
    """Returns the collections of which instances of an object or of a collection consist, or on
    which they depend: itself, its children, and those that are instanced by what is in them. What
    shows such instances cannot be in one of these collections itself.
    """
    reached = (item, *_reached(item, _shown))
    return {each for each in reached if isinstance(each, bpy.types.Collection)}


def _reached(
    start: bpy.types.ID, direct: Callable[[bpy.types.ID], Iterator[bpy.types.ID]]
) -> set[bpy.types.ID]:
    found: set[bpy.types.ID] = set()
    waiting = [start]
    while waiting:
        for other in direct(waiting.pop()):
            if other not in found:
                found.add(other)
                waiting.append(other)
    return found


def _shown(item: bpy.types.ID) -> Iterator[bpy.types.ID]:
    yield from _direct(item)
    if isinstance(item, bpy.types.Object) and item.instance_collection:
        yield item.instance_collection


def _direct(item: bpy.types.ID) -> Iterator[bpy.types.ID]:
    if isinstance(item, bpy.types.Collection):
        yield from item.all_objects
        yield from item.children_recursive
    else:
        yield from _direct_of_object(item)


def _direct_of_object(ob: bpy.types.Object) -> Iterator[bpy.types.ID]:
    if ob.parent:
        yield ob.parent
    bones = ob.pose.bones if ob.pose else ()
    for item in (*ob.modifiers, *ob.constraints, *(c for bone in bones for c in bone.constraints)):
        yield from _pointers(item)
        for target in getattr(item, "targets", ()):  # those of an Armature constraint
            yield from _pointers(target)
        if item.type == "NODES":
            yield from _blocks_in(groups.inputs_of(item))
            yield from _blocks_in(groups.values_in(item.node_group))
    for block in (ob, ob.data, getattr(ob.data, "shape_keys", None)):
        drivers = block.animation_data.drivers if block and block.animation_data else ()
        for curve in drivers:
            for variable in curve.driver.variables:
                yield from _blocks_in(target.id for target in variable.targets)


def _pointers(item: bpy.types.bpy_struct) -> Iterator[bpy.types.ID]:
    return _blocks_in(
        getattr(item, p.identifier) for p in item.bl_rna.properties if p.type == "POINTER"
    )


def _blocks_in(values: Iterable[object]) -> Iterator[bpy.types.ID]:
    for value in values:
        if isinstance(value, bpy.types.Object | bpy.types.Collection):
            yield value
