# SPDX-License-Identifier: GPL-3.0-or-later
"""The distance of the mesh that Blender shows from the limit surface."""

from .operator import OBJECT_OT_limit_report
from .panel import VIEW3D_PT_limit_report

classes = (OBJECT_OT_limit_report, VIEW3D_PT_limit_report)
