# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator view3d.limit_snap_modal."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np
from bpy.props import FloatVectorProperty, IntProperty

from .. import ids, native
from ..errors import RefusalError
from ..snap.binding_again import bind_again
from ..snap.properties import ALIGNMENTS, HAIR, PlacingProperties
from ..snap.surface import TargetSurface
from ..tasks.properties import check_numbers
from ..tasks.running import Running
from ..viewport.ray import Ray
from ..viewport.view import View
from .drag import Drag, Glide, nearest_in_sight, offset_step
from .drawing import Drawing, Mark
from .subject import Subject, find_subject
from .typed_number import TypedNumber

LOCK_KEYS = {"X": "BORDER", "Y": "BOUNDARY", "Z": "FREE"}
LOCK_NAMES = {"FREE": "Free", "BORDER": "Along the face's border", "BOUNDARY": "Along the boundary"}
NAVIGATION = {"MIDDLEMOUSE", "NDOF_MOTION", "TRACKPADPAN", "TRACKPADZOOM"}
MOVES = {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}
WHEEL = {"WHEELUPMOUSE": 1, "WHEELDOWNMOUSE": -1}
CLICK = 3  # in pixels: a smaller move with the button pressed is a click, not a drag
FINE = 0.1  # the share of a wheel step that is used with Shift
KEYS = (
    "Click or Enter: confirm   Esc or right click: cancel   Wheel or number: offset "
    "(Shift: fine)   X: face border   Y: boundary   Z: free   A: align   H: hair   "
    "Ctrl Wheel, middle mouse: view"
)
RUNNING = {"RUNNING_MODAL"}


