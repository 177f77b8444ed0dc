# SPDX-License-Identifier: GPL-3.0-or-later
"""A long drag over a large mesh, for the tests and for tools/bench_window.py."""

from typing import NamedTuple

import numpy as np
from session import BlenderSession

SIDE = 317  # the square of this is slightly more than 100,000 faces
FREE, CONSTRAINED = 40, 10  # number of moves that are enough for a median


class Moves(NamedTuple):
    """The seconds that the operator spent at each move."""

    free: np.ndarray
    border: np.ndarray
    boundary: np.ndarray


def circle(blender: BlenderSession, moves: int) -> None:
    for turn in np.linspace(0, 2 * np.pi, moves):
        blender.move(520 + 150 * np.cos(turn), 380 + 100 * np.sin(turn))


def draw_over_large_sheet(blender: BlenderSession, moves: int = FREE) -> np.ndarray:
    """Draws a stroke with so many moves over the sheet, and does not end it. Returns the seconds
    that drawing spent at each move.
    """
    assert blender.call("large_sheet", SIDE) > 100_000
    blender.call("time_strokes")
    blender.call("start_drawing")
    blender.move(520 + 150, 380)
    before = len(blender.call("times"))
    blender.hold()
    circle(blender, moves)
    times = np.array(blender.call("times"))[before:]
    assert len(times) >= moves
    return times


def drag_over_large_sheet(
    blender: BlenderSession, free: int = FREE, constrained: int = CONSTRAINED
) -> Moves:
    """Drags all over the sheet, along its faces' borders and along its boundary, with so many moves
    each, and does not end the drag.
    """
    assert blender.call("large_sheet", SIDE) > 100_000
    blender.call("pin")
    blender.call("time_moves")
    blender.call("start_drag")
    circle(blender, free)
    for key in "x", "y":
        blender.key(key)  # the drag follows this event as it follows a move
        circle(blender, constrained)
    times = np.array(blender.call("times"))
    ends = np.cumsum([free, constrained + 1, constrained + 1])
    assert len(times) >= ends[-1]
    return Moves(*np.split(times[-ends[-1] :], ends[:-1]))
