# SPDX-License-Identifier: GPL-3.0-or-later
"""The things that are to be snapped in the current mode, and those that cannot be."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple, Protocol

import bpy

from ..errors import RefusalError
from ..placing.followers import has_own_places
from .aim import Elements, Placement
from .bones import SnappedBones
from .choices import Choices, Outcome
from .curve_points import SnappedCurvePoints
from .hair import SnappedHair
from .lattice_points import SnappedLatticePoints
from .mesh_vertices import SnappedVertices
from .objects import SnappedObjects
from .surface import TargetSurface

POINTS: dict[str, Callable[[bpy.types.Object], Snapped]] = {
    "EDIT_MESH": SnappedVertices,
    "EDIT_CURVE": SnappedCurvePoints,
    "EDIT_SURFACE": SnappedCurvePoints,
    "EDIT_LATTICE": SnappedLatticePoints,
}
HAIR_MODES = ("EDIT_CURVES", "SCULPT_CURVES")
MODES = ("OBJECT", "EDIT_ARMATURE", *POINTS, *HAIR_MODES)
#: To move the object by its origin would tear its points off the surface, or would be undone by
#: what makes them follow.
OWN_PLACES = "the object's own points are placed on a surface, and its origin is not"


class Snapped(Protocol):
    noun: str  # in the plural
    stores_location: bool

    @property
    def follower(self) -> bpy.types.Object | None:
        """What may follow a surface by nodes"""

    def elements(self) -> Elements: ...
    def place(self, placement: Placement, choices: Choices) -> Outcome: ...


class Selection(NamedTuple):
    parts: list[Snapped]
    failures: Counter[str]  # reasons why whole objects cannot be snapped


def find_target(context: bpy.types.Context) -> bpy.types.Object | None:
    if context.mode == "OBJECT":
        return context.active_object
    return context.scene.limit_surface.target


def check_target(context: bpy.types.Context, target: bpy.types.Object) -> None:
    if target.mode == "EDIT" or any(ob.data == target.data for ob in context.objects_in_mode):
        raise RefusalError(f"{target.name} is being edited: choose another target")


def gather(context: bpy.types.Context, surface: TargetSurface) -> Selection:
    selection = Selection([], Counter())
    if context.mode == "OBJECT":
        makers = _objects(context, surface, selection.failures)
    else:
        makers = _edited(context, surface)
    for make in makers:
        try:
            selection.parts.append(make())
        except RefusalError as error:
            selection.failures[str(error)] += 1
    return selection


def _objects(
    context: bpy.types.Context, surface: TargetSurface, failures: Counter[str]
) -> Iterator[Callable[[], Snapped]]:
    target = surface.ob
    carriers = set(ancestors(target))
    movable, hair, curves = [], [], set()
    for ob in context.selected_objects:
        if ob == target:
            continue
        if ob in carriers:
            failures[f"{target.name} is parented to the object and would move with it"] += 1
        elif not (ob.data if ob.type == "CURVES" else ob).is_editable:
            failures["the object is linked from another file"] += 1
        elif ob.type != "CURVES" and has_own_places(ob):
            failures[OWN_PLACES] += 1
        elif ob.type != "CURVES":
            movable.append(ob)
        elif ob.data in curves:
            failures["another selected object has the same curves"] += 1
        else:
            curves.add(ob.data)
            hair.append(ob)
    if movable:  # objects come first, because hair may be parented to them
        yield partial(SnappedObjects, movable)
    for ob in hair:
        yield partial(SnappedHair, ob, surface, selected_only=False)


def _edited(context: bpy.types.Context, surface: TargetSurface) -> Iterator[Callable[[], Snapped]]:
    mode = context.mode
    for ob in context.objects_in_mode_unique_data:
        if mode in HAIR_MODES:
            yield partial(SnappedHair, ob, surface, selected_only=True)
        elif mode == "EDIT_ARMATURE":
            yield partial(SnappedBones, ob)
        else:
            yield partial(POINTS[mode], ob)


def ancestors(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    while ob.parent:
        ob = ob.parent
        yield ob
