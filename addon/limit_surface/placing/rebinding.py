# SPDX-License-Identifier: GPL-3.0-or-later
"""Binds things anew to a surface whose topology, creases or rules have changed."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import bpy
import numpy as np

from .. import ids, native
from ..counting import by_count, counted
from ..errors import RefusalError
from ..reading import attributes, cage
from ..tasks.job import Progress
from ..tasks.piecewise_job import Pieces, aside
from ..tasks.refused_faces import check_some_left
from . import curve_points, following, live_binding, render_faces, seals
from .applied_shapes import rows_as_posed
from .changed_places import ByFace, ByUv, Closest, Finder, UvMaps, stores_uv
from .followers import bound_to, holder_of, is_astray, is_own, is_stray, live_modifier_of
from .newcomers import bound_at_closest, put_places
from .places import NOWHERE
from .posed_surface import PosedSurface, transformed
from .relocation import Elements, Relocation

Method = Literal["CLOSEST", "UV", "FACE"]

# What is turned with a root
_THINGS = "strands and points"
_POINTS = (ids.POSITION, ids.HANDLE_LEFT, ids.HANDLE_RIGHT)
_DIRECTIONS = (ids.NORMAL, ids.TANGENT)


@dataclass(frozen=True)
class Rebound:
    """What a report says."""

    surface: str
    names: list[str]
    distances: np.ndarray  # by which roots moved, in world units
    lost: int
    reason: str  # why the lost ones could not be kept
    overridden: list[str]  # what follows the surface, but belongs to a library

    def __str__(self) -> str:
        count = len(self.distances)
        are = by_count(count, "is", "are")
        text = f"{counted(count, _THINGS)} on {self.surface} {are} bound again"
        if count:
            median, largest = np.median(self.distances), self.distances.max()
            they = by_count(count, "it", "they")
            text += (
                f". At rest {they} moved by {median:.4g} (median) and by at most {largest:.4g} "
                "(world units)"
            )
        return text

    @property
    def warnings(self) -> list[str]:
        """Names what could not be kept, and what was left as it was."""
        texts = [self._about_lost()] if self.lost else []
        if self.overridden:
            texts.append(
                "Not bound again, because Blender would not save the new places of library "
                f"overrides: {', '.join(self.overridden)}"
            )
        return texts

    def _about_lost(self) -> str:
        stay = by_count(
            self.lost,
            "it stays where it is, and is selected",
            "they stay where they are, and are selected",
        )
        return (
            f"{counted(self.lost, _THINGS)} on {self.surface} could not be kept, because "
            f"{self.reason}: {stay}"
        )


class Rebinding:
    """Binds everything that follows a surface anew, and other things that stand on it, in three
    steps: what is needed is read, the new places are computed, and written. Raises RefusalError
    where that is impossible; nothing has changed then.
    """

    def __init__(
        self,
        surface: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        things: Sequence[bpy.types.Object],
        method: Method,
        max_distance: float = math.inf,
    ) -> None:
        following.check_surface(surface, depsgraph.scene)
        on_surface = bound_to(surface)
        following_now = [ob for ob in on_surface if is_own(ob)]
        bound = list(dict.fromkeys([*following_now, *things]))
        # There are no places that could be kept for control points that were added, nor for those
        # of a curve whose modifier was copied with the table of another curve.
        self._curves = [
            ob
            for ob in bound
            if ob.type == "CURVE" and (curve_points.has_others(ob) or is_astray(ob))
        ]
        kept = [ob for ob in bound if ob not in self._curves]
        for ob in self._curves:
            curve_points.check(ob, surface)
        for ob in kept:
            following.check_thing(ob, surface)
        self._live = [ob for ob in kept if live_modifier_of(ob)]
        if self._curves or len(self._live) < len(kept):
            render_faces.check(surface, depsgraph)
        live_binding.prepare_rebinding(self._live, depsgraph)
        for ob in kept:
            following.settle(ob)
        blocks = {holder_of(ob): ob for ob in reversed(kept)}
        self._elements = [Elements(ob, at_rest=True) for ob in blocks.values()]
        with cage.opened(surface, depsgraph) as (found, mesh):
            self._posed = PosedSurface(found)
            check_some_left(self._posed.in_world, surface.name)
            maps = UvMaps(self._posed, mesh, surface)
            for elements in self._elements:
                if method == "UV" or (method == "CLOSEST" and stores_uv(elements)):
                    maps.read(elements.data)
            self._signature = following.signature(found)
        self._find: Finder
        if method == "CLOSEST":
            self._find = Closest(self._posed, maps, max_distance)
        elif method == "UV":
            self._find = ByUv(maps)
        else:
            self._find = ByFace(self._posed)
        self._target, self.bound, self.uv_maps = surface, bound, maps.names
        self._surface, self._names = surface.name, [ob.name for ob in bound]
        self._overridden = [ob.name for ob in on_surface if not is_own(ob)]
        self._by_nodes = [ob for ob in kept if ob not in self._live]

    def compute(self, context: bpy.types.Context) -> Pieces:
        self._relocations = []
        for elements in self._elements:
            yield from _check_not_applied(elements, self._posed, self._signature)
            relocation = yield from _relocation(elements, self._posed, self._find)
            self._relocations.append(relocation)
        self._relocations_of_live = [r for r in self._relocations if r.elements.ob in self._live]
        others = [r for r in self._relocations if r not in self._relocations_of_live]
        self._bindings = None
        if self._by_nodes:
            request = following.Request(
                self._target,
                context.evaluated_depsgraph_get(),
                self._by_nodes,
                relocated=others,
                without=self._curves,
            )
            self._bindings = yield from aside(lambda _progress: request.compute())

    def write(self, context: bpy.types.Context) -> Rebound:
        """Changes the file."""
        if self._bindings:
            self._bindings.write()
        for relocation in self._relocations_of_live:
            relocation.write()
        live_binding.finish_rebinding(self._live, self._target, self._signature, context)
        curve_points.bind(self._curves, self._target, context)
        for relocation in self._relocations:
            if len(relocation.lost) and relocation.elements.ob.type != "CURVE":
                _select(relocation)
        return Rebound(
            self._surface,
            self._names,
            np.concatenate(
                [np.empty(0), *(relocation.distances for relocation in self._relocations)]
            ),
            sum(len(relocation.lost) for relocation in self._relocations),
            self._find.reason,
            self._overridden,
        )


def _check_not_applied(elements: Elements, posed: PosedSurface, signature: str) -> Pieces:
    """Raises RefusalError for something that would be moved a second time, because its modifier was
    applied in this frame.
    """
    ob = elements.ob
    if is_stray(ob) and following.holds(elements.data, signature):
        rows = yield from rows_as_posed(elements, posed)
        if len(rows):
            raise RefusalError(
                f"The modifier by which {ob.name} followed was applied in this frame: run Follow "
                "Limit Surface instead, which binds it as it is now"
            )


def _relocation(elements: Elements, posed: PosedSurface, find: Finder) -> Pieces:
    rows = np.flatnonzero(elements.has_place)
    if elements.ob.type == "CURVE" and not find.keeps_frame:
        return (yield from _curve_relocation(elements, posed))
    found = yield from find(elements, rows)
    kept = found.face != NOWHERE
    relocation = Relocation(elements, lost=rows[~kept])
    if find.keeps_frame:
        face, uv = found.face[kept], found.uv[kept].astype(np.float64)
        places = yield from aside(lambda _progress: posed.places(face, uv, elements.matrix))
        now = places.position
    else:
        now = yield from _moved(relocation, posed, rows[kept], found.face[kept], found.uv[kept])
        if isinstance(find, Closest):
            yield from _bind_others(relocation, posed, find.max_distance)
            yield from _store_uv(relocation, find.maps)
    relocation.distances = np.linalg.norm(
        transformed(elements.matrix, now) - elements.roots()[rows[kept]], axis=1
    )
    relocation.put(ids.FACE, relocation.lost, NOWHERE)
    return relocation


def _curve_relocation(elements: Elements, posed: PosedSurface) -> Pieces:
    """Binds the control points of a Curve object where they are, as new ones are bound."""
    rows, before = np.arange(elements.count), elements.roots()
    relocation = yield from bound_at_closest(elements, posed, rows)
    after = transformed(elements.matrix, relocation.values[ids.REST_ROOT].astype(np.float64))
    relocation.distances = np.linalg.norm(after - before, axis=1)
    return relocation


def _moved(
    relocation: Relocation,
    posed: PosedSurface,
    rows: np.ndarray,
    face: np.ndarray,
    uv: np.ndarray,
) -> Pieces:
    """Moves elements with their roots, and turns them by the smallest angle that turns the normal
    of before into that of now: on other faces u and v run elsewhere. Returns the new roots.
    """
    elements = relocation.elements
    if getattr(elements.data, "shape_keys", None) and len(rows):
        raise RefusalError(
            f"{elements.ob.name} has shape keys, which would stay behind: choose the method Face, "
            "or apply them"
        )
    before = elements.read(ids.REST_ROOT).astype(np.float64)
    rotation = elements.read(ids.REST_ROTATION)[rows]
    frame = yield from put_places(relocation, posed, rows, face, uv)
    after = before.copy()
    after[rows] = relocation.values[ids.REST_ROOT][rows]

    def turns(_progress: Progress) -> np.ndarray:
        old = native.limitsurf.rotation_matrices(rotation)
        turn = np.tile(np.eye(3), (elements.count, 1, 1))
        turn[rows] = native.limitsurf.shortest_turns(old[:, :, 2], frame[:, :, 2])
        return turn

    turn = yield from aside(turns)
    is_moving = np.zeros(elements.count, bool)
    is_moving[rows] = True
    if elements.broken is not None:
        by = seals.carriers(elements.data, elements.broken, is_moving)
        is_moving, before, after, turn = (each[by] for each in (is_moving, before, after, turn))
    offsets = np.concatenate([[0], np.cumsum(elements.sizes)])

    def move(points: np.ndarray) -> Callable[[Progress], np.ndarray]:
        return lambda _progress: native.limitsurf.move_strands(points, offsets, before, after, turn)

    for name in _POINTS:
        if elements.rest_name(name) in elements.data.attributes:
            points = elements.read_shape(name).astype(np.float64)
            moved = yield from aside(move(points))
            if not is_moving.all():
                resting = np.repeat(~is_moving, elements.sizes)
                moved[resting] = points[resting]
            relocation.values[elements.rest_name(name)] = moved
    if elements.domain == "POINT":
        _turn_attributes(relocation, rows, turn[rows])
    return after[rows]


def _turn_attributes(relocation: Relocation, rows: np.ndarray, turn: np.ndarray) -> None:
    """Turns what points store about their orientation."""
    elements = relocation.elements
    stored = relocation.data.attributes
    for name in _DIRECTIONS:
        if elements.rest_name(name) in stored:
            vectors = elements.read_shape(name)
            origin = np.zeros((len(rows), 3))
            vectors[rows] = native.limitsurf.move_strands(vectors[rows], None, origin, origin, turn)
            relocation.values[elements.rest_name(name)] = vectors
    if elements.rest_name(ids.ROTATION) in stored:
        rotation = elements.read_shape(ids.ROTATION)
        matrices = native.limitsurf.rotation_matrices(rotation[rows])
        rotation[rows] = native.limitsurf.quaternions(turn @ matrices)
        relocation.values[elements.rest_name(ids.ROTATION)] = rotation


def _bind_others(relocation: Relocation, posed: PosedSurface, max_distance: float) -> Pieces:
    """Binds elements that had no place where they are now."""
    elements = relocation.elements
    rows = np.flatnonzero(~elements.has_place)
    if not len(rows):
        return
    points = elements.first_points()
    moved = relocation.values.get(elements.rest_name(ids.POSITION))
    if moved is not None and elements.broken is not None:
        points[elements.broken] = transformed(elements.matrix, moved)[elements.broken]
    others = yield from bound_at_closest(elements, posed, rows, max_distance, points)
    found = np.setdiff1d(rows, others.lost)
    for name, values in others.values.items():
        relocation.put(name, found, values[found])
    relocation.lost = np.concatenate([relocation.lost, others.lost])


def _store_uv(relocation: Relocation, maps: UvMaps) -> Pieces:
    """Changes stored UVs to those of the new places."""
    if not stores_uv(relocation.elements):
        return
    try:
        on_surface = maps.of(relocation.data)
    except RefusalError:
        return  # the map exists no more
    places = relocation.places
    uv = attributes.read(relocation.data, ids.SURFACE_UV)
    found = yield from aside(lambda _progress: on_surface.evaluate(places.face, places.uv))
    uv[places.rows] = found.value
    relocation.values[ids.SURFACE_UV] = uv


def _select(relocation: Relocation) -> None:
    """Selects the elements that have lost their place, and nothing else of their data."""
    data, elements = relocation.data, relocation.elements
    chosen = np.zeros(elements.count, bool)
    chosen[relocation.lost] = True
    if isinstance(data, bpy.types.Mesh):
        for name in (ids.EDGE_SELECTION, ids.FACE_SELECTION):
            selection = data.attributes.get(name)
            if selection:  # setting it instead crashes where Blender 5.0 gave it a wrong type
                data.attributes.remove(selection)
        data.vertices.foreach_set("select", chosen)
        return
    stored = data.attributes.get(ids.SELECTION)
    if stored and (stored.data_type != "BOOLEAN" or stored.domain != elements.domain):
        data.attributes.remove(stored)
    attributes.write(data, ids.SELECTION, "BOOLEAN", elements.domain, chosen)
    if elements.domain == "CURVE":
        data.selection_domain = "CURVE"
