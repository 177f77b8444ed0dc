# SPDX-License-Identifier: GPL-3.0-or-later
"""All that follows surfaces live is posed by the library in each frame, and after each change."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import bpy
import numpy as np

from .. import ids, native
from ..errors import RefusalError
from ..nodes import groups
from ..nodes.follow import SURFACE
from ..reading import private_scene
from ..reading.users import objects_using
from . import live_attributes, live_source, live_surface, live_thing
from . import live_kept as kept
from .followers import is_astray, own_surface_of, sharers
from .live_chains import Chains, Followers
from .live_defects import Defects
from .live_edits import Edits
from .live_surface import LiveSurface
from .live_thing import LiveThing


def is_enabled(scene: bpy.types.Scene) -> bool:
    return getattr(scene, ids.LIVE, True)


def surface_of(ob: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the surface that an object follows live, if it does."""
    modifier = next(groups.modifiers(ob, ids.FOLLOW_LIVE_GROUP), None)
    surface = groups.get_input(modifier, SURFACE) if modifier else None
    return surface if surface is not None and surface.type == "MESH" else None


def followers_in(
    depsgraph: bpy.types.Depsgraph,
) -> dict[bpy.types.Object, list[bpy.types.Object]]:
    """Returns all that follows live and is evaluated by the depsgraph, by surface; of objects that
    share their data, one.
    """
    found: dict[bpy.types.Object, list[bpy.types.Object]] = {}
    seen: set[bpy.types.ID] = set()
    marks = {g for g in bpy.data.node_groups if groups.is_of(g, ids.FOLLOW_LIVE_GROUP)}
    for ob in objects_using(*marks):
        if ob.type not in ("CURVES", "MESH", "POINTCLOUD") or ob.data in seen:
            continue
        surface = surface_of(ob)
        if surface is None or is_astray(ob):
            continue
        missing = live_attributes.missing(ob.data)
        if missing:
            kept.refuse(
                [ob],
                f"{ob.data.name} has no attribute {missing} any more: run Follow Limit Surface "
                "again",
            )
            continue
        in_edit_mode = ob.type == "MESH" and ob.data.is_editmode  # perhaps by way of another object
        if ob.evaluated_get(depsgraph).is_evaluated and not in_edit_mode:
            seen.add(ob.data)
            found.setdefault(surface, []).append(ob)
    return found


def pose_all(depsgraph: bpy.types.Depsgraph) -> None:
    """Poses everything for the depsgraph's frame."""
    followers = followers_in(depsgraph)
    _read_changed_ones_anew(followers, depsgraph)
    _pose_some(followers, followers, Chains(followers), depsgraph)


def pose_changed(depsgraph: bpy.types.Depsgraph) -> None:
    """Poses what is not in its place any more after a change, and takes up edits."""
    followers = followers_in(depsgraph)
    if not followers:
        return
    _read_changed_ones_anew(followers, depsgraph)
    changed = {
        update.id.original
        for update in depsgraph.updates
        if update.is_updated_geometry or update.is_updated_transform
    }
    wanted = {
        surface
        for surface, things in followers.items()
        if _has_to_be_posed(surface, things, changed, depsgraph)
    }
    chains = Chains(followers if wanted else {})
    posed = chains.behind(wanted)
    defects = Defects()
    for surface, things in followers.items():
        if surface not in posed:
            edited = [ob for ob in things if ob in changed or ob.data in changed]
            with defects.held_back(surface, edited):
                _take_up_edits(surface, edited, depsgraph)
    _pose_some(wanted, {s: followers[s] for s in followers if s in posed}, chains, depsgraph)
    defects.raise_first()


