# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps the copy of an object in step with the object, by what Blender evaluates itself.

A constraint gives the copy the place of the original, however that is moved or parented. Drivers
give it the values of the original's modifiers, whether they are set by hand, animated or driven.
So the copy needs no animation of its own. What no driver can carry over is compared instead: the
modifiers and their order, those of their settings that are names, objects or curves, and which
shape key is shown alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

from ..nodes import groups
from ..reading.modifier_kinds import DEFORMING_PARENTS

# Of modifiers: what changes no shape in the viewport
_WITHOUT_EFFECT = {
    *("name", "type", "rna_type", "is_active", "is_override_data", "execution_time"),
    *("persistent_uid", "show_expanded", "show_in_editmode", "show_on_cage", "show_render"),
    *("show_group_selector", "show_manage_panel", "use_apply_on_spline", "use_pin_to_last"),
    *("open_bake_panel", "open_manage_panel", "open_named_attributes_panel"),
    *("open_output_attributes_panel", "open_warnings_panel"),
}


def keep(copy: bpy.types.Object, original: bpy.types.Object) -> None:
    """Has Blender keep a new copy of an object in step with it. The copy may lack the last of the
    original's modifiers.
    """
    copy.animation_data_clear()
    if copy.parent_type not in DEFORMING_PARENTS:
        copy.parent = None
    copy.constraints.clear()
    copy.constraints.new("COPY_TRANSFORMS").target = original
    for path in _paths(copy):
        _drive(copy, original, path)


def why_not(copy: bpy.types.Object, original: bpy.types.Object) -> str:
    """Returns why a copy may not be in step with the original, as the end of a sentence about the
    copy; nothing if it is.
    """
    constraint = next((c for c in copy.constraints if c.type == "COPY_TRANSFORMS"), None)
    if constraint is None:
        return "was made by an earlier version of this extension"
    if constraint.target != original:
        whose = constraint.target.name if constraint.target else "an object that was deleted"
        return f"is a copy of {whose}"
    if copy.data != original.data:
        return f"has another mesh than {original.name}"
    if _deforming_parent(copy) != _deforming_parent(original):
        return f"has another parent than {original.name}"
    if _shown_alone(copy) != _shown_alone(original):
        return f"does not show the same shape key alone as {original.name}"
    ours = list(copy.modifiers)
    theirs = list(original.modifiers)[: len(ours)]
    if [m.type for m in ours] != [m.type for m in theirs]:
        return f"has other modifiers than {original.name}"
    animation = copy.animation_data
    driven = {curve.data_path for curve in animation.drivers} if animation else set()
    for one, other in zip(ours, theirs, strict=True):
        of_modifier = one.path_from_id()
        by_drivers = {p.removeprefix(of_modifier) for p in driven if p.startswith(of_modifier)}
        if _compared(one, by_drivers) != _compared(other, by_drivers):
            return f"has other settings of the modifier {other.name} than {original.name}"
    return ""


def _deforming_parent(ob: bpy.types.Object) -> tuple[bpy.types.Object, str] | None:
    deforms = ob.parent is not None and ob.parent_type in DEFORMING_PARENTS
    return (ob.parent, ob.parent_type) if deforms else None


def _shown_alone(ob: bpy.types.Object) -> int | None:
    is_alone = ob.show_only_shape_key and ob.data.shape_keys
    return ob.active_shape_key_index if is_alone else None


def _paths(ob: bpy.types.Object) -> Iterator[str]:
    """Yields the paths of all values that a driver may carry over."""
    for modifier in ob.modifiers:
        for path, _value in _values(modifier):
            yield f"{modifier.path_from_id()}{path}"


def _values(modifier: bpy.types.Modifier) -> Iterator[tuple[str, Any]]:
    """Yields the paths, as seen from the modifier, and the values of all of its settings that may
    change a shape.
    """
    for prop in modifier.bl_rna.properties:
        if prop.identifier not in _WITHOUT_EFFECT and prop.type != "COLLECTION":
            yield f".{prop.identifier}", getattr(modifier, prop.identifier)
    if modifier.type == "NODES":
        yield from groups.paths_of_inputs(modifier)


def _drive(copy: bpy.types.Object, original: bpy.types.Object, path: str) -> None:
    """Gives a value of the copy, or each value of an array, a driver that reads the original's. A
    driver without an expression does not need Python.
    """
    value = copy.path_resolve(path)
    if isinstance(value, bool | int | float | str):
        indices: tuple[int, ...] = (-1,)
    elif _is_array(value) and all(isinstance(each, bool | int | float) for each in value):
        indices = tuple(range(len(value)))
    else:
        return
    for index in indices:
        try:
            driver = copy.driver_add(path, index).driver
        except TypeError:  # no driver can carry it over: a text, say, or what is not animatable
            return
        driver.type = "SUM"
        target = driver.variables.new().targets[0]
        target.id, target.data_path = original, path if index < 0 else f"{path}[{index}]"


def _is_array(value: Any) -> bool:
    return hasattr(value, "__len__") and not isinstance(value, str | bytes | dict | set)


def _compared(modifier: bpy.types.Modifier, driven: set[str]) -> dict[str, Any]:
    """Returns the values that no driver carries over, as values that can be compared."""
    compared = ((path, value) for path, value in _values(modifier) if path not in driven)
    # where an object names itself, its copy names the copy
    return {path: None if value == modifier.id_data else _frozen(value) for path, value in compared}


def _frozen(value: Any) -> Any:
    if isinstance(value, bpy.types.CurveMapping):
        return tuple(
            tuple((*point.location, point.handle_type) for point in curve.points)
            for curve in value.curves
        )
    if isinstance(value, bpy.types.CurveProfile):
        return tuple((*point.location, point.handle_type_1) for point in value.points)
    if isinstance(value, bpy.types.ID):
        return value.session_uid
    if isinstance(value, bpy.types.bpy_struct):
        return None
    if _is_array(value):
        return tuple(_frozen(each) for each in value)
    return frozenset(value) if isinstance(value, set) else value
