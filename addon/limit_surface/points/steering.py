# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties by which vertex groups, images and attributes steer what stands on points."""

from __future__ import annotations

import math

import bpy
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty

from ..sources import flow_properties
from ..sources.value_properties import SourceNames

SCALE = SourceNames.of("scale", "Scale")
ROTATION = SourceNames.of("rotation", "Rotation")
TILT = SourceNames.of("tilt", "Tilt")
RANDOM = SourceNames.of("random", "Random")
INDEX = SourceNames.of("index", "Index")
STEERED = {"scale": SCALE, "rotation": ROTATION, "tilt": TILT, "random": RANDOM}
SIGNED = ("rotation", "tilt")
_LAID_OUT = (
    (("scale", "random_scale"), SCALE),
    (("rotation", "random_rotation"), ROTATION),
    (("tilt",), TILT),
    (("random",), RANDOM),
)


class SteeringProperties(flow_properties.FlowProperties):
    """Mixin with how large instances are and how they are turned, with a source and a range for
    each.
    """

    __annotations__ = {  # noqa: RUF012
        "scale": FloatProperty(
            name="Scale",
            description="Size of the instances, as a factor of their original size",
            default=1.0,
            min=0.0,
            soft_max=10.0,
        ),
        "random_scale": FloatProperty(
            name="Random Scale",
            description="How much smaller instances may be at random, as a fraction of their "
            "size: 0.4 gives 60% to 100% of it",
            default=0.0,
            min=0.0,
            max=1.0,
            subtype="FACTOR",
        ),
        "rotation": FloatProperty(
            name="Rotation",
            description="Angle by which instances are turned about their Z axis",
            default=0.0,
            soft_min=-math.tau,
            soft_max=math.tau,
            unit="ROTATION",
        ),
        "random_rotation": FloatProperty(
            name="Random Rotation",
            description="Largest random angle, to either side, that is added to each instance's "
            "rotation",
            default=0.0,
            min=0.0,
            max=math.pi,
            unit="ROTATION",
        ),
        "tilt": FloatVectorProperty(
            name="Tilt",
            description="Angles by which the Z axis of instances leans, towards their X axis and "
            "towards their Y axis. Along a border, the Y axis runs along the border",
            size=2,
            default=(0.0, 0.0),
            min=-math.pi,
            max=math.pi,
            unit="ROTATION",
        ),
        "random": FloatProperty(
            name="Random",
            description="Largest random angle by which the Z axis of each instance leans in "
            "addition, in a random direction",
            default=0.0,
            min=0.0,
            max=math.pi,
            unit="ROTATION",
        ),
        "flow_axis": EnumProperty(
            name="Flow Axis",
            description="Which axis of the instances follows the directions along the surface",
            items=(
                (
                    "X",
                    "X",
                    "The X axis points along the direction, and the Z axis stays as it is",
                    0,
                ),
                ("Z", "Z", "The Z axis leans into the direction, as strands do", 1),
            ),
            default="X",
        ),
        **SCALE.properties("the scale", "Factor of the scale"),
        **ROTATION.properties("the rotation", "Factor of the rotation"),
        **TILT.properties("the tilt", "Factor of both angles of the tilt"),
        **RANDOM.properties(
            "the random part", "Factor of Random, Random Scale and Random Rotation"
        ),
        **INDEX.properties(
            "the choice from the collection",
            "Place in the collection, from 0 for its first member to 1 for its last one,",
            unsteered="Choose members at random",
        ),
    }


def draw(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
) -> None:
    """Draws the properties of the instances' size and rotation, each with its source below it."""
    for names, source in _LAID_OUT:
        for name in names:
            layout.prop(properties, name)
        source.draw(layout, properties, ob)
    flow_properties.draw(layout, properties, ob)
    if properties.flow_source != "NONE":
        layout.prop(properties, "flow_axis")
        if properties.flow_axis == "Z":
            layout.prop(properties, "flow_angle")
