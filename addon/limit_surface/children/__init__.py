# SPDX-License-Identifier: GPL-3.0-or-later
"""Children: strands between guides, as curves or grown by nodes."""

from .operator import OBJECT_OT_limit_children_add

classes = (OBJECT_OT_limit_children_add,)
