# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator object.limit_follow."""

from collections.abc import Callable

import bpy
from bpy.props import BoolProperty, EnumProperty

from .. import ids
from ..errors import RefusalError
from ..placing import curve_points, following, live_binding, newcomers
from ..placing.binding_operator import BindingOperator, rely_on_bound
from ..placing.followers import live_modifier_of
from ..tasks import polling
from ..tasks.job import Progress
from ..tasks.piecewise_job import Pieces, aside
from ..tasks.properties import draw_summary
from .subjects import has_to_bind, selected, to_bind

Things = dict[bpy.types.Object, list[bpy.types.Object]]  # by their surface

NOTHING = (
    "Select hair or points that stand on a limit surface, or select other hair, points or "
    "Curve objects and, last, the mesh that they should follow"
)


class OBJECT_OT_limit_follow(BindingOperator, bpy.types.Operator):
    """Make the selected hair, points and meshes follow the limit surface that they stand on,
    however its mesh deforms. Curve objects, and hair and points that this extension has not
    placed, follow the closest points of the active mesh"""

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
                "Geometry Nodes move things. This also works where this extension is not installed",
                0,
            ),
            (
                "LIVE",
                "Live",
                "This extension moves things in each frame. It is faster for very many "
                "strands, but slower in scenes with very many objects. Creases may be animated. "
                "Modifiers before the subdivision may add and remove faces. They must keep the "
                "faces on which things stand, and the numbers of these faces",
                1,
            ),
        ),
    )

    use_proxy: BoolProperty(
        name="Fast Viewport",
        description="Make playback faster: in the viewport nodes read a hidden copy of the "
        "surface, so that the graphics card can subdivide the surface itself. "
        "Use it if the last modifier is a Subdivision Surface modifier of level 3 or "
        "more. Run this operator again after you add, remove or move modifiers of the surface",
        default=False,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polling.in_object_mode(cls, context, lambda: has_to_bind(context), NOTHING)

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(self, "mode")
        self.layout.prop(self, "use_proxy")
        draw_summary(self.layout, self.summary)

    def bind(self, context: bpy.types.Context) -> Pieces:
        by_surface = to_bind(context)
        if not by_surface:
            raise RefusalError(NOTHING)
        for surface, things in by_surface.items():
            self.rely_on(surface)
            rely_on_bound(self, things)
        live, others = self._divided(context, by_surface)
        requests = yield from self._located(context, live)
        lines = (yield from self._by_nodes(context, others)) if others else []
        lines += [str(request.write(context)) for request in requests]
        self.summary = "\n".join(lines)
        self.report({"INFO"}, "; ".join(lines))
        self._take_over(by_surface)
        return {"FINISHED"}

    @property
    def _proxy(self) -> bool | None:
        """None, which keeps what there is, unless the property has been set."""
        return self.use_proxy if self.properties.is_property_set("use_proxy") else None

    def _divided(self, context: bpy.types.Context, by_surface: Things) -> tuple[Things, Things]:
        """Returns what is to follow live, and what by nodes. What follows a selected surface live
        and is not selected itself goes on so.
        """
        chosen = selected(context)
        live, others = Things(), Things()
        for on, things in by_surface.items():
            for ob in things:
                goes_on = ob not in chosen and live_modifier_of(ob) is not None
                way = live if self.mode == "LIVE" or goes_on else others
                way.setdefault(on, []).append(ob)
        return live, others

    def _by_nodes(self, context: bpy.types.Context, by_surface: Things) -> Pieces:
        requests = []
        for on, obs in by_surface.items():
            depsgraph = context.evaluated_depsgraph_get()
            following.check_surface(on, depsgraph.scene)
            obs = live_binding.with_live_sharers(obs)
            things, curves = (
                [ob for ob in obs if (ob.type == "CURVE") == is_curve] for is_curve in (False, True)
            )
            for ob in things:
                following.check_thing(ob, on)
            for ob in curves:
                curve_points.check_any(ob)
            bound_curves = curve_points.CurveRequest(curves, on, depsgraph, self._proxy)
            relocated = yield from newcomers.relocations(things, on, depsgraph)
            depsgraph = context.evaluated_depsgraph_get()
            request = following.Request(
                on, depsgraph, things, self._proxy, relocated, without=curves
            )
            requests.append((request, things, bound_curves))
        made = []
        for request, things, _curves in requests:
            if things:
                made.append((yield from aside(_computing(request))))
        depsgraph = context.evaluated_depsgraph_get()
        for ob in [ob for obs in by_surface.values() for ob in obs]:
            live_binding.end(ob, depsgraph)
        outcomes = [bindings.write() for bindings in made]
        for _request, _things, bound_curves in requests:
            outcomes += bound_curves.write(context)
        return [str(outcome) for outcome in outcomes]

    def _located(self, context: bpy.types.Context, by_surface: Things) -> Pieces:
        """Returns requests (list[LiveRequest]) that can be written."""
        depsgraph = context.evaluated_depsgraph_get()
        requests = [live_binding.LiveRequest(on, depsgraph, obs) for on, obs in by_surface.items()]
        for request in requests:
            yield from request.locate(context.evaluated_depsgraph_get())
        return requests

    def _take_over(self, by_surface: Things) -> None:
        """Makes the surface known to hair, and ends what else moves it."""
        for surface, things in by_surface.items():
            for ob in things:
                if ob.type == "CURVES" and ob.data.surface is None:
                    ob.data.surface = surface
                for name in newcomers.other_deformers(ob):
                    self.report(
                        {"WARNING"},
                        f"{ob.name}: its modifier {name} deforms it as well. Disable that modifier "
                        "if it moves the object with the same surface",
                    )
                for name in newcomers.disable_deformation_by_blender(ob):
                    self.report(
                        {"WARNING"},
                        f"{ob.name}: the modifier {name} was disabled, because it would move the "
                        "hair a second time",
                    )


def _computing(request: following.Request) -> Callable[[Progress], following.Bindings]:
    return lambda _progress: request.compute()
