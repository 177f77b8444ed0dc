# SPDX-License-Identifier: GPL-3.0-or-later
"""Animated values that were changed without a key: Blender shows them until the frame changes.

The evaluation of a new scene computes all animation again, and writes the values into the file. So
what was changed without a key would be lost, and the shape that is read would not be the one that
is shown.
"""

from __future__ import annotations

from collections.abc import Iterator

import bpy


def put_back(
    evaluated_now: bpy.types.Depsgraph,
    shown: bpy.types.Depsgraph,
    copies: dict[bpy.types.ID, bpy.types.ID],
) -> bool:
    """Gives the data-blocks that one depsgraph has evaluated the values that another one shows,
    wherever they are animated. `copies` are data-blocks that stand for others. Returns whether any
    value was another one.
    """
    has_changed = False
    for original in _animated_blocks(evaluated_now):
        there = copies.get(original, original).evaluated_get(shown)
        if not there.is_evaluated:
            continue
        copied = [_copy(there, original, *value) for value in _animated(original.animation_data)]
        if any(copied):
            original.update_tag()  # custom properties do not do that themselves
            has_changed = True
    return has_changed


def _animated_blocks(depsgraph: bpy.types.Depsgraph) -> list[bpy.types.ID]:
    """Returns the data-blocks that have actions and that a depsgraph has evaluated. Its own list of
    data-blocks lacks objects on which others only depend.
    """
    actions = set(bpy.data.actions)
    if not actions:
        return []
    users = set().union(*bpy.data.user_map(subset=actions).values())
    return [
        user
        for user in users
        if getattr(user, "animation_data", None) and user.evaluated_get(depsgraph).is_evaluated
    ]


def _animated(animation: bpy.types.AnimData) -> Iterator[tuple[str, int]]:
    """Yields the paths and the indices in arrays of all values that have curves."""
    curves = list(_curves(animation.action, getattr(animation, "action_slot", None)))
    for track in animation.nla_tracks:
        for strip in track.strips:
            curves += _curves(strip.action, getattr(strip, "action_slot", None))
    yield from dict.fromkeys((curve.data_path, curve.array_index) for curve in curves)


def _curves(action: bpy.types.Action | None, slot: object) -> Iterator[bpy.types.FCurve]:
    if action is None:
        return
    if slot is None:  # before Blender 4.4
        yield from getattr(action, "fcurves", ())
        return
    for layer in action.layers:
        for strip in layer.strips:
            bag = strip.channelbag(slot)
            if bag:
                yield from bag.fcurves


def _copy(source: bpy.types.ID, target: bpy.types.ID, path: str, index: int) -> bool:
    """Copies a value, and returns whether it was another one. What a curve belonged to may have
    been deleted, and some values cannot be written.
    """
    try:
        old, new = target.path_resolve(path), source.path_resolve(path)
        if hasattr(old, "__len__") and not isinstance(old, str):
            is_other = old[index] != new[index]
            if is_other:
                old[index] = new[index]
            return bool(is_other)
        if old == new:
            return False
        owner = target.path_resolve(path, False).data
        if path.endswith('"]'):
            owner[path.rpartition('["')[2].removesuffix('"]')] = new
        else:
            setattr(owner, path.rpartition(".")[2], new)
    except (ValueError, AttributeError, TypeError, IndexError, KeyError):
        return False
    return True