def _pose_some(
    wanted: Collection[bpy.types.Object],
    followers: Followers,
    chains: Chains,
    depsgraph: bpy.types.Depsgraph,
) -> None:
    """Poses what follows the surfaces that are wanted, and those that change with them. Edits of
    all are taken up before anything moves, because the surfaces are then as they were when the
    edits were made.
    """
    defects = Defects()
    good: dict[bpy.types.Object, list[bpy.types.Object]] = {}
    for surface, things in followers.items():
        with defects.held_back(surface, things):
            good[surface] = _take_up_all(surface, things, depsgraph)
    moved: set[bpy.types.ID] = set()
    for surface in chains.in_order():
        is_behind = chains.depends(surface, moved)
        if surface in good and (is_behind or surface in wanted):
            things = followers[surface]
            with defects.held_back(surface, things):
                moved |= _pose(surface, things, good[surface], depsgraph, is_behind)
    defects.raise_first()


def _has_to_be_posed(
    surface: bpy.types.Object,
    things: Sequence[bpy.types.Object],
    changed: set[bpy.types.ID],
    depsgraph: bpy.types.Depsgraph,
) -> bool:
    known, frame = kept.known(surface), depsgraph.scene.frame_float
    if known is None or surface in changed:
        return True
    if any(not _is_posed(ob, known, frame) for ob in things):
        return True
    return any(
        (ob in changed or not changed.isdisjoint(sharers(ob)))
        and not _same_place(ob, surface, depsgraph)
        for ob in things
    )


def _read_changed_ones_anew(
    followers: dict[bpy.types.Object, list[bpy.types.Object]], depsgraph: bpy.types.Depsgraph
) -> None:
    changed = {update.id.original for update in depsgraph.updates}
    for surface, things in followers.items():
        if surface.data in changed and (known := kept.known(surface)):
            known.look_at_faces()
        for ob in things:
            if ob.data in changed:
                kept.thing(ob).read_anew()


