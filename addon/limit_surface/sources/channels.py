# SPDX-License-Identifier: GPL-3.0-or-later
"""The choice of one number from a colour."""

import numpy as np

from ..errors import RefusalError

LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)
NAMES = ("RED", "GREEN", "BLUE", "ALPHA")


def pick(colours: np.ndarray, channel: str, whose: str) -> np.ndarray:
    """Returns one channel of colours (..., channels). Raises RefusalError if they have no such
    channel, or some values are not finite.
    """
    count = colours.shape[-1]
    if channel == "LUMINANCE":
        values = colours[..., :3] @ LUMINANCE if count >= 3 else colours[..., 0]
    elif NAMES.index(channel) < count:
        values = np.ascontiguousarray(colours[..., NAMES.index(channel)])
    else:
        raise RefusalError(f"The {whose} has no {channel.lower()} channel")
    if not np.isfinite(values).all():
        raise RefusalError(f"The {whose} has values that are not finite numbers")
    return values
