# SPDX-License-Identifier: GPL-3.0-or-later
"""The curve of sRGB (IEC 61966-2-1), by which Blender's byte colours stand for linear light."""

import numpy as np


def to_linear(values: np.ndarray) -> np.ndarray:
    return np.where(
        values <= 0.04045, values / 12.92, ((np.maximum(values, 0) + 0.055) / 1.055) ** 2.4
    )


def from_linear(values: np.ndarray) -> np.ndarray:
    return np.where(
        values <= 0.0031308, values * 12.92, 1.055 * np.maximum(values, 0) ** (1 / 2.4) - 0.055
    )
