# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties of things that are placed along borders, and their layout."""

import math

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from .border import BorderChoice, BorderLayout, Turn


class BorderProperties:
    """Mixin with the properties of the distribution along borders."""

    border: EnumProperty(
        name="Border",
        description="Edges along which strands or points stand, for the distribution Border",
        items=(
            (
                "BOUNDARY",
                "Boundary",
                "Use the open boundaries of the mesh: edges that belong to one face",
                "",
                0,
            ),
            ("CREASES", "Creases", "Use edges between faces with a crease above 0", "", 1),
            ("SHARP", "Sharp", "Use edges that are marked sharp", "", 2),
            ("SELECTED", "Selected", "Use the edges that were selected in Edit Mode", "", 3),
        ),
        default="BOUNDARY",
    )
    border_jitter: FloatProperty(
        name="Jitter",
        description="Random movement along the border, as a fraction of the distance between "
        "neighbors. At 1 each strand or point moves by at most half of this distance to either "
        "side",
        default=0.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    rows: IntProperty(
        name="Rows",
        description="Number of rows. The first row lies on the border, and the others beside "
        "it. A row ends where it would meet itself or another row",
        default=1,
        min=1,
        max=1000,
        soft_max=20,
    )
    row_distance: FloatProperty(
        name="Row Distance",
        description="Distance between rows in world space, measured along the surface",
        default=0.05,
        min=1e-6,
        soft_min=1e-3,
        soft_max=10.0,
        precision=4,
        subtype="DISTANCE",
    )
    other_side: BoolProperty(
        name="Other Side",
        description="Put strands or points on the faces on the other side of the border, where it "
        "has faces on both sides",
        default=False,
    )
    direction: EnumProperty(
        name="Direction",
        description="Direction of strands, and of the instances on points, along a border",
        items=(
            ("NORMAL", "Normal", "Point along the surface's normal", "", 0),
            (
                "OUTWARDS",
                "Outwards",
                "Point away from the faces beside the border, in the tangent plane of the surface",
                "",
                1,
            ),
        ),
        default="NORMAL",
    )
    lift: FloatProperty(
        name="Lift",
        description="Angle by which strands or instances that point outwards are raised towards "
        "the surface's normal: at 90 degrees they point along the normal",
        default=0.0,
        min=-math.pi / 2,
        max=math.pi / 2,
        unit="ROTATION",
    )
    flow: FloatProperty(
        name="Flow",
        description="Angle by which strands or instances lean along the border. Negative angles "
        "make them lean the opposite way",
        default=0.0,
        min=-math.pi / 2,
        max=math.pi / 2,
        unit="ROTATION",
    )


def choice(properties: bpy.types.OperatorProperties) -> BorderChoice | None:
    """Returns the choice of edges, or None for other distributions."""
    return BorderChoice(properties.border) if properties.distribution == "BORDER" else None


def layout_of(properties: bpy.types.OperatorProperties) -> BorderLayout:
    return BorderLayout(
        jitter=properties.border_jitter,
        side="right" if properties.other_side else "left",
        rows=properties.rows,
        row_distance=properties.row_distance,
    )


def turn_of(properties: bpy.types.OperatorProperties) -> Turn:
    is_outwards = properties.direction == "OUTWARDS"
    return Turn(math.pi / 2 - properties.lift if is_outwards else 0.0, properties.flow)


def draw(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
    layout.prop(properties, "border")
    layout.prop(properties, "border_jitter", slider=True)
    layout.prop(properties, "rows")
    if properties.rows > 1:
        layout.prop(properties, "row_distance")
    layout.prop(properties, "other_side")
    layout.prop(properties, "direction")
    if properties.direction == "OUTWARDS":
        layout.prop(properties, "lift")
    layout.prop(properties, "flow")
