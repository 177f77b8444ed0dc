# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that make an object and then have it follow: a failure of the second step must not
leave the object behind.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

_MADE = ("objects", "hair_curves", "pointclouds", "meshes", "materials", "node_groups")


@contextmanager
def all_or_nothing(context: bpy.types.Context, surface: bpy.types.Object) -> Iterator[None]:
    """Where an error leaves the context, removes what has been added to the file and to the
    surface's modifiers within it, and selects what was selected before.
    """
    before, modifiers = set(_blocks()), set(surface.modifiers.keys())
    active, selected = context.view_layer.objects.active, list(context.selected_objects)
    try:
        yield
    except BaseException:
        for name in set(surface.modifiers.keys()) - modifiers:
            surface.modifiers.remove(surface.modifiers[name])
        bpy.data.batch_remove([block for block in _blocks() if block not in before])
        for ob in context.selected_objects:
            ob.select_set(False)
        for ob in selected:
            ob.select_set(True)
        context.view_layer.objects.active = active
        raise


def _blocks() -> Iterator[bpy.types.ID]:
    for kind in _MADE:
        yield from getattr(bpy.data, kind, ())
