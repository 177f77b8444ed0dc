# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_hair_from_particles."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from bpy.props import BoolProperty, StringProperty

from .. import ids
from ..counting import counted
from ..errors import RefusalError
from ..placing import followers, following, live_binding, new_hair
from ..placing.all_or_nothing import all_or_nothing
from ..placing.binding import Binding
from ..placing.follow_properties import FollowOrLiveProperties, can_deform, why_not_automatic
from ..placing.new_hair import Strands
from ..placing.posed_surface import PosedSurface, at_closest
from ..placing.rotations import WorldSpace
from ..reading import cage
from ..tasks import polling
from ..tasks.job import Job
from ..tasks.object_keys import MaterialKey, ObjectKey
from ..tasks.piecewise_job import Pieces, PiecewiseJob
from ..tasks.properties import draw_summary
from ..tasks.refused_faces import check_some_left
from ..tasks.watched_operator import WatchedOperator
from . import system, thickness

_NOTHING = "Make a mesh with a hair particle system active first"
_POLL = 0.05  # seconds between two looks at a thread


@dataclass(frozen=True)
class Made:
    surface: ObjectKey
    system: str
    material: MaterialKey | None  # of the particles
    strands: Strands
    bindings: following.Bindings | None
    farthest: float  # the largest distance of a root from the surface, in the world


@dataclass(frozen=True)
class Target:
    """The surface as arrays, and what makes the new hair follow it."""

    found: cage.Cage
    request: following.Request | None  # None: it does not follow by nodes
    snap_roots: bool

    def strands(
        self, keys: system.Keys, radius: np.ndarray
    ) -> tuple[Strands, following.Bindings | None, float]:
        """Returns the strands, bound where their roots are closest to the surface, what makes
        them follow, and the largest distance of a root from the surface, in the world.
        """
        found, posed = self.found, PosedSurface(self.found)
        check_some_left(posed.in_world, "the surface")
        first = keys.offsets[:-1]
        hits = posed.in_world.closest(found.to_world(keys.position[first]))
        locations = at_closest(posed, hits)
        binding = Binding.at(posed, locations, found.matrix)
        position = keys.position
        if self.snap_roots:
            moves = binding.root - keys.position[first]
            position = position + np.repeat(moves, keys.sizes, axis=0)
            position[first] = binding.root
        uv = locations.uv.astype(np.float64)
        surface_uv = found.surface_uv(posed.in_object, locations.face, uv)
        uv_map = found.uv_map.name if found.uv_map else ""
        made = Strands(binding, keys.sizes, position, radius, surface_uv, uv_map)
        bindings = self.request.compute(locations) if self.request else None
        return made, bindings, float(hits.distance.max())


class OBJECT_OT_limit_hair_from_particles(
    WatchedOperator, FollowOrLiveProperties, bpy.types.Operator
):
    """Make hair on the active mesh's limit surface from one of its legacy hair particle systems:
    each particle, without children, becomes a curve that is bound to the surface"""

    bl_idname = ids.HAIR_FROM_PARTICLES
    bl_label = "Hair from Particle System"
    bl_options = {"REGISTER", "UNDO"}

    system: StringProperty(
        name="Particle System",
        description="Name of the particle system. If empty, the active one is used",
    )
    snap_roots: BoolProperty(
        name="Snap Roots",
        description="Move strands so that their roots lie exactly on the limit surface. "
        "Particles stand on the displayed polygons, a little away from it. If "
        "this is off, strands stay where they are",
        default=True,
    )

    @property
    def cancelled(self) -> str:
        return "Cancelled: no hair was made"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        def has_particles() -> bool:
            ob = context.active_object
            return ob is not None and ob.type == "MESH" and bool(ob.particle_systems)

        return polling.in_object_mode(cls, context, has_particles, _NOTHING)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        surface = followers.ground_of(context.active_object)
        if surface is not None:
            layout.prop_search(self, "system", surface, "particle_systems")
        layout.prop(self, "snap_roots")
        layout.prop(self, "follow")
        draw_summary(layout, self.summary)

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        surface = context.active_object
        name = self._chosen(surface)
        system.check_shown(surface, context)
        depsgraph = context.evaluated_depsgraph_get()
        if self.follow == "LIVE":
            following.check_surface(surface, depsgraph.scene)
        target = Target(
            cage.read(surface, depsgraph),
            following.request_for(self.follow, surface, depsgraph),
            self.snap_roots,
        )
        scale = WorldSpace(target.found.matrix, target.found.name).mean_scale
        key = ObjectKey.of(surface)
        uv_map = target.found.uv_map  # strands store their places on it
        self.rely_on(surface, named=[uv_map.name] if uv_map else ())

        def pieces() -> Pieces:
            settings = key.find().particle_systems[name].settings
            with system.all_shown(settings):
                keys = yield from system.read_keys(context, key, name)
            if not len(keys.sizes):
                raise RefusalError(f"The particle system {name} has no hair")
            radius = thickness.radii(settings, keys.time) / scale
            material = _material(key.find(), settings)
            job = Job(lambda _progress: target.strands(keys, radius))
            job.start()
            while not job.wait(_POLL):
                yield 1.0
            return Made(key, name, material, *job.result())

        return self.watch(context, PiecewiseJob(pieces()), "Reading particles")

    def finish(self, context: bpy.types.Context, made: Made) -> set[str]:
        surface = made.surface.find()
        why = ""
        with all_or_nothing(context, surface):
            material = _found(made.material)
            hair = new_hair.add(context, ids.HAIR_OBJECT, surface, made.strands, material)
            how = live_binding.have_follow(context, surface, hair, made.bindings, self.follow)
        if not how and self.follow == "AUTO" and can_deform(surface):
            why = why_not_automatic(surface)
        context.view_layer.update()
        self._report(made, how, why)
        return {"FINISHED"}

    def _chosen(self, surface: bpy.types.Object) -> str:
        """Returns the name of the particle system. Raises RefusalError where it has no hair."""
        systems = surface.particle_systems
        found = systems.get(self.system) if self.system else systems.active
        if found is None:
            raise RefusalError(f"{surface.name} has no particle system {self.system!r}")
        if found.settings.type != "HAIR":
            raise RefusalError(
                f"The particle system {found.name} emits particles: only hair can be converted"
            )
        return found.name

    def _report(self, made: Made, how: str, why_not: str) -> None:
        count = len(made.strands.sizes)
        self.summary = f"{counted(count, 'strands')} from {made.system} of {made.surface.name}"
        were = "were" if self.snap_roots else "are"
        notes = [f"roots {were} at most {made.farthest:.4g} from the limit surface"]
        if how:
            notes.append(f"they follow the surface {how}")
        if why_not:
            notes.append(f"they do not follow the surface: {why_not}")
        self.report({"INFO"}, "; ".join([self.summary, *notes]))
        self.summary += "".join(f"\n{note[0].upper()}{note[1:]}" for note in notes)


def _material(
    surface: bpy.types.Object, settings: bpy.types.ParticleSettings
) -> MaterialKey | None:
    """Returns the material of the particles, if there is one."""
    slots = surface.material_slots
    slot = slots[min(settings.material, len(slots)) - 1] if len(slots) else None
    return MaterialKey.of(slot.material) if slot and slot.material else None


def _found(key: MaterialKey | None) -> list[bpy.types.Material]:
    material = key.find() if key else None
    return [material] if material else []
