# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how quickly the extension answers in Blender's window: dragging and drawing over a large
mesh, the window during a long bake, and ESC. Prints a table in Markdown.

    tools/gui_test.sh --bench

This command runs it in the Blender of the window tests, without a graphics card. Drawing takes
longer there than elsewhere, so only the times of dragging and of strokes are those of the extension
itself.
"""

import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "blend_tests/gui"))

import drags  # noqa: E402
from session import BlenderSession, virtual_screen, wait_until  # noqa: E402
from test_textures import BAKE_MAPS, LONG_BAKE  # noqa: E402
from test_waiting import ADD_POINTS, MOST  # noqa: E402

DRAWINGS = 20  # the number of drawings of the window that are measured


def measured(blender: BlenderSession) -> Iterator[tuple[str, float, float]]:
    """Yields the name of what is measured, and its median and largest time in seconds."""
    for name, times in moves(blender):
        yield f"Dragging, {name}", *summary(times)
    yield "Drawing a stroke", *summary(stroke(blender))
    idle, baking, escape = bake(blender)
    yield "Drawing the whole window", *summary(idle)
    yield "Drawing the whole window while maps are baked", *summary(baking)
    yield "ESC until the bake has ended", escape, escape
    escape = scatter(blender)
    yield "ESC until the scattering has ended", escape, escape


def summary(times: np.ndarray) -> tuple[float, float]:
    return float(np.median(times)), float(np.max(times))


def moves(blender: BlenderSession) -> list[tuple[str, np.ndarray]]:
    blender.new_file()
    found = drags.drag_over_large_sheet(blender)
    blender.key("Escape")
    return list(found._asdict().items())


def stroke(blender: BlenderSession) -> np.ndarray:
    blender.new_file()
    found = drags.draw_over_large_sheet(blender)
    blender.release()
    blender.key("Escape", "Escape")
    return found


def bake(blender: BlenderSession) -> tuple[np.ndarray, np.ndarray, float]:
    """Returns the times of drawings before and during a bake, and the time from ESC to the end of
    all its threads.
    """
    blender.new_file()
    blender.call("textured_sheet", 0.35)
    blender.settle()
    threads = blender.call("threads")
    idle = drawings(blender)
    before = blender.screenshot("bench_before")
    with tempfile.TemporaryDirectory() as folder:
        blender.call("start", BAKE_MAPS, **LONG_BAKE, folder=folder)
        blender.await_dialog(before)
        blender.key("Return")
        await_start(blender)
        baking = drawings(blender)
        return idle, baking, seconds(lambda: escape(blender, threads))


def drawings(blender: BlenderSession) -> np.ndarray:
    return np.array([blender.call("time_of_drawing") for _ in range(DRAWINGS)])


def scatter(blender: BlenderSession) -> float:
    blender.new_file()
    blender.call("subdivide", "Cube")  # otherwise a dialog offers the modifier
    threads = blender.call("threads")
    blender.call("set_next", ADD_POINTS, distribution="BLUE_NOISE", amount="COUNT", count=MOST)
    blender.call("start", ADD_POINTS, distribution="BLUE_NOISE", amount="COUNT", count=MOST)
    await_start(blender)
    return seconds(lambda: escape(blender, threads))


def await_start(blender: BlenderSession) -> None:
    wait_until(lambda: blender.call("running") or None, "the work has begun")


def escape(blender: BlenderSession, threads: int) -> None:
    blender.key("Escape")
    blender.await_value([], "running")
    blender.await_value(threads, "threads")


def seconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def main() -> None:
    with (
        virtual_screen() as screen,
        tempfile.TemporaryDirectory() as user,
        BlenderSession(screen, Path(user)) as blender,
    ):
        print("| | median | at most |", "|---|---:|---:|", sep="\n")
        for what, median, most in measured(blender):
            print(f"| {what} | {1000 * median:.1f} ms | {1000 * most:.1f} ms |", flush=True)


if __name__ == "__main__":
    main()
