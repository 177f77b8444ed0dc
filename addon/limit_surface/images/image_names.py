# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of images and of their files, which are found again and stay different from each other."""

from ..tasks import file_names

#: Blender's limit before version 5.0, in bytes. It counts in all versions, so that an image that
#: one of them has made is found again by another.
MOST_BYTES = 63


def with_ending(name: str, ending: str) -> str:
    """Returns the name and its ending. Where that is longer than names can be, the name is cut off,
    and a number that depends on all of it stands before the ending: Blender itself would cut off
    the ending.
    """
    whole = name + ending
    if len(whole.encode()) <= MOST_BYTES:
        return whole
    ending = f"~{file_names.number(name)}{ending}"
    kept = name.encode()[: MOST_BYTES - len(ending.encode())]
    return kept.decode(errors="ignore") + ending


def file_stem(name: str) -> str:
    """Returns the name of an image as it can be part of a file's name everywhere: spaces become _,
    too.
    """
    return file_names.different(name).replace(" ", "_")
