# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of Blender's data as names of files."""

import re

_FORBIDDEN = re.compile(r'[<>:"/\\|?*\x00-\x1f]|^\.|[. ]$')


def allowed(name: str) -> str:
    """Returns the name as it can be part of a file's name everywhere."""
    return _FORBIDDEN.sub("_", name)
