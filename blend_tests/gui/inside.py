# SPDX-License-Identifier: GPL-3.0-or-later
"""The program within Blender: it does what the tests ask for, between two events of the main
loop.
"""

import os
import sys
import traceback
from multiprocessing.connection import Listener
from pathlib import Path

import bpy

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "docs")]
preferences = bpy.context.preferences
# Both would intercept clicks.
preferences.view.show_splash = False
preferences.view.show_tooltips = False

import actions  # noqa: E402
import meanwhile_actions  # noqa: E402
import texture_actions  # noqa: E402
import waiting_actions  # noqa: E402

actions.smooth_lines(False)

POLL = 0.005  # seconds
#: The number of rounds of the main loop, at least POLL apart, in which an event and everything that
#: follows from it is handled. A round reads all events that have come to the window, handles them,
#: calls `tick`, and draws what has changed. What is drawn anew under the mouse gets a move of the
#: mouse in the next round, and a button that is used by a key is lit for 0.02 s before it acts.
ROUNDS = 6
ACTIONS = {}
for module in (actions, meanwhile_actions, texture_actions, waiting_actions):
    for word, action in vars(module).items():
        if callable(action) and ACTIONS.setdefault(word, action) is not action:
            raise ImportError(f"two functions for the window tests have the name {word}")


def serve() -> None:
    listener = Listener(os.environ["LIMIT_SURFACE_SOCKET"])
    connection = None
    rounds = 0  # rounds that remain before "settle" is answered

    def tick() -> float:
        nonlocal connection, rounds
        if connection is None:
            connection = listener.accept()
        if rounds:
            rounds -= 1
            if rounds == 0:
                connection.send((False, None))
        while not rounds and connection.poll():
            name, arguments, keywords = connection.recv()
            if name == "settle":
                rounds = arguments[0] if arguments else ROUNDS
            else:
                connection.send(outcome(name, arguments, keywords))
        return POLL

    bpy.app.timers.register(tick, first_interval=1.0, persistent=True)


def outcome(name: str, arguments: tuple, keywords: dict) -> tuple[bool, object]:
    """Returns whether it failed, and its result."""
    try:
        window = bpy.context.window_manager.windows[0]
        with bpy.context.temp_override(window=window):
            return False, ACTIONS[name](*arguments, **keywords)
    except BaseException:
        return True, traceback.format_exc()


serve()
