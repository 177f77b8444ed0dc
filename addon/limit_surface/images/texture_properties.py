# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that all operators that make textures have."""

from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

LARGEST = 16384  # texels along a side


class TextureProperties:
    """Mixin for the operators."""

    width: IntProperty(
        name="Width",
        description="Of new images, or of each of their tiles, in texels",
        default=1024,
        min=1,
        max=LARGEST,
        subtype="PIXEL",
    )
    height: IntProperty(
        name="Height",
        description="Of new images, or of each of their tiles, in texels",
        default=1024,
        min=1,
        max=LARGEST,
        subtype="PIXEL",
    )
    margin: IntProperty(
        name="Margin",
        description="So many texels around the UV map's islands take what is nearest on them, so "
        "that no seams are seen",
        default=16,
        min=0,
        max=256,
        subtype="PIXEL",
    )
    uv_map: StringProperty(
        name="UV Map",
        description="Name of the UV map that places the texels. Without one the active map is "
        "taken",
    )
    overlap: EnumProperty(
        name="Overlap",
        description="If several places of the surface share texels on the UV map",
        items=(
            (
                "ERROR",
                "Refuse",
                "Nothing is made, unless it is no more than one texel in 500, where a map folds at "
                "the corners of its islands: then the face with the lowest number counts, and a "
                "warning says how many texels there are",
                "",
                0,
            ),
            ("ALLOW", "Allow", "The place on the face with the lowest number counts", "", 1),
        ),
        default="ERROR",
    )
    allow_large: BoolProperty(
        name="Allow Large Images",
        description="Make what takes gigabytes of memory",
        default=False,
        options={"SKIP_SAVE"},
    )
    summary: StringProperty(
        name="Result",
        description="What the operator made",
        options={"HIDDEN", "SKIP_SAVE"},
    )
