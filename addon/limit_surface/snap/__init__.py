# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapping to the limit surface: object.limit_snap, and the scene's target."""

from .settings import LimitSurfaceSettings, attach_settings, detach_settings

__all__ = ["attach_settings", "classes", "detach_settings"]

classes = (LimitSurfaceSettings,)