class VIEW3D_OT_limit_snap_modal(PlacingProperties, bpy.types.Operator):
    """Drag things over the exact limit surface with the mouse. In Object Mode, drag the selected
    object over the active mesh. Drag a vertex in Edit Mode, or a strand of hair by its root, over
    the target in the sidebar tab Limit"""

    bl_idname = ids.SNAP_MODAL
    bl_label = "Drag on Limit Surface"
    bl_options = {"REGISTER", "UNDO", "BLOCKING"}

    element: IntProperty(
        name="Element",
        description="Index of the vertex or strand that is dragged",
        default=-1,
        options={"HIDDEN", "SKIP_SAVE"},
    )
    face: IntProperty(
        name="Face",
        description="Number of the Ptex face on which the element is put: quads count once, other "
        "faces once for each corner. Scripts and the redo panel use it together with UV",
        default=-1,
        options={"HIDDEN", "SKIP_SAVE"},
    )
    uv: FloatVectorProperty(
        name="UV",
        description="u and v of the place on that face, 0 to 1",
        size=2,
        min=0.0,
        max=1.0,
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not native.available():
            cls.poll_message_set(native.obstacle())
            return False
        try:
            find_subject(context)
        except RefusalError as error:
            cls.poll_message_set(str(error))
            return False
        return True

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "offset")
        if context.mode != "EDIT_MESH":
            layout.prop(self, "align")
        if self.element >= 0 and context.mode != "EDIT_MESH":
            layout.prop(self, "hair")
        layout.prop(self, "target")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Puts the element at a stored location; without one there is nothing to do."""
        if self.face < 0:
            return self._refuse(
                "Dragging needs a window and a mouse. Scripts set `face` and `uv` instead, or use "
                "object.limit_snap"
            )
        try:
            check_numbers(self.properties)
            subject = find_subject(context)
            surface = TargetSurface(subject.target, context.evaluated_depsgraph_get(), self.target)
            self._check_element(subject)
            glide = Glide(surface)
            glide.go_to(self.face, self.uv)
            drag = Drag(glide, subject.handle(self.element, surface))
            with native.rows_called(lambda _row: subject.target.name):
                drag.put(self.offset, self.align, self.hair)
            drag.confirm(self.offset, self.align, self.hair)
        except native.refusals as error:
            return self._refuse(error)
        self._bind_again(subject)
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if context.area is None or context.area.type != "VIEW_3D":
            return self._refuse("Only available in a 3D viewport")
        try:
            self._subject = find_subject(context)
            self._unchanged = self._subject.unchanged()
            depsgraph = context.evaluated_depsgraph_get()
            self._glide = Glide(TargetSurface(self._subject.target, depsgraph, self.target))
            self._glide.prepare()
            self._candidates: np.ndarray | None = None
            self._hovered: int | None = None
            self._drag: Drag | None = None
            if self._subject.is_picked:
                self._candidates = self._subject.candidates()
            else:
                self._take(-1)
        except native.refusals as error:
            return self._refuse(error)
        self._view, self._drawing = View(context), Drawing()
        self._running = Running(context, self.cancel)
        self._step = offset_step(self._glide.surface)
        self._typed, self._offset_before_typing = TypedNumber(), self.offset
        self._pressed_at: tuple[int, int] | None = None
        self._is_astray = False
        self._view.show_keys(KEYS)
        answer = self._take_event(event, self._begin)
        if answer == RUNNING:
            context.window_manager.modal_handler_add(self)
        return answer

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return self._take_event(event, self._handle)

    def cancel(self, context: bpy.types.Context) -> None:
        """Is called when Blender ends the operator, for example because another file is opened, and
        when the extension is disabled.
        """
        self._end(restores=True)

    def _take_event(
        self, event: bpy.types.Event, handle: Callable[[bpy.types.Event], set[str]]
    ) -> set[str]:
        """Handles an event. However the drag ends, nothing of it stays on the screen."""
        answer = {"CANCELLED"}
        try:
            if not self._view.exists:
                raise RefusalError("The 3D viewport was closed meanwhile")
            answer = handle(event)
            if answer == RUNNING:
                self._show_state()
        except native.refusals as error:
            answer = self._refuse(error)
        finally:
            if answer & {"FINISHED", "CANCELLED"}:
                self._end(restores=answer == {"CANCELLED"})
        return answer

    def _begin(self, event: bpy.types.Event) -> set[str]:
        self._follow(event)
        return RUNNING

    def _handle(self, event: bpy.types.Event) -> set[str]:
        kind, is_press = event.type, event.value == "PRESS"
        if kind in NAVIGATION or (kind in WHEEL and (event.ctrl or self._drag is None)):
            return {"PASS_THROUGH"}
        if kind in MOVES:
            self._follow(event)
        elif kind in {"ESC", "RIGHTMOUSE"} and is_press:
            return {"CANCELLED"}
        elif kind == "LEFTMOUSE":
            return self._click(event)
        elif self._drag is None or not is_press:
            pass
        elif kind in {"RET", "NUMPAD_ENTER"}:
            return self._confirm()
        elif not (event.ctrl or event.alt or event.oskey):
            # with one of these a key means something else, which has to wait: undo, for example
            self._key(event)
        return RUNNING

    def _key(self, event: bpy.types.Event) -> None:
        drag, kind = self._drag, event.type
        assert drag is not None
        if kind in WHEEL:
            self._typed = TypedNumber()
            self.offset += WHEEL[kind] * self._step * (FINE if event.shift else 1)
            self._put()
        elif kind in LOCK_KEYS:
            self._lock(LOCK_KEYS[kind])
            self._follow(event)
        elif kind == "A" and drag.handle.can_turn:
            self.align = _next(ALIGNMENTS, self.align)
            self._put()
        elif kind == "H" and drag.handle.has_strand:
            self.hair = _next(HAIR, self.hair)
            self._put()
        else:
            self._type(event)

    def _click(self, event: bpy.types.Event) -> set[str]:
        """Picks an element with the mouse. It is dragged while the button is held, or after a click
        until the next click confirms.

        A click beside the viewport, also on a sidebar or header that overlaps it, is ignored: it is
        not meant for what is behind, and a button there would change the scene during the drag.
        """
        at = (event.mouse_x, event.mouse_y)
        if event.value == "PRESS" and not self._view.is_over(event):
            return RUNNING
        if event.value == "PRESS":
            if self._drag is not None:
                return self._confirm()
            self._follow(event)
            if self._hovered is not None:
                self._take(self._hovered)
                self._pressed_at = at
        elif event.value == "RELEASE" and self._pressed_at is not None:
            dragged = np.hypot(*np.subtract(at, self._pressed_at)) > CLICK
            self._pressed_at = None
            if dragged:
                return self._confirm()
        return RUNNING

    def _take(self, element: int) -> None:
        self._unchanged.check()
        self.element = element
        handle = self._subject.handle(element, self._glide.surface)
        self._drag = Drag(self._glide, handle)

    def _follow(self, event: bpy.types.Event) -> None:
        sight = self._view.sight(event)
        if sight is None:
            self._is_astray = True
        elif self._drag is None:
            self._hover(sight)
        else:
            self._is_astray = not self._glide.follow(sight)
            self._put()
        self._view.redraw()

    def _hover(self, sight: Ray) -> None:
        candidates = self._candidates
        assert candidates is not None
        self._hovered = nearest_in_sight(candidates, sight, self._glide.surface)
        self._drawing.mark = None
        if self._hovered is not None:
            across = np.linalg.svd(sight.direction[None])[2].T[:, [1, 2, 0]]
            self._drawing.mark = Mark(candidates[self._hovered], across, None, ())

    def _put(self) -> None:
        drag = self._drag
        assert drag is not None
        drag.put(self.offset, self.align, self.hair)
        place = drag.place
        if place is not None:
            directions = self._glide.bending().directions
            self._drawing.mark = Mark(place.position, place.frame, place.frame[:, 2], directions)
        self._view.redraw()

    def _lock(self, lock: str) -> None:
        """Locks the drag to a border. The same key releases it again."""
        glide = self._glide
        if lock == "BOUNDARY" and not glide.borders.has_boundary:
            self.report({"WARNING"}, f"{glide.surface.ob.name} has no boundary")
            return
        glide.lock = "FREE" if glide.lock == lock else lock

    def _type(self, event: bpy.types.Event) -> None:
        was_typing = bool(self._typed)
        if event.type == "BACK_SPACE":
            self._typed.erase()
        elif not (event.unicode and self._typed.take(event.unicode)):
            return
        if not was_typing:
            self._offset_before_typing = self.offset
        self.offset = self._typed.value if self._typed else self._offset_before_typing
        self._put()

    def _confirm(self) -> set[str]:
        drag = self._drag
        assert drag is not None
        if drag.place is None:
            self.report(
                {"WARNING"}, "Nothing was moved, because the mouse was never over the surface"
            )
            return {"CANCELLED"}
        drag.confirm(self.offset, self.align, self.hair)
        self._bind_again(self._subject)
        self.face, self.uv = self._glide.face, self._glide.uv
        return {"FINISHED"}

    def _bind_again(self, subject: Subject) -> None:
        if subject.kind == "STRAND":
            for warning in bind_again([subject.ob], subject.target, bpy.context):
                self.report({"WARNING"}, warning)

    def _end(self, restores: bool) -> None:
        self._running.over()
        try:
            if restores and self._drag is not None:
                self._drag.handle.restore()
        finally:
            self._drawing.remove()
            self._view.clear()

    def _check_element(self, subject: Subject) -> None:
        if subject.is_picked and not 0 <= self.element < len(subject.candidates()):
            noun = "vertex" if subject.kind == "VERTEX" else "strand"
            raise RefusalError(f"{subject.ob.name} has no {noun} {self.element}")

    def _refuse(self, reason: object) -> set[str]:
        self.report({"ERROR"}, native.sentence(reason))
        return {"CANCELLED"}

    def _show_state(self) -> None:
        if self._drag is None:
            noun = "vertex" if self._subject.kind == "VERTEX" else "strand"
            self._view.show_state(f"Press the mouse button on a {noun} and drag it, or click it")
            return
        offset = self._typed.text or f"{self.offset:.6g}"
        parts = [f"Offset: {offset}", LOCK_NAMES[self._glide.lock]]
        handle = self._drag.handle
        if handle.can_turn:
            parts.append(f"Align: {_label(ALIGNMENTS, self.align)}")
        if handle.has_strand:
            parts.append(f"Hair: {_label(HAIR, self.hair)}")
        if self._is_astray:
            parts.append("no surface under the mouse")
        self._view.show_state("   ".join(parts))


def _next(items: tuple[tuple[str, str, str, int], ...], chosen: str) -> str:
    names = [name for name, *_rest in items]
    return names[(names.index(chosen) + 1) % len(names)]


def _label(items: tuple[tuple[str, str, str, int], ...], chosen: str) -> str:
    return next(label for name, label, *_rest in items if name == chosen)