def take_up_edits(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
    """Makes sure that the shape at rest is that of the points as they are now. Raises CageError or
    MeshError where there is no surface, and StaleFacesError where it has other faces.
    """
    surface = own_surface_of(ob) if is_astray(ob) else surface_of(ob)
    if surface is not None:
        on = kept.surface(surface, depsgraph)
        kept.thing(ob).read_anew()
        _take_up(ob, surface, on, depsgraph)


def read_anew(surface: bpy.types.Object) -> None:
    """Makes sure that the surface is read as a whole for the next pose. The checksums that tell
    whether it has changed do not see another order of its faces, which matters once something is
    bound to them.
    """
    kept.drop(surface)


def check_sharers(
    ob: bpy.types.Object, surface: bpy.types.Object, depsgraph: bpy.types.Depsgraph
) -> None:
    """Raises RefusalError where the data has another user whose points would have to be elsewhere
    in the data: the points are written once for all users.
    """
    others = [o for o in sharers(ob) if o.evaluated_get(depsgraph).is_evaluated]
    if not others:
        return
    own = _matrix(ob, surface, depsgraph)
    for other in others:
        theirs = surface_of(other)
        if theirs is not None and theirs != surface:
            reason = f"follows {theirs.name}"
        elif not np.allclose(_matrix(other, surface, depsgraph), own, atol=1e-6):
            reason = f"has another transform relative to {surface.name}"
        else:
            continue
        raise RefusalError(
            f"{ob.name} shares its data with {other.name}, which {reason}: make one of them a "
            "single-user copy, or let them follow by nodes"
        )


def start(ob: bpy.types.Object, surface: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
    """Takes the points of the object for those at rest. Raises CageError, MeshError or
    LocationError where the points do not belong to the surface.
    """
    live_thing.start(ob.data, kept.surface(surface, depsgraph).limit)
    kept.thing(ob).read_anew()


def admit(ob: bpy.types.Object, surface: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
    """Has strands and points follow that were added later. Raises CageError, MeshError or
    LocationError where they do not belong to the surface.
    """
    LiveThing().admit(ob.data, kept.surface(surface, depsgraph).limit)
    kept.thing(ob).read_anew()


def _take_up_all(
    surface: bpy.types.Object,
    things: Sequence[bpy.types.Object],
    depsgraph: bpy.types.Depsgraph,
) -> list[bpy.types.Object]:
    """Takes up edits in the pose for which they were made. Returns the things that can be posed."""
    try:
        on = kept.surface(surface, depsgraph)
    except live_surface.errors as error:
        kept.refuse(things, native.sentence(error))
        return []
    return list(kept.each(things, lambda ob: _take_up(ob, surface, on, depsgraph)))


def _pose(
    surface: bpy.types.Object,
    things: Sequence[bpy.types.Object],
    good: Sequence[bpy.types.Object],
    depsgraph: bpy.types.Depsgraph,
    is_behind: bool,
) -> set[bpy.types.ID]:
    """Poses the good things, those whose edits have been taken up. Returns the data-blocks that
    were moved. `is_behind` tells that the surface depends on something that was moved since the
    depsgraph was evaluated.
    """
    moved: set[bpy.types.ID] = set()
    on = kept.known(surface)
    if on is None:  # there was none when edits were to be taken up
        return moved
    before, frame_before = on.limit, on.pose.frame
    try:
        (on.read_again if is_behind else on.read)(surface, depsgraph)
    except live_surface.errors as error:
        if not private_scene.is_barred():  # it can only be read later
            kept.drop(surface)
        kept.refuse(things, native.sentence(error))
        return moved
    # it may have the faces, or the pose, now that some of the things were written for
    if on.limit is not before or on.pose.frame != frame_before:
        late = [ob for ob in things if ob not in good]
        good = [*good, *kept.each(late, lambda ob: _take_up(ob, surface, on, depsgraph))]
    frame = depsgraph.scene.frame_float

    def pose(ob: bpy.types.Object) -> None:
        live_source.check(ob, surface, on.source, on.signature)
        check_sharers(ob, surface, depsgraph)
        thing = kept.thing(ob)
        if thing.pose(ob.data, on.posed(), _matrix(ob, surface, depsgraph), frame):
            moved.add(ob.data)
            kept.count_move()
        thing.version, thing.surface_pose = on.version, on.pose

    for _ in kept.each(good, pose):
        pass
    return moved


def _take_up_edits(
    surface: bpy.types.Object,
    things: Sequence[bpy.types.Object],
    depsgraph: bpy.types.Depsgraph,
) -> None:
    on = kept.surface(surface, depsgraph)
    for _ in kept.each(things, lambda ob: _take_up(ob, surface, on, depsgraph)):
        pass


def _take_up(
    ob: bpy.types.Object,
    surface: bpy.types.Object,
    on: LiveSurface,
    depsgraph: bpy.types.Depsgraph,
) -> None:
    def needed() -> Collection[bpy.types.ID]:
        followers = followers_in(depsgraph)
        followers.setdefault(surface, [ob])
        return Chains(followers).needed_by(surface)

    live_source.check(ob, surface, on.source, on.signature)
    edits = Edits(ob, kept.thing(ob), on, needed)
    edits.take_up(surface, depsgraph, lambda: _matrix(ob, surface, depsgraph))


def _matrix(
    ob: bpy.types.Object, surface: bpy.types.Object, depsgraph: bpy.types.Depsgraph
) -> np.ndarray:
    """Returns the matrix from the surface's space to that of the thing."""
    here, there = (
        np.array(each.evaluated_get(depsgraph).matrix_world, np.float64) for each in (ob, surface)
    )
    if np.array_equal(here, there):
        return np.eye(4)
    try:
        relation: np.ndarray = np.linalg.inv(here) @ there
    except np.linalg.LinAlgError:
        raise ValueError(f"{ob.name} has a scale of 0 along an axis") from None
    relation[3] = 0, 0, 0, 1
    return relation


def _is_posed(ob: bpy.types.Object, on: LiveSurface, frame: float) -> bool:
    written = live_attributes.written(ob.data)
    return written is not None and written.frame == frame and kept.thing(ob).version == on.version


def _same_place(
    ob: bpy.types.Object, surface: bpy.types.Object, depsgraph: bpy.types.Depsgraph
) -> bool:
    written = live_attributes.written(ob.data)
    try:
        check_sharers(ob, surface, depsgraph)
        return written is not None and np.array_equal(
            written.matrix, _matrix(ob, surface, depsgraph)
        )
    except (RefusalError, ValueError):
        return False
