# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender -b FILE --command limit_surface bake ...`, and the same for Blender as a module."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import bpy

from .. import ids, native
from ..placing import proxy
from . import arguments, bindings
from .bake import Bake, say

DONE = 0
FRAMES_FAILED = 1
BAD_ARGUMENTS = 2
STALE_BINDING = 3

_handle: Any = None


def main(argv: Sequence[str]) -> int:
    """Runs the command on the open file, for example with ["bake", "--frames", "1-24",
    "--objects", "Hair", "--output", "caches"], and returns its exit code.

    The scene is left at the frame at which it was. Nothing is saved.
    """
    with _window():
        return _run(argv)


def _run(argv: Sequence[str]) -> int:
    try:
        wanted = arguments.parse(argv)
    except SystemExit as end:  # argparse has printed help, or what is wrong
        return int(end.code or 0)
    try:
        bake = Bake(wanted)
    except native.refusals as error:
        return _refuse(error, BAD_ARGUMENTS)
    with proxy.aside():
        return _write(bake)


def _write(bake: Bake) -> int:
    try:
        with bake.at_first_frame():
            bindings.check(bake.objects)
    except native.refusals as error:
        return _refuse(error, STALE_BINDING)
    try:
        bake.prepare()
    except native.refusals as error:
        return _refuse(error, BAD_ARGUMENTS)
    return FRAMES_FAILED if bake.run(say) else DONE


@contextmanager
def _window() -> Iterator[None]:
    """Makes the context have a window, which exporters ask for. On Blender's command line there are
    the windows of the file, but none is the current one.
    """
    context = bpy.context
    windows = context.window_manager.windows
    if context.window or not windows:
        yield
        return
    with context.temp_override(
        window=windows[0], scene=context.scene, view_layer=context.view_layer
    ):
        yield


def _refuse(error: Exception, code: int) -> int:
    print(f"limit_surface: error: {native.sentence(error)}", file=sys.stderr, flush=True)
    return code


def attach_command() -> None:
    global _handle
    _handle = bpy.utils.register_cli_command(ids.COMMAND, main)


def detach_command() -> None:
    bpy.utils.unregister_cli_command(_handle)
