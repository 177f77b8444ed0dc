# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties by which operators are told how to spread things, and their layout."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    StringProperty,
)

from ..errors import RefusalError
from .density import DensityChoice
from .distribution import Distribution
from .mask import MaskChoice

_MOST_SLOTS = 31  # choices that a property can hold at once
_slot_items: list[tuple[str, str, str, int]] = []  # Blender does not keep the strings


def _material_slots(
    properties: bpy.types.OperatorProperties, context: bpy.types.Context | None
) -> list[tuple[str, str, str, int]]:
    ob = surface_object(properties, context) if context else None
    slots = ob.material_slots[:_MOST_SLOTS] if ob else ()
    _slot_items[:] = [
        (str(i), f"{i}: {slot.name or 'empty'}", f"Faces of material slot {i}", 1 << i)
        for i, slot in enumerate(slots)
    ]
    return _slot_items


class DistributionProperties:
    """Mixin for operators."""

    distribution: EnumProperty(
        name="Distribution",
        description="How locations are spread over the surface",
        items=(
            (
                "JITTERED",
                "Jittered",
                "The same number on each face: one at a random place in each cell of a grid",
                "",
                0,
            ),
            (
                "UNIFORM",
                "Uniform",
                "Independent of each other, as many on any two parts of the same area",
                "",
                1,
            ),
            (
                "BLUE_NOISE",
                "Blue Noise",
                "Random, but evenly apart: none is nearer to another than a minimum distance",
                "",
                2,
            ),
        ),
        default="JITTERED",
    )
    per_side: IntProperty(
        name="Per Side",
        description="Cells along each side of a face, for Jittered: 20 makes 400 on every face "
        "with four corners, and as many at each corner of any other",
        default=20,
        min=1,
        max=10_000,
        soft_max=100,
    )
    amount: EnumProperty(
        name="Amount",
        description="What says how many there are, for Uniform and Blue Noise. A script may leave "
        "it out and give one of count, density and distance",
        items=(
            ("COUNT", "Count", "So many", "", 0),
            ("DENSITY", "Density", "So many for a square unit of area", "", 1),
            ("DISTANCE", "Distance", "As many as fit, so far apart: for Blue Noise", "", 2),
        ),
        default="COUNT",
    )
    count: IntProperty(
        name="Count",
        description="How many are made, all in all",
        default=1000,
        min=1,
        soft_max=1_000_000,
    )
    density: FloatProperty(
        name="Density",
        description="How many are made on each square unit in the world, whatever the object's "
        "scale; where a density source says less than 1, so much less",
        default=1000.0,
        min=1e-6,
        max=1e12,
        soft_max=1e6,
        precision=3,
    )
    distance: FloatProperty(
        name="Distance",
        description="Least distance from one to another in the world, whatever the object's "
        "scale; where a density source says less than its largest value, so much more that the "
        "density is in proportion",
        default=0.05,
        min=1e-6,
        soft_min=1e-3,
        soft_max=10.0,
        precision=4,
        subtype="DISTANCE",
    )
    seed: IntProperty(
        name="Seed",
        description="Another seed gives another random arrangement",
        default=0,
        min=0,
    )
    density_source: EnumProperty(
        name="Density From",
        description="What makes some parts denser than others",
        items=(
            ("NONE", "None", "The same density everywhere", "", 0),
            ("VERTEX_GROUP", "Vertex Group", "A vertex group's weights", "GROUP_VERTEX", 1),
            ("IMAGE", "Image", "An image, placed by a UV map", "IMAGE_DATA", 2),
            (
                "COLOR_ATTRIBUTE",
                "Color Attribute",
                "Colors of vertices or face corners",
                "GROUP_VCOL",
                3,
            ),
        ),
        default="NONE",
    )
    vertex_group: StringProperty(
        name="Vertex Group",
        description="Name of the vertex group whose weights are the density",
    )
    image: StringProperty(
        name="Image",
        description="Name of the image that holds the density",
    )
    uv_map: StringProperty(
        name="UV Map",
        description="Name of the UV map that places the image; empty: the active one",
    )
    color_attribute: StringProperty(
        name="Color Attribute",
        description="Name of the color attribute that holds the density",
    )
    channel: EnumProperty(
        name="Channel",
        description="What of a color is the density. Images count as their pixels' numbers are, "
        "whatever their color space; color attributes are linear",
        items=(
            ("LUMINANCE", "Luminance", "0.2126 red + 0.7152 green + 0.0722 blue", "", 0),
            ("RED", "Red", "", "", 1),
            ("GREEN", "Green", "", "", 2),
            ("BLUE", "Blue", "", "", 3),
            ("ALPHA", "Alpha", "", "", 4),
        ),
        default="LUMINANCE",
    )
    extension: EnumProperty(
        name="Extension",
        description="What is outside the image",
        items=(
            ("REPEAT", "Repeat", "The image again", "", 0),
            ("EXTEND", "Extend", "Its border's pixels", "", 1),
            ("CLIP", "Clip", "Nothing: density 0", "", 2),
        ),
        default="REPEAT",
    )
    invert: BoolProperty(
        name="Invert",
        description="1 minus the density that the source has",
        default=False,
    )
    material_slots: EnumProperty(
        name="Material Slots",
        description="Only faces of these material slots are covered; none chosen: of all",
        items=_material_slots,
        options={"ENUM_FLAG", "SKIP_SAVE"},
    )
    faces: EnumProperty(
        name="Faces",
        description="Which faces are covered",
        items=(
            ("ALL", "All", "All of them", "", 0),
            ("SELECTED", "Selected", "Those that were selected in Edit Mode", "", 1),
            ("ATTRIBUTE", "Attribute", "Those where an attribute is true", "", 2),
        ),
        default="ALL",
    )
    face_attribute: StringProperty(
        name="Face Attribute",
        description="Name of a Boolean attribute of faces: they are covered where it is true",
    )
    target: EnumProperty(
        name="Target",
        description="What roots lie on",
        items=(
            ("LIMIT", "Limit Surface", "The surface itself, which all subdivision leads to", "", 0),
            (
                "VIEWPORT",
                "Viewport Mesh",
                "At the same places of its faces, the polygons that the viewport shows",
                "",
                1,
            ),
            (
                "RENDER",
                "Render Mesh",
                "At the same places of its faces, the polygons that a render shows",
                "",
                2,
            ),
        ),
        default="LIMIT",
    )
    surface: StringProperty(
        name="Surface",
        description="The object that was covered",
        options={"HIDDEN", "SKIP_SAVE"},
    )


