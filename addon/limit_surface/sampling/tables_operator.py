# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_sample_tables."""

import bpy
from bpy.props import IntProperty

from .. import ids
from ..counting import counted
from ..placing.all_tiles import AllTiles, remove_left_behind, settings_of
from ..placing.mending import mended
from ..tasks.job import Job, Progress
from ..tasks.properties import draw_summary
from ..tasks.watched_operator import WatchedOperator


class OBJECT_OT_limit_sample_tables(WatchedOperator, bpy.types.Operator):
    """Make the hidden tables that the node group Sample Limit Surface needs to sample the active
    mesh's limit surface. Make them again after faces, creases or settings of the Subdivision
    Surface modifier have changed. Depth and Levels then stay as they were unless you set them"""

    bl_idname = ids.SAMPLE_TABLES
    bl_label = "Tables for Sample Limit Surface"
    bl_options = {"REGISTER", "UNDO"}
    too_large = "There is not enough memory for the tables"
    cancelled = "Cancelled: no tables were made"

    depth: IntProperty(
        name="Depth",
        description="How close to irregular vertices, such as poles, the node gives exact "
        "results: down to a distance of 2^-Depth of a face. A place that is closer to such a "
        "vertex is moved away from it, to that distance. A larger depth makes larger tables",
        default=16,
        min=1,
        max=24,
    )
    levels: IntProperty(
        name="Levels",
        description="Number of subdivisions of the mesh Limit Faces, on which points can be "
        "distributed. More levels distribute points more evenly on curved faces",
        default=2,
        min=0,
        max=6,
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self._keep_settings(context.active_object)
        return super().invoke(context, event)

    def _keep_settings(self, surface: bpy.types.Object) -> None:
        """Takes the settings of the tables that are there."""
        was = settings_of(surface)
        if was.depth is not None:
            self.depth = was.depth
        if was.levels is not None:
            self.levels = was.levels

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        surface = context.active_object
        if not any(self.properties.is_property_set(name) for name in ("depth", "levels")):
            self._keep_settings(surface)
        tables = AllTiles(surface, context.evaluated_depsgraph_get(), self.depth, self.levels)
        self.rely_on(surface)

        def work(progress: Progress) -> AllTiles:
            tables.compute(progress)
            return tables

        return self.watch(context, Job(work), f"Making tables of {surface.name}")

    def finish(self, _context: bpy.types.Context, made: AllTiles) -> set[str]:
        left, readers = remove_left_behind(but=made.surface)
        with mended():
            made.write()
        self.summary = (
            f"{counted(len(made.tree.tiles.tile_points), 'tiles')} of {made.surface_name}"
        )
        if left:
            self.summary += f"\n{left}"
        self.report({"INFO"}, self.summary.replace("\n", "; "))
        if readers:
            self.report({"WARNING"}, f"The removed tables were used by: {', '.join(readers)}")
        return {"FINISHED"}

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(self, "depth")
        self.layout.prop(self, "levels")
        draw_summary(self.layout, self.summary)
