# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs within Blender: does what the tests ask for, between two events of the main loop."""

import os
import sys
import traceback
from multiprocessing.connection import Listener
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
# Both would swallow clicks.
bpy.context.preferences.view.show_splash = False
bpy.context.preferences.view.show_tooltips = False

import actions  # noqa: E402
import texture_actions  # noqa: E402

POLL = 0.01  # seconds
ACTIONS = {**vars(actions), **vars(texture_actions)}


def serve() -> None:
    listener = Listener(os.environ["LIMIT_SURFACE_SOCKET"])
    connection = None

    def tick() -> float:
        nonlocal connection
        if connection is None:
            connection = listener.accept()
        while connection.poll():
            name, arguments, keywords = connection.recv()
            connection.send(outcome(name, arguments, keywords))
        return POLL

    bpy.app.timers.register(tick, first_interval=1.0, persistent=True)


def outcome(name: str, arguments: tuple, keywords: dict) -> tuple[bool, object]:
    """Whether it failed, and what came of it."""
    try:
        window = bpy.context.window_manager.windows[0]
        with bpy.context.temp_override(window=window):
            return False, ACTIONS[name](*arguments, **keywords)
    except BaseException:
        return True, traceback.format_exc()


serve()
