# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether Blender keeps what is written to the points of an object's data."""

import bpy

from ..errors import RefusalError


def check_data_editable(data: bpy.types.ID) -> None:
    """Raises RefusalError for data that cannot be changed, or whose changes are lost when the file
    is saved: of a library override Blender saves properties, but neither points nor attributes.
    """
    if not data.is_editable:
        raise RefusalError(f"{data.name} is linked from another file")
    if data.override_library:
        raise RefusalError(
            f"{data.name} is a library override: Blender does not save changes of its points and "
            "attributes. Make it local first"
        )
