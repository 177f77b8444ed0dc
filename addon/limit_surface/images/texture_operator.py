# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts that all operators share which make textures: properties, and the dialog that shows
them.
"""

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from ..tasks.properties import draw_summary
from ..tasks.watched_operator import WatchedOperator

LARGEST = 16384  # texels along a side


class TextureProperties:
    """Mixin with the properties that these operators share."""

    width: IntProperty(
        name="Width",
        description="Size of new images, or of each of their tiles, in texels",
        default=1024,
        min=1,
        max=LARGEST,
        subtype="PIXEL",
    )
    height: IntProperty(
        name="Height",
        description="Size of new images, or of each of their tiles, in texels",
        default=1024,
        min=1,
        max=LARGEST,
        subtype="PIXEL",
    )
    margin: IntProperty(
        name="Margin",
        description="Number of texels around the UV map's islands that are filled from the "
        "nearest place on an island, so that no seams are visible",
        default=16,
        min=0,
        max=256,
        subtype="PIXEL",
    )
    uv_map: StringProperty(
        name="UV Map",
        description="Name of the UV map that places the texels. If empty, the active UV map is "
        "used",
    )
    overlap: EnumProperty(
        name="Overlap",
        description="What happens where several places of the surface share texels on the UV map",
        items=(
            (
                "ERROR",
                "Refuse",
                "Stop with an error if more than one texel in 500 is shared. If fewer are "
                "shared, as at folded corners of islands, these texels show the face with "
                "the lowest number, and a warning says how many there are",
                "",
                0,
            ),
            ("ALLOW", "Allow", "Show the face with the lowest number in these texels", "", 1),
        ),
        default="ERROR",
    )
    allow_large: BoolProperty(
        name="Allow Large Images",
        description="Allow images that take gigabytes of memory",
        default=False,
        options={"SKIP_SAVE"},
    )


class TextureOperator(WatchedOperator):
    """Mixin that opens a dialog with the operator's properties before it runs.

    `tasks/watched_operator.py` says where this stands among the steps of an operator. A subclass
    also inherits from TextureProperties, and lays its properties out in `draw_properties`.
    """

    bl_options = {"REGISTER", "UNDO"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self._someone_waits = True
        return context.window_manager.invoke_props_dialog(self, width=380)

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.draw_properties()
        draw_summary(self.layout, self.summary)

    def draw_properties(self) -> None:
        raise NotImplementedError
