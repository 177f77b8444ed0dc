# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of Blender's data as names of files."""

import hashlib
import re

_FORBIDDEN = re.compile(r'[<>:"/\\|?*\x00-\x1f]|^\.|[. ]$')


def allowed(name: str) -> str:
    """Returns the name as it can be part of a file's name everywhere."""
    return _FORBIDDEN.sub("_", name)


def different(name: str) -> str:
    """Returns the same, where a number keeps names different in which characters were replaced."""
    replaced = allowed(name)
    return replaced if replaced == name else f"{replaced}_{number(name)}"


def number(text: str) -> str:
    """Returns eight hexadecimal digits that depend on the whole text."""
    return hashlib.sha256(text.encode()).hexdigest()[:8]
