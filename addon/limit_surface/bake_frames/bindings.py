# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether what stands on a surface still fits it."""

from collections.abc import Iterator, Sequence

import bpy

from .. import ids
from ..counting import by_count, counted
from ..errors import RefusalError
from ..nodes import children, groups
from ..nodes.follow import TILES
from ..placing import all_tiles, capture_place, followers, following, live, live_children, live_kept
from ..placing.follow_state import State, Trouble
from ..reading import attributes, cage, modifier_kinds, rules


def check(objects: Sequence[bpy.types.Object]) -> None:
    """Raises RefusalError for the first object that is stale or broken in the current frame."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    cages: dict[bpy.types.Object, cage.Cage] = {}
    for ob in objects:
        for thing in _needed(ob):
            check_live(thing, depsgraph.scene)
            ground = live_children.surface_of(thing)
            _check_growing(thing)
            stands = followers.is_placed(thing) or followers.is_astray(thing)
            surface = followers.surface_of(thing) if stands else ground
            if surface is None:
                continue
            if surface not in cages:
                cages[surface] = cage.read(surface, depsgraph)
            signature = following.signature(cages[surface])
            if ground is not None:
                _check_children(thing, surface, signature)
            else:
                _check_following(thing, surface, signature)
                _check_faces(thing, surface, cages[surface].ptex_face_count)
            _check_nodes(thing, depsgraph.scene)


def check_frame(ob: bpy.types.Object, scene: bpy.types.Scene, as_rendered: bool) -> None:
    """Raises RefusalError if the object cannot follow its surface in the current frame.
    `as_rendered` tells that what renders show is written, and not what the viewport shows.
    """
    for thing in _needed(ob):
        check_live(thing, scene)
        _check_nodes(thing, scene)
        if as_rendered:
            _check_render(thing)


def check_posed(ob: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Raises RefusalError if the object could not be posed when it was last evaluated."""
    for thing in _needed(ob):
        check_live(thing, scene)


