# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that an object's place and shape depend on."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import bpy

from ..nodes import groups


def needed_by(ob: bpy.types.Object) -> set[bpy.types.Object]:
    """Returns the objects that this one depends on, also by way of others: by parents, modifiers,
    constraints and drivers. Those that are named by a collection are the objects in it and in its
    children.
    """
    found: set[bpy.types.Object] = set()
    waiting = [ob]
    while waiting:
        for other in _direct(waiting.pop()):
            if other not in found:
                found.add(other)
                waiting.append(other)
    return found


def _direct(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    if ob.parent:
        yield ob.parent
    bones = ob.pose.bones if ob.pose else ()
    for item in (*ob.modifiers, *ob.constraints, *(c for bone in bones for c in bone.constraints)):
        yield from _pointers(item)
        for target in getattr(item, "targets", ()):  # those of an Armature constraint
            yield from _pointers(target)
        if item.type == "NODES":
            yield from _objects_in(groups.inputs_of(item))
            yield from _objects_in(groups.values_in(item.node_group))
    for block in (ob, ob.data, getattr(ob.data, "shape_keys", None)):
        drivers = block.animation_data.drivers if block and block.animation_data else ()
        for curve in drivers:
            for variable in curve.driver.variables:
                yield from _objects_in(target.id for target in variable.targets)


def _pointers(item: bpy.types.bpy_struct) -> Iterator[bpy.types.Object]:
    return _objects_in(
        getattr(item, p.identifier) for p in item.bl_rna.properties if p.type == "POINTER"
    )


def _objects_in(values: Iterable[object]) -> Iterator[bpy.types.Object]:
    for value in values:
        if isinstance(value, bpy.types.Object):
            yield value
        elif isinstance(value, bpy.types.Collection):
            yield from value.all_objects
