# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapping to the limit surface: object.limit_snap, and the scene's target."""

from .operator import OBJECT_OT_limit_snap
from .panel import VIEW3D_PT_limit_snap
from .settings import LimitSurfaceSettings, attach_settings, detach_settings

__all__ = ["attach_settings", "classes", "detach_settings"]

classes = (LimitSurfaceSettings, OBJECT_OT_limit_snap, VIEW3D_PT_limit_snap)
