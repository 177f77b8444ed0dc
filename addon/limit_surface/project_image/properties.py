# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties of object.limit_project_image, and their layout."""

import bpy
import numpy as np
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    StringProperty,
)

from ..images.texture_operator import TextureProperties

# Sources that throw the image from somewhere: rays can be followed through its pixels.
THROWN = {"CAMERA", "VIEW", "PLANAR"}


class ProjectionProperties(TextureProperties):
    """Mixin for the operator."""

    source: EnumProperty(
        name="From",
        description="Where the image is projected from",
        items=(
            ("CAMERA", "Camera", "A camera with its lens and shift, as it would render", "", 0),
            ("VIEW", "View", "The 3D view, the image as large as fits into it", "", 1),
            ("PLANAR", "Empty, Planar", "An empty's x-y plane, along its -Z", "", 2),
            ("BOX", "Empty, Box", "All six sides of an empty's box, mixed by the normal", "", 3),
            ("NORMALS", "Other Surface", "Along normals, from another mesh's texture", "", 4),
        ),
        default="CAMERA",
    )
    image: StringProperty(name="Image", description="Name of the image that is projected")
    camera: StringProperty(
        name="Camera", description="Name of the camera. Without one the scene's is taken"
    )
    empty: StringProperty(
        name="Empty",
        description="Name of the empty. An image empty projects from the rectangle that it shows, "
        "others from the square, or the cube, of their size",
    )
    from_object: StringProperty(
        name="Object",
        description="Name of the mesh whose limit surface carries the image, by its active UV map",
    )
    mode: EnumProperty(
        name="Result",
        description="What becomes of the projected image",
        items=(
            ("TEXTURE", "Texture", "It is painted into an image, by a UV map", "", 0),
            ("DECAL", "Decal", "A new mesh that lies on the surface, with a UV map", "", 1),
        ),
        default="TEXTURE",
    )
    output: EnumProperty(
        name="Paint Into",
        description="Which image takes the texture",
        items=(
            ("NEW", "New Image", "A new one, transparent where nothing is projected", "", 0),
            ("EXISTING", "Existing Image", "One that is there, over its pixels", "", 1),
        ),
        default="NEW",
    )
    target: StringProperty(
        name="Texture", description="Name of the image to paint into, or of the new one"
    )
    use_float: BoolProperty(
        name="32-bit Float",
        description="A new image has floating point numbers instead of 8 bits",
        default=False,
    )
    opacity: FloatProperty(
        name="Opacity",
        description="How much of the texture the projected image hides",
        default=1.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    extension: EnumProperty(
        name="Outside",
        description="What is projected outside the image",
        items=(
            ("CLIP", "Clip", "Nothing", "", 0),
            ("EXTEND", "Extend", "The pixels along its border", "", 1),
            ("REPEAT", "Repeat", "The image again and again", "", 2),
            ("MIRROR", "Mirror", "The image again and again, every other time mirrored", "", 3),
        ),
        default="CLIP",
    )
    facing: FloatVectorProperty(
        name="Facing",
        description="Angles between the surface's normal and the direction it is seen from: up to "
        "the first the image is projected fully, from the second on not at all",
        size=2,
        default=(np.radians(75), np.radians(88)),
        min=0.0,
        max=np.pi / 2,
        subtype="EULER",
        unit="ROTATION",
    )
    two_sided: BoolProperty(
        name="Two-Sided",
        description="Project onto the surface's inner side, too",
        default=False,
    )
    occlusion: BoolProperty(
        name="Occlusion",
        description="Not onto what the surface hides behind itself",
        default=True,
    )
    occlusion_samples: EnumProperty(
        name="Samples",
        description="Rays for each texel, for smooth borders of what is hidden",
        items=(("1", "1", "", 1), ("4", "4", "", 4), ("16", "16", "", 16)),
        default="4",
    )
    soft_edge: FloatProperty(
        name="Soft Edge",
        description="Part of the image's width and height over which it fades in from its borders",
        default=0.0,
        min=0.0,
        max=0.5,
        subtype="FACTOR",
    )
    use_depth: BoolProperty(
        name="Limit Depth",
        description="Project only between two distances from the empty's plane",
        default=False,
    )
    depth: FloatVectorProperty(
        name="Depth",
        description="These distances, in world units along the empty's -Z",
        size=2,
        default=(0.0, 1.0),
        subtype="XYZ_LENGTH",
    )
    blend: FloatProperty(
        name="Blend",
        description="How softly the box's sides are mixed: at 0 every place takes the side that it "
        "faces most",
        default=0.2,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    max_distance: FloatProperty(
        name="Distance",
        description="How far away the other surface may be, in world units. 0 is any distance",
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
    )
    direction: EnumProperty(
        name="Direction",
        description="Which way the other surface is looked for",
        items=(
            ("BOTH", "Both", "The nearer of both ways", "", 0),
            ("OUTWARD", "Outward", "Along the normal", "", 1),
            ("INWARD", "Inward", "Against the normal", "", 2),
        ),
        default="BOTH",
    )
    decal_resolution: IntProperty(
        name="Resolution",
        description="Polygons of the decal along the image's longer side",
        default=64,
        min=1,
        max=2048,
        soft_max=256,
    )
    decal_offset: FloatProperty(
        name="Offset",
        description="How far above the surface the decal lies, in world units",
        default=0.001,
        soft_min=-0.1,
        soft_max=0.1,
        precision=4,
        subtype="DISTANCE",
    )
    create_material: BoolProperty(
        name="Create Material",
        description="Show the result: lay it over the base color of the active material, or of "
        "a new one",
        default=False,
    )


def draw(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
    """What counts, and no more."""
    column = layout.column()
    column.prop(properties, "source")
    column.prop_search(properties, "image", bpy.data, "images")
    if properties.source == "CAMERA":
        column.prop_search(properties, "camera", bpy.data, "objects", icon="CAMERA_DATA")
    elif properties.source in {"PLANAR", "BOX"}:
        column.prop_search(properties, "empty", bpy.data, "objects", icon="EMPTY_DATA")
    elif properties.source == "NORMALS":
        column.prop_search(properties, "from_object", bpy.data, "objects", icon="MESH_DATA")
        column.prop(properties, "max_distance")
        column.prop(properties, "direction")
    column.prop(properties, "mode")
    if properties.mode == "DECAL":
        column.prop(properties, "decal_resolution")
        column.prop(properties, "decal_offset")
    else:
        _draw_texture(layout.column(), properties)
    _draw_coverage(layout.column(), properties)
    layout.prop(properties, "create_material")
    layout.prop(properties, "allow_large")


def _draw_texture(column: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
    column.prop(properties, "output")
    if properties.output == "EXISTING":
        column.prop_search(properties, "target", bpy.data, "images")
    else:
        column.prop(properties, "target")
        for name in ("width", "height", "use_float"):
            column.prop(properties, name)
    for name in ("uv_map", "margin", "overlap", "opacity", "extension"):
        column.prop(properties, name)


def _draw_coverage(column: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
    if properties.source == "BOX":
        column.prop(properties, "blend")
    if properties.source not in THROWN:
        return
    column.prop(properties, "facing", index=0, text="Full Up To")
    column.prop(properties, "facing", index=1, text="Nothing From")
    column.prop(properties, "two_sided")
    if properties.mode == "TEXTURE":
        column.prop(properties, "soft_edge")
        column.prop(properties, "occlusion")
        if properties.occlusion:
            column.prop(properties, "occlusion_samples")
    if properties.source == "PLANAR":
        column.prop(properties, "use_depth")
        if properties.use_depth:
            column.prop(properties, "depth")
