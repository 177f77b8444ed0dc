# SPDX-License-Identifier: GPL-3.0-or-later
"""The mouse, the pen and the keys while somebody draws."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import bpy
import numpy as np

from ..tasks.running import Running
from ..tasks.status_bar import StatusText
from ..viewport import ray
from ..viewport.lines import pixel_size
from ..viewport.view import region_at
from . import brush_sizes, keys, texts
from .ground import Ground
from .overlay import Mark, Overlay
from .session import Samples, Session

if TYPE_CHECKING:
    import limitsurf

#: In pixels: how far apart a stroke is sampled, and how near to an end a stroke continues it
SPACING, REACH = 4, 12
MOST_RAYS = 256  # between two events
#: Brushes touch the surface at every so many of their own radii.
TOUCHES = 0.5
RUNNING = {"RUNNING_MODAL"}


class Sight(NamedTuple):
    """What is seen through a pixel."""

    region: bpy.types.Region
    ray: ray.Ray
    pressure: float


class Pen:
    """Turns events into changes of the session."""

    running: Running | None = None

    def __init__(
        self, area: bpy.types.Area, session: Session, brush: int, use_pressure: bool
    ) -> None:
        self.session, self.brush = session, brush
        self.notice = ""  # is shown until something is drawn
        self.obstacle = ""  # why nothing can be drawn at present
        self._area, self._use_pressure = area, use_pressure
        self._tool: str | None = None  # while the button is held
        self._hovering = "DRAW"
        self._at = np.zeros(2)
        self._pressure = 1.0
        self._samples: Samples | None = None
        self._is_astray = False
        self._lacks_mirror = False  # whether the surface has no mirrored place of that of the mouse
        self._shown = -1
        self._is_open = True
        self._asks = False  # whether to discard everything
        self._is_shown = True  # whether the screen shows the area
        self._status: StatusText | None = None
        self._overlay = Overlay(session.ground.size)
        self._prepare()

    def _prepare(self) -> None:
        """Builds the search structure now, not at the next move."""
        surface = self.session.ground.surface
        surface.ray_cast(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]))

    def stand_on(self, ground: Ground) -> None:
        """Goes on with the surface as it is by now."""
        self.obstacle = ""
        if ground is self.session.ground:
            return
        self.session.stand_on(ground)
        self._overlay.set_size(ground.size)
        self._overlay.mark = self._overlay.end = None
        if self._samples is not None:
            self._samples.stand_on(ground)
            self._overlay.pen = self._samples.positions()
        self._prepare()

    def take(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handles an event, and returns what the operator returns: FINISHED to confirm."""
        self._is_shown = any(area == self._area for area in context.screen.areas)
        if self._tool is None:
            over = self._region(event.mouse_x, event.mouse_y) is not None
            if keys.is_view(event, over):
                return {"PASS_THROUGH"}
        if event.type in keys.MOVES:
            self.move(event)
        elif event.type == "LEFTMOUSE":
            if event.value == "PRESS":
                self._press(event)
            elif event.value == "RELEASE":
                self._release()
        elif event.value == "PRESS":
            answer = self._key(event)
            if answer:
                return {answer}
        self.show(context)
        return RUNNING

    def close(self, context: bpy.types.Context) -> None:
        if self._is_open:
            self._is_open = False
            if self.running:
                self.running.over()
            self._overlay.remove()
            self._area.header_text_set(None)
            if self._status:
                self._status.clear()
            self._area.tag_redraw()

    def move(self, event: bpy.types.Event) -> None:
        """Follows the mouse: draws, erases or smooths while the button is held."""
        self._hovering = keys.tool(event) or self._hovering
        to = np.array([event.mouse_x, event.mouse_y], np.float64)
        pressure = self._pressure_of(event)
        sights = self._sights(to, pressure)
        self._at, self._pressure = to, pressure
        self._follow(sights)
        self._area.tag_redraw()

    def _press(self, event: bpy.types.Event) -> None:
        self._tool = keys.tool(event)
        if self._tool is None:
            return
        self.notice, self._asks = "", False
        self._at = np.array([event.mouse_x, event.mouse_y], np.float64)
        self._pressure = self._pressure_of(event)
        self.session.begin()
        sights = self._sights(self._at, self._pressure)
        self._samples = Samples(0.0) if self._tool == "DRAW" else None
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

    def _key(self, event: bpy.types.Event) -> str | None:
        """Handles a key or the right button, and returns how the drawing ends if it does."""
        if self._tool is not None:
            if event.type in keys.LEAVING:
                self._drop()
            return None
        command = keys.command(event)
        settings = self.session.settings
        if command == "CONFIRM":
            return "FINISHED"
        if command == "LEAVE":
            return self._leave(event)
        self._asks = False
        if command == "UNDO":
            self.session.undo()
        elif command == "REDO":
            self.session.redo()
        elif command == "MIRROR":
            settings.is_mirrored = not settings.is_mirrored
            self._lacks_mirror = self.session.lacks_mirror = False
        elif command == "JOIN":
            settings.continues = not settings.continues
        elif command == "SMALLER":
            self.brush = brush_sizes.smaller(self.brush)
        elif command == "LARGER":
            self.brush = brush_sizes.larger(self.brush)
        self._hovering = keys.tool(event) or self._hovering
        return None

    def _leave(self, event: bpy.types.Event) -> str | None:
        """Asks before anything that was drawn is lost: nothing could bring it back."""
        if event.is_repeat:  # the key is still held
            return None
        if self._asks or not self.session.is_changed:
            return "CANCELLED"
        self._asks = True
        return None

    def _sights(self, to: np.ndarray, pressure: float) -> list[Sight | None]:
        """Returns lines of sight through the pixels between the last place and this one: None where
        the viewport is not seen. While no button is held this place alone counts.
        """
        steps = 1
        if self._tool is not None:
            spacing = SPACING if self._tool == "DRAW" else max(TOUCHES * self.brush, 1)
            steps = int(np.clip(np.ceil(np.linalg.norm(to - self._at) / spacing), 1, MOST_RAYS))
        found: list[Sight | None] = []
        for t in np.linspace(1 / steps, 1, steps):
            x, y = (1 - t) * self._at + t * to
            region = self._region(x, y)
            if region is None:
                found.append(None)
            else:
                at = (1 - t) * self._pressure + t * pressure
                found.append(Sight(region, ray.through(region, region.data, x, y), float(at)))
        return found

    def _follow(self, sights: list[Sight | None]) -> None:
        self._is_astray, self._lacks_mirror = True, False
        self._overlay.mark = self._overlay.end = None
        seen = [sight for sight in sights if sight is not None]
        if seen:
            hits = self.session.ground.surface.ray_cast(
                np.stack([sight.ray.origin for sight in seen]),
                np.stack([sight.ray.direction for sight in seen]),
            )
        row = -1
        for sight in sights:
            row += sight is not None
            self._is_astray = sight is None or bool(hits.face[row] < 0)
            if sight is not None and not self._is_astray:
                uv = hits.uv[row].astype(np.float32).astype(np.float64)
                position = hits.position[row]
                self._touch(sight.region, int(hits.face[row]), uv, position, sight.pressure)
            elif self._samples is not None:
                self._samples.interrupt()
        if seen and not self._is_astray:
            self._mark(seen[-1].region, hits)

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
        tool = self._tool or self._hovering
        position = hits.position[-1]
        if self.session.settings.is_mirrored:
            _places, is_there = self.session.ground.mirror_places(position[None])
            self._lacks_mirror = not is_there[0]
        frame = self.session.ground.surface.frames(hits.face[-1:], hits.uv[-1:])[0]
        pixels = REACH / 2 if tool == "DRAW" else self.brush
        self._overlay.mark = Mark(position, frame, pixels, tool)
        if self._tool is None and tool == "DRAW":
            pixel = pixel_size(region, np.array(region.data.perspective_matrix), position)
            end = self.session.end_near(position, REACH * pixel)
            self._overlay.end = end.position if end else None

    def _region(self, x: float, y: float) -> bpy.types.Region | None:
        """Returns the view that is seen at this place of the window: none where the header, the
        sidebar or another region lies over it, or where the screen shows something else by now. Nor
        while there is an obstacle.
        """
        return region_at(self._area, x, y) if self._is_shown and not self.obstacle else None

    def _pressure_of(self, event: bpy.types.Event) -> float:
        return event.pressure if self._use_pressure and event.is_tablet else 1.0

    def show(self, context: bpy.types.Context) -> None:
        """Shows the strokes, and the state and the keys in the header and the status bar."""
        session = self.session
        if self._shown != session.version:
            self._shown = session.version
            self._overlay.show(session.strokes)
        notes = ["no surface under the mouse"] if self._is_astray else []
        if session.settings.is_mirrored and (self._lacks_mirror or session.lacks_mirror):
            notes.append("no surface at the mirrored place")
        notes = [self.obstacle] if self.obstacle else [*notes, *filter(None, [self.notice])]
        self._area.header_text_set(
            texts.question(session)
            if self._asks
            else texts.state(session, self._tool or self._hovering, self.brush, notes)
        )
        if self._status is None:
            self._status = StatusText(context)
        self._status.show(texts.ANSWERS if self._asks else texts.KEYS)
        self._area.tag_redraw()
