# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties of object.limit_bake_maps, and their layout."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from ..images.image_files import PATH_OPTIONS
from ..images.texture_operator import TextureProperties
from .maps import AREA_DISTORTION, KINDS, NORMAL_TANGENT

CURVATURES = {"CURVATURE_MEAN", "CURVATURE_GAUSSIAN", "CURVATURE_PRINCIPAL"}


class BakeProperties(TextureProperties):
    """Mixin with the properties of the operator."""

    maps: EnumProperty(
        name="Maps",
        description="Maps to bake. Each becomes an image",
        items=tuple(
            (key, kind.name, kind.description, "", 1 << i)
            for i, (key, kind) in enumerate(KINDS.items())
        ),
        options={"ENUM_FLAG"},
        default={NORMAL_TANGENT},
    )
    tiles: EnumProperty(
        name="Tiles",
        description="UDIM tiles of the UV map to bake",
        items=(
            (
                "FIRST",
                "First",
                "Bake the part of the UV map between (0, 0) and (1, 1) into plain images",
                "",
                0,
            ),
            (
                "ALL",
                "All",
                "Bake all tiles in which the UV map covers texels, into tiled images unless 1001 "
                "is the only tile",
                "",
                1,
            ),
        ),
        default="FIRST",
    )
    space: EnumProperty(
        name="Space",
        description="Space of positions, normals and directions, and of the lengths by which "
        "curvature is measured. It does not affect tangent-space normals",
        items=(
            ("OBJECT", "Object", "Local space of the object, without its scale", "", 0),
            ("WORLD", "World", "World space, in which the object's scale counts", "", 1),
        ),
        default="OBJECT",
    )
    target: EnumProperty(
        name="Normals For",
        description="Mesh on which the tangent-space normals will be used",
        items=(
            ("CAGE", "Control Mesh", "The mesh before its subdivision, for games", "", 0),
            ("VIEWPORT", "Viewport", "The mesh at the viewport's subdivision level", "", 1),
            ("RENDER", "Render", "The mesh at the render's subdivision level", "", 2),
        ),
        default="CAGE",
    )
    format: EnumProperty(
        name="Format",
        description="Format of the images and of their files",
        items=(
            (
                "EXR_32",
                "Float",
                "Store the values themselves in 32-bit images and 32-bit OpenEXR files",
                "",
                0,
            ),
            (
                "EXR_16",
                "Half Float",
                "Store the values themselves in 32-bit images and 16-bit OpenEXR files",
                "",
                1,
            ),
            (
                "PNG_16",
                "16 Bits",
                "Map the values to 0 to 1, in float images and 16-bit PNG files",
                "",
                2,
            ),
            (
                "PNG_8",
                "8 Bits",
                "Map the values to 0 to 1, in 8-bit images and 8-bit PNG files",
                "",
                3,
            ),
        ),
        default="EXR_32",
    )
    curvature_range: FloatProperty(
        name="Curvature Range",
        description="Largest curvature that 8-bit and 16-bit images can show. They store it as "
        "1, its negative as 0, and zero curvature as 0.5. The largest Gaussian curvature is the "
        "square of this number. 0 chooses a range that contains 95% of the values",
        default=0.0,
        min=0.0,
        soft_max=100.0,
        precision=4,
    )
    cavity_radius: FloatProperty(
        name="Cavity Radius",
        description="Radius of a hollow that is shown as black. 0 chooses a twentieth of the "
        "surface's size",
        default=0.0,
        min=0.0,
        soft_max=10.0,
        subtype="DISTANCE",
    )
    distortion_range: FloatProperty(
        name="Distortion Range",
        description="Number of doublings of area or length that 8-bit and 16-bit images show as "
        "1. The same number of halvings is shown as 0, and no distortion as 0.5",
        default=2.0,
        min=0.01,
        soft_max=8.0,
        max=16.0,
    )
    name: StringProperty(
        name="Name",
        description="Beginning of the images' names. If empty, the object's name is used",
    )
    reuse: BoolProperty(
        name="Reuse Images",
        description="Write into existing images with the same names, instead of making new ones",
        default=True,
    )
    folder: StringProperty(
        name="Folder",
        description="Folder in which each image is saved under its name. Existing files with "
        "these names are replaced. If empty, no files are saved",
        subtype="DIR_PATH",
        options=PATH_OPTIONS,
    )


def draw(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
    layout.use_property_split = False  # the maps' names are too long to stand side by side
    names = layout.grid_flow(columns=2, even_columns=True, align=True)
    names.prop(properties, "maps")
    layout.use_property_split = True
    wanted = properties.maps
    size = layout.column(align=True)
    for name in ("width", "height", "margin"):
        size.prop(properties, name)
    for name in ("uv_map", "tiles", "overlap"):
        layout.prop(properties, name)
    if wanted - {NORMAL_TANGENT, AREA_DISTORTION}:
        layout.prop(properties, "space")
    if NORMAL_TANGENT in wanted:
        layout.prop(properties, "target")
    layout.prop(properties, "format")
    if "CAVITY" in wanted:
        layout.prop(properties, "cavity_radius")
    if properties.format.startswith("PNG"):
        if wanted & CURVATURES:
            layout.prop(properties, "curvature_range")
        if AREA_DISTORTION in wanted:
            layout.prop(properties, "distortion_range")
    for name in ("name", "reuse", "folder", "allow_large"):
        layout.prop(properties, name)
