# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties of object.limit_bake_maps, and their layout."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from ..images.image_files import PATH_OPTIONS
from ..images.texture_operator import TextureProperties
from .maps import AREA_DISTORTION, KINDS, NORMAL_TANGENT

CURVATURES = {"CURVATURE_MEAN", "CURVATURE_GAUSSIAN", "CURVATURE_PRINCIPAL"}


class BakeProperties(TextureProperties):
    """Mixin for the operator."""

    maps: EnumProperty(
        name="Maps",
        description="Which maps are made, an image each",
        items=tuple(
            (key, kind.name, kind.description, "", 1 << i)
            for i, (key, kind) in enumerate(KINDS.items())
        ),
        options={"ENUM_FLAG"},
        default={NORMAL_TANGENT},
    )
    tiles: EnumProperty(
        name="Tiles",
        description="Which UDIM tiles of the UV map are made",
        items=(
            ("FIRST", "First", "What lies between (0, 0) and (1, 1), in plain images", "", 0),
            ("ALL", "All", "All that the UV map touches, in tiled images if it is several", "", 1),
        ),
        default="FIRST",
    )
    space: EnumProperty(
        name="Space",
        description="Of positions, normals, directions, and of the lengths that curvature is "
        "measured with. Normals in tangent space have none",
        items=(
            ("OBJECT", "Object", "The object's own, without its scale", "", 0),
            ("WORLD", "World", "The surface as it lies in the world", "", 1),
        ),
        default="OBJECT",
    )
    target: EnumProperty(
        name="Normals For",
        description="The mesh that will be shown with the tangent-space normals",
        items=(
            ("CAGE", "Control Mesh", "The mesh without its subdivision, for games", "", 0),
            ("VIEWPORT", "Viewport", "The mesh at the level that the viewport shows", "", 1),
            ("RENDER", "Render", "The mesh at the level that a render shows", "", 2),
        ),
        default="CAGE",
    )
    format: EnumProperty(
        name="Format",
        description="Of the images and their files",
        items=(
            ("EXR_32", "Float", "32-bit numbers as they are; OpenEXR files", "", 0),
            ("EXR_16", "Half Float", "The same, with files of 16 bits", "", 1),
            ("PNG_16", "16 Bits", "Colors from 0 to 1; PNG files", "", 2),
            ("PNG_8", "8 Bits", "Colors from 0 to 1 in 256 steps; PNG files", "", 3),
        ),
        default="EXR_32",
    )
    curvature_range: FloatProperty(
        name="Curvature Range",
        description="In 8 and 16 bits: curvature of so much is 1, of as much below zero 0, and "
        "zero is 0.5. Gaussian curvature: of its square. At 0 it is such that 95% fit",
        default=0.0,
        min=0.0,
        soft_max=100.0,
        precision=4,
    )
    cavity_radius: FloatProperty(
        name="Cavity Radius",
        description="A hollow of this radius is black. At 0 it is a twentieth of the surface's "
        "size",
        default=0.0,
        min=0.0,
        soft_max=10.0,
        subtype="DISTANCE",
    )
    distortion_range: FloatProperty(
        name="Distortion Range",
        description="In 8 and 16 bits: so many doublings of area or length are 1, as many halvings "
        "0, and none is 0.5",
        default=2.0,
        min=0.01,
        soft_max=8.0,
        max=16.0,
    )
    name: StringProperty(
        name="Name",
        description="What the images' names begin with. The object's name if it is empty",
    )
    reuse: BoolProperty(
        name="Reuse Images",
        description="Write into images of these names where there are ones, instead of new ones",
        default=True,
    )
    folder: StringProperty(
        name="Folder",
        description="Where the images are saved, each by its name. Files of these names are "
        "replaced. Without a folder nothing is saved",
        subtype="DIR_PATH",
        options=PATH_OPTIONS,
    )


def draw(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
    layout.use_property_split = False  # side by side the maps' names cannot be read
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
