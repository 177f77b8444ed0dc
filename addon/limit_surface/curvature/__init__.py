# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature of the limit surface as attributes."""

from .operator import OBJECT_OT_limit_curvature

classes = (OBJECT_OT_limit_curvature,)
