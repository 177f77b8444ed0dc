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
    """Gives these modifiers their groups again, and takes them back if an error occurs."""
    found = list(_broken())
    groups_before = set(bpy.data.node_groups)
    for modifier, kind in found:
        modifier.node_group = kind.group()
    try:
        yield
    except BaseException:
        for modifier, _kind in found:
            modifier.node_group = None
        for group in set(bpy.data.node_groups) - groups_before:
            bpy.data.node_groups.remove(group)
        raise


def is_broken(ob: bpy.types.Object) -> bool:
    """Tells whether one of these modifiers has lost its group, or its group one within it."""
    return any(True for kind in _KINDS for _modifier in groups.without_group(ob, kind.name)) or any(
        groups.has_lost_a_group(modifier.node_group)
        for kind in _KINDS
        for modifier in groups.modifiers(ob, kind.name)
    )


def _broken() -> Iterator[tuple[bpy.types.NodesModifier, groups.Kind]]:
    for ob in bpy.data.objects:
        if ob.library is None:
            for kind in _KINDS:
                for modifier in groups.without_group(ob, kind.name):
                    yield modifier, kind
