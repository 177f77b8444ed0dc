# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface that things follow live: its limit surface in the pose of the present frame.

The modifier *Limit Capture* hands on the control mesh's positions, and checksums of all else that
the limit surface depends on. While these stay the same, a new frame costs only the reading of one
attribute. Otherwise the control mesh is read anew.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import bpy
import numpy as np

from .. import ids, native
from ..errors import CageError
from ..reading import attributes, cage, rules

if TYPE_CHECKING:
    import limitsurf

_CHECKSUMS = (ids.CAGE_COUNT, ids.CAGE_TOPOLOGY, ids.CAGE_EDGE_CREASES, ids.CAGE_VERTEX_CREASES)


class _Captured(NamedTuple):
    """What *Limit Capture* hands on."""

    positions: np.ndarray  # (vertices of the control mesh, 3) float64
    checksums: tuple[object, ...]


class LiveSurface:
    """`version` counts the poses. Raises CageError and MeshError where there is no surface."""

    limit: limitsurf.LimitSurface  # there is one once it has been read

    def __init__(self) -> None:
        self.version = 0
        self._checksums: tuple[object, ...] | None = None

    def read(self, ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
        """Takes the pose of the depsgraph's frame."""
        evaluated = ob.evaluated_get(depsgraph)
        mesh = evaluated.data if evaluated.is_evaluated and evaluated.type == "MESH" else None
        captured = _captured(ob, mesh) if mesh else None
        self._take(ob, captured, lambda: cage.read(ob, depsgraph))

    def read_again(self, ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
        """Takes the pose that the surface has in the depsgraph's frame after something was moved
        on which it depends, and which the depsgraph has not evaluated again.
        """
        with cage.opened(ob, depsgraph) as (found, mesh):
            self._take(ob, _captured(ob, mesh), lambda: found)

    def _take(
        self, ob: bpy.types.Object, captured: _Captured | None, find: Callable[[], cage.Cage]
    ) -> None:
        self.version += 1
        if captured is None or captured.checksums != self._checksums:
            self._checksums = None
            self.limit = find().surface()
        if captured is None:
            return
        if len(captured.positions) != len(self.limit.positions):
            raise CageError(
                f"The modifiers of {ob.name} give another control mesh in renders "
                "than in the viewport: enable each of them in both, or in neither"
            )
        self.limit.set_positions(captured.positions)
        self._checksums = captured.checksums


def surface_at(
    ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph, frame: float
) -> limitsurf.LimitSurface:
    """Returns the limit surface of another frame."""
    with cage.opened(ob, depsgraph, _at(frame)) as (found, _):
        return found.surface()


def _at(frame: float) -> Callable[[bpy.types.Object, bpy.types.Scene], None]:
    def go(_copy: bpy.types.Object, scene: bpy.types.Scene) -> None:
        scene.frame_float = frame

    return go


def _captured(ob: bpy.types.Object, mesh: bpy.types.Mesh) -> _Captured | None:
    """Returns what the object's evaluated mesh contains, if it has the modifier."""
    stored = mesh.attributes
    if any(name not in stored for name in (ids.CAGE_POSITION, *_CHECKSUMS)) or not mesh.vertices:
        return None
    sums = tuple(stored[name].data[0].value for name in _CHECKSUMS)
    positions = attributes.read(mesh, ids.CAGE_POSITION)
    if len(positions) < sums[0]:
        return None
    rule = rules.read(rules.find_subsurf(ob))
    return _Captured(positions[: sums[0]].astype(np.float64), (*sums, rule))


#: What may be raised where a surface cannot be read
errors: tuple[type[Exception], ...] = (CageError, *native.errors)
