# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator view3d.limit_draw."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, CollectionProperty, IntProperty

from .. import ids, native
from ..errors import RefusalError
from ..placing.follow_properties import FollowProperties, why_it_stays
from ..tasks.properties import SummaryProperty, check_numbers, draw_summary
from ..tasks.running import Running
from . import brush_sizes, curve_object, properties, result, splines, stroke, subject
from .ground import Ground
from .pen import Pen
from .session import Session, Settings
from .stroke import LIMIT_PG_draw_point, LIMIT_PG_draw_spline
from .surface_watch import SurfaceWatch


class VIEW3D_OT_limit_draw(
    properties.DrawingProperties, FollowProperties, SummaryProperty, bpy.types.Operator
):
    """Draw curves or guide strands on the exact limit surface of the active mesh, with the mouse or
    a pen. If a curve that was drawn before is active, continue, erase and smooth its
    strokes"""

    bl_idname = ids.DRAW
    bl_label = "Draw on Limit Surface"
    bl_options = {"REGISTER", "UNDO", "BLOCKING"}

    strokes: CollectionProperty(
        name="Strokes",
        description="Points of all strokes, one stroke after the other, for scripts and the "
        "redo panel",
        type=LIMIT_PG_draw_point,
        options={"HIDDEN", "SKIP_SAVE"},
    )
    removed: CollectionProperty(
        name="Removed",
        description="Splines of the active curve that the strokes replace",
        type=LIMIT_PG_draw_spline,
        options={"HIDDEN", "SKIP_SAVE"},
    )
    changes_active: BoolProperty(
        name="Changes Active",
        description="Whether the active curve was changed, and no new object was made",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    is_drawn: BoolProperty(
        name="Is Drawn",
        description="Whether the strokes were drawn with the mouse or a pen, so that they have "
        "their mirror images already",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    steadying: IntProperty(
        name="Steady",
        description="Number of times that new strokes are smoothed. 8 times are enough to remove "
        "the unevenness that comes from the pixels of the screen",
        default=8,
        min=0,
        max=200,
    )
    use_mirror: BoolProperty(
        name="X Mirror",
        description="Also draw, erase and smooth at the place that is mirrored along the "
        "surface's X axis. Nothing is made where the surface is farther than 3 % of its size "
        "from that place, or ends before it",
        default=False,
    )
    use_pressure: BoolProperty(
        name="Pressure",
        description="Make the curves thinner where the pressure of the pen is low",
        default=True,
    )
    use_join: BoolProperty(
        name="Join",
        description="Continue a stroke if a new one begins at its end, and close a stroke if it "
        "ends where it began",
        default=True,
    )
    brush: IntProperty(
        name="Brush",
        description="Radius of the brushes that erase and smooth, in pixels",
        default=brush_sizes.DEFAULT,
        min=brush_sizes.LEAST,
        max=brush_sizes.MOST,
        subtype="PIXEL",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not native.available():
            cls.poll_message_set(native.obstacle())
            return False
        try:
            subject.find(context)
        except RefusalError as error:
            cls.poll_message_set(str(error))
            return False
        return True

    draw_next = staticmethod(properties.draw_next)

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        properties.draw(self.layout, self, is_new=not self.changes_active)
        draw_summary(self.layout, self.summary)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Makes what the stored strokes say; without strokes there is nothing to do."""
        if not self.strokes and not self.removed:
            return self._refuse(
                "Drawing needs a window and a mouse or pen. Scripts set `strokes` instead"
            )
        try:
            found = subject.find(context)
            ground = Ground(found.surface, context.evaluated_depsgraph_get())
            return self._make(context, found, ground)
        except native.refusals as error:
            return self._refuse(error)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if context.area is None or context.area.type != "VIEW_3D":
            return self._refuse("Only available in a 3D viewport")
        try:
            found, depsgraph = subject.find(context), context.evaluated_depsgraph_get()
            ground = Ground(found.surface, depsgraph)
            tolerance = ground.tolerance(self.tolerance)
            begun = []
            if found.edited:
                curve_object.check_places(found.edited, ground, depsgraph)
                self.output = "CURVE"
                self.offset = float(found.edited.data.get(ids.OFFSET, 0.0))
                begun = splines.strokes(found.edited, ground, tolerance)
            else:  # what is drawn would be lost if it turned out later
                curve_object.check_follows(self.follow, ground, depsgraph)
        except native.refusals as error:
            return self._refuse(error)
        self._keys = subject.Keys.of(found)
        self._watch = SurfaceWatch(found.surface)
        settings = Settings(tolerance, self.steadying, self.use_mirror, self.use_join)
        self._pen = Pen(
            context.area, Session(ground, settings, begun), self.brush, self.use_pressure
        )
        self._pen.running = Running(context, self._close)
        context.window_manager.modal_handler_add(self)
        self._stop_playback(context)
        self._pen.show(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        try:
            self._keep_up(context)
            answer = self._pen.take(context, event)
            if answer == {"FINISHED"} and self._pen.obstacle:
                # it may pass, and the strokes would be lost
                self._refuse(self._pen.obstacle)
                answer = {"RUNNING_MODAL"}
            elif answer == {"FINISHED"}:
                answer = self._confirm(context)
        except native.refusals as error:
            answer = self._refuse(error)
        except BaseException:
            self._close(context)
            raise
        if answer & {"FINISHED", "CANCELLED"}:
            self._close(context)
        return answer

    def cancel(self, context: bpy.types.Context) -> None:
        """Is called when Blender ends the operator, for example because another file is opened."""
        self._close(context)

    def _close(self, context: bpy.types.Context) -> None:
        self._watch.close()
        self._pen.close(context)

    def _stop_playback(self, context: bpy.types.Context) -> None:
        """Stops it in the present frame: over a surface that moves under the pen, the hand's line
        would become another one.
        """
        if context.screen.is_animation_playing:
            bpy.ops.screen.animation_cancel(restore_frame=False)
            self._pen.notice = "Playback was stopped: a surface that moves cannot be drawn on"
            self.report({"INFO"}, self._pen.notice)

    def _keep_up(self, context: bpy.types.Context) -> None:
        """Draws on the surface as it is by now, if a script has changed it or the frame."""
        if not self._watch.take():
            return
        try:
            found, depsgraph = self._keys.find(), context.evaluated_depsgraph_get()
            ground = self._pen.session.ground.now(found.surface, depsgraph)
        except native.refusals as error:
            self._pen.obstacle = native.sentence(error)
        else:
            self._pen.stand_on(ground)
        # Where reading has put back a pose without keys, the surface is evaluated once more.
        context.evaluated_depsgraph_get()
        self._watch.take()

    def _confirm(self, context: bpy.types.Context) -> set[str]:
        session = self._pen.session
        self.brush, settings = self._pen.brush, session.settings
        self.use_mirror, self.use_join = settings.is_mirrored, settings.continues
        if not session.is_changed:
            self.report({"INFO"}, "Nothing was drawn")
            return {"CANCELLED"}
        stroke.write(session.changed, self.strokes)
        self.is_drawn = True
        self.removed.clear()
        for number in session.removed:
            self.removed.add().index = number
        found, depsgraph = self._keys.find(), context.evaluated_depsgraph_get()
        return self._make(context, found, session.ground.now(found.surface, depsgraph))

    def _make(self, context: bpy.types.Context, found: subject.Subject, ground: Ground) -> set[str]:
        """Puts the strokes into the file. The stored strokes are read back, so that the redo panel
        makes the same of them.
        """
        check_numbers(self.properties)
        self.changes_active = found.edited is not None
        tolerance = ground.tolerance(self.tolerance)
        if found.edited is not None:
            curve_object.check_places(found.edited, ground, context.evaluated_depsgraph_get())
        strokes = result.read_strokes(self.strokes, ground, tolerance)
        result.warn_of_pieces(self, len(strokes), stroke.count(self.strokes))
        if self.use_mirror and not self.is_drawn:
            strokes = result.with_mirror_images(self, strokes, ground, tolerance)
        removed = [each.index for each in self.removed]
        if removed and found.edited is None:
            raise RefusalError(
                "The property `removed` names splines, but no curve is "
                "active: make the drawn curve active"
            )
        self.summary = result.make(context, ground, found.edited, strokes, removed, self)
        if found.edited is not None:
            result.warn_of_modifiers(self, [found.edited])
        notes = [self.summary, *ground.posed.cage.notes]
        why = "" if found.edited else why_it_stays(self.follow, ground.ob)
        if why:
            notes.append(f"it does not follow the surface: {why}")
        self.report({"INFO"}, "; ".join(notes))
        return {"FINISHED"}

    def _refuse(self, reason: object) -> set[str]:
        self.report({"ERROR"}, native.sentence(reason))
        return {"CANCELLED"}
