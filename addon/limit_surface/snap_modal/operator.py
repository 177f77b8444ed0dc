# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator view3d.limit_snap_modal."""

import bpy
import numpy as np
from bpy.props import FloatVectorProperty, IntProperty

from .. import ids, native
from ..errors import RefusalError
from ..snap.binding_again import bind_again
from ..snap.properties import ALIGNMENTS, HAIR, PlacingProperties
from ..snap.surface import TargetSurface
from ..tasks.properties import check_numbers
from ..viewport import ray
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
                "Dragging needs a window and a mouse: set `face` and `uv`, or use object.limit_snap"
            )
        try:
            check_numbers(self.properties)
            subject = find_subject(context)
            surface = TargetSurface(subject.target, context.evaluated_depsgraph_get(), self.target)
            self._check_element(subject)
            glide = Glide(surface)
            glide.go_to(self.face, self.uv)
            drag = Drag(glide, subject.handle(self.element, surface))
            drag.put(self.offset, self.align, self.hair)
            drag.confirm()
        except native.refusals as error:
            return self._refuse(error)
        self._bind_again(subject, context)
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if context.area is None or context.area.type != "VIEW_3D":
            return self._refuse("Only available in a 3D viewport")
        try:
            self._subject = find_subject(context)
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
        self._area = context.area
        self._step = offset_step(self._glide.surface)
        self._typed, self._offset_before_typing = TypedNumber(), self.offset
        self._pressed_at: tuple[int, int] | None = None
        self._is_astray = False
        self._drawing = Drawing()
        context.window_manager.modal_handler_add(self)
        self._show_keys(context)
        self._follow(context, event)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        try:
            result = self._handle(context, event)
        except native.refusals as error:
            self._restore()
            result = self._refuse(error)
        except BaseException:
            self._restore()
            self._clean_up(context)
            raise
        if result & {"FINISHED", "CANCELLED"}:
            self._clean_up(context)
        return result

    def cancel(self, context: bpy.types.Context) -> None:
        """Is called when Blender ends the operator, for example because another file is opened."""
        self._restore()
        self._clean_up(context)

    def _handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        kind, is_press = event.type, event.value == "PRESS"
        if kind in NAVIGATION or (kind in WHEEL and (event.ctrl or self._drag is None)):
            return {"PASS_THROUGH"}
        if kind in MOVES:
            self._follow(context, event)
        elif kind in {"ESC", "RIGHTMOUSE"} and is_press:
            self._restore()
            return {"CANCELLED"}
        elif kind == "LEFTMOUSE":
            return self._click(context, event)
        elif self._drag is None or not is_press:
            pass
        elif kind in {"RET", "NUMPAD_ENTER"}:
            return self._confirm(context)
        elif kind in WHEEL:
            self._typed = TypedNumber()
            self.offset += WHEEL[kind] * self._step * (FINE if event.shift else 1)
            self._put()
        elif kind in LOCK_KEYS:
            self._lock(LOCK_KEYS[kind])
            self._follow(context, event)
        elif kind == "A" and self._drag.handle.can_turn:
            self.align = _next(ALIGNMENTS, self.align)
            self._put()
        elif kind == "H" and self._drag.handle.has_strand:
            self.hair = _next(HAIR, self.hair)
            self._put()
        else:
            self._type(event)
        self._show_state(context)
        return {"RUNNING_MODAL"}

    def _click(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Picks an element with the mouse. It is dragged while the button is held, or after a click
        until the next click confirms.
        """
        at = (event.mouse_x, event.mouse_y)
        if event.value == "PRESS":
            if self._drag is not None:
                return self._confirm(context)
            self._follow(context, event)
            if self._hovered is not None:
                self._take(self._hovered)
                self._pressed_at = at
        elif event.value == "RELEASE" and self._pressed_at is not None:
            dragged = np.hypot(*np.subtract(at, self._pressed_at)) > CLICK
            self._pressed_at = None
            if dragged:
                return self._confirm(context)
        self._show_state(context)
        return {"RUNNING_MODAL"}

    def _take(self, element: int) -> None:
        self.element = element
        handle = self._subject.handle(element, self._glide.surface)
        self._drag = Drag(self._glide, handle)

    def _follow(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        sight = self._sight(event)
        if sight is None:
            return
        if self._drag is None:
            self._hover(sight)
        else:
            self._is_astray = not self._glide.follow(sight)
            self._put()
        self._area.tag_redraw()

    def _sight(self, event: bpy.types.Event) -> ray.Ray | None:
        for region in self._area.regions:
            x, y = event.mouse_x - region.x, event.mouse_y - region.y
            if region.type == "WINDOW" and 0 <= x < region.width and 0 <= y < region.height:
                return ray.through(region, region.data, event.mouse_x, event.mouse_y)
        return None

    def _hover(self, sight: ray.Ray) -> None:
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
        self._area.tag_redraw()

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

    def _confirm(self, context: bpy.types.Context) -> set[str]:
        drag = self._drag
        assert drag is not None
        if drag.place is None:
            self.report(
                {"WARNING"}, "Nothing was moved, because the mouse was never over the surface"
            )
            return {"CANCELLED"}
        drag.confirm()
        self._bind_again(self._subject, context)
        self.face, self.uv = self._glide.face, self._glide.uv
        return {"FINISHED"}

    def _bind_again(self, subject: Subject, context: bpy.types.Context) -> None:
        if subject.kind == "STRAND":
            for warning in bind_again([subject.ob], subject.target, context):
                self.report({"WARNING"}, warning)

    def _restore(self) -> None:
        if self._drag is not None:
            self._drag.handle.restore()

    def _clean_up(self, context: bpy.types.Context) -> None:
        self._drawing.remove()
        self._area.header_text_set(None)
        context.workspace.status_text_set(None)
        self._area.tag_redraw()

    def _check_element(self, subject: Subject) -> None:
        if subject.is_picked and not 0 <= self.element < len(subject.candidates()):
            raise RefusalError(f"{subject.ob.name} has no element {self.element}")

    def _refuse(self, reason: object) -> set[str]:
        self.report({"ERROR"}, native.sentence(reason))
        return {"CANCELLED"}

    def _show_state(self, context: bpy.types.Context) -> None:
        if self._drag is None:
            noun = "vertex" if self._subject.kind == "VERTEX" else "strand"
            self._area.header_text_set(
                f"Press the mouse button on a {noun} and drag it, or click it"
            )
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
        self._area.header_text_set("   ".join(parts))

    def _show_keys(self, context: bpy.types.Context) -> None:
        context.workspace.status_text_set(
            "Click or Enter: confirm   Esc or right click: cancel   Wheel or number: offset "
            "(Shift: fine)   X: face border   Y: boundary   Z: free   A: align   H: hair   "
            "Ctrl Wheel, middle mouse: view"
        )
        self._show_state(context)


def _next(items: tuple[tuple[str, str, str, int], ...], chosen: str) -> str:
    names = [name for name, *_rest in items]
    return names[(names.index(chosen) + 1) % len(names)]


def _label(items: tuple[tuple[str, str, str, int], ...], chosen: str) -> str:
    return next(label for name, label, *_rest in items if name == chosen)
