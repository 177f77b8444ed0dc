# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that choose how things are distributed, and their layout."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    StringProperty,
)

from ..errors import RefusalError
from ..sources import value_properties
from ..sources.value_properties import SourceNames
from . import border_properties
from .density import DensityChoice
from .distribution import Distribution
from .followers import ground_of
from .mask import MaskChoice

_MOST_SLOTS = 31  # the number of choices that one property can hold
_slot_items: list[tuple[str, str, str, int]] = []  # Blender keeps no references to the strings


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


DENSITY = SourceNames(
    subject="",
    label="Density",
    source="density_source",
    vertex_group="vertex_group",
    image="image",
    attribute="attribute",
    channel="channel",
    range="density_range",
    color_attribute="color_attribute",
    invert="invert",
)


class DensityProperties(value_properties.ImagePlaceProperties):
    """Mixin with the properties that choose the source of a density."""

    __annotations__ = DENSITY.properties("the density", "Density")  # noqa: RUF012


class DistributionProperties(DensityProperties, border_properties.BorderProperties):
    """Mixin with the properties of operators that distribute things."""

    distribution: EnumProperty(
        name="Distribution",
        description="How strands or points are distributed over the surface",
        items=(
            (
                "JITTERED",
                "Jittered",
                "Divide each face into equal squares, and put one strand or point at a random "
                "place in each",
                "",
                0,
            ),
            (
                "UNIFORM",
                "Uniform",
                "Place each strand or point independently of the others, so that parts of equal "
                "area get equal numbers on average",
                "",
                1,
            ),
            (
                "BLUE_NOISE",
                "Blue Noise",
                "Place strands or points at random, but no two closer to each other than a minimum "
                "distance",
                "",
                2,
            ),
            (
                "BORDER",
                "Border",
                "Place strands or points evenly along boundaries, creases or other edges",
                "",
                3,
            ),
        ),
        default="JITTERED",
    )
    per_side: IntProperty(
        name="Per Side",
        description="Number of squares along each side of a face, for Jittered. 20 makes 400 "
        "squares on each quad, and 400 for each corner of any other face",
        default=20,
        min=1,
        max=10_000,
        soft_max=100,
    )
    amount: EnumProperty(
        name="Amount",
        description="Which setting determines the number of strands or points. Jittered uses Per "
        "Side instead. Scripts can leave Amount out and set one of count, density and distance",
        items=(
            ("COUNT", "Count", "Make exactly the number that Count gives", "", 0),
            (
                "DENSITY",
                "Density",
                "Make the number that Density gives on each square unit of area, for Uniform and "
                "Blue Noise",
                "",
                1,
            ),
            (
                "DISTANCE",
                "Distance",
                "Make as many as fit if neighbors are as far apart as Distance says, for Blue "
                "Noise and Border",
                "",
                2,
            ),
        ),
        default="COUNT",
    )
    count: IntProperty(
        name="Count",
        description="Total number of strands or points",
        default=1000,
        min=1,
        soft_max=1_000_000,
    )
    density: FloatProperty(
        name="Density",
        description="Number of strands or points on each square unit of area in world space. A "
        "density source multiplies it by values from 0 to 1",
        default=1000.0,
        min=1e-6,
        max=1e12,
        soft_max=1e6,
        precision=3,
    )
    distance: FloatProperty(
        name="Distance",
        description="For Blue Noise, the minimum distance between any two strands or points in "
        "world space. Where a density source is lower, the distance is larger. For Border, the "
        "length of the border between neighbors",
        default=0.05,
        min=1e-6,
        soft_min=1e-3,
        soft_max=10.0,
        precision=4,
        subtype="DISTANCE",
    )
    seed: IntProperty(
        name="Seed",
        description="Seed of the random numbers. Each seed gives another random arrangement",
        default=0,
        min=0,
    )
    color_attribute: StringProperty(
        name="Color Attribute",
        description="Name of the color attribute that steers the density. If empty, the active "
        "color attribute is used",
    )
    invert: BoolProperty(
        name="Invert",
        description="Use 1 minus the number that the source gives",
        default=False,
    )
    material_slots: EnumProperty(
        name="Material Slots",
        description="Material slots on whose faces strands or points stand. If none is chosen, "
        "they stand on the faces of all slots",
        items=_material_slots,
        options={"ENUM_FLAG", "SKIP_SAVE"},
    )
    faces: EnumProperty(
        name="Faces",
        description="Faces on which strands or points stand",
        items=(
            ("ALL", "All", "Use all faces", "", 0),
            ("SELECTED", "Selected", "Use the faces that were selected in Edit Mode", "", 1),
            ("ATTRIBUTE", "Attribute", "Use the faces where an attribute is true", "", 2),
        ),
        default="ALL",
    )
    face_attribute: StringProperty(
        name="Face Attribute",
        description="Name of a Boolean face attribute. Strands or points stand where it is true",
    )
    target: EnumProperty(
        name="Target",
        description="Surface on which roots and points lie",
        items=(
            (
                "LIMIT",
                "Limit Surface",
                "Put roots and points exactly on the limit surface, the smooth surface that "
                "infinitely many subdivisions approach",
                "",
                0,
            ),
            (
                "VIEWPORT",
                "Viewport Mesh",
                "Put roots and points on the polygons that the viewport shows, at the same places "
                "of the faces",
                "",
                1,
            ),
            (
                "RENDER",
                "Render Mesh",
                "Put roots and points on the polygons that a render shows, at the same places of "
                "the faces",
                "",
                2,
            ),
        ),
        default="LIMIT",
    )
    surface: StringProperty(
        name="Surface",
        description="Object that was covered",
        options={"HIDDEN", "SKIP_SAVE"},
    )


