# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair curves rooted on the limit surface."""

from .operator import OBJECT_OT_limit_hair_add

classes = (OBJECT_OT_limit_hair_add,)
