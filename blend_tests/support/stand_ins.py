# SPDX-License-Identifier: GPL-3.0-or-later
"""Stand-ins of plain Python for operators that place things, and for what Blender gives them where
there is a window.
"""

from types import CellType, FunctionType, SimpleNamespace
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
    cell = CellType()
    own = {name: _with_class(value, cell) for name, value in own.items()}
    cell.cell_contents = cls = type("StandIn", bases, own)
    made = cls()
    category, name = operator.bl_idname.split(".")
    kind = getattr(getattr(bpy.ops, category), name).get_rna_type()
    return with_properties(made, kind, chosen)


def _with_class(value, cell):
    """Returns a method that calls `super()` as one of the class that the cell will hold."""
    if not isinstance(value, FunctionType) or "__class__" not in value.__code__.co_freevars:
        return value
    names = value.__code__.co_freevars
    closure = tuple(
        cell if name == "__class__" else old
        for name, old in zip(names, value.__closure__, strict=True)
    )
    return FunctionType(
        value.__code__, value.__globals__, value.__name__, value.__defaults__, closure
    )


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
    for name in (*names, "objects_in_mode", "objects_in_mode_unique_data"):
        setattr(context, name, getattr(bpy.context, name, []))
    context.window_manager, context.workspace = MagicMock(), MagicMock()
    context.window = MagicMock()
    context.screen = MagicMock(is_animation_playing=False)
    return context


def status_text(context):
    """Returns the text that the status bar shows in the context's window."""
    header, draw = MagicMock(), context.workspace.status_text_set.call_args.args[0]
    draw(header, context)
    return header.layout.label.call_args.kwargs["text"]


def event(kind, value="PRESS"):
    return SimpleNamespace(type=kind, value=value)
