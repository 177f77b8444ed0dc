# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_show."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from bpy.props import IntProperty

from .. import ids
from ..counting import counted
from ..placing.followers import ground_of
from ..reading import attributes, cage, displayed_mesh, rules, subdivided_mesh
from ..subsurf import setup, shown
from ..subsurf.setup import LimitDisplay
from ..tasks import polling
from ..tasks.job import Job, Progress
from ..tasks.object_keys import ObjectKey
from ..tasks.properties import LargeCountProperty, draw_summary
from ..tasks.request_size import RequestSize
from ..tasks.watched_operator import WatchedOperator
from .distances import Distances, measure_all

_SHOWN = "VIEWPORT"
MOST_LEVELS = 6


@dataclass(frozen=True)
class Measured:
    surface: ObjectKey
    cage: cage.Cage
    display: LimitDisplay
    polygons: int
    distances: Distances


class OBJECT_OT_limit_show(WatchedOperator, LargeCountProperty, bpy.types.Operator):
    """Set the Subdivision Surface modifier up, or add one, so that the viewport shows the limit
    surface: the smooth surface that infinitely many subdivisions approach. Measure how far the
    displayed polygons still are from it"""

    bl_idname = ids.SHOW
    bl_label = "Show Limit Surface"
    bl_options = {"REGISTER", "UNDO"}
    too_large = "There is not enough memory for so many polygons"
    cancelled = "Cancelled: nothing was changed"

    levels: IntProperty(
        name="Levels",
        description="Number of subdivisions in the viewport. The vertices lie on the limit "
        "surface. With more subdivisions the polygons between the vertices "
        "follow it more closely",
        default=setup.LEVELS,
        min=1,
        max=MOST_LEVELS,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polling.mesh_in_object_mode(cls, context, ground_of(context.active_object))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if not self.properties.is_property_set("levels"):
            self.levels = _levels_for(ground_of(context.active_object))
        return super().invoke(context, event)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "levels")
        layout.prop(self, "allow_large")
        draw_summary(layout, self.summary)

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        ob, depsgraph = ground_of(context.active_object), context.evaluated_depsgraph_get()
        assert ob is not None  # as poll has found
        setup.check_editable(ob)
        found = cage.read(ob, depsgraph)
        self.rely_on(ob)
        polygons = int(subdivided_mesh.polygon_counts(found.face_sizes, self.levels).sum())
        RequestSize("polygons", polygons, 1).check(self.allow_large)
        display = LimitDisplay.of(found, self.levels)
        mesh = displayed_mesh.read_as_set_up(ob, depsgraph, found, display)
        key, count = ObjectKey.of(ob), len(mesh.quads.corners)

        def work(progress: Progress) -> Measured:
            results, _refused = measure_all(found, {_SHOWN: mesh}, progress)
            return Measured(key, found, display, count, results[_SHOWN])

        return self.watch(context, Job(work), f"Measuring {ob.name}")

    def finish(self, context: bpy.types.Context, made: Measured) -> set[str]:
        ob = made.surface.find()
        setup.check_editable(ob)
        subsurf = made.display.apply(ob)
        context.view_layer.update()
        found, distance = made.cage, made.distances.apart
        corners = np.ptp(found.world_positions(), axis=0)
        part = f"{100 * distance.largest / float(np.linalg.norm(corners)):.2g} % of the diagonal"
        level = made.distances.level
        self.summary = (
            f"{counted(made.polygons, 'polygons')} at level {level}\n"
            f"at most {distance.largest:.3g} from the surface\n({part})"
        )
        notes = [
            f"{ob.name} shows its limit surface at level {level}: the polygons are at most "
            f"{distance.largest:.3g} from it ({part}), {distance.mean:.3g} on average"
        ]
        if found.ignored:
            notes.append(f"not measured: {', '.join(found.ignored)} after {subsurf.name}")
        if shown.shown_level(subsurf, context.scene) < self.levels:
            self.report({"WARNING"}, f"Simplify shows level {level} instead of {self.levels}")
        if subsurf.quality < setup.QUALITY:
            self.report({"WARNING"}, f"Quality is {subsurf.quality}, {setup.LOW_QUALITY_REASON}")
        self.report({"INFO"}, "; ".join(notes))
        return {"FINISHED"}


def _levels_for(ob: bpy.types.Object) -> int:
    """Returns as many levels as polygons that look smooth need, or those that the viewport shows
    already if these are more.
    """
    subsurf = rules.shown_subsurf(ob)
    fitting = setup.fitting_levels(attributes.face_sizes(ob.data))
    return min(max(subsurf.levels if subsurf else 0, fitting), MOST_LEVELS)
