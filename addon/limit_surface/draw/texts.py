# SPDX-License-Identifier: GPL-3.0-or-later
"""What the header and the status bar say while somebody draws."""

from __future__ import annotations

from collections.abc import Sequence

from .session import Session

TOOL_NAMES = {"DRAW": "Draw", "ERASE": "Erase", "SMOOTH": "Smooth"}
KEYS = (
    "Drag: draw   Ctrl drag: erase   Shift drag: smooth   [ ]: brush size   X: mirror   "
    "J: join at ends   Ctrl Z: undo   Ctrl Shift Z: redo   Enter or Space: confirm   "
    "Esc or right click: cancel"
)


def state(session: Session, tool: str, brush: int, notes: Sequence[str]) -> str:
    settings = session.settings
    parts = [
        TOOL_NAMES[tool],
        f"Strokes: {len(session.strokes)}",
        f"Brush: {brush} px",
        f"X Mirror: {_on(settings.is_mirrored)}",
        f"Join: {_on(settings.continues)}",
        *notes,
    ]
    return "   ".join(parts)


def _on(value: bool) -> str:
    return "on" if value else "off"
