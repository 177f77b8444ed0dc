# SPDX-License-Identifier: GPL-3.0-or-later
"""How strands and points are spread over a surface: where, how many, how densely."""

from .live_count import attach_handlers, detach_handlers
from .panel import VIEW3D_PT_limit_hair, VIEW3D_PT_limit_points

__all__ = ["attach_handlers", "classes", "detach_handlers"]

classes = (VIEW3D_PT_limit_hair, VIEW3D_PT_limit_points)
