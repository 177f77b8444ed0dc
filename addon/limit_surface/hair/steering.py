# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties by which vertex groups, images and attributes steer strands."""

from __future__ import annotations

import bpy
from bpy.props import FloatProperty

from ..sources import flow_properties
from ..sources.value_properties import SourceNames

LENGTH = SourceNames.of("length", "Length")
RADIUS = SourceNames.of("radius", "Radius")
TILT = SourceNames.of("tilt", "Tilt")
RANDOM = SourceNames.of("random", "Random")
STEERED = {"length": LENGTH, "radius": RADIUS, "tilt": TILT, "random": RANDOM}
SIGNED = ("tilt",)
_LAID_OUT = (
    (("length",), LENGTH),
    (("points",), None),
    (("tilt",), TILT),
    (("random", "random_length"), RANDOM),
    (("radius",), RADIUS),
)


class SteeringProperties(flow_properties.FlowProperties):
    """Mixin with a source and a range for each property of strands that can be steered."""

    __annotations__ = {  # noqa: RUF012
        **LENGTH.properties("the length", "Factor of the length"),
        **RADIUS.properties("the radius", "Factor of the radius"),
        **TILT.properties("the tilt", "Factor of both angles of the tilt"),
        **RANDOM.properties("the random part", "Factor of Random and Random Length"),
        "random_length": FloatProperty(
            name="Random Length",
            description="How much shorter strands may be at random, as a fraction of their "
            "length: 0.4 gives 60% to 100% of it",
            default=0.0,
            min=0.0,
            max=1.0,
            subtype="FACTOR",
        ),
    }


def draw(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
) -> None:
    """Draws the properties of the strands' shape, each with its source below it."""
    for names, source in _LAID_OUT:
        for name in names:
            layout.prop(properties, name)
        if source:
            source.draw(layout, properties, ob)
    flow_properties.draw(layout, properties, ob)
    if properties.flow_source != "NONE":
        layout.prop(properties, "flow_angle")
