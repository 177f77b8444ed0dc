# SPDX-License-Identifier: GPL-3.0-or-later
"""Position, normal, curvature, cavity and distortion of the limit surface as images:
object.limit_bake_maps."""

from .operator import OBJECT_OT_limit_bake_maps

classes = (OBJECT_OT_limit_bake_maps,)
