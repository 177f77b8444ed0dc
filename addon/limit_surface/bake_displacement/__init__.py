# SPDX-License-Identifier: GPL-3.0-or-later
"""Displacement between two surfaces, as an image."""

from .operator import OBJECT_OT_limit_bake_displacement

classes = (OBJECT_OT_limit_bake_displacement,)
