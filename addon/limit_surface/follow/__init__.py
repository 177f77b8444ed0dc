# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that stay on the limit surface of a mesh that deforms."""

from .handlers import attach_handlers, detach_handlers
from .operator import OBJECT_OT_limit_follow
from .panel import VIEW3D_PT_limit_follow
from .rebind_operator import OBJECT_OT_limit_rebind
from .unbind_operator import OBJECT_OT_limit_unbind

classes = (
    OBJECT_OT_limit_follow,
    OBJECT_OT_limit_unbind,
    OBJECT_OT_limit_rebind,
    VIEW3D_PT_limit_follow,
)

__all__ = ["attach_handlers", "classes", "detach_handlers"]
