# SPDX-License-Identifier: GPL-3.0-or-later
"""The limit surface in users' own node trees: tables, node groups and their asset library."""

from .add_operator import NODE_OT_limit_sample_add
from .library import attach_library as attach_library
from .library import detach_library as detach_library
from .remove_operator import OBJECT_OT_limit_sample_remove
from .tables_operator import OBJECT_OT_limit_sample_tables

classes = (
    OBJECT_OT_limit_sample_tables,
    OBJECT_OT_limit_sample_remove,
    NODE_OT_limit_sample_add,
)
