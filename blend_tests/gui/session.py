# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender with a window and a real mouse, driven from outside.

`session.call("name", ...)` runs a function of actions.py or texture_actions.py within Blender;
mouse and keys are X11's. Nothing here waits for a fixed time: after each input Blender's main loop
goes round some times, and whatever comes later than that is polled for. Blender draws what has
changed; pictures are read from the memory of the screen.
"""

import os
import re
import shutil
import struct
import subprocess
import time
import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from multiprocessing.connection import Client
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
import pytest

HERE = Path(__file__).parent
OUT = Path("/out")
PACKAGES = OUT
WIDTH, HEIGHT = 1280, 800
LIMIT = 120  # seconds after which a test stops waiting and fails
POLL = 0.05  # seconds between two checks of what is waited for
ROW = 20  # the height of a button in pixels
TAB_STRIP = 22  # the width in pixels of the strip of tabs at the sidebar's right edge
MOST_ENTRIES = 30  # the largest number of entries in a menu
MOVED = 2  # rounds of the main loop in which a move of the mouse during a stroke is handled
CONFIRMATION = (71, 114, 179)  # the color of a dialog's OK button
XWD_COLOR = 12  # bytes of each entry in the table of colors of X11's format XWD
ADDON = "bl_ext.user_default.limit_surface"


class Screen(NamedTuple):
    display: str  # X11's name
    picture: Path  # what it shows, in X11's format XWD

    def pixels(self) -> np.ndarray:
        """Returns pixels (rows, columns, 3) from 0 to 255."""
        content = self.picture.read_bytes()
        header = np.frombuffer(content, ">u4", 25)
        begin = header[0] + XWD_COLOR * header[19]
        stored = np.frombuffer(content, np.uint8, 4 * WIDTH * HEIGHT, begin)
        return stored.reshape(HEIGHT, WIDTH, 4)[:, :, 2::-1]  # blue, green, red and a spare byte


@contextmanager
def virtual_screen() -> Iterator[Screen]:
    read, write = os.pipe()
    size = f"{WIDTH}x{HEIGHT}x24"
    with TemporaryDirectory() as folder:
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", size, "-nocursor", "-fbdir", folder],
            pass_fds=[write],
            stderr=subprocess.DEVNULL,
        )
        os.close(write)
        try:
            with os.fdopen(read) as display:
                yield Screen(f":{display.readline().strip()}", Path(folder, "Xvfb_screen0"))
        finally:
            server.terminate()
            server.wait()


def install_extension(user: Path) -> str:
    """Installs the extension as *Install from Disk* does, and returns Blender's output."""
    (package,) = PACKAGES.glob("limit_surface-*.zip")
    command = ("blender", "--command", "extension", "install-file", "-r", "user_default")
    done = subprocess.run(
        [*command, "--enable", package],
        env={**os.environ, "BLENDER_USER_RESOURCES": str(user)},
        capture_output=True,
        text=True,
        timeout=LIMIT,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def write_png(path: Path, pixels: np.ndarray) -> None:
    """Writes pixels (rows, columns, 3) from 0 to 255."""

    def chunk(kind: bytes, content: bytes) -> bytes:
        checked = kind + content
        return struct.pack(">I", len(content)) + checked + struct.pack(">I", zlib.crc32(checked))

    height, width, _ = pixels.shape
    header = struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)
    rows = np.insert(pixels.reshape(height, -1), 0, 0, axis=1)  # each row begins with its filter
    parts = [(b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 1)), (b"IEND", b"")]
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*part) for part in parts))


def is_near(pixels: np.ndarray, color: Sequence[int]) -> np.ndarray:
    return (np.abs(pixels.astype(int) - color) < 12).all(axis=2)


def wait_until(look: Callable[[], Any], what: str) -> Any:
    """Returns the result of `look` as soon as it is neither None nor False."""
    deadline = time.monotonic() + LIMIT
    while (seen := look()) is None or seen is False:
        if time.monotonic() > deadline:
            pytest.fail(f"{what}: not after {LIMIT} s")
        time.sleep(POLL)
    return seen


def on_screen(x: float, y: float) -> tuple[int, int]:
    """Returns X11's coordinates for a place counted from the window's lower left, as in Blender."""
    return round(x), HEIGHT - 1 - round(y)


def class_name(operator: str) -> str:
    """Returns the name by which Blender knows the class of an operator in bpy.ops."""
    category, name = operator.split(".")
    return f"{category.upper()}_OT_{name}"


