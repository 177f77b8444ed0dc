# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that choose a source of numbers and its range, and their layout: the same for
everything that a source steers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
from bpy.props import EnumProperty, FloatVectorProperty, StringProperty

from .values import ValueChoice

_CHANNELS = (
    (
        "LUMINANCE",
        "Luminance",
        "Use the brightness: 0.2126 red + 0.7152 green + 0.0722 blue",
        "",
        0,
    ),
    ("RED", "Red", "Use the red channel", "", 1),
    ("GREEN", "Green", "Use the green channel", "", 2),
    ("BLUE", "Blue", "Use the blue channel", "", 3),
    ("ALPHA", "Alpha", "Use the alpha channel", "", 4),
)
_SOURCES = (
    ("VERTEX_GROUP", "Vertex Group", "Use the weights of a vertex group", "GROUP_VERTEX", 1),
    ("IMAGE", "Image", "Use an image that is placed by a UV map", "IMAGE_DATA", 2),
)
_COLOR_ATTRIBUTE = (
    "COLOR_ATTRIBUTE",
    "Color Attribute",
    "Use the colors of vertices or face corners",
    "GROUP_VCOL",
    3,
)
_ATTRIBUTE = (
    "ATTRIBUTE",
    "Attribute",
    "Use numbers or colors of vertices, face corners or faces",
    "SPREADSHEET",
    4,
)


@dataclass(frozen=True)
class SourceNames:
    """What a source steers, and the names of the properties that choose it."""

    subject: str  # the name of what is steered, as it begins error messages
    label: str
    source: str
    vertex_group: str
    image: str
    attribute: str
    channel: str
    range: str
    color_attribute: str = ""  # empty: attributes with colors are chosen as all others are
    invert: str = ""

    @classmethod
    def of(cls, prefix: str, label: str) -> SourceNames:
        parts = ("source", "vertex_group", "image", "attribute", "channel", "range")
        return cls(label, label, *(f"{prefix}_{part}" for part in parts))

    def properties(self, what: str, low: str, unsteered: str = "") -> dict[str, Any]:
        """Returns the annotations of a mixin class. `what` is steered; `low` says what its value
        is at the ends of the range, and `unsteered` what happens without a source, if that is not
        the same everywhere.
        """
        colors = (_COLOR_ATTRIBUTE,) if self.color_attribute else ()
        unsteered = unsteered or f"Use the same {what.removeprefix('the ')} everywhere"
        return {
            self.source: EnumProperty(
                name=f"{self.label} From",
                description=f"Where the numbers come from that make {what} differ from place to "
                "place",
                items=(
                    ("NONE", "None", unsteered, "", 0),
                    *_SOURCES,
                    *colors,
                    _ATTRIBUTE,
                ),
                default="NONE",
            ),
            self.vertex_group: StringProperty(
                name="Vertex Group",
                description=f"Name of the vertex group whose weights steer {what}. If empty, the "
                "active vertex group is used",
            ),
            self.image: StringProperty(
                name="Image", description=f"Name of the image that steers {what}"
            ),
            self.attribute: StringProperty(
                name="Attribute", description=f"Name of the attribute that steers {what}"
            ),
            self.channel: EnumProperty(
                name="Channel",
                description="Which channel of the colors is used. Images are read without "
                "color conversion; color attributes are linear",
                items=_CHANNELS,
                default="LUMINANCE",
            ),
            self.range: FloatVectorProperty(
                name="Range",
                description=f"{low} where the source is 0 (Low), and where it is 1 (High). For "
                "other values of the source, it changes in proportion",
                size=2,
                default=(0.0, 1.0),
                soft_min=0.0,
                soft_max=1.0,
            ),
        }

    def choice(self, properties: bpy.types.OperatorProperties) -> ValueChoice:
        """Returns what is chosen. The UV map and the extension of images are common to all
        sources.
        """
        source = getattr(properties, self.source)
        low, high = getattr(properties, self.range)
        if self.invert and getattr(properties, self.invert):
            low, high = high, low
        by_color = source == "COLOR_ATTRIBUTE"
        return ValueChoice(
            label=self.subject,
            source=source,
            vertex_group=getattr(properties, self.vertex_group),
            image=getattr(properties, self.image),
            uv_map=properties.uv_map,
            attribute=getattr(properties, self.color_attribute if by_color else self.attribute),
            channel=getattr(properties, self.channel),
            extension=properties.extension,
            low=low,
            high=high,
        )

    def names_of_active(
        self, properties: bpy.types.OperatorProperties, ob: bpy.types.Object
    ) -> dict[str, str]:
        """Returns the properties of what is chosen without a name, and the name of what is active
        on the object now. Choices that are used again later are stored with it: another group may
        be active then.
        """
        source = getattr(properties, self.source)
        group, color, uv_map = (
            ob.vertex_groups.active,
            ob.data.color_attributes.active_color,
            ob.data.uv_layers.active,
        )
        active = {
            "VERTEX_GROUP": (self.vertex_group, group),
            "COLOR_ATTRIBUTE": (self.color_attribute, color),
            "IMAGE": ("uv_map", uv_map),
        }
        name, used = active.get(source, ("", None))
        return {name: used.name} if used is not None and not getattr(properties, name) else {}

    def draw(
        self,
        layout: bpy.types.UILayout,
        properties: bpy.types.OperatorProperties,
        ob: bpy.types.Object | None,
    ) -> None:
        layout.prop(properties, self.source)
        source = getattr(properties, self.source)
        if source == "NONE":
            return
        mesh = ob and ob.data
        if source == "VERTEX_GROUP":
            search(layout, properties, self.vertex_group, ob, "vertex_groups")
        elif source == "IMAGE":
            search(layout, properties, self.image, bpy.data, "images")
        elif source == "ATTRIBUTE":
            search(layout, properties, self.attribute, mesh, "attributes")
        else:
            search(layout, properties, self.color_attribute, mesh, "color_attributes")
        if source != "VERTEX_GROUP":
            layout.prop(properties, self.channel)
        column = layout.column(align=True)
        column.prop(properties, self.range, index=0, text="Low")
        column.prop(properties, self.range, index=1, text="High")
        if self.invert:
            layout.prop(properties, self.invert)


class ImagePlaceProperties:
    """Mixin with the properties that place all images of an operator's sources."""

    uv_map: StringProperty(
        name="UV Map",
        description="Name of the UV map that places images. If empty, the active UV map is used",
    )
    extension: EnumProperty(
        name="Extension",
        description="What lies outside the borders of images",
        items=(
            ("REPEAT", "Repeat", "Repeat the image", "", 0),
            ("EXTEND", "Extend", "Extend the pixels at the image's border", "", 1),
            ("CLIP", "Clip", "Use the value 0", "", 2),
        ),
        default="REPEAT",
    )


def draw_image_place(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
    sources: Sequence[str],
) -> None:
    """Draws how images are placed, if one of these properties chooses an image."""
    if "IMAGE" in (getattr(properties, name) for name in sources):
        search(layout, properties, "uv_map", ob and ob.data, "uv_layers")
        layout.prop(properties, "extension")


def search(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    name: str,
    owner: bpy.types.bpy_struct | None,
    collection: str,
) -> None:
    """Draws a name with a list of the names in the owner's collection, if there is an owner."""
    if owner:
        layout.prop_search(properties, name, owner, collection)
    else:
        layout.prop(properties, name)
