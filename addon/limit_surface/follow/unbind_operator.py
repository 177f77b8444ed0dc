# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_unbind."""

import bpy
from bpy.props import EnumProperty

from .. import ids
from ..placing.binding_operator import rely_on_bound
from ..placing.followers import live_modifier_of
from ..placing.following import has_unused_attributes, unused_captures
from ..placing.live_unbinding import LiveUnbinding
from ..placing.unbinding import Unbinding, leftovers_of, remove_leftovers
from ..tasks import polling
from ..tasks.piecewise_job import Pieces, PiecewiseJob
from ..tasks.properties import draw_summary
from ..tasks.watched_operator import WatchedOperator
from .children_unbinding import ChildrenUnbinding
from .subjects import children_to_unbind, chosen_followers, selected


class OBJECT_OT_limit_unbind(WatchedOperator, bpy.types.Operator):
    """Stop the selected objects from following (hair, points, decals, meshes, Curve objects). If
    only the surface is selected, stop everything that follows it. Live children become curves"""

    bl_idname = ids.UNBIND
    bl_label = "Unbind from Limit Surface"
    bl_options = {"REGISTER", "UNDO"}
    cancelled = "Cancelled: nothing has changed"

    shape: EnumProperty(
        name="Shape",
        description="Which shape things keep",
        items=(
            ("SHOWN", "As Shown", "Keep the shape of this frame", 0),
            (
                "REST",
                "At Rest",
                "Go back to the shape at rest: the shape that things had when they were bound, "
                "with what you have combed since",
                1,
            ),
        ),
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polling.in_object_mode(
            cls,
            context,
            lambda: (
                bool(chosen_followers(context) or children_to_unbind(context))
                or bool(_with_leftovers(context))
            ),
            "Select what follows a limit surface (hair, points, decals, meshes, Curve objects), "
            "live children, or the surface itself",
        )

    def start(self, context: bpy.types.Context) -> set[str]:
        self.summary = ""
        return self.watch(context, PiecewiseJob(self._pieces(context)), "Unbinding")

    def finish(self, _context: bpy.types.Context, made: str) -> set[str]:
        self.summary = made
        self.report({"INFO"}, self.summary)
        return {"FINISHED"}

    def _pieces(self, context: bpy.types.Context) -> Pieces:
        """Unbinds in the last piece, and returns a report."""
        things = chosen_followers(context)
        children = children_to_unbind(context)
        self.rely_on(*children)
        rely_on_bound(self, things)
        live = [ob for ob in things if live_modifier_of(ob)]
        by_nodes = [ob for ob in things if ob not in live]
        if not things and not children:
            return "\n".join(map(remove_leftovers, _with_leftovers(context)))
        unbindings: list[Unbinding | LiveUnbinding | ChildrenUnbinding] = []
        if children:  # before their guides are unbound
            unbindings.append(ChildrenUnbinding(children))
        if by_nodes:
            unbindings.append(Unbinding(by_nodes, self.shape))
        if live:
            unbindings.append(LiveUnbinding(live, context.evaluated_depsgraph_get(), self.shape))
        for unbinding in unbindings:
            if not isinstance(unbinding, LiveUnbinding):
                yield from unbinding.compute(context)
        depsgraph = context.evaluated_depsgraph_get()
        return "\n".join([unbinding.write(depsgraph) for unbinding in unbindings])

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(self, "shape")
        draw_summary(self.layout, self.summary)


def _with_leftovers(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Returns the active mesh if there are tables that nothing reads any more, and the selected
    meshes that have *Limit Capture*, or the attributes of one that was applied, although nothing
    follows them, as copies of a surface have.
    """
    meshes = [ob for ob in selected(context) if ob.type == "MESH"]
    active = context.active_object
    return [
        ob
        for ob in meshes
        if unused_captures(ob) or has_unused_attributes(ob) or (ob == active and leftovers_of(ob))
    ]
