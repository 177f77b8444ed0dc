# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_follow."""

import bpy
from bpy.props import BoolProperty, EnumProperty

from .. import ids, native
from ..errors import RefusalError
from ..placing import following
from ..placing.followers import is_placed, surface_of
from ..tasks.properties import SummaryProperty, draw_summary


class OBJECT_OT_limit_follow(SummaryProperty, bpy.types.Operator):
    """Make the selected hair and points follow the limit surface that they stand on, however the
    mesh deforms"""

    bl_idname = ids.FOLLOW
    bl_label = "Follow Limit Surface"
    bl_options = {"REGISTER", "UNDO"}

    mode: EnumProperty(
        name="Mode",
        description="How things follow the surface",
        items=(
            (
                "NODES",
                "Nodes",
                "Geometry Nodes move them. Files play everywhere, also without this extension",
                0,
            ),
        ),
    )

    use_proxy: BoolProperty(
        name="Fast Viewport",
        description="Read a hidden copy of the surface in the viewport, so that the graphics card "
        "can subdivide the surface itself. Use it with a Subdivision Surface of level 3 and more "
        "at the end of the stack. Run this operator again after a change of the surface's "
        "modifiers",
        default=False,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not native.available():
            cls.poll_message_set(native.obstacle())
        elif not _placed(context):
            cls.poll_message_set("Select hair or points that stand on a limit surface")
        else:
            return True
        return False

    def execute(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        try:
            return self._bind(context)
        except native.refusals as error:
            self.report({"ERROR"}, str(error))
        except MemoryError:
            self.report({"ERROR"}, "There is not enough memory for the tables")
        return {"CANCELLED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(self, "mode")
        self.layout.prop(self, "use_proxy")
        draw_summary(self.layout, self.summary)

    def _bind(self, context: bpy.types.Context) -> set[str]:
        by_surface: dict[bpy.types.Object, list[bpy.types.Object]] = {}
        for ob in _placed(context):
            surface = surface_of(ob)
            if surface is None:
                raise RefusalError(f"{ob.name} has no surface: parent it to its mesh")
            by_surface.setdefault(surface, []).append(ob)
        depsgraph = context.evaluated_depsgraph_get()
        requests = [
            following.Request(on, depsgraph, obs, self.use_proxy) for on, obs in by_surface.items()
        ]
        lines = [str(made.write()) for made in [request.compute() for request in requests]]
        self.summary = "\n".join(lines)
        self.report({"INFO"}, "; ".join(lines))
        return {"FINISHED"}


def _placed(context: bpy.types.Context) -> list[bpy.types.Object]:
    chosen = dict.fromkeys([*context.selected_objects, context.active_object])
    return [ob for ob in chosen if ob is not None and is_placed(ob)]
