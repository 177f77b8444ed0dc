# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that snapping and dragging share: what is done with things at their new places."""

from bpy.props import EnumProperty, FloatProperty

ALIGNMENTS = (
    ("NONE", "None", "Keep the rotation", 0),
    ("NORMAL", "Normal", "Turn to the surface normal by the smallest angle", 1),
    (
        "NORMAL_DU",
        "Normal and U",
        "Turn to the surface normal, with X along u of the face, on a quad from its first corner "
        "to its second one. Strands that are bound to a surface turn as the surface turns between "
        "their old and new places",
        2,
    ),
)
HAIR = (
    ("ROOT", "Root", "Move only the root", 0),
    ("STRAND", "Strand", "Move the whole strand", 1),
    (
        "BLEND",
        "Blend",
        "Move the root fully, the points along the strand less and less, and the tip not at all",
        2,
    ),
)


class PlacingProperties:
    """Mixin with properties for operators."""

    offset: FloatProperty(
        name="Offset",
        description="Distance from the surface along its normal, in world units",
        default=0.0,
        subtype="DISTANCE",
    )
    align: EnumProperty(
        name="Align",
        description="How objects, strands and bones are rotated",
        items=ALIGNMENTS,
    )
    hair: EnumProperty(
        name="Hair",
        description="Which part of a strand moves",
        items=HAIR,
        default="STRAND",
    )
    target: EnumProperty(
        name="Put On",
        description="Where things are put: on the limit surface itself, or at the same place of "
        "the displayed polygons",
        items=(
            ("LIMIT", "Limit Surface", "Put things on the exact surface", 0),
            ("VIEWPORT", "Viewport Mesh", "Put things on the polygons that the viewport shows", 1),
            ("RENDER", "Render Mesh", "Put things on the polygons that a render shows", 2),
        ),
    )