def distribution(properties: bpy.types.OperatorProperties) -> Distribution:
    """Returns the chosen distribution. Raises RefusalError where the properties contradict each
    other.
    """
    numbers = ("per_side", "count", "density", "distance", "seed")
    return Distribution(
        kind=properties.distribution,
        amount=_amount(properties),
        border=border_properties.layout_of(properties),
        turn=border_properties.turn_of(properties),
        **{name: getattr(properties, name) for name in numbers},
    )


def _amount(properties: bpy.types.OperatorProperties) -> str:
    if properties.distribution == "JITTERED" or properties.is_property_set("amount"):
        return properties.amount
    given = [n for n in ("count", "density", "distance") if properties.is_property_set(n)]
    if len(given) > 1:
        raise RefusalError(
            f"{' and '.join(given)} are given: choose one of them with the property amount"
        )
    return given[0].upper() if given else properties.amount


def density_choice(properties: bpy.types.OperatorProperties) -> DensityChoice:
    return DensityChoice(DENSITY.choice(properties))


def mask_choice(properties: bpy.types.OperatorProperties) -> MaskChoice:
    slots = frozenset(int(slot) for slot in properties.material_slots)
    return MaskChoice(slots, properties.faces, properties.face_attribute)


def surface_object(
    properties: bpy.types.OperatorProperties, context: bpy.types.Context
) -> bpy.types.Object | None:
    """Returns the mesh that is covered. After the operator has run, the new object that covers it
    is active.
    """
    return ground_of(bpy.data.objects.get(properties.surface) or context.active_object)


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
    if properties.distribution == "BORDER":
        border_properties.draw(layout, properties)
    layout.prop(properties, "seed")
    ob = surface_object(properties, context)
    DENSITY.draw(layout, properties, ob)
    value_properties.draw_image_place(layout, properties, ob, [DENSITY.source])
    _draw_mask(layout, properties, ob)
    layout.prop(properties, "target")


def _draw_mask(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
) -> None:
    if ob and len(ob.material_slots) > 1:
        layout.column().prop(properties, "material_slots")
    layout.prop(properties, "faces")
    if properties.faces == "ATTRIBUTE":
        value_properties.search(layout, properties, "face_attribute", ob and ob.data, "attributes")
