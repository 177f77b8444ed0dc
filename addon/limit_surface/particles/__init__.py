# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair as a legacy hair particle system, and back."""

from .from_hair_operator import OBJECT_OT_limit_particles_from_hair
from .panel import VIEW3D_PT_limit_particles
from .to_hair_operator import OBJECT_OT_limit_hair_from_particles

classes = (
    OBJECT_OT_limit_particles_from_hair,
    OBJECT_OT_limit_hair_from_particles,
    VIEW3D_PT_limit_particles,
)
