# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes position, normal, curvature, cavity and distortion of the limit surface into images:
object.limit_bake_maps.
"""

from .operator import OBJECT_OT_limit_bake_maps

classes = (OBJECT_OT_limit_bake_maps,)
