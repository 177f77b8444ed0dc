# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_particles_from_hair."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.props import EnumProperty, IntProperty

from .. import ids, native
from ..errors import RefusalError
from ..placing import followers, following, shown_strands
from ..placing.places import Places
from ..placing.posed_surface import PosedSurface, at_closest
from ..placing.rotations import WorldSpace
from ..reading import attributes, cage, rules
from ..tasks import polling
from ..tasks.object_keys import ObjectKey
from ..tasks.piecewise_job import Pieces, PiecewiseJob
from ..tasks.properties import draw_summary
from ..tasks.watched_operator import WatchedOperator
from . import creation, system
from .creation import Particles

_RADIUS = 0.01  # Blender's own where curves store none
_NOTHING = "Make hair on a limit surface active first"


@dataclass(frozen=True)
class Made:
    surface: str
    system: str
    count: int
    keys: int
    resampled: int  # the number of strands that had another number of points


class OBJECT_OT_limit_particles_from_hair(WatchedOperator, bpy.types.Operator):
    """Make a legacy hair particle system on the surface from the active hair: every key lies where
    the strands are shown now"""

    bl_idname = ids.PARTICLES_FROM_HAIR
    bl_label = "Particle System from Hair"
    bl_options = {"REGISTER", "UNDO"}

    keys: IntProperty(
        name="Keys",
        description="Number of keys on each particle, including the root. 0 means the number of "
        "points of the strands, or the largest one where strands differ. Strands with another "
        "number of points are resampled at equal distances",
        default=0,
        min=0,
        max=1024,
        soft_max=32,
    )

    levels: EnumProperty(
        name="Levels",
        description="The subdivision at which the keys lie on the strands. Particles stand on the "
        "displayed polygons, so that they move a little where these change",
        items=(
            ("VIEWPORT", "Viewport", "Use the levels of the viewport", 0),
            ("RENDER", "Render", "Use the levels of renders", 1),
        ),
        default="VIEWPORT",
    )

    @property
    def cancelled(self) -> str:
        return "Cancelled: no particle system was made"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        def is_hair() -> bool:
            ob = context.active_object
            return ob is not None and ob.type == "CURVES"

        return polling.in_object_mode(cls, context, is_hair, _NOTHING)

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(self, "keys")
        self.layout.prop(self, "levels")
        draw_summary(self.layout, self.summary)

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        hair = context.active_object
        surface = _surface_of(hair, context)
        made, resampled = self._read(hair, surface, context.evaluated_depsgraph_get())
        key = ObjectKey.of(surface)

        at_levels = system.at_render_levels(key) if self.levels == "RENDER" else nullcontext()

        def pieces() -> Pieces:
            name = creation.add(context, key.find(), made)
            try:
                with at_levels:
                    yield from system.write_keys(context, key, name, made.strands)
            except BaseException:  # ESC as well
                system.remove(key.find(), name)
                raise
            count, keys = made.strands.shape[:2]
            return Made(key.name, name, count, keys, resampled)

        return self.watch(context, PiecewiseJob(pieces()), "Making particles")

    def finish(self, context: bpy.types.Context, made: Made) -> set[str]:
        context.view_layer.update()
        self.summary = (
            f"{made.count:,} particles of {made.keys} keys: {made.system} of {made.surface}"
        )
        if made.resampled:
            self.summary += f"\n{made.resampled:,} strands were resampled"
        self.report({"INFO"}, self.summary.replace("\n", "; "))
        warning = _levels_warning(bpy.data.objects[made.surface], self.levels)
        if warning:
            self.summary += f"\n{warning}"
            self.report({"WARNING"}, warning)
        return {"FINISHED"}

    def _read(
        self, hair: bpy.types.Object, surface: bpy.types.Object, depsgraph: bpy.types.Depsgraph
    ) -> tuple[Particles, int]:
        """Returns what the system is made of, and the number of strands that were resampled."""
        found = cage.read(surface, depsgraph)
        following.check_holds(hair, surface, following.signature(found))
        places = Places.read(hair.data)
        places.check(found.ptex_face_count, surface.name)
        points, offsets = shown_strands.read(hair, found.matrix, depsgraph)
        sizes = np.diff(offsets)
        keys = self.keys or int(sizes.max())
        if keys < 2:
            raise RefusalError("A particle needs at least 2 keys: its root and its tip")
        strands = _with_keys(points, offsets, keys)
        place = _places(found, places, strands[:, 0], _standing(surface, found))
        radius = _radius(hair, offsets, depsgraph)
        resampled = int(np.count_nonzero(sizes != keys))
        return Particles(hair.name, place, strands, radius), resampled


def _surface_of(hair: bpy.types.Object, context: bpy.types.Context) -> bpy.types.Object:
    """Returns the surface of hair. Raises RefusalError where the hair is not bound to one, or this
    one cannot get a particle system.
    """
    surface = followers.surface_of(hair)
    if surface is None or not followers.is_placed(hair):
        raise RefusalError(
            f"{hair.name} stores no places on a limit surface: run Follow Limit Surface or Snap to "
            "Limit Surface on it first"
        )
    if not len(hair.data.curves):
        raise RefusalError(f"{hair.name} has no strands")
    if not surface.is_editable or surface.override_library:
        raise RefusalError(
            f"{surface.name} is linked from another file: make it local first, because Blender "
            "adds no particle systems to linked objects and library overrides"
        )
    system.check_shown(surface, context)
    return surface


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


def _levels_warning(surface: bpy.types.Object, levels: str) -> str:
    """Returns a warning where the viewport and renders do not show the same polygons, or None."""
    subsurf = rules.find_subsurf(surface)
    if subsurf is None or subsurf.levels == subsurf.render_levels:
        return ""
    exact, other = "the viewport", "renders"
    at, beside = subsurf.levels, subsurf.render_levels
    if levels == "RENDER":
        exact, other, at, beside = other, exact, beside, at
    return (
        f"The particles are where the strands are in {exact} (level {at}), and beside them in "
        f"{other} (level {beside}): give {subsurf.name} the same levels for both"
    )


def _radius(
    hair: bpy.types.Object, offsets: np.ndarray, depsgraph: bpy.types.Depsgraph
) -> tuple[float, float]:
    """Returns the mean radii of roots and tips in the world."""
    shown = hair.evaluated_get(depsgraph)
    if "radius" not in shown.data.attributes:
        return _RADIUS, _RADIUS
    radius = attributes.read(shown.data, "radius")
    scale = WorldSpace(np.array(shown.matrix_world, np.float64)).mean_scale
    at_root, at_tip = radius[offsets[:-1]].mean(), radius[offsets[1:] - 1].mean()
    return float(scale * at_root), float(scale * at_tip)
