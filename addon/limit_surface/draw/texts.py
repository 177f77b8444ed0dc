# SPDX-License-Identifier: GPL-3.0-or-later
"""What the header and the status bar say while somebody draws."""

from __future__ import annotations

from collections.abc import Sequence

from ..counting import counted
from .session import Session

TOOL_NAMES = {"DRAW": "Draw", "ERASE": "Erase", "SMOOTH": "Smooth"}
KEYS = (
    "Drag: draw   Ctrl drag: erase   Shift drag: smooth   [ ]: brush size   X: mirror   "
    "J: join at ends   Ctrl Z: undo   Ctrl Shift Z: redo   Enter or Space: confirm   "
    "Esc or right click: cancel"
)
ANSWERS = (
    "Esc or right click: discard what was drawn   Enter or Space: confirm   "
    "Any other key or a drag: go on drawing"
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


def question(session: Session) -> str:
    """Asks whether what was drawn is to be lost."""
    count = len(session.changed)
    what = counted(count, "strokes") if count else "the changes"
    return f"Discard {what}? Press Esc or the right mouse button again"


def _on(value: bool) -> str:
    return "on" if value else "off"