def check_live(ob: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Raises RefusalError if the object follows by handlers that could not pose it."""
    if followers.live_modifier_of(ob) is None:
        return
    if not live.is_enabled(scene):
        raise RefusalError(f"{ob.name} follows live, which is switched off in {scene.name}")
    reason, remedy = live_kept.trouble(ob), live_kept.remedy(ob)
    if reason:
        raise RefusalError(f"{reason}; {remedy} puts it right" if remedy else reason)


def _check_render(ob: bpy.types.Object) -> None:
    """Raises RefusalError where renders show other faces of its surface than the viewport, to which
    the object is bound.
    """
    surface = followers.followed_surface(ob) or live_children.surface_of(ob)
    if surface is None:
        return
    before = surface.modifiers[: rules.place_of_subsurf(surface)]
    hands_on = any(groups.modifiers(surface, ids.CAPTURE_GROUP))
    hands_on = hands_on and not capture_place.hands_on_another_mesh(surface)
    for modifier in before:
        if modifier.show_viewport == modifier.show_render:
            continue
        deforms = modifier.type in modifier_kinds.DEFORMING
        if deforms and not hands_on and followers.live_modifier_of(ob) is not None:
            raise RefusalError(
                f"{ob.name} follows {surface.name} as the viewport shows it, because "
                f"{surface.name} has no modifier {ids.CAPTURE_GROUP} directly before the "
                "subdivision, and files of this format hold what renders show: run "
                f"object.limit_follow, which puts {ids.CAPTURE_GROUP} in its place, or enable the "
                f"modifier {modifier.name} in both, or in neither, or use --format npz"
            )
        if not deforms:
            raise RefusalError(
                f"{ob.name} is bound to the faces that the viewport shows of {surface.name}, and "
                "files of this format hold what renders show: enable the modifier "
                f"{modifier.name} in both, or in neither, or use --format npz"
            )


def _needed(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Yields the object and those by which it follows: attached objects follow by a parent, and
    live children have the shapes of their guides.
    """
    yield ob
    guides = live_children.guides_of(ob) if live_children.modifier_of(ob) else None
    if guides is not None:
        yield guides
    while ob.parent:
        ob = ob.parent
        yield ob


def _check_nodes(ob: bpy.types.Object, scene: bpy.types.Scene) -> None:
    grows = live_children.modifier_of(ob)
    modifier = grows or followers.modifier_of(ob)
    if modifier is None:
        return
    if not (modifier.show_viewport and modifier.show_render):
        does = "grow" if grows else "follow"
        raise RefusalError(f"{ob.name} does not {does}: its modifier {modifier.name} is disabled")
    frame = scene.frame_current
    if grows:
        _check_guide_count(ob, grows, frame)
    table = groups.get_input(modifier, children.TILES if grows else TILES)
    if table is None:
        return  # a trouble that the state names
    shown = table.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.attributes
    if ids.CAGE_FITS in shown and not shown[ids.CAGE_FITS].data[0].value:
        does, made = ("does not grow", "made") if grows else ("is at rest", "bound")
        raise RefusalError(
            f"{ob.name} {does} in frame {frame}: the control mesh of its surface has other faces, "
            f"other creases or another order of vertices there than when it was {made}"
        )


def _check_guide_count(ob: bpy.types.Object, modifier: bpy.types.NodesModifier, frame: int) -> None:
    """Raises RefusalError where modifiers of the guides make more or fewer of them in this
    frame.
    """
    guides = groups.get_input(modifier, children.GUIDES)
    if guides is None or guides.type != "CURVES":
        return  # a trouble that the state names
    shown = guides.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    before, now = groups.get_input(modifier, children.GUIDE_COUNT), len(shown.curves)
    if before != now:
        raise RefusalError(
            f"{ob.name} does not grow in frame {frame}: it has {counted(now, 'guides')} there, and "
            f"had {before:,} when it was made"
        )


def _check_growing(ob: bpy.types.Object) -> None:
    """Raises RefusalError where live children have lost what they cannot grow without, and where
    their surface cannot even be found.
    """
    if any(groups.without_group(ob, ids.CHILDREN_GROUP)):
        raise RefusalError(
            f"{ob.name} does not grow: the node group of its modifier {ids.CHILDREN_GROUP} was "
            "deleted. Choose the group in the modifier again, or add the children again"
        )
    if live_children.modifier_of(ob) and live_children.surface_of(ob) is None:
        raise RefusalError(
            f"{ob.name} does not grow: its surface was deleted. Choose another surface in its "
            "modifier, and run object.limit_rebind"
        )


def _check_children(ob: bpy.types.Object, surface: bpy.types.Object, signature: str) -> None:
    for text in live_children.obstacles(ob, signature):
        _refuse(ob, [Trouble(text, ids.REBIND)])
    state = State(surface, [], [], all_tiles.of_surface(surface))
    _refuse(ob, [*state.troubles(None), *state.stale_samples(signature)])


def _check_following(ob: bpy.types.Object, surface: bpy.types.Object, signature: str) -> None:
    follows = followers.modifier_of(ob) is not None
    if not follows and not followers.was_bound(ob):
        return
    state = State(surface, [ob] if follows else [], [] if follows else [ob])
    if followers.is_astray(ob):
        state = State(surface, [], [], astray=(ob,))
    _refuse(ob, state.troubles(signature))


def _refuse(ob: bpy.types.Object, troubles: Sequence[Trouble]) -> None:
    """Raises RefusalError for the first trouble."""
    for trouble in troubles:
        raise RefusalError(f"{ob.name}: {trouble.text}; {trouble.remedy} puts it right")


def _check_faces(ob: bpy.types.Object, surface: bpy.types.Object, count: int) -> None:
    face = attributes.read(followers.holder_of(ob), ids.FACE)
    strays = int((face >= count).sum())
    if strays:
        raise RefusalError(
            f"{strays:,} of the {counted(len(face), 'places')} of {ob.name} "
            f"{by_count(strays, 'is', 'are')} on faces that {surface.name} does not have: its "
            "topology has changed since things were placed on it"
        )
