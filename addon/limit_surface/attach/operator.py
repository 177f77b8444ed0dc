# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_attach."""

from __future__ import annotations

import bpy
import numpy as np

from .. import ids
from ..counting import counted
from ..errors import RefusalError
from ..placing import dependencies, following
from ..placing.binding import Binding
from ..placing.binding_operator import BindingOperator
from ..placing.followers import live_modifier_of, modifier_of
from ..placing.posed_surface import Places, PosedSurface, at_closest
from ..placing.unbinding import remove_unused_carriers
from ..reading import cage, transform
from ..tasks import polling
from ..tasks.job import Progress
from ..tasks.piecewise_job import Pieces, aside
from ..tasks.properties import draw_summary
from ..tasks.refused_faces import check_some_left
from .carrier import Extension, is_carrier
from .parenting import attach, parent_matrices

_WORLD = np.eye(4)
#: Types of constraints that decide where an object is
_PLACING = {
    *("ACTION", "ARMATURE", "CHILD_OF", "CLAMP_TO", "COPY_LOCATION", "COPY_TRANSFORMS"),
    *("FLOOR", "FOLLOW_PATH", "FOLLOW_TRACK", "LIMIT_DISTANCE", "LIMIT_LOCATION"),
    *("OBJECT_SOLVER", "PIVOT", "SHRINKWRAP", "TRANSFORM", "TRANSFORM_CACHE"),
}
_MOST_NAMES = 3  # of a report
_NOTHING = "Select the objects to attach and, last, the mesh that they should follow"


class OBJECT_OT_limit_attach(BindingOperator, bpy.types.Operator):
    """Attach the selected objects to the active mesh: each follows the point of the limit surface
    that is closest to it now, however the mesh deforms"""

    bl_idname = ids.ATTACH
    bl_label = "Attach to Limit Surface"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        surface = context.active_object
        return polling.in_object_mode(
            cls,
            context,
            lambda: surface is not None and surface.type == "MESH" and bool(_others(context)),
            _NOTHING,
        )

    def draw(self, _context: bpy.types.Context) -> None:
        draw_summary(self.layout, self.summary)

    def bind(self, context: bpy.types.Context) -> Pieces:
        surface, objects = context.active_object, _others(context)
        context.view_layer.update()
        depsgraph = context.evaluated_depsgraph_get()
        following.check_surface(surface, depsgraph.scene)
        _check(objects, surface)
        self.rely_on(surface, placed=True)
        self.rely_on(*objects, data=False, placed=True)

        posed = PosedSurface(cage.read(surface, depsgraph))
        check_some_left(posed.in_world, surface.name)
        origins = np.array([ob.matrix_world.translation for ob in objects], np.float64)

        def locate(progress: Progress) -> tuple[Binding, Places]:
            hits = posed.in_world.closest(origins, progress=progress)
            found = at_closest(posed, hits)
            places = posed.places(found.face, found.uv.astype(np.float64), _WORLD)
            return Binding.at(posed, found, _WORLD), places

        binding, places = yield from aside(locate)
        depsgraph = context.evaluated_depsgraph_get()
        size = float(np.abs(posed.in_world.positions).max())

        attached = [i for i, ob in enumerate(objects) if ob.parent]
        was = np.tile(_WORLD, (len(objects), 1, 1))
        if attached:
            held_by = [(objects[i].parent, objects[i].parent_vertices) for i in attached]
            was[attached] = parent_matrices(context, held_by)
        new = Extension(surface, depsgraph, binding, places, size)
        now = parent_matrices(context, [(new.carrier, vertices) for vertices in new.vertices])
        for ob, vertices, before, after in zip(objects, new.vertices, was, now, strict=True):
            attach(ob, new.carrier, vertices, before, after)
        remove_unused_carriers()
        context.view_layer.update()
        distances = np.linalg.norm(origins - places.position, axis=1)
        self._summarize(surface, len(objects), len(attached), distances)
        self.report({"INFO"}, "; ".join([self.summary, *posed.cage.notes]))
        self._warn_of_constraints(objects)
        return {"FINISHED"}

    def _warn_of_constraints(self, objects: list[bpy.types.Object]) -> None:
        held = [ob for ob in objects if any(_may_hold(each) for each in ob.constraints)]
        if held:
            names = ", ".join(ob.name for ob in held[:_MOST_NAMES])
            names += ", ..." if len(held) > _MOST_NAMES else ""
            text = f"Constraints may hold {counted(len(held), 'objects')} elsewhere: {names}"
            self.summary += f"\n{text}"
            self.report({"WARNING"}, text)

    def _summarize(
        self, surface: bpy.types.Object, count: int, again: int, distances: np.ndarray
    ) -> None:
        sentences = [
            f"{counted(count, 'objects', 'is', 'are')} attached to {surface.name}",
            f"The largest distance from the limit surface is {distances.max():.4g}",
        ]
        if again:
            sentences.append(
                f"{counted(again, 'objects', 'was', 'were')} attached already and got new places"
            )
        self.summary = ". ".join(sentences)


def _may_hold(constraint: bpy.types.Constraint) -> bool:
    return constraint.type in _PLACING and constraint.enabled and constraint.influence > 0


def _others(context: bpy.types.Context) -> list[bpy.types.Object]:
    return [ob for ob in context.selected_objects if ob != context.active_object]


def _check(objects: list[bpy.types.Object], surface: bpy.types.Object) -> None:
    """Raises RefusalError for the first object that cannot be attached."""
    needed = dependencies.needed_by(surface)
    for ob in objects:
        transform.check_finite(np.array(ob.matrix_world), ob.name)
        if not ob.is_editable:
            raise RefusalError(
                f"{ob.name} is linked from another file: make it local, or make a library override"
            )
        if modifier_of(ob) or live_modifier_of(ob):
            raise RefusalError(
                f"{ob.name} follows a surface by itself: run Unbind from Limit Surface on it "
                "first, or do not attach it"
            )
        if ob in needed:
            raise RefusalError(
                f"{ob.name} cannot be attached to {surface.name}, because {surface.name} depends "
                f"on {ob.name}: by a parent, a modifier, a constraint or a driver"
            )
        if ob.parent and not (is_carrier(ob.parent) and ob.parent_type == "VERTEX_3"):
            raise RefusalError(
                f"{ob.name} has the parent {ob.parent.name}: clear it first (Clear and Keep "
                "Transformation), or attach the parent"
            )
