# SPDX-License-Identifier: GPL-3.0-or-later
"""The strands of hair, read for a particle system: where they are shown, and on which polygons
their particles are to stand.
"""

from __future__ import annotations

import bpy
import numpy as np

from .. import ids, native
from ..errors import RefusalError
from ..placing import following, shown_strands
from ..placing.places import Places
from ..placing.posed_surface import PosedSurface, at_closest
from ..placing.rotations import WorldSpace
from ..reading import attributes, cage
from .creation import Particles

_RADIUS = 0.01  # Blender's own where curves store none
#: Squares of larger coordinates exceed single precision, and Blender crashes when it looks for the
#: polygons that are closest to roots.
_LARGEST = 1e18


def read(
    hair: bpy.types.Object, surface: bpy.types.Object, keys: int, depsgraph: bpy.types.Depsgraph
) -> tuple[Particles, int]:
    """Returns what a system with so many keys is made of, and the number of strands that were
    resampled. 0 keys mean as many as the longest strand has points.
    """
    found = cage.read(surface, depsgraph)
    following.check_holds(hair, surface, following.signature(found))
    places = Places.read(hair.data)
    places.check(found.ptex_face_count, surface.name)
    points, offsets = shown_strands.read(hair, found.matrix, depsgraph)
    sizes = np.diff(offsets)
    keys = keys or int(sizes.max())
    if keys < 2:
        raise RefusalError("A particle needs at least 2 keys: its root and its tip")
    strands = _with_keys(points, offsets, keys)
    standing = _standing(surface, found)
    if max(np.abs(strands).max(initial=0), np.abs(standing).max()) > _LARGEST:
        raise RefusalError(
            f"{hair.name} or {surface.name} has coordinates beyond {_LARGEST:g}, of which Blender "
            "cannot make particles"
        )
    place = _places(found, places, strands[:, 0], standing)
    radius = _radius(hair, offsets, depsgraph)
    resampled = int(np.count_nonzero(sizes != keys))
    slot = slot_of(material_of(hair), surface) or 1
    return Particles(hair.name, place, strands, radius, slot), resampled


def material_of(hair: bpy.types.Object) -> bpy.types.Material | None:
    """Returns the first material of hair: all particles of a system have the same one."""
    return hair.material_slots[0].material if hair.material_slots else None


def slot_of(material: bpy.types.Material | None, surface: bpy.types.Object) -> int:
    """Returns the number of the surface's slot with this material, counted from 1; 0 for none."""
    found = [slot.material for slot in surface.material_slots]
    return found.index(material) + 1 if material and material in found else 0


def _with_keys(points: np.ndarray, offsets: np.ndarray, keys: int) -> np.ndarray:
    """Returns strands (n, keys, 3): those with so many points as they are, and the others with
    points at equal distances.
    """
    is_whole = np.diff(offsets) == keys
    strands = np.empty((len(is_whole), keys, 3))
    if not is_whole.all():
        strands[:] = native.limitsurf.resample_strands(points, offsets, keys)
    strands[is_whole] = points[offsets[:-1][is_whole][:, None] + np.arange(keys)]
    return strands


def _standing(surface: bpy.types.Object, found: cage.Cage) -> np.ndarray:
    """Returns the vertices (n, 3) of the polygons on which particles are to stand: those of the
    edited mesh, or of the cage where modifiers change their number.
    """
    if cage.why_not_on_mesh(surface, found):
        return found.mesh.positions
    return attributes.read(surface.data, ids.POSITION).astype(np.float64)


def _places(
    found: cage.Cage, places: Places, roots: np.ndarray, vertices: np.ndarray
) -> np.ndarray:
    """Returns points (n, 3) on the polygons of the mesh, where the strands' locations are. Strands
    without one get that closest to their root.
    """
    face = np.empty(places.count, np.int32)
    uv = np.empty((places.count, 2))
    face[places.rows], uv[places.rows] = places.face, places.uv
    others = np.setdiff1d(np.arange(places.count), places.rows)
    if len(others):
        posed = PosedSurface(found)
        near = at_closest(posed, posed.in_world.closest(found.to_world(roots[others])))
        face[others], uv[others] = near.face, near.uv
    return found.surface().varying(vertices).evaluate(face, uv).value


def _radius(
    hair: bpy.types.Object, offsets: np.ndarray, depsgraph: bpy.types.Depsgraph
) -> tuple[float, float]:
    """Returns the mean radii of roots and tips in the world."""
    with shown_strands.shown_as(hair, depsgraph) as shown:
        if "radius" not in shown.data.attributes:
            return _RADIUS, _RADIUS
        radius = attributes.read(shown.data, "radius")
        scale = WorldSpace(np.array(shown.matrix_world, np.float64), hair.name).mean_scale
    at_root, at_tip = radius[offsets[:-1]].mean(), radius[offsets[1:] - 1].mean()
    return float(scale * at_root), float(scale * at_tip)