class BlenderSession:
    def __init__(self, screen: Screen, user: Path) -> None:
        self._screen = screen
        # where something was found the last time: it is searched there first
        self._heights: dict[str, float] = {}
        self._read = 0  # the number of characters of Blender's output that were read
        self.installed = install_extension(user)
        address = user / "socket"
        self._environment = {
            **os.environ,
            "DISPLAY": screen.display,
            "LIBGL_ALWAYS_SOFTWARE": "1",
            "BLENDER_USER_RESOURCES": str(user),
            "LIMIT_SURFACE_SOCKET": str(address),
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        self._log = (OUT / "blender.log").open("w")
        geometry = ("--window-geometry", "0", "0", str(WIDTH), str(HEIGHT))
        self._process = subprocess.Popen(
            ["blender", *geometry, "--addons", ADDON, "--python", HERE / "inside.py"],
            env=self._environment,
            stdout=self._log,
            stderr=subprocess.STDOUT,
        )
        self._connection = self._connect(str(address))

    def _connect(self, address: str) -> Any:
        def connection() -> Any:
            assert self._process.poll() is None, "Blender ended: see blender.log"
            try:
                return Client(address)
            except (FileNotFoundError, ConnectionRefusedError):
                return None

        return wait_until(connection, "Blender answers (see blender.log)")

    def __enter__(self) -> "BlenderSession":
        return self

    def __exit__(self, *_error: object) -> None:
        self._process.kill()
        self._process.wait()
        self._log.close()
        for report in Path("/tmp").glob("*.crash.txt"):
            shutil.copy(report, OUT)

    def call(self, name: str, *arguments: Any, **keywords: Any) -> Any:
        """Returns the result of the function within Blender, once Blender has nothing else to
        do.
        """
        self._connection.send((name, arguments, keywords))
        if not self._connection.poll(LIMIT):
            pytest.fail(f"{name} in Blender has not ended after {LIMIT} s")
        raised, value = self._connection.recv()
        assert not raised, value
        return value

    def log(self) -> str:
        """Returns what Blender has printed since this was called the last time."""
        text = (OUT / "blender.log").read_text()
        begin, self._read = self._read, len(text)
        return text[begin:]

    def await_value(self, value: Any, name: str, *arguments: Any) -> None:
        """Waits until the function within Blender returns this value."""
        wait_until(lambda: self.call(name, *arguments) == value, f"{name}{arguments} is {value!r}")

    def await_end(self, operator: str) -> None:
        """Waits until this operator, object.limit_points_add for example, has done its work."""
        self.await_value([], "running")
        self.settle()
        self.await_value(class_name(operator), "last_operator")

    def new_file(self) -> None:
        self.key("Escape")
        self.call("new_file")
        self.settle()
        self.move(*self.call("view_centre"))

    def settle(self) -> None:
        """Waits until all input has been handled, and what it has changed has been drawn."""
        self.call("settle")

    # Mouse positions are counted from the window's lower left, as in Blender.

    def move(self, x: float, y: float) -> None:
        self._xdotool("mousemove", *on_screen(x, y))
        self.settle()

    def click(self, x: float, y: float, button: int = 1) -> None:
        self.move(x, y)
        self.press(button)

    def press(self, button: int = 1) -> None:
        self._xdotool("mousedown", button, "mouseup", button)
        self.settle()

    def drag(self, start: Sequence[float], end: Sequence[float]) -> None:
        """Drags with the left button held down."""
        self.move(*start)
        self._xdotool("mousedown", 1)
        self.settle()
        self.move(*end)
        self._xdotool("mouseup", 1)
        self.settle()

    def hold(self) -> None:
        """Presses the left button, and holds it down until `release`."""
        self._xdotool("mousedown", 1)
        self.settle()

    def release(self) -> None:
        self._xdotool("mouseup", 1)
        self.settle()

    def stroke(self, places: Sequence[Sequence[float]], held: str | None = None) -> None:
        """Moves along these places with the left button held down, and a key as well."""
        self.move(*places[0])
        if held:
            self._xdotool("keydown", held)
        self.hold()
        for place in places[1:]:
            self._xdotool("mousemove", *on_screen(*place))
            self.call("settle", MOVED)
        self.release()
        if held:
            self._xdotool("keyup", held)
            self.settle()

    def wheel(self, steps: int) -> None:
        """Turns the wheel upwards, or downwards if negative."""
        for _ in range(abs(steps)):
            self.press(4 if steps > 0 else 5)

    def key(self, *names: str) -> None:
        """Presses a key by X11's name, such as ctrl+z, F9, Escape, period."""
        for name in names:
            self._xdotool("key", name)
            self.settle()

    def open_tab(self) -> None:
        """Shows the sidebar's tab Limit, by clicking down the strip of tabs until it opens."""
        self.call("show_sidebar")
        self.settle()
        bar = self.call("sidebar")

        def is_open(y: float) -> bool:
            self.click(bar["right"] - TAB_STRIP / 2, y)
            return self.call("sidebar")["tab"] == "Limit"

        self._search("the tab Limit", is_open, bar["top"] - ROW, bar["bottom"], ROW)

    def open_panel(self, panel: str) -> float:
        """Opens a closed panel in the open tab by the key A above its header. Returns a place at or
        above its buttons.
        """
        self.call("count_draws", panel)
        bar = self.call("sidebar")
        x = (bar["left"] + bar["right"] - TAB_STRIP) / 2

        def is_opened(y: float) -> bool:
            self.move(x, y)
            before = self._screen.pixels()
            self.key("a")
            # Another panel is opened or closed again, which may bring this one to the mouse.
            if not self.call("draws", panel) and not np.array_equal(self._screen.pixels(), before):
                self.key("a")
            return self.call("draws", panel) > 0

        return self._search(
            f"the header of {panel}", is_opened, bar["top"] - ROW / 2, bar["bottom"], ROW / 2
        )

    def find_button(self, command: str, top: float | None = None) -> tuple[float, float]:
        """Returns where in the open tab, or below a given height, the button of an operator is, by
        the text that it copies.
        """
        bar = self.call("sidebar")
        x = (bar["left"] + bar["right"] - TAB_STRIP) / 2
        return self._find(x, top or bar["top"] - 10, bar["bottom"], f"bpy.ops.{command}(")

    def await_dialog(self, before: np.ndarray) -> tuple[float, float]:
        """Waits for a dialog and returns the place of its OK button, given the picture before it
        opened.
        """
        return wait_until(lambda: self.find_confirmation(before), "a dialog with an OK is open")

    def find_confirmation(self, before: np.ndarray) -> tuple[float, float] | None:
        """Returns the place of the OK button of the open dialog, if there is one: the lowest of the
        places that have become blue.
        """
        now = self.screenshot("dialog")
        blue = is_near(now, CONFIRMATION) & ~is_near(before, CONFIRMATION)
        rows = np.flatnonzero(blue.sum(axis=1) > ROW)
        if len(rows) == 0:
            return None
        row = rows[-1] - ROW // 4
        return np.flatnonzero(blue[row]).mean(), HEIGHT - 1 - row

    def operators_in_menu(self) -> list[str]:
        """Returns the operators of the open menu, which must have so many, each once."""
        found = []
        while len(found) < MOST_ENTRIES:
            self.call("clear_clipboard")
            self.key("Down", "ctrl+c")
            name = self.call("clipboard").removeprefix("bpy.ops.").split("(")[0]
            if found[:1] == [name]:
                return found
            found.append(name)
        raise AssertionError(f"a menu without an end: {found}")

    def choose_in_menu(self, command: str) -> None:
        """Chooses the entry of the open menu whose command, as it is copied, contains a text."""
        seen: list[str] = []
        while len(seen) < MOST_ENTRIES:
            self.call("clear_clipboard")
            self.key("Down", "ctrl+c")
            seen.append(self.call("clipboard"))
            if command in seen[-1]:
                self.key("Return")
                return
        raise AssertionError(f"no entry of the menu has {command}: {seen}")

    def open_redo_panel(self) -> tuple[float, float]:
        """Opens the redo panel by F9 in the middle of the viewport, and returns where the column of
        its fields begins.
        """
        x, y = self.call("view_centre")
        self.move(x, y)
        self.key("F9")
        return x + 200, y

    def find_field(self, x: float, y: float, value: str) -> tuple[float, float]:
        """Returns where below (x, y) a field with this value is."""
        return self._find(x, y, y - 400, value)

    def _find(self, x: float, top: float, bottom: float, copied: str) -> tuple[float, float]:
        """Searches by what Ctrl+C copies from under the mouse: this text, not the same number with
        more digits.
        """
        copied_here = re.compile(re.escape(copied) + r"(?!\d)")
        self.call("clear_clipboard")

        def is_here(y: float) -> bool:
            self._xdotool("mousemove", *on_screen(x, y), "key", "ctrl+c")
            self.settle()
            return copied_here.match(self.call("clipboard")) is not None

        return x, self._search(f"what copies {copied!r}", is_here, top, bottom, ROW * 3 / 4)

    def _search(
        self, what: str, is_here: Callable[[float], bool], top: float, bottom: float, step: float
    ) -> float:
        """Returns the height at which something is found, searching downwards. Where it was found
        the last time is looked at first.
        """
        heights = np.arange(top, bottom, -step).tolist()
        last = self._heights.get(what)
        if last is not None and bottom < last <= top:
            heights.insert(0, last)
        for y in heights:
            if is_here(y):
                self._heights[what] = y
                return y
        raise AssertionError(f"{what} is not between the heights {top} and {bottom}")

    def screenshot(self, name: str) -> np.ndarray:
        """Returns the pixels (rows, columns, 3) of the screen, from 0 to 255, once everything has
        been drawn and nothing moves any more.
        """
        self.call("redraw")
        pixels = self._still()
        write_png(OUT / f"{name}.png", pixels)
        return pixels

    def _still(self) -> np.ndarray:
        """Returns what the screen shows, once nothing moves on it any more."""
        shown = None

        def is_still() -> bool:
            nonlocal shown
            self.settle()
            before, shown = shown, self._screen.pixels()
            return np.array_equal(before, shown)

        wait_until(is_still, "the screen is still")
        return shown

    def picture(self, name: str) -> None:
        """Writes a picture of the screen as it is."""
        write_png(OUT / f"{name}.png", self._screen.pixels())

    def _xdotool(self, *words: object) -> None:
        command = ("xdotool", *map(str, words))
        subprocess.run(command, env=self._environment, check=True, timeout=LIMIT)
