# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that stay on the limit surface of a mesh that deforms."""

from .operator import OBJECT_OT_limit_follow

classes = (OBJECT_OT_limit_follow,)
