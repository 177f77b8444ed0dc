# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on the limit surface, with frames to put instances on."""

from .operator import OBJECT_OT_limit_points_add

classes = (OBJECT_OT_limit_points_add,)
