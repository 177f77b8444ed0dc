# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature at the roots of hair and points that store their locations."""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..placing.places import check_uv
from ..reading import attributes, cage, transform
from ..tasks.editable import check_data_editable
from ..tasks.job import Progress, part_of
from ..tasks.object_keys import ObjectKey
from . import storage
from .settings import Settings
from .values import NOWHERE, CurvedSurface, Values

_DOMAINS = {"CURVES": "CURVE", "MESH": "POINT"}


class _Part(NamedTuple):
    key: ObjectKey
    surface: ObjectKey
    face: np.ndarray
    uv: np.ndarray
    matrix: np.ndarray
    found: cage.Cage


class StoredRoots:
    """The roots of the selected objects that store locations. Where no selected object does, all
    objects on the active mesh are taken.
    """

    noun = "roots"

    def __init__(self, context: bpy.types.Context, settings: Settings) -> None:
        self._settings = settings
        self._parts: list[_Part] = []
        failures: Counter[str] = Counter()
        cages: dict[bpy.types.Object, cage.Cage] = {}
        depsgraph, seen = context.evaluated_depsgraph_get(), set()
        for ob in _chosen(context):
            if ob.data in seen:
                continue
            seen.add(ob.data)
            try:
                surface = _surface(ob)
                if surface is None or surface.type != "MESH":
                    raise RefusalError(f"{ob.name} has no surface: parent it to the mesh below it")
                if surface not in cages:
                    cages[surface] = cage.read(surface, depsgraph)
                self._parts.append(_read(ob, cages[surface], surface))
            except RefusalError as error:
                failures[str(error)] += 1
        if not self._parts:
            raise RefusalError(
                "; ".join(failures)
                or f"No selected object, and none on the active object, has the attributes "
                f"{ids.FACE} and {ids.UV}: select hair or points that stand on a limit surface"
            )
        self.notes = tuple(f"{n:,} left out: {reason}" for reason, n in failures.items())

    def relied_on(self) -> list[tuple[bpy.types.Object, tuple[str, ...]]]:
        """Returns the objects that were read, with the names of those of their attributes."""
        surfaces = dict.fromkeys(part.surface for part in self._parts)
        return [
            *((part.key.find(), (ids.FACE, ids.UV)) for part in self._parts),
            *((surface.find(), ()) for surface in surfaces),
        ]

    def measure(self, progress: Progress) -> list[Values]:
        surfaces: dict[int, CurvedSurface] = {}
        result = []
        for i, part in enumerate(self._parts):
            key = id(part.found)
            if key not in surfaces:
                surfaces[key] = CurvedSurface(
                    part.found, self._settings.in_world, self._settings.radius
                )
            here = part_of(progress, i / len(self._parts), (i + 1) / len(self._parts))
            result.append(surfaces[key].values(part.face, part.uv, part.matrix, here))
        return result

    def store(
        self, _context: bpy.types.Context, values: list[Values], colors: list[np.ndarray]
    ) -> str:
        stored = [part.key.find() for part in self._parts]
        for ob in stored:
            _check(ob)
        for ob, of, color in zip(stored, values, colors, strict=True):
            storage.write(ob.data, _DOMAINS[ob.type], of, color)
            ob.data.update_tag()
        return ", ".join(ob.name for ob in stored)


def _chosen(context: bpy.types.Context) -> list[bpy.types.Object]:
    active = context.active_object
    selected = dict.fromkeys([active, *context.selected_objects])
    carriers = [ob for ob in selected if _carries(ob)]
    if carriers:
        return carriers
    return [ob for ob in context.view_layer.objects if _carries(ob) and _surface(ob) == active]


def _carries(ob: bpy.types.Object) -> bool:
    if ob.type not in _DOMAINS or ids.FACES_MARK in ob:  # Limit Faces has them on faces and corners
        return False
    return {ids.FACE, ids.UV} <= set(ob.data.attributes.keys())


def _surface(ob: bpy.types.Object) -> bpy.types.Object | None:
    return (ob.data.surface if ob.type == "CURVES" else None) or ob.parent


def _check(ob: bpy.types.Object) -> None:
    domain = _DOMAINS[ob.type]
    check_data_editable(ob.data)
    for name, kind in ((ids.FACE, "INT"), (ids.UV, "FLOAT2")):
        there = ob.data.attributes[name]
        if (there.data_type, there.domain) != (kind, domain):
            raise RefusalError(
                f"{ob.data.name}: the attribute {name} exists with another type or domain: "
                "rename or remove it"
            )
    storage.check(ob, domain)


def _read(ob: bpy.types.Object, found: cage.Cage, surface: bpy.types.Object) -> _Part:
    _check(ob)
    face = attributes.read(ob.data, ids.FACE)
    uv = attributes.read(ob.data, ids.UV).astype(np.float64)
    face[face < 0] = NOWHERE
    if face.max(initial=NOWHERE) >= found.ptex_face_count:
        raise RefusalError(
            f"{ob.name} stands on faces that {surface.name} does not have: the faces have changed "
            "since it was placed"
        )
    check_uv(uv[face != NOWHERE], f"A place of {ob.name}")
    matrix = transform.world_matrix(ob)
    return _Part(ObjectKey.of(ob), ObjectKey.of(surface), face, uv, matrix, found)
