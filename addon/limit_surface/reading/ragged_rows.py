# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays of rows that follow each other end to end, each row with a size of its own, at least 1.

The corners of polygons are such an array, with one row for each polygon, and so are the points of
curves.
"""

import numpy as np


def starts(sizes: np.ndarray) -> np.ndarray:
    """Returns the first element of each row."""
    return np.cumsum(sizes) - sizes


def places(sizes: np.ndarray) -> np.ndarray:
    """Returns for each element its place in its row, counted from 0."""
    return np.arange(np.sum(sizes)) - np.repeat(starts(sizes), sizes)


def following(sizes: np.ndarray) -> np.ndarray:
    """Returns for each element the next one of its row; for the last one, the row's first."""
    first = starts(sizes)
    result = np.arange(np.sum(sizes)) + 1
    result[first + sizes - 1] = first
    return result


def preceding(sizes: np.ndarray) -> np.ndarray:
    """Returns for each element the one before it in its row; for the first one, the row's last."""
    first = starts(sizes)
    result = np.arange(np.sum(sizes)) - 1
    result[first] = first + sizes - 1
    return result
