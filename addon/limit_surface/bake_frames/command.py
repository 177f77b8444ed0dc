# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender -b FILE --command limit_surface bake ...`, and the same for Blender as a module."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import bpy

from .. import ids, native
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
    try:
        wanted = arguments.parse(argv)
    except SystemExit as end:  # argparse has printed help, or what is wrong
        return int(end.code or 0)
    try:
        bake = Bake(wanted)
    except native.refusals as error:
        return _refuse(error, BAD_ARGUMENTS)
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


def _refuse(error: Exception, code: int) -> int:
    print(f"limit_surface: error: {error}", file=sys.stderr, flush=True)
    return code


def attach_command() -> None:
    global _handle
    _handle = bpy.utils.register_cli_command(ids.COMMAND, main)


def detach_command() -> None:
    bpy.utils.unregister_cli_command(_handle)
