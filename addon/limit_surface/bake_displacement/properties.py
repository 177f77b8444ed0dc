# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties of object.limit_bake_displacement, and their layout."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from ..counting import counted
from ..images.image_files import PATH_OPTIONS
from ..images.texture_operator import TextureProperties

FACE_RESOLUTIONS = tuple(2**exponent for exponent in range(11))


class DisplacementProperties(TextureProperties):
    """Mixin with the properties of the operator."""

    target: StringProperty(
        name="Sculpted",
        description="Name of the sculpted mesh, whose shape the image describes. If empty, "
        "the other selected mesh is used",
    )
    mode: EnumProperty(
        name="Displacement",
        description="What the image stores: vectors, or distances along the normal",
        items=(
            (
                "VECTOR",
                "Vector",
                "Store the vector from each place to the same place on the sculpted mesh, which "
                "has the same faces as the active mesh or is a subdivided copy of it",
                "",
                0,
            ),
            (
                "SCALAR",
                "Distance",
                "Store the distance along the exact normal to the sculpted surface, which may "
                "have any faces",
                "",
                1,
            ),
        ),
        default="VECTOR",
    )
    space: EnumProperty(
        name="Space",
        description="Axes of the stored vectors",
        items=(
            (
                "TANGENT",
                "Tangent",
                "Tangent, normal and bitangent, which a UV map determines",
                "",
                0,
            ),
            ("OBJECT", "Object", "Axes of the active object", "", 1),
        ),
        default="TANGENT",
    )
    target_shape: EnumProperty(
        name="Sculpted Surface",
        description="Which surface of the sculpted mesh is the target",
        items=(
            (
                "LIMIT",
                "Limit",
                "The limit surface of the sculpted mesh, with the settings of its own Subdivision "
                "Surface modifier",
                "",
                0,
            ),
            (
                "POLYGONS",
                "Polygons",
                "The polygons that the viewport shows after all modifiers, for example those of a "
                "sculpted mesh with Multiresolution enabled or applied",
                "",
                1,
            ),
        ),
        default="LIMIT",
    )
    transform: EnumProperty(
        name="Compare In",
        description="Space in which the two meshes are compared",
        items=(
            (
                "WORLD",
                "World Space",
                "Compare the meshes in world space, where the objects are",
                "",
                0,
            ),
            (
                "OWN",
                "Local Space",
                "Compare the meshes' own coordinates and ignore where the objects are, for a copy "
                "that was moved aside",
                "",
                1,
            ),
        ),
        default="WORLD",
    )
    max_distance: FloatProperty(
        name="Distance",
        description="Largest distance to the sculpted surface, in the active object's units. 0 "
        "means any distance",
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
    )
    direction: EnumProperty(
        name="Direction",
        description="Direction in which the sculpted surface is searched for",
        items=(
            (
                "BOTH",
                "Both",
                "Search along the normal and against it, and take the nearer point",
                "",
                0,
            ),
            ("OUTWARD", "Outward", "Search along the normal", "", 1),
            ("INWARD", "Inward", "Search against the normal", "", 2),
        ),
        default="BOTH",
    )
    layout_kind: EnumProperty(
        name="Layout",
        description="How places of the surface are arranged in the image",
        items=(
            ("UV", "UV Map", "Arrange them by the UV map on the limit surface", "", 0),
            (
                "PTEX",
                "Tile per Face",
                "Give each quad, and each corner of any other face, a square tile of its own "
                "(Ptex). No UV map is needed",
                "",
                1,
            ),
        ),
        default="UV",
    )
    use_tiles: BoolProperty(
        name="UDIM Tiles",
        description="Make a tiled image with all tiles in which the UV map covers texels, instead "
        "of an image of the first tile",
        default=False,
    )
    face_resolution: EnumProperty(
        name="Resolution",
        description="Resolution of each face's tile: the number of parts into which a side "
        "of the face is divided. The tile is one texel wider and higher than "
        "this number",
        items=tuple(
            (str(n), str(n), f"Divide each side of a face into {counted(n, 'parts')}", n)
            for n in FACE_RESOLUTIONS
        ),
        default="16",
    )
    image_name: StringProperty(
        name="Image",
        description="Name of the image. If empty, the image is named after the object",
    )
    reuse: BoolProperty(
        name="Reuse Image",
        description="Write into an existing image with the same name, instead of making a new one",
        default=True,
    )
    filepath: StringProperty(
        name="File",
        description="Path of the 32-bit OpenEXR file to save. <UDIM> in the path stands for a "
        "tile's number. If empty, the image is not saved",
        subtype="FILE_PATH",
        options=PATH_OPTIONS,
    )
    create_material: BoolProperty(
        name="Create Material",
        description="Link the image to the displacement of the active material, or of a new one, "
        "so that renders show the active mesh displaced",
        default=False,
    )


def draw(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
    """Draws the properties that have an effect with the current choices."""
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
    for name in ("image_name", "reuse", "filepath", "create_material", "allow_large"):
        column.prop(properties, name)
