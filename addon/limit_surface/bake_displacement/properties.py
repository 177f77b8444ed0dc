# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties of object.limit_bake_displacement, and their layout."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from ..images.image_files import PATH_OPTIONS
from ..images.texture_operator import TextureProperties

FACE_RESOLUTIONS = tuple(2**exponent for exponent in range(11))


class DisplacementProperties(TextureProperties):
    """Mixin for the operator."""

    target: StringProperty(
        name="Sculpted",
        description="Name of the mesh that the active one is to become. Without one it is the "
        "other selected mesh",
    )
    mode: EnumProperty(
        name="Displacement",
        description="What the image holds",
        items=(
            (
                "VECTOR",
                "Vector",
                "From every place to the same place on the sculpted mesh, which has the same "
                "faces, or those of the active mesh subdivided",
                "",
                0,
            ),
            (
                "SCALAR",
                "Distance",
                "Along the exact normal to the sculpted surface, whatever its faces",
                "",
                1,
            ),
        ),
        default="VECTOR",
    )
    space: EnumProperty(
        name="Space",
        description="Which axes vectors are given in",
        items=(
            ("TANGENT", "Tangent", "Tangent, normal, bitangent: a UV map gives them", "", 0),
            ("OBJECT", "Object", "The active object's axes", "", 1),
        ),
        default="TANGENT",
    )
    target_shape: EnumProperty(
        name="Sculpted Surface",
        description="What of the sculpted mesh counts",
        items=(
            ("LIMIT", "Limit", "Its limit surface, by the rules of its own modifier", "", 0),
            (
                "POLYGONS",
                "Polygons",
                "Its polygons as the viewport shows them, behind all modifiers: for a sculpt in "
                "Multiresolution, switched on or applied",
                "",
                1,
            ),
        ),
        default="LIMIT",
    )
    transform: EnumProperty(
        name="Sculpted Lies",
        description="Where the sculpted mesh is taken to be",
        items=(
            ("WORLD", "Where It Is", "As both are seen in the world", "", 0),
            (
                "OWN",
                "In the Same Place",
                "Both objects' own coordinates count: for a copy that was moved aside",
                "",
                1,
            ),
        ),
        default="WORLD",
    )
    max_distance: FloatProperty(
        name="Distance",
        description="How far away the sculpted surface may be, in the active object's units. 0 is "
        "any distance",
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
    )
    direction: EnumProperty(
        name="Direction",
        description="Which way the sculpted surface is looked for",
        items=(
            ("BOTH", "Both", "The nearer of both ways", "", 0),
            ("OUTWARD", "Outward", "Along the normal", "", 1),
            ("INWARD", "Inward", "Against the normal", "", 2),
        ),
        default="BOTH",
    )
    layout_kind: EnumProperty(
        name="Layout",
        description="How places are found on the image",
        items=(
            ("UV", "UV Map", "By a UV map, as it is on the limit surface", "", 0),
            ("PTEX", "Tile per Face", "A tile for each Ptex face, whatever the UV map", "", 1),
        ),
        default="UV",
    )
    use_tiles: BoolProperty(
        name="UDIM Tiles",
        description="An image with all tiles that the UV map touches, instead of the first alone",
        default=False,
    )
    face_resolution: EnumProperty(
        name="Resolution",
        description="Parts along the side of each Ptex face; its tile has one texel more",
        items=tuple((str(n), str(n), "", n) for n in FACE_RESOLUTIONS),
        default="16",
    )
    image_name: StringProperty(
        name="Image", description="Name of the new image. Without one it is named after the mesh"
    )
    filepath: StringProperty(
        name="File",
        description="Where the image is saved, as a 32-bit OpenEXR file. <UDIM> in the path stands "
        "for a tile's number. Without a path it is not saved",
        subtype="FILE_PATH",
        options=PATH_OPTIONS,
    )
    create_material: BoolProperty(
        name="Create Material",
        description="Displace the active mesh when it is rendered: link the image to the "
        "displacement of the active material, or of a new one",
        default=False,
    )


def draw(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
    """What counts, and no more."""
    column = layout.column()
    column.prop_search(properties, "target", bpy.data, "objects", icon="MESH_DATA")
    for name in ("target_shape", "transform", "mode"):
        column.prop(properties, name)
    for name in ("space",) if properties.mode == "VECTOR" else ("direction", "max_distance"):
        column.prop(properties, name)
    column = layout.column()
    column.prop(properties, "layout_kind")
    column.prop(properties, "uv_map")
    if properties.layout_kind == "UV":
        for name in ("width", "height", "margin", "use_tiles", "overlap"):
            column.prop(properties, name)
    else:
        column.prop(properties, "face_resolution")
    column = layout.column()
    for name in ("image_name", "filepath", "create_material", "allow_large"):
        column.prop(properties, name)