def distribution(properties: bpy.types.OperatorProperties) -> Distribution:
    """RefusalError where nobody could know what is meant."""
    numbers = ("per_side", "count", "density", "distance", "seed")
    return Distribution(
        kind=properties.distribution,
        amount=_amount(properties),
        **{name: getattr(properties, name) for name in numbers},
    )


def _amount(properties: bpy.types.OperatorProperties) -> str:
    if properties.distribution == "JITTERED" or properties.is_property_set("amount"):
        return properties.amount
    given = [n for n in ("count", "density", "distance") if properties.is_property_set(n)]
    if len(given) > 1:
        raise RefusalError(f"{' and '.join(given)} are given: say by amount which one counts")
    return given[0].upper() if given else properties.amount


def density_choice(properties: bpy.types.OperatorProperties) -> DensityChoice:
    names = ("vertex_group", "image", "uv_map", "color_attribute", "channel", "extension", "invert")
    source = properties.density_source
    return DensityChoice(source, **{name: getattr(properties, name) for name in names})


def mask_choice(properties: bpy.types.OperatorProperties) -> MaskChoice:
    slots = frozenset(int(slot) for slot in properties.material_slots)
    return MaskChoice(slots, properties.faces, properties.face_attribute)


def surface_object(
    properties: bpy.types.OperatorProperties, context: bpy.types.Context
) -> bpy.types.Object | None:
    """The mesh that is covered: right after that, what covers it is active."""
    ob = bpy.data.objects.get(properties.surface) or context.active_object
    return ob if ob and ob.type == "MESH" else None


def draw(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    context: bpy.types.Context,
) -> None:
    layout.prop(properties, "distribution")
    if properties.distribution == "JITTERED":
        layout.prop(properties, "per_side")
    else:
        layout.prop(properties, "amount")
        layout.prop(properties, properties.amount.lower())
    layout.prop(properties, "seed")
    ob = surface_object(properties, context)
    _draw_density(layout, properties, ob)
    _draw_mask(layout, properties, ob)
    layout.prop(properties, "target")


def _draw_density(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
) -> None:
    layout.prop(properties, "density_source")
    source = properties.density_source
    if source == "NONE":
        return
    if source == "VERTEX_GROUP":
        _search(layout, properties, "vertex_group", ob, "vertex_groups")
    elif source == "IMAGE":
        _search(layout, properties, "image", bpy.data, "images")
        _search(layout, properties, "uv_map", ob and ob.data, "uv_layers")
        layout.prop(properties, "extension")
    else:
        _search(layout, properties, "color_attribute", ob and ob.data, "color_attributes")
    if source != "VERTEX_GROUP":
        layout.prop(properties, "channel")
    layout.prop(properties, "invert")


def _draw_mask(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
) -> None:
    if ob and len(ob.material_slots) > 1:
        layout.column().prop(properties, "material_slots")
    layout.prop(properties, "faces")
    if properties.faces == "ATTRIBUTE":
        _search(layout, properties, "face_attribute", ob and ob.data, "attributes")


def _search(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    name: str,
    owner: bpy.types.bpy_struct | None,
    collection: str,
) -> None:
    if owner:
        layout.prop_search(properties, name, owner, collection)
    else:
        layout.prop(properties, name)
