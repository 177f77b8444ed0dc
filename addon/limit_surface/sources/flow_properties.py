# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that choose a flow, and their layout."""

from __future__ import annotations

import math

import bpy
from bpy.props import EnumProperty, FloatProperty, StringProperty

from .flow import FlowChoice
from .value_properties import search

SOURCE = "flow_source"


class FlowProperties:
    """Mixin for operators whose strands can be combed."""

    flow_source: EnumProperty(
        name="Flow From",
        description="Source of directions along the surface, towards which strands lean",
        items=(
            ("NONE", "None", "Do not comb the strands", "", 0),
            (
                "IMAGE",
                "Image",
                "Use a comb map: red is the direction of the UV map's U, green that of its V, and "
                "0.5 in both is none",
                "IMAGE_DATA",
                1,
            ),
            (
                "ATTRIBUTE",
                "Attribute",
                "Use vectors of vertices, face corners or faces, in the object's space",
                "SPREADSHEET",
                2,
            ),
            (
                "CURVATURE_1",
                "Larger Curvature",
                "Use the principal direction of the larger curvature, which runs along a limb. Of "
                "its two ends, the lower one is taken",
                "SPHERECURVE",
                4,
            ),
            (
                "CURVATURE_2",
                "Smaller Curvature",
                "Use the principal direction of the smaller curvature, which runs around a limb. "
                "Of its two ends, the lower one is taken",
                "SPHERECURVE",
                5,
            ),
        ),
        default="NONE",
    )
    flow_image: StringProperty(
        name="Comb Map", description="Name of the image that holds the directions"
    )
    flow_attribute: StringProperty(
        name="Attribute", description="Name of the vector attribute that holds the directions"
    )
    flow_angle: FloatProperty(
        name="Flow Angle",
        description="Angle by which strands lean away from the normal where the flow has the "
        "length 1. Where it is shorter they lean less. A negative angle reverses the flow",
        default=math.radians(60),
        min=-math.pi,
        max=math.pi,
        unit="ROTATION",
    )


def choice(properties: bpy.types.OperatorProperties) -> FlowChoice:
    return FlowChoice(
        source=properties.flow_source,
        image=properties.flow_image,
        uv_map=properties.uv_map,
        extension=properties.extension,
        attribute=properties.flow_attribute,
    )


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
    layout.prop(properties, "flow_angle")
