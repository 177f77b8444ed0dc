# SPDX-License-Identifier: GPL-3.0-or-later
"""A stand-in for the surface in the viewport.

Whoever reads a subdivided mesh forces Blender to subdivide it on the processor, although the
viewport alone would have the graphics card do it. The proxy is a copy of the surface's object that
shares its mesh and ends at *Limit Capture*. It is in no collection, so that it is never shown.
"""

import bpy

from .. import ids
from ..nodes import groups
from ..reading import copied_object, overrides

USE, OBJECT = "Use Proxy", "Proxy"


def update(surface: bpy.types.Object | None, table: bpy.types.Object, wanted: bool | None) -> None:
    """Makes the proxy anew, so that its modifiers are those of the surface, or removes it where
    none is wanted or there is no surface. None keeps what there was: a proxy or none.
    """
    modifier = next(groups.modifiers(table, ids.TILES_GROUP), None)
    if modifier is None:  # somebody has removed it, and Blender removes a proxy that nobody uses
        return
    old = groups.get_input(modifier, OBJECT)
    if wanted is None:
        wanted = bool(groups.get_input(modifier, USE))
    groups.set_input(modifier, USE, wanted)
    proxy = _copy(surface) if wanted and surface else None
    groups.set_input(modifier, OBJECT, proxy)
    if old is not None and old.library is None:
        bpy.data.objects.remove(old)
    if proxy is not None and surface:
        proxy.name = f"{ids.PROXY_OBJECT} of {surface.name}"


def _copy(surface: bpy.types.Object) -> bpy.types.Object:
    proxy = overrides.make_own(copied_object.of(surface))
    capture = next(groups.modifiers(proxy, ids.CAPTURE_GROUP))
    for modifier in proxy.modifiers[proxy.modifiers.find(capture.name) + 1 :]:
        proxy.modifiers.remove(modifier)
    return proxy
