# SPDX-License-Identifier: GPL-3.0-or-later
"""Stand-ins of plain Python for operators that place things, and for what Blender gives them where
there is a window.
"""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
from limit_surface.placing import scatter_operator

OPERATORS = {"hair": "limit_hair_add", "points": "limit_points_add"}


def stand_in(name, **chosen):
    kind = getattr(bpy.ops.object, OPERATORS[name]).get_rna_type()
    operator = getattr(bpy.types, kind.identifier)
    own = ("maker", "add", "noun", "bl_label", "elements_per_location", "check_properties")
    cls = type(
        "StandIn", (scatter_operator.ScatterOperator,), {n: getattr(operator, n) for n in own}
    )
    made = cls()
    for prop in kind.properties:
        if prop.identifier != "rna_type":
            value = prop.default_array[:] if getattr(prop, "is_array", False) else None
            if value is None:
                is_flag = prop.type == "ENUM" and prop.is_enum_flag
                value = set() if is_flag else prop.default
            setattr(made, prop.identifier, chosen.get(prop.identifier, value))
    made.is_property_set = chosen.__contains__
    made.properties = made
    made.report = MagicMock()
    return made


def window_context():
    """Returns a context as a user has it, with a window manager and a workspace that only record
    calls.
    """
    context = MagicMock(wraps=bpy.context)
    for name in ("active_object", "scene", "view_layer", "selected_objects", "space_data"):
        setattr(context, name, getattr(bpy.context, name))
    context.window_manager, context.workspace = MagicMock(), MagicMock()
    context.window = MagicMock()
    return context


def event(kind, value="PRESS"):
    return SimpleNamespace(type=kind, value=value)
