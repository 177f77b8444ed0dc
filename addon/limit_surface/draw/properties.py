# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of what is drawn, which operators share, and their layout in the redo panel."""

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty

SPLINES = (
    ("BEZIER", "Bézier", "Make Bézier curves with few control points", 0),
    ("POLY", "Poly", "Make polylines", 1),
)


class FitProperties:
    """Mixin with what curves are fitted by."""

    spline: EnumProperty(name="Spline", description="Type of the new curves", items=SPLINES)
    tolerance: FloatProperty(
        name="Tolerance",
        description="How far the curves may be from the surface, or from the places to which "
        "Offset moves them, in world units. 0 chooses a ten-thousandth of the surface's size. "
        "The smallest tolerance is a millionth of this size",
        default=0.0,
        min=0.0,
        soft_max=0.1,
        precision=5,
        subtype="DISTANCE",
    )
    offset: FloatProperty(
        name="Offset",
        description="Distance from the surface along its normal, in world units",
        default=0.0,
        subtype="DISTANCE",
    )


class DrawingProperties(FitProperties):
    """Mixin with what is made of strokes."""

    output: EnumProperty(
        name="Make",
        description="What the strokes become",
        items=(
            ("CURVE", "Curve", "Make a Curve object: for stitches, cables, seams and scratches", 0),
            (
                "GUIDES",
                "Guide Strands",
                "Make hair curves that are rooted where the strokes begin",
                1,
            ),
        ),
    )
    radius: FloatProperty(
        name="Radius",
        description="Radius of the curves at full pressure, in world units. 0 makes curves without "
        "thickness",
        default=0.01,
        min=0.0,
        soft_max=1.0,
        precision=4,
        subtype="DISTANCE",
    )
    bevel_resolution: IntProperty(
        name="Bevel Resolution",
        description="Roundness of the tube around the curves: each quarter of it has one segment "
        "more than this number",
        default=2,
        min=0,
        max=32,
    )
    points: IntProperty(
        name="Points",
        description="Number of control points on each strand, including the root",
        default=8,
        min=2,
        max=1024,
        soft_max=64,
    )


#: What has an effect only while somebody draws
WHILE_DRAWING = ("steadying", "use_pressure", "use_mirror", "use_join", "brush")


def draw_next(layout: bpy.types.UILayout, of: bpy.types.OperatorProperties, is_new: bool) -> None:
    """Draws the settings for the next strokes. A drawing that exists is continued with its own
    offset.
    """
    for name in WHILE_DRAWING:
        layout.prop(of, name)
    layout.separator()
    draw(layout, of, is_new, has_offset=is_new)


def draw(
    layout: bpy.types.UILayout,
    of: bpy.types.OperatorProperties,
    is_new: bool,
    has_offset: bool = True,
) -> None:
    """Draws what is made of strokes. A Curve object that exists keeps what belongs to all its
    splines.
    """
    is_curve = not is_new or of.output == "CURVE"
    if is_new:
        layout.prop(of, "output")
    if is_curve:
        layout.prop(of, "spline")
        layout.prop(of, "tolerance")
    else:
        layout.prop(of, "points")
    if has_offset:
        layout.prop(of, "offset")
    if is_new:
        layout.prop(of, "radius")
        if is_curve:
            row = layout.row()
            row.active = of.radius > 0
            row.prop(of, "bevel_resolution")
        layout.prop(of, "follow")
