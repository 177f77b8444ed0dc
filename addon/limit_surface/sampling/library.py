# SPDX-License-Identifier: GPL-3.0-or-later
"""The asset library that comes with the extension. Blender lists it as long as the extension is
enabled.
"""

from pathlib import Path

import bpy

from .. import ids

FOLDER = Path(__file__).resolve().parents[1] / "assets"
# Each file gets the groups as its own. From 5.0 on the reuse of what is there is another setting.
_METHOD = "APPEND" if bpy.app.version >= (5, 0) else "APPEND_REUSE"
FILE = FOLDER / "limit_surface.blend"


def attach_library() -> None:
    if _own() is None:
        libraries = bpy.context.preferences.filepaths.asset_libraries
        library = libraries.new(name=ids.ASSET_LIBRARY, directory=str(FOLDER))
        library.import_method = _METHOD


def detach_library() -> None:
    library = _own()
    if library is not None:
        bpy.context.preferences.filepaths.asset_libraries.remove(library)


def _own() -> bpy.types.UserAssetLibrary | None:
    """Returns the entry of this folder: it may be left from a session that ended abruptly."""
    libraries = bpy.context.preferences.filepaths.asset_libraries
    return next((x for x in libraries if x.path and Path(x.path) == FOLDER), None)
