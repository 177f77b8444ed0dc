# SPDX-License-Identifier: GPL-3.0-or-later
"""The mouse, the pen and the keys while somebody draws."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..viewport import ray
from ..viewport.lines import pixel_size
from .overlay import Mark, Overlay
from .session import Samples, Session

if TYPE_CHECKING:
    import limitsurf

NAVIGATION = {
    "MIDDLEMOUSE",
    "WHEELUPMOUSE",
    "WHEELDOWNMOUSE",
    "NDOF_MOTION",
    "TRACKPADPAN",
    "TRACKPADZOOM",
}
MOVES = {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}
CONFIRM = {"RET", "NUMPAD_ENTER", "SPACE"}
BRUSH_KEYS = {"LEFT_BRACKET": 0.8, "RIGHT_BRACKET": 1.25}
#: In pixels: how far apart a stroke is sampled, and how near to an end a stroke continues it
SPACING, REACH = 4, 12
MOST_RAYS = 256  # between two events
#: Brushes touch the surface at every so many of their own radii.
TOUCHES = 0.5
TOOL_NAMES = {"DRAW": "Draw", "ERASE": "Erase", "SMOOTH": "Smooth"}
RUNNING = {"RUNNING_MODAL"}


class Pen:
    """Turns events into changes of the session."""

    def __init__(
        self, area: bpy.types.Area, session: Session, brush: int, use_pressure: bool
    ) -> None:
        self.session, self.brush = session, brush
        self._area, self._use_pressure = area, use_pressure
        self._tool: str | None = None  # while the button is held
        self._hovering = "DRAW"
        self._at = np.zeros(2)
        self._pressure = 1.0
        self._samples: Samples | None = None
        self._is_astray = False
        self._has_left = False  # whether the last rays would have been beside the viewport
        self._shown = -1
        self._is_open = True
        # builds the search structure now, not at the first move
        session.ground.surface.ray_cast(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]))
        self._overlay = Overlay(session.ground.size)

    def take(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handles an event, and returns what the operator returns: FINISHED to confirm."""
        kind, is_press = event.type, event.value == "PRESS"
        is_view = kind in NAVIGATION or (kind.startswith("NUMPAD_") and kind not in CONFIRM)
        if self._tool is None and is_view:
            return {"PASS_THROUGH"}
        if kind in MOVES:
            self.move(event)
        elif kind == "LEFTMOUSE":
            if is_press:
                self._press(event)
            elif event.value == "RELEASE":
                self._release()
        elif is_press and kind in {"ESC", "RIGHTMOUSE"}:
            if self._tool is None:
                return {"CANCELLED"}
            self._drop()
        elif is_press and self._tool is None:
            if kind in CONFIRM:
                return {"FINISHED"}
            self._key(event)
        self.show(context)
        return RUNNING

    def close(self, context: bpy.types.Context) -> None:
        if self._is_open:
            self._is_open = False
            self._overlay.remove()
            self._area.header_text_set(None)
            context.workspace.status_text_set(None)
            self._area.tag_redraw()

    def move(self, event: bpy.types.Event) -> None:
        """Follows the mouse: draws, erases or smooths while the button is held."""
        self._hovering = _tool(event)
        to = np.array([event.mouse_x, event.mouse_y], np.float64)
        pressure = self._pressure_of(event)
        sights = self._sights(to, pressure)
        self._at, self._pressure = to, pressure
        if sights:
            self._follow(sights)
        elif self._samples is not None:  # beside the viewport
            self._samples.interrupt()
        self._area.tag_redraw()

    def _press(self, event: bpy.types.Event) -> None:
        self._tool = _tool(event)
        self._at = np.array([event.mouse_x, event.mouse_y], np.float64)
        self._pressure = self._pressure_of(event)
        self.session.begin()
        sights = self._sights(self._at, self._pressure)
        self._samples = Samples(0.0) if self._tool == "DRAW" else None
        if sights:
            self._follow(sights)

    def _release(self) -> None:
        if self._samples is not None:
            self.session.draw(self._samples)
        self.session.end()
        self._samples, self._tool = None, None
        self._overlay.pen = []

    def _drop(self) -> None:
        """Takes back what was begun with the button that is held."""
        self.session.drop()
        self._samples, self._tool = None, None
        self._overlay.pen = []

    def _key(self, event: bpy.types.Event) -> None:
        settings = self.session.settings
        if event.type == "Z" and event.ctrl:
            (self.session.redo if event.shift else self.session.undo)()
        elif event.type == "X":
            settings.is_mirrored = not settings.is_mirrored
        elif event.type == "J":
            settings.continues = not settings.continues
        elif event.type in BRUSH_KEYS:
            self.brush = int(np.clip(round(self.brush * BRUSH_KEYS[event.type]), 1, 1000))
        self._hovering = _tool(event)

    def _sights(
        self, to: np.ndarray, pressure: float
    ) -> list[tuple[bpy.types.Region, ray.Ray, float]]:
        """Returns rays through the pixels between the last place and this one, with the pressure
        there. While no button is held this place alone counts.
        """
        steps = 1
        if self._tool is not None:
            spacing = SPACING if self._tool == "DRAW" else max(TOUCHES * self.brush, 1)
            steps = int(np.clip(np.ceil(np.linalg.norm(to - self._at) / spacing), 1, MOST_RAYS))
        found = []
        self._has_left = False
        for t in np.linspace(1 / steps, 1, steps):
            x, y = (1 - t) * self._at + t * to
            region = self._region(x, y)
            if region is None:
                self._has_left = True
            else:
                at = (1 - t) * self._pressure + t * pressure
                found.append((region, ray.through(region, region.data, x, y), float(at)))
        return found

    def _follow(self, sights: list[tuple[bpy.types.Region, ray.Ray, float]]) -> None:
        surface = self.session.ground.surface
        hits = surface.ray_cast(
            np.stack([sight.origin for _region, sight, _pressure in sights]),
            np.stack([sight.direction for _region, sight, _pressure in sights]),
        )
        for row, (region, _sight, pressure) in enumerate(sights):
            if hits.face[row] < 0:
                if self._samples is not None:
                    self._samples.interrupt()
                continue
            uv = hits.uv[row].astype(np.float32).astype(np.float64)
            self._touch(region, int(hits.face[row]), uv, hits.position[row], pressure)
        if self._has_left and self._samples is not None:
            self._samples.interrupt()
        self._is_astray = bool(hits.face[-1] < 0)
        self._mark(sights[-1][0], hits)

    def _touch(
        self,
        region: bpy.types.Region,
        face: int,
        uv: np.ndarray,
        position: np.ndarray,
        pressure: float,
    ) -> None:
        pixel = pixel_size(region, np.array(region.data.perspective_matrix), position)
        if self._samples is not None:
            self._samples.reach = REACH * pixel
            self._samples.add(face, uv, pressure, position)
            self._overlay.pen = self._samples.positions()
        elif self._tool == "ERASE":
            self.session.erase(position, self.brush * pixel)
        elif self._tool == "SMOOTH":
            self.session.smooth(position, self.brush * pixel)

    def _mark(self, region: bpy.types.Region, hits: limitsurf.Hits) -> None:
        """Shows the brush, and the end that a new stroke would continue."""
        self._overlay.mark, self._overlay.end = None, None
        if self._is_astray:
            return
        tool = self._tool or self._hovering
        position = hits.position[-1]
        frame = self.session.ground.surface.frames(hits.face[-1:], hits.uv[-1:])[0]
        pixels = REACH / 2 if tool == "DRAW" else self.brush
        self._overlay.mark = Mark(position, frame, pixels, tool)
        if self._tool is None and tool == "DRAW":
            pixel = pixel_size(region, np.array(region.data.perspective_matrix), position)
            end = self.session.end_near(position, REACH * pixel)
            self._overlay.end = end.position if end else None

    def _region(self, x: float, y: float) -> bpy.types.Region | None:
        for region in self._area.regions:
            inside = 0 <= x - region.x < region.width and 0 <= y - region.y < region.height
            if region.type == "WINDOW" and inside:
                return region
        return None

    def _pressure_of(self, event: bpy.types.Event) -> float:
        return event.pressure if self._use_pressure and event.is_tablet else 1.0

    def show(self, context: bpy.types.Context) -> None:
        """Shows the strokes, and the state and the keys in the header and the status bar."""
        session = self.session
        if self._shown != session.version:
            self._shown = session.version
            self._overlay.show(session.strokes)
        settings = session.settings
        parts = [
            TOOL_NAMES[self._tool or self._hovering],
            f"Strokes: {len(session.strokes)}",
            f"Brush: {self.brush} px",
            f"X Mirror: {_on(settings.is_mirrored)}",
            f"Join: {_on(settings.continues)}",
        ]
        if self._is_astray:
            parts.append("no surface under the mouse")
        self._area.header_text_set("   ".join(parts))
        context.workspace.status_text_set(
            "Drag: draw   Ctrl drag: erase   Shift drag: smooth   [ ]: brush size   X: mirror   "
            "J: join at ends   Ctrl Z: undo   Ctrl Shift Z: redo   Enter or Space: confirm   "
            "Esc or right click: cancel"
        )
        self._area.tag_redraw()


def _tool(event: bpy.types.Event) -> str:
    if event.ctrl:
        return "ERASE"
    return "SMOOTH" if event.shift else "DRAW"


def _on(value: bool) -> str:
    return "on" if value else "off"
