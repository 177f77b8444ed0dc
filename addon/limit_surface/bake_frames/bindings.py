# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether what stands on a surface still fits it."""

from collections.abc import Iterator, Sequence

import bpy

from .. import ids
from ..errors import RefusalError
from ..nodes import groups
from ..nodes.follow import TILES
from ..placing import followers, following, live
from ..placing.follow_state import State
from ..reading import attributes, cage
from ..tasks.counting import by_count, counted


def check(objects: Sequence[bpy.types.Object]) -> None:
    """Raises RefusalError for the first object that is stale or broken in the current frame."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    cages: dict[bpy.types.Object, cage.Cage] = {}
    for ob in objects:
        for thing in (ob, *_parents(ob)):
            check_live(thing, depsgraph.scene)
            surface = followers.surface_of(thing) if followers.is_placed(thing) else None
            if surface is None:
                continue
            if surface not in cages:
                cages[surface] = cage.read(surface, depsgraph)
            _check_following(thing, surface, following.signature(cages[surface]))
            _check_faces(thing, surface, cages[surface].ptex_face_count)
            _check_nodes(thing, depsgraph.scene)


def check_frame(ob: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Raises RefusalError if the object cannot follow its surface in the current frame."""
    check_live(ob, scene)
    for thing in (ob, *_parents(ob)):
        _check_nodes(thing, scene)


def check_live(ob: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Raises RefusalError if the object follows by handlers that could not pose it."""
    if followers.live_modifier_of(ob) is None:
        return
    if not live.is_enabled(scene):
        raise RefusalError(f"{ob.name} follows live, which is switched off in {scene.name}")
    reason = live.trouble(ob)
    if reason:
        raise RefusalError(reason)


def _parents(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Yields what the object is parented to: attached objects follow by a parent."""
    while ob.parent:
        ob = ob.parent
        yield ob


def _check_nodes(ob: bpy.types.Object, scene: bpy.types.Scene) -> None:
    modifier = followers.modifier_of(ob)
    if modifier is None:
        return
    if not (modifier.show_viewport and modifier.show_render):
        raise RefusalError(f"{ob.name} does not follow: its modifier {modifier.name} is disabled")
    table = groups.get_input(modifier, TILES)
    if table is None:
        return  # a trouble that the state names
    shown = table.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.attributes
    if ids.CAGE_FITS in shown and not shown[ids.CAGE_FITS].data[0].value:
        raise RefusalError(
            f"{ob.name} is at rest in frame {scene.frame_current}: the control mesh of its surface "
            "has other faces, other creases or another order of vertices there than when it was "
            "bound"
        )


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
            f"{strays:,} of the {counted(len(face), 'roots')} of {ob.name} "
            f"{by_count(strays, 'is', 'are')} bound to faces that "
            f"{surface.name} does not have: its topology has changed since they were placed"
        )
