# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that choose a flow, and their layout."""

from __future__ import annotations

import math

import bpy
from bpy.props import EnumProperty, FloatProperty, StringProperty

from ..reading import curve_lines
from ..reading.named import find_object
from .flow import Curves, FlowChoice
from .value_properties import search
from .values import labelled

SOURCE = "flow_source"


class FlowProperties:
    """Mixin for operators whose things can be combed."""

    flow_source: EnumProperty(
        name="Flow From",
        description="Source of directions along the surface in which strands or instances lean or "
        "point",
        items=(
            ("NONE", "None", "Use no directions along the surface", "", 0),
            (
                "IMAGE",
                "Image",
                "Use a flow map, an image of directions: red is the part along the UV map's U, "
                "green the part along its V, and 0.5 in both means no direction",
                "IMAGE_DATA",
                1,
            ),
            (
                "ATTRIBUTE",
                "Attribute",
                "Use a vector attribute of vertices, face corners or faces, in the object's space",
                "SPREADSHEET",
                2,
            ),
            (
                "CURVES",
                "Curves",
                "Follow the curves of an object that are nearest along the surface, from their "
                "first points to their last",
                "OUTLINER_OB_CURVE",
                3,
            ),
            (
                "CURVATURE_1",
                "Larger Curvature",
                "Use the principal direction of the larger curvature, which runs along a limb, "
                "because bulges have negative curvature. Of the two opposite directions, the one "
                "that points downwards is used",
                "SPHERECURVE",
                4,
            ),
            (
                "CURVATURE_2",
                "Smaller Curvature",
                "Use the principal direction of the smaller curvature, which runs around a limb. "
                "Of the two opposite directions, the one that points downwards is used",
                "SPHERECURVE",
                5,
            ),
        ),
        default="NONE",
    )
    flow_image: StringProperty(
        name="Flow Map", description="Name of the image that holds the directions"
    )
    flow_attribute: StringProperty(
        name="Attribute", description="Name of the vector attribute that holds the directions"
    )
    flow_curves: StringProperty(
        name="Curves",
        description="Name of the curve or hair object whose curves are followed. They may "
        "lie on the surface or near it",
    )
    flow_angle: FloatProperty(
        name="Flow Angle",
        description="Angle by which strands or instances lean away from the surface normal, where "
        "the vector of the direction has the length 1. Where the vector is shorter, they lean "
        "less. With a negative angle they lean the opposite way",
        default=math.radians(60),
        min=-math.pi,
        max=math.pi,
        unit="ROTATION",
    )


def choice(properties: bpy.types.OperatorProperties, context: bpy.types.Context) -> FlowChoice:
    """Returns the choice. Curves are read at once. Raises RefusalError where there are none."""
    return FlowChoice(
        source=properties.flow_source,
        image=properties.flow_image,
        uv_map=properties.uv_map,
        extension=properties.extension,
        attribute=properties.flow_attribute,
        curves=_read_curves(properties, context) if properties.flow_source == "CURVES" else None,
    )


def _read_curves(properties: bpy.types.OperatorProperties, context: bpy.types.Context) -> Curves:
    with labelled("Flow"):
        ob = find_object(properties.flow_curves, "curves or hair whose direction strands follow")
        return Curves(ob.name, curve_lines.read(ob, context.evaluated_depsgraph_get()))


def draw(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
) -> None:
    layout.prop(properties, "flow_source")
    source = properties.flow_source
    if source == "NONE":
        return
    if source == "IMAGE":
        search(layout, properties, "flow_image", bpy.data, "images")
    elif source == "ATTRIBUTE":
        search(layout, properties, "flow_attribute", ob and ob.data, "attributes")
    elif source == "CURVES":
        search(layout, properties, "flow_curves", bpy.data, "objects")
