# SPDX-License-Identifier: GPL-3.0-or-later
"""What becomes of things at their places: properties that snapping and dragging share."""

from bpy.props import EnumProperty, FloatProperty

ALIGNMENTS = (
    ("NONE", "None", "As it is", 0),
    ("NORMAL", "Normal", "Turned to the surface's normal by the smallest angle", 1),
    (
        "NORMAL_DU",
        "Normal and U",
        "To the normal, and X along growing u of the face. Strands that are on a surface already "
        "turn as much as its frame does",
        2,
    ),
)
HAIR = (
    ("ROOT", "Root", "The root alone", 0),
    ("STRAND", "Strand", "All of it", 1),
    ("BLEND", "Blend", "The root fully, the tip not at all", 2),
)


class PlacingProperties:
    """Mixin for operators."""

    offset: FloatProperty(
        name="Offset",
        description="Distance from the surface along its normal, in world units",
        default=0.0,
        subtype="DISTANCE",
    )
    align: EnumProperty(
        name="Align",
        description="Rotation of objects, strands and bones",
        items=ALIGNMENTS,
    )
    hair: EnumProperty(
        name="Hair",
        description="What of a strand moves",
        items=HAIR,
        default="STRAND",
    )
    target: EnumProperty(
        name="Put On",
        description="The surface is searched in any case; things can be put at the same place of "
        "the polygons that are shown instead",
        items=(
            ("LIMIT", "Limit Surface", "The exact surface", 0),
            ("VIEWPORT", "Viewport Mesh", "The polygons that the viewport shows", 1),
            ("RENDER", "Render Mesh", "The polygons that are rendered", 2),
        ),
    )
