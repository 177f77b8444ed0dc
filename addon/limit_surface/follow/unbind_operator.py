# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_unbind."""

import bpy
from bpy.props import EnumProperty

from .. import ids, native
from ..placing.followers import live_modifier_of
from ..placing.live_unbinding import LiveUnbinding
from ..placing.unbinding import Unbinding, leftovers_of, remove_leftovers
from ..tasks import polling
from ..tasks.properties import SummaryProperty, draw_summary
from .children_unbinding import ChildrenUnbinding
from .subjects import children_to_unbind, chosen_followers


class OBJECT_OT_limit_unbind(SummaryProperty, bpy.types.Operator):
    """Stop the selected hair and points from following. If only the surface is selected, stop
    everything that follows it. Live children become curves"""

    bl_idname = ids.UNBIND
    bl_label = "Unbind from Limit Surface"
    bl_options = {"REGISTER", "UNDO"}

    shape: EnumProperty(
        name="Shape",
        description="Shape in which things are left",
        items=(
            ("SHOWN", "As Shown", "Keep the shape that is shown in this frame", 0),
            ("REST", "At Rest", "Go back to the shape that things had when they were bound", 1),
        ),
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polling.in_object_mode(
            cls,
            context,
            lambda: (
                bool(chosen_followers(context) or children_to_unbind(context))
                or _leftovers(context)
            ),
            "Select hair or points that follow a limit surface, or live children",
        )

    def execute(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        try:
            depsgraph = context.evaluated_depsgraph_get()
            things = chosen_followers(context)
            children = children_to_unbind(context)
            live = [ob for ob in things if live_modifier_of(ob)]
            by_nodes = [ob for ob in things if ob not in live]
            if not things and not children:
                self.summary = remove_leftovers(context.active_object)
                self.report({"INFO"}, self.summary)
                return {"FINISHED"}
            unbindings: list[Unbinding | LiveUnbinding | ChildrenUnbinding] = []
            if children:  # before their guides are unbound
                unbindings.append(ChildrenUnbinding(children, depsgraph))
            if by_nodes:
                unbindings.append(Unbinding(by_nodes, depsgraph, self.shape))
            if live:
                unbindings.append(LiveUnbinding(live, depsgraph, self.shape))
            self.summary = "\n".join([unbinding.write() for unbinding in unbindings])
        except native.refusals as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, self.summary)
        return {"FINISHED"}

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(self, "shape")
        draw_summary(self.layout, self.summary)


def _leftovers(context: bpy.types.Context) -> bool:
    """Tells whether the active mesh has tables that nothing reads any more."""
    active = context.active_object
    return active is not None and active.type == "MESH" and bool(leftovers_of(active))
