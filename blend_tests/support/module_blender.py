# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender as a module behind the command line of its executable, as far as farms need it:

python module_blender.py -b FILE --command limit_surface ARGUMENTS...
"""

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "addon"))

import bpy  # noqa: E402
import limit_surface  # noqa: E402
from limit_surface.bake_frames import command  # noqa: E402


def run(arguments: list[str]) -> int:
    background, file, word, name, *rest = arguments
    assert (background, word, name) == ("-b", "--command", "limit_surface"), arguments
    limit_surface.register()
    bpy.ops.wm.open_mainfile(filepath=file)
    return command.main(rest)


if __name__ == "__main__":
    code = run(sys.argv[1:])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # the module's own clean-up at exit sometimes hangs
