# SPDX-License-Identifier: GPL-3.0-or-later
"""Strokes that are drawn on the limit surface, and curves that are laid onto it."""

from .lay_operator import OBJECT_OT_limit_curve_lay
from .operator import VIEW3D_OT_limit_draw
from .stroke import LIMIT_PG_draw_point, LIMIT_PG_draw_spline

classes = (
    LIMIT_PG_draw_point,
    LIMIT_PG_draw_spline,
    VIEW3D_OT_limit_draw,
    OBJECT_OT_limit_curve_lay,
)
