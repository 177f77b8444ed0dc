# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the Subdivision Surface modifier with which the viewport shows the limit surface.

Nothing here changes the limit surface itself. A modifier that is added has the rules that count for
objects without one, and it is added at the end, where the surface is without one.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from ..errors import RefusalError
from ..reading import cage, rules, subdivided_mesh

NAME = "Subdivision"
QUALITY = 10  # the full one; with less, vertices near irregular places are beside the limit surface
LEVELS = 3  # enough for polygons that look smooth
MOST_POLYGONS = 1_000_000  # more of them make the viewport slow

# From quality 2 on, the time that Blender's modifier needs for a vertex of many edges, or for a
# face of many sides, grows with the cube of their number, at each evaluation: 1 to 2 s at 100.
LOW_QUALITY = 1  # takes less than a twentieth of that
FEW_SIDES = 32  # up to here that time is short, however many such vertices and faces there are
MOST_CUBES = 100**3  # the sum of these cubes up to which the modifier gets the full quality


LOW_QUALITY_REASON = (
    "because at a higher quality Blender would take seconds for vertices and faces with so many "
    "edges: near them the displayed mesh is a little off the limit surface"
)


@dataclass(frozen=True)
class LimitDisplay:
    """The settings that put the vertices of the displayed mesh on the limit surface, or near it
    where the quality is low.
    """

    levels: int
    quality: int

    @classmethod
    def of(cls, found: cage.Cage, levels: int) -> LimitDisplay:
        return cls(levels, fitting_quality(found))

    def apply(self, ob: bpy.types.Object) -> bpy.types.SubsurfModifier:
        """Sets up the modifier whose rules the surface follows, or adds one."""
        subsurf = rules.find_subsurf(ob)
        if subsurf is None:
            subsurf = ob.modifiers.new(NAME, "SUBSURF")
            subsurf.render_levels = self.levels
        subsurf.show_viewport = True
        subsurf.levels = self.levels
        subsurf.use_limit_surface = True
        subsurf.quality = self.quality
        return subsurf

    def holds(self, subsurf: bpy.types.SubsurfModifier) -> bool:
        """Tells whether a modifier has these settings."""
        return (
            subsurf.show_viewport
            and subsurf.levels == self.levels
            and subsurf.use_limit_surface
            and subsurf.quality == self.quality
        )


def lacks_subsurf(ob: bpy.types.Object) -> bool:
    """Tells whether the object has no Subdivision Surface modifier that is enabled anywhere."""
    return rules.find_subsurf(ob) is None


def check_editable(ob: bpy.types.Object) -> None:
    """Raises RefusalError where the object's modifiers cannot be changed."""
    if not ob.is_editable:
        raise RefusalError(
            f"{ob.name} is linked from another file: its modifiers cannot be changed here"
        )


def fitting_levels(face_sizes: np.ndarray) -> int:
    """Returns the usual number of levels, or fewer for meshes of very many faces; at least 1."""
    for levels in range(LEVELS, 1, -1):
        if subdivided_mesh.polygon_counts(face_sizes, levels).sum() <= MOST_POLYGONS:
            return levels
    return 1


def fitting_quality(found: cage.Cage) -> int:
    """Returns the full quality, or the low one for cages with such vertices and faces that Blender
    would be busy for seconds at each evaluation.
    """
    sides = np.concatenate([found.face_sizes, np.bincount(found.mesh.face_vertices)])
    many = sides[sides > FEW_SIDES].astype(np.float64)
    return QUALITY if (many**3).sum() <= MOST_CUBES else LOW_QUALITY


def add(ob: bpy.types.Object, found: cage.Cage) -> bpy.types.SubsurfModifier:
    """Adds a modifier that shows the limit surface of the object's cage."""
    check_editable(ob)
    return LimitDisplay.of(found, fitting_levels(found.face_sizes)).apply(ob)


@contextmanager
def added(ob: bpy.types.Object, found: cage.Cage) -> Iterator[None]:
    """Gives the object such a modifier for as long as the context lasts, so that everything is read
    as it will be.
    """
    subsurf = add(ob, found)
    try:
        yield
    finally:
        ob.modifiers.remove(subsurf)
