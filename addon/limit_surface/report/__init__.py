# SPDX-License-Identifier: GPL-3.0-or-later
"""The distance of the mesh that Blender shows from the limit surface, and how it shows that
surface itself.
"""

from .operator import OBJECT_OT_limit_report
from .panel import VIEW3D_PT_limit_report
from .show_operator import OBJECT_OT_limit_show

classes = (OBJECT_OT_limit_report, OBJECT_OT_limit_show, VIEW3D_PT_limit_report)
