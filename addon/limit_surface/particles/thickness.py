# SPDX-License-Identifier: GPL-3.0-or-later
"""The thickness of hair particles: one profile from root to tip for all of them.

Blender draws curves by radii in their object's space, and particles by diameters in the world.
"""

from __future__ import annotations

import bpy
import numpy as np


def set_profile(settings: bpy.types.ParticleSettings, root: float, tip: float) -> None:
    """Sets radii in the world, in between which the radius is on a straight line."""
    thickest = max(root, tip)
    settings.radius_scale = 2 * thickest
    settings.root_radius = root / thickest if thickest else 1.0
    settings.tip_radius = tip / thickest if thickest else 1.0
    settings.shape = 0.0
    settings.use_close_tip = False


def radii(settings: bpy.types.ParticleSettings, time: np.ndarray) -> np.ndarray:
    """Returns radii in the world (n,) at times from 0 at the root to 1 at the tip, as renderers
    calculate them.
    """
    shape = settings.shape
    power = 1 + shape if shape < 0 else 1 / max(1 - shape, 1e-6)
    along = (1 - time) ** power
    thickness = settings.tip_radius + (settings.root_radius - settings.tip_radius) * along
    if settings.use_close_tip:
        thickness = np.where(time >= 1, 0, thickness)
    return 0.5 * settings.radius_scale * thickness
