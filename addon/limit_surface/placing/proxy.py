# SPDX-License-Identifier: GPL-3.0-or-later
"""A stand-in for the surface in the viewport.

Whoever reads a subdivided mesh forces Blender to subdivide it on the processor, although the
viewport alone would have the graphics card do it. The proxy is a copy of the surface's object that
shares its mesh and ends at *Limit Capture*. It is in no collection, so that it is never shown.

Blender keeps it in step with the surface (`in_step`), except for what no driver can carry over.
`trouble` tells whether the surface has changed in such a way. What is written into a file never
depends on a proxy: `aside` has nodes read the surfaces themselves.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np

from .. import ids
from ..nodes import groups
from ..nodes.follow import TILES
from ..reading import attributes, copied_object, overrides
from ..reading.cage import Cage
from ..reading.users import objects_using
from . import in_step
from .followers import modifier_of

USE, OBJECT = "Use Proxy", "Proxy"

# relative to the diagonal of the control mesh; both copies are evaluated in single precision
_SAME = 1e-6


def update(surface: bpy.types.Object | None, table: bpy.types.Object, wanted: bool | None) -> None:
    """Makes the proxy anew, so that its modifiers are those of the surface, or removes it where
    none is wanted or there is no surface. None keeps what there was: a proxy or none.
    """
    modifier = _modifier(table)
    if modifier is None:  # somebody has removed it, and Blender removes a proxy that nobody uses
        return
    old = groups.get_input(modifier, OBJECT)
    if wanted is None:
        wanted = bool(groups.get_input(modifier, USE))
    groups.set_input(modifier, USE, wanted)
    proxy = _copy(surface) if wanted and surface else None
    groups.set_input(modifier, OBJECT, proxy)
    # the tables of a full copy of the scene name the proxy of the original surface
    if old is not None and old.library is None and not objects_using(old):
        bpy.data.objects.remove(old)
    if proxy is not None and surface:
        proxy.name = f"{ids.PROXY_OBJECT} of {surface.name}"


def is_used(table: bpy.types.Object) -> bool:
    """Tells whether nodes read the proxy in the viewport."""
    modifier = _modifier(table)
    return modifier is not None and bool(groups.get_input(modifier, USE))


def is_read_by(ob: bpy.types.Object) -> bool:
    """Tells whether an object follows by nodes that read a proxy in the viewport."""
    modifier = modifier_of(ob)
    table = groups.get_input(modifier, TILES) if modifier else None
    return table is not None and is_used(table)


def trouble(surface: bpy.types.Object, table: bpy.types.Object) -> str:
    """Returns a sentence about why the proxy does not stand for the surface, as far as that can be
    seen without an evaluation, or nothing.
    """
    if not is_used(table):
        return ""
    proxy = groups.get_input(_modifier(table), OBJECT)
    if proxy is None:
        return f"The hidden copy of {surface.name} for Fast Viewport was deleted"
    reason = in_step.why_not(proxy, surface)
    return f"{_called(proxy, surface)} {reason}" if reason else ""


def trouble_in(
    found: Cage,
    surface: bpy.types.Object,
    table: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
) -> str:
    """Returns a sentence where the proxy has another shape in this frame than the control mesh of
    the surface, or nothing.
    """
    proxy = groups.get_input(_modifier(table), OBJECT) if is_used(table) else None
    shown = proxy.evaluated_get(depsgraph) if proxy is not None else None
    if proxy is None or shown is None or not shown.is_evaluated:
        return ""
    now = found.mesh.positions
    if ids.CAGE_POSITION in shown.data.attributes:
        there = attributes.read(shown.data, ids.CAGE_POSITION)
        size = float(np.linalg.norm(np.ptp(now, axis=0))) if len(now) else 0.0
        if there.shape == now.shape and np.abs(there - now).max(initial=0.0) <= _SAME * size:
            return ""
    return f"{_called(proxy, surface)} has another shape than {surface.name} in this frame"


def _called(proxy: bpy.types.Object, surface: bpy.types.Object) -> str:
    return (
        f"What follows {surface.name} by nodes may be at wrong places in the viewport, because its "
        f"hidden copy {proxy.name}, which Fast Viewport reads,"
    )


@contextmanager
def aside() -> Iterator[None]:
    """Has all nodes read the surfaces themselves, also in the viewport, as long as the context
    lasts.
    """
    kinds = [group for group in bpy.data.node_groups if groups.is_of(group, ids.TILES_GROUP)]
    used = [ob for ob in objects_using(*kinds) if is_used(ob)]
    for table in used:
        groups.set_input(_modifier(table), USE, False)
    try:
        yield
    finally:
        for table in used:
            groups.set_input(_modifier(table), USE, True)


def _modifier(table: bpy.types.Object) -> bpy.types.NodesModifier | None:
    return next(groups.modifiers(table, ids.TILES_GROUP), None)


def _copy(surface: bpy.types.Object) -> bpy.types.Object:
    proxy = overrides.make_own(copied_object.of(surface))
    capture = next(groups.modifiers(proxy, ids.CAPTURE_GROUP))
    for modifier in proxy.modifiers[proxy.modifiers.find(capture.name) + 1 :]:
        proxy.modifiers.remove(modifier)
    in_step.keep(proxy, surface)
    return proxy
