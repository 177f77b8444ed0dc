# SPDX-License-Identifier: GPL-3.0-or-later
"""Modifiers of following that have lost their node group."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ..nodes import groups
from ..nodes.capture import CAPTURE
from ..nodes.follow import (
    FOLLOW_BEZIER,
    FOLLOW_HAIR,
    FOLLOW_NORMALS,
    FOLLOW_ORIENTED,
    FOLLOW_POINTS,
)
from ..nodes.follow_curve import FOLLOW_CURVE
from ..nodes.tiles import TILES
from ..tasks.object_keys import ObjectKey

_KINDS = (
    CAPTURE,
    TILES,
    FOLLOW_HAIR,
    FOLLOW_BEZIER,
    FOLLOW_POINTS,
    FOLLOW_ORIENTED,
    FOLLOW_NORMALS,
    FOLLOW_CURVE,
)


@contextmanager
def mended() -> Iterator[None]:
    """Gives these modifiers their groups again, and takes them back if an error occurs. Nothing is
    held until then: undo may replace it, and users may make groups of their own meanwhile.
    """
    before = {group.session_uid for group in bpy.data.node_groups}
    found: list[tuple[ObjectKey, str]] = []
    for ob, modifier, kind in list(_broken()):
        modifier.node_group = kind.group()
        found.append((ObjectKey.of(ob), modifier.name))
    try:
        yield
    except BaseException:
        for key, name in found:
            ob = key.among(bpy.data.objects)
            if ob is not None and name in ob.modifiers:
                ob.modifiers[name].node_group = None
        while made := _unused_since(before):
            bpy.data.batch_remove(made)
        raise


def _unused_since(before: set[int]) -> list[bpy.types.NodeTree]:
    """Returns the groups that are none of these, by their session_uid, and that nothing uses."""
    return [
        group
        for group in bpy.data.node_groups
        if group.session_uid not in before and not group.users
    ]


def is_broken(ob: bpy.types.Object) -> bool:
    """Tells whether one of these modifiers has lost its group, or its group one within it."""
    return any(True for kind in _KINDS for _modifier in groups.without_group(ob, kind.name)) or any(
        groups.has_lost_a_group(modifier.node_group)
        for kind in _KINDS
        for modifier in groups.modifiers(ob, kind.name)
    )


def _broken() -> Iterator[tuple[bpy.types.Object, bpy.types.NodesModifier, groups.Kind]]:
    for ob in bpy.data.objects:
        if ob.library is None:
            for kind in _KINDS:
                for modifier in groups.without_group(ob, kind.name):
                    yield ob, modifier, kind
