# SPDX-License-Identifier: GPL-3.0-or-later
"""What live following keeps from frame to frame: surfaces, what is prepared for things, and the
reasons why things do not follow. None of it has an influence on where things are: it only saves
time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

import bpy

from .. import ids, native
from ..counting import by_count, counted
from ..errors import RefusalError
from ..tasks.object_keys import ObjectKey
from . import live_attributes
from .followers import element_called, sharers, why_astray
from .live_surface import LiveSurface
from .live_thing import LiveThing

_surfaces: dict[ObjectKey, LiveSurface] = {}
_things: dict[tuple[str, str, str | None], LiveThing] = {}  # by type, name and library


class _Reason(NamedTuple):
    text: str
    remedy: str  # the operator that helps, if it is known


#: The reasons why objects do not follow at present
_troubles: dict[ObjectKey, _Reason] = {}
_moves = 0


def forget() -> None:
    """Is called when other data may have the same names, as in another file."""
    _surfaces.clear()
    _things.clear()
    _troubles.clear()


def forget_after_undo() -> None:
    """Forgets all but the poses for which meshes in Edit Mode were written. These stay as they are
    until Edit Mode is left.
    """
    poses = {key: thing.surface_pose for key, thing in _things.items() if _is_edited(*key)}
    forget()
    for key, pose in poses.items():
        _things[key] = LiveThing()
        _things[key].surface_pose = pose


def _is_edited(kind: str, name: str, library: str | None) -> bool:
    mesh = bpy.data.meshes.get((name, library)) if kind == "MESH" else None
    return mesh is not None and mesh.is_editmode


def trouble(ob: bpy.types.Object) -> str:
    """Returns the reason why the object, or a part of it, does not follow at present."""
    kept = thing(ob)
    reason = why_astray(ob) or _reason(ob).text
    return reason or _lost_frames(ob, kept.lost_frames) or _added(ob, kept.added)


def remedy(ob: bpy.types.Object) -> str:
    """Returns the operator that puts this right, if it is known."""
    if why_astray(ob):
        return ids.FOLLOW
    if (reason := _reason(ob)).text:
        return reason.remedy
    kept = thing(ob)
    return ids.FOLLOW if kept.lost_frames or kept.added else ""


def _reason(ob: bpy.types.Object) -> _Reason:
    # of objects that share their data one is posed, for all
    reasons = (_troubles.get(ObjectKey.of(each)) for each in (ob, *sharers(ob)))
    return next(filter(None, reasons), _Reason("", ""))


def trouble_in_file(ob: bpy.types.Object) -> str:
    """Returns what does not follow because the file was made before version 0.2.0."""
    return _lost_frames(ob, live_attributes.lost_frames(ob.data))


def _lost_frames(ob: bpy.types.Object, count: int) -> str:
    if not count:
        return ""
    things = counted(count, "strands" if ob.type == "CURVES" else "points")
    return (
        f"{ob.name}: {things} stay still, because the file was made before version 0.2.0 of the "
        "extension and lacks their rest orientation"
    )


def _added(ob: bpy.types.Object, count: int) -> str:
    if not count:
        return ""
    were = by_count(count, "was added and has no place of its own", "were added and have no places")
    return (
        f"{counted(count, 'vertices')} of {ob.name} {were}: they follow neighbors that have "
        "places, and stay still without such neighbors"
    )


def surface(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> LiveSurface:
    """Returns the surface in the pose in which it was read last, or if it is not known yet, in that
    of the depsgraph's frame. Raises CageError and MeshError where there is none.
    """
    key = ObjectKey.of(ob)
    found = _surfaces.get(key)
    if found is None:
        found = LiveSurface()
        found.read(ob, depsgraph)
        _surfaces[key] = found
    return found


def count_move() -> None:
    global _moves
    _moves += 1


def moves() -> int:
    """Returns how often something was moved: whoever compares two numbers learns whether anything
    has moved between.
    """
    return _moves


def known(ob: bpy.types.Object) -> LiveSurface | None:
    """Returns the surface if it was read before."""
    return _surfaces.get(ObjectKey.of(ob))


def drop(ob: bpy.types.Object) -> None:
    """Has the surface read as a whole for the next pose."""
    _surfaces.pop(ObjectKey.of(ob), None)


def thing(ob: bpy.types.Object) -> LiveThing:
    data = ob.data
    library = data.library.filepath if data.library else None
    return _things.setdefault((data.id_type, data.name, library), LiveThing())


def each(
    things: Sequence[bpy.types.Object], work: Callable[[bpy.types.Object], None]
) -> Iterator[bpy.types.Object]:
    """Yields the things for which the work succeeds, and keeps the reason for the others."""
    for ob in things:
        try:
            work(ob)
        except (RefusalError, ValueError, MemoryError) as error:
            reason = native.sentence(error, partial(element_called, ob))
            refuse([ob], reason or "There is not enough memory", getattr(error, "remedy", ""))
        else:
            for well in (ob, *sharers(ob)):
                _troubles.pop(ObjectKey.of(well), None)
            yield ob


def refuse(things: Sequence[bpy.types.Object], reason: str, remedy: str = "") -> None:
    for ob in things:
        _troubles[ObjectKey.of(ob)] = _Reason(reason, remedy)
