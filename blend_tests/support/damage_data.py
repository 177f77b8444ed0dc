# SPDX-License-Identifier: GPL-3.0-or-later
"""Damage to data: numbers that are not finite, attributes of other types, nothing at all."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
from damage_kinds import NAN, Damage, DoesNotApplyError, needs
from limit_surface import ids
from limit_surface.reading import attributes


def positions(values: Callable[[np.ndarray], np.ndarray]) -> Damage:
    def damage(ob: bpy.types.Object, _folder: Path) -> None:
        data = ob.data
        if ob.type == "CURVE":
            for spline in data.splines:
                for point in (*spline.points, *spline.bezier_points):
                    at = values(np.array(point.co[:3])[None])[0]
                    point.co = at if spline.type == "BEZIER" else (*at, 1)
        elif ob.type in ("MESH", "CURVES") and ids.POSITION in data.attributes:
            at = values(attributes.read(data, ids.POSITION))
            attributes.write(data, ids.POSITION, "FLOAT_VECTOR", "POINT", at)
        else:
            raise DoesNotApplyError
        data.update_tag()

    return damage


def one_at(value: float) -> Damage:
    def change(at: np.ndarray) -> np.ndarray:
        if not len(at):
            raise DoesNotApplyError
        at = at.copy()
        at[len(at) // 2] = value
        return at

    return positions(change)


def nothing_in_it(ob: bpy.types.Object, _folder: Path) -> None:
    if ob.type == "MESH":
        ob.data.clear_geometry()
    elif ob.type == "CURVES":
        if not hasattr(ob.data, "remove_curves"):  # before Blender 4.3
            raise DoesNotApplyError
        ob.data.remove_curves()
    elif ob.type == "CURVE":
        ob.data.splines.clear()
    else:
        raise DoesNotApplyError


def vertices_alone(ob: bpy.types.Object, _folder: Path) -> None:
    needs(ob, "MESH")
    ob.data.clear_geometry()
    ob.data.vertices.add(3)


def one_point(ob: bpy.types.Object, _folder: Path) -> None:
    if ob.type == "CURVES":
        if not hasattr(ob.data, "resize_curves"):  # before Blender 4.3
            raise DoesNotApplyError
        ob.data.resize_curves([1] * len(ob.data.curves))
    elif ob.type == "CURVE":
        ob.data.splines.clear()
        ob.data.splines.new("POLY")
    else:
        raise DoesNotApplyError


def nurbs(ob: bpy.types.Object, _folder: Path) -> None:
    needs(ob, "CURVE")
    for spline in ob.data.splines:
        spline.type = "NURBS"


def loose_edge(ob: bpy.types.Object, _folder: Path) -> None:
    needs(ob, "MESH")
    mesh = ob.data
    mesh.vertices.add(2)
    mesh.edges.add(1)
    mesh.edges[-1].vertices = (len(mesh.vertices) - 2, len(mesh.vertices) - 1)


def no_map(ob: bpy.types.Object, _folder: Path) -> None:
    needs(ob, "MESH")
    while ob.data.uv_layers:
        ob.data.uv_layers.remove(ob.data.uv_layers[0])


def map_at(value: float) -> Damage:
    def damage(ob: bpy.types.Object, _folder: Path) -> None:
        needs(ob, "MESH")
        if not ob.data.uv_layers:
            raise DoesNotApplyError
        layer = ob.data.uv_layers.active.data
        layer.foreach_set("uv", np.full(2 * len(layer), value, np.float32))

    return damage


def on_attributes(change: Callable[[bpy.types.Attribute], bool]) -> Damage:
    """Returns what changes each attribute that an extension or the user may store."""

    def damage(ob: bpy.types.Object, _folder: Path) -> None:
        if ob.type not in ("MESH", "CURVES"):
            raise DoesNotApplyError
        names = [name for name, _ in ob.data.attributes.items() if not name.startswith(".")]
        if not sum(change(ob.data.attributes[name]) for name in names if name != ids.POSITION):
            raise DoesNotApplyError

    return damage


def not_numbers(attribute: bpy.types.Attribute) -> bool:
    layout = attributes.LAYOUTS.get(attribute.data_type)
    if layout is None or layout.dtype != np.float32:
        return False
    attribute.data.foreach_set(
        layout.key, np.full(len(attribute.data) * layout.width, NAN, np.float32)
    )
    return True


def out_of_range(attribute: bpy.types.Attribute) -> bool:
    layout = attributes.LAYOUTS.get(attribute.data_type)
    if layout is None or layout.dtype not in (np.float32, np.int32):
        return False
    values = np.full(len(attribute.data) * layout.width, 1e9, layout.dtype)
    attribute.data.foreach_set(layout.key, values)
    return True


def negative(attribute: bpy.types.Attribute) -> bool:
    layout = attributes.LAYOUTS.get(attribute.data_type)
    if layout is None or layout.dtype not in (np.float32, np.int32):
        return False
    values = np.full(len(attribute.data) * layout.width, -3, layout.dtype)
    attribute.data.foreach_set(layout.key, values)
    return True


def of_another_type(attribute: bpy.types.Attribute) -> bool:
    data, name, domain = attribute.id_data, attribute.name, attribute.domain
    kind = "FLOAT_COLOR" if attribute.data_type != "FLOAT_COLOR" else "INT"
    if attribute.is_required:
        return False
    data.attributes.remove(attribute)
    data.attributes.new(name, kind, domain)
    return True


def on_another_domain(attribute: bpy.types.Attribute) -> bool:
    data, name, kind = attribute.id_data, attribute.name, attribute.data_type
    if attribute.is_required or attribute.domain == "CORNER":
        return False
    others = {"POINT": "CURVE", "CURVE": "POINT"}
    domain = (
        others[attribute.domain]
        if isinstance(data, bpy.types.Curves)
        else ("FACE" if attribute.domain == "POINT" else "POINT")
    )
    data.attributes.remove(attribute)
    data.attributes.new(name, kind, domain)
    return True


def attribute_removed(attribute: bpy.types.Attribute) -> bool:
    if attribute.is_required:
        return False
    attribute.id_data.attributes.remove(attribute)
    return True


def names_taken(ob: bpy.types.Object, _folder: Path) -> None:
    """The user has attributes with the names that the extension uses."""
    if ob.type not in ("MESH", "CURVES"):
        raise DoesNotApplyError
    for name in vars(ids).values():
        if (
            isinstance(name, str)
            and name.startswith("limit_")
            or name
            in (
                *(ids.REST_ROOT, ids.REST_ROTATION, ids.SURFACE_UV, ids.NORMAL, ids.TANGENT),
                *(ids.ROTATION, ids.SCALE, ids.MEMBER, ids.EDGE_CREASE, ids.VERTEX_CREASE),
            )
        ):
            there = ob.data.attributes.get(name)
            if there:
                ob.data.attributes.remove(there)
            ob.data.attributes.new(name, "BYTE_COLOR", "POINT")


def groups_with_taken_names(ob: bpy.types.Object, _folder: Path) -> None:
    needs(ob, "MESH")
    for name in (ids.FACE, ids.UV, ids.REST_ROOT, ids.DISTANCE, ids.CURVATURE_MEAN, ids.SCALE):
        ob.vertex_groups.new(name=name)


def creased(value: float) -> Damage:
    def damage(ob: bpy.types.Object, _folder: Path) -> None:
        needs(ob, "MESH")
        values = np.full(len(ob.data.edges), value)
        attributes.write(ob.data, ids.EDGE_CREASE, "FLOAT", "EDGE", values)

    return damage


def shape_keys(ob: bpy.types.Object, _folder: Path) -> None:
    if ob.type not in ("MESH", "CURVE"):
        raise DoesNotApplyError
    for name in ("Basis", "Other"):
        key = ob.shape_key_add(name=name)
    key.value = 1
    for point in key.data:
        point.co.z = NAN
