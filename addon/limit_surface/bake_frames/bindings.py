# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether what stands on a surface still fits it."""

from collections.abc import Sequence

import bpy

from .. import ids
from ..errors import RefusalError
from ..placing import followers, following, live
from ..placing.follow_state import State
from ..reading import attributes, cage


def check(objects: Sequence[bpy.types.Object]) -> None:
    """Raises RefusalError for the first object that is stale or broken in the current frame."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    cages: dict[bpy.types.Object, cage.Cage] = {}
    for ob in objects:
        check_live(ob, depsgraph.scene)
        surface = followers.surface_of(ob) if followers.is_placed(ob) else None
        if surface is None:
            continue
        if surface not in cages:
            cages[surface] = cage.read(surface, depsgraph)
        _check_following(ob, surface, following.signature(cages[surface]))
        _check_faces(ob, surface, cages[surface].ptex_face_count)


def check_live(ob: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Raises RefusalError if the object follows by handlers that could not pose it."""
    if followers.live_modifier_of(ob) is None:
        return
    if not live.is_enabled(scene):
        raise RefusalError(f"{ob.name} follows live, which is switched off in {scene.name}")
    reason = live.trouble(ob)
    if reason:
        raise RefusalError(reason)


def _check_following(ob: bpy.types.Object, surface: bpy.types.Object, signature: str) -> None:
    follows = followers.modifier_of(ob) is not None
    if not follows and not followers.was_bound(ob):
        return
    state = State(surface, [ob] if follows else [], [] if follows else [ob])
    for trouble in state.troubles(signature):
        raise RefusalError(f"{ob.name}: {trouble.text}; {trouble.remedy} puts it right")


def _check_faces(ob: bpy.types.Object, surface: bpy.types.Object, count: int) -> None:
    face = attributes.read(followers.holder_of(ob), ids.FACE)
    strays = int((face >= count).sum())
    if strays:
        raise RefusalError(
            f"{strays:,} of the {len(face):,} roots of {ob.name} are bound to faces that "
            f"{surface.name} does not have: its topology has changed since they were placed"
        )
