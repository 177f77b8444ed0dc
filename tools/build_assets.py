#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the asset library of the extension: the node groups for users' own trees.

    tools/build_assets.py [FILE]

The file is part of the repository. Blender opens the files of older versions, but not those of
newer ones: run this with the oldest Blender that the extension supports (`bpy` of Blender 4.2).
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "addon"))

import bpy  # noqa: E402
from limit_surface.nodes.locate import LOCATE  # noqa: E402
from limit_surface.nodes.sample_surface import SAMPLE_SURFACE  # noqa: E402
from limit_surface.sampling.library import FILE  # noqa: E402

DESCRIPTIONS = {
    SAMPLE_SURFACE: "Position and frame of the exact limit surface of a mesh, at any face, u and v",
    LOCATE: "The bicubic tile of a limit surface that holds a face's u and v",
}


def write(path: Path) -> None:
    """Writes the library into an empty file of Blender."""
    for kind, description in DESCRIPTIONS.items():
        group = kind.group()
        group.asset_mark()
        group.asset_data.description = description
        group.asset_data.author = "Limit Surface"
        group.asset_data.license = "GPL-3.0-or-later"
        group.asset_data.tags.new("subdivision")
    groups = {kind.group() for kind in DESCRIPTIONS}
    bpy.data.libraries.write(str(path), groups, fake_user=True, compress=True)


if __name__ == "__main__":
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    write(Path(sys.argv[1]) if len(sys.argv) > 1 else FILE)
