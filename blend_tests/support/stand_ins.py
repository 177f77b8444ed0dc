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
    return with_properties(cls(), kind, chosen)


def stand_in_of(operator, **chosen):
    """Returns a stand-in for any operator of the extension, by its class."""
    own = {name: value for name, value in vars(operator).items() if not name.startswith("bl_")}
    own = {name: value for name, value in own.items() if not name.startswith("__")}
    bases = tuple(base for base in operator.__bases__ if base is not bpy.types.Operator)
    made = type("StandIn", bases, own)()
    kind = getattr(bpy.ops.object, operator.bl_idname.partition(".")[2]).get_rna_type()
    return with_properties(made, kind, chosen)


def with_properties(made, kind, chosen):
    for prop in kind.properties:
        if prop.identifier != "rna_type":
            value = prop.default_array[:] if getattr(prop, "is_array", False) else None
            if value is None:
                is_flag = prop.type == "ENUM" and prop.is_enum_flag
                value = set() if is_flag else prop.default
            setattr(made, prop.identifier, chosen.get(prop.identifier, value))
    made.is_property_set = chosen.__contains__
    made.properties = made
    made.bl_rna = kind
    made.report = MagicMock()
    return made


def window_context():
    """Returns a context as a user has it, with a window manager and a workspace that only record
    calls.
    """
    context = MagicMock(wraps=bpy.context)
    names = ("active_object", "scene", "view_layer", "selected_objects", "space_data", "mode")
    for name in (*names, "objects_in_mode"):
        setattr(context, name, getattr(bpy.context, name, []))
    context.window_manager, context.workspace = MagicMock(), MagicMock()
    context.window = MagicMock()
    return context


def event(kind, value="PRESS"):
    return SimpleNamespace(type=kind, value=value)
