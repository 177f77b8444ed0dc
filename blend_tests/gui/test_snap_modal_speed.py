# SPDX-License-Identifier: GPL-3.0-or-later
"""Dragging keeps up with the screen, whatever the size of the target."""

import time

import numpy as np

SIDE = 317  # squared: a bit over 100,000 faces
FRAME = 1 / 60


def test_moves_on_a_hundred_thousand_faces(blender):
    assert blender.call("large_sheet", SIDE) > 100_000
    blender.call("pin")
    blender.call("time_moves")
    start = time.perf_counter()
    blender.call("start_drag")
    print(f"begun after {time.perf_counter() - start:.2f} s")
    for turn in np.linspace(0, 2 * np.pi, 40):
        blender.move(520 + 150 * np.cos(turn), 380 + 100 * np.sin(turn))
    for key in "x", "y":
        blender.key(key)
        for turn in np.linspace(0, 2 * np.pi, 10):
            blender.move(520 + 150 * np.cos(turn), 380 + 100 * np.sin(turn))
    free, border, boundary = np.split(1000 * np.array(blender.call("times"))[-62:], [40, 51])
    blender.key("Return")
    for name, measured in (("free", free), ("border", border), ("boundary", boundary)):
        print(f"{name}: {np.median(measured):.2f} ms per move, {max(measured):.2f} at most")
        assert np.median(measured) < 1000 * FRAME
