# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_particles_from_hair."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass

import bpy
from bpy.props import EnumProperty, IntProperty

from .. import ids
from ..counting import counted
from ..errors import RefusalError
from ..placing import followers, shown_strands
from ..tasks import polling
from ..tasks.object_keys import ObjectKey
from ..tasks.piecewise_job import Pieces, PiecewiseJob
from ..tasks.properties import draw_summary
from ..tasks.watched_operator import WatchedOperator
from . import creation, levels, strands, system

_NOTHING = "Make hair on a limit surface active first"


@dataclass(frozen=True)
class Made:
    surface: str
    system: str
    count: int
    keys: int
    resampled: int  # the number of strands that had another number of points
    of_types: str  # a warning of the types of strands
    unseen: str  # the material of the hair, if the surface has it in no slot


class OBJECT_OT_limit_particles_from_hair(WatchedOperator, bpy.types.Operator):
    """Make a legacy hair particle system on the surface from the active hair. Every key, which is a
    point of a particle's strand, lies exactly on a strand as it is shown now"""

    bl_idname = ids.PARTICLES_FROM_HAIR
    bl_label = "Particle System from Hair"
    bl_options = {"REGISTER", "UNDO"}

    keys: IntProperty(
        name="Keys",
        description="Number of keys on each particle, including the root. 0 means the number of "
        "points of the strands, or the largest such number if strands differ. Strands with "
        "another number of points are resampled at equal distances",
        default=0,
        min=0,
        max=1024,
        soft_max=32,
    )

    levels: EnumProperty(
        name="Levels",
        description="Subdivision level at which the particles match the strands exactly. "
        "Particles stand on the displayed polygons, so at another level they "
        "move a little",
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
        depsgraph = context.evaluated_depsgraph_get()
        made, resampled = strands.read(hair, surface, self.keys, depsgraph)
        key = ObjectKey.of(surface)
        self.rely_on(surface)
        material = strands.material_of(hair)
        unseen = material.name if material and not strands.slot_of(material, surface) else ""

        of_types = shown_strands.warning_of_types(hair)
        is_for_renders = self.levels == "RENDER"
        at_levels = levels.at_render_levels(context, key) if is_for_renders else nullcontext()

        def pieces() -> Pieces:
            name = creation.add(context, key.find(), made)
            try:
                with at_levels:
                    yield from system.write_keys(context, key, name, made.strands)
                    system.check_keys(context, key, name, made.strands)
            except BaseException:  # ESC as well
                system.remove(key.find(), name)
                raise
            count, keys = made.strands.shape[:2]
            return Made(key.find().name, name, count, keys, resampled, of_types, unseen)

        return self.watch(context, PiecewiseJob(pieces()), "Making particles")

    def finish(self, context: bpy.types.Context, made: Made) -> set[str]:
        context.view_layer.update()
        self.summary = (
            f"{counted(made.count, 'particles')} of {counted(made.keys, 'keys')}: {made.system} of "
            f"{made.surface}"
        )
        if made.resampled:
            self.summary += f"\n{counted(made.resampled, 'strands', 'was', 'were')} resampled"
        self.report({"INFO"}, self.summary.replace("\n", "; "))
        warnings = [
            made.of_types,
            levels.warning(context, bpy.data.objects[made.surface], self.levels),
        ]
        if made.unseen:
            warnings.append(
                f"{made.surface} has no material slot with {made.unseen}, the material of the "
                "hair: add one, and choose it in the particle settings"
            )
        for warning in filter(None, warnings):
            self.summary += f"\n{warning}"
            self.report({"WARNING"}, warning)
        return {"FINISHED"}


def _surface_of(hair: bpy.types.Object, context: bpy.types.Context) -> bpy.types.Object:
    """Returns the surface of hair. Raises RefusalError where the hair is not bound to one, or this
    one cannot get a particle system.
    """
    followers.check_placed(hair)
    surface = followers.surface_of(hair)
    assert surface is not None
    if not len(hair.data.curves):
        raise RefusalError(f"{hair.name} has no strands")
    if not surface.is_editable or surface.override_library:
        raise RefusalError(
            f"{surface.name} is linked from another file: make it local first, because Blender "
            "adds no particle systems to linked objects and library overrides"
        )
    system.check_shown(surface, context)
    return surface
