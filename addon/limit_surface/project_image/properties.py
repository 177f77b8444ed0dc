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
from ..placing.follow_properties import FollowProperties

# Sources that project the image along rays through its pixels.
ALONG_RAYS = {"CAMERA", "VIEW", "PLANAR"}


class ProjectionProperties(TextureProperties, FollowProperties):
    """Mixin with the properties of the operator."""

    source: EnumProperty(
        name="From",
        description="What projects the image",
        items=(
            (
                "CAMERA",
                "Camera",
                "Project from a camera, with its lens and shift as in a render",
                "",
                0,
            ),
            (
                "VIEW",
                "View",
                "Project from the 3D view, with the image as large as fits into it",
                "",
                1,
            ),
            (
                "PLANAR",
                "Empty, Planar",
                "Project from an empty's x-y plane, along its -Z axis",
                "",
                2,
            ),
            (
                "BOX",
                "Empty, Box",
                "Project from all six sides of an empty's box, blended by the surface normal",
                "",
                3,
            ),
            (
                "NORMALS",
                "Other Surface",
                "Project the texture of another mesh, along the normals",
                "",
                4,
            ),
        ),
        default="CAMERA",
    )
    image: StringProperty(name="Image", description="Name of the image that is projected")
    camera: StringProperty(
        name="Camera", description="Name of the camera. If empty, the camera of the scene is used"
    )
    empty: StringProperty(
        name="Empty",
        description="Name of the empty. An image empty projects from the rectangle of its image, "
        "other empties from a square or a cube of their size",
    )
    from_object: StringProperty(
        name="Object",
        description="Name of the mesh object whose limit surface shows the image by its active UV "
        "map",
    )
    mode: EnumProperty(
        name="Result",
        description="What the operator makes from the projected image",
        items=(
            ("TEXTURE", "Texture", "Paint it into an image, by a UV map", "", 0),
            ("DECAL", "Decal", "Make a new mesh that lies on the surface and has a UV map", "", 1),
        ),
        default="TEXTURE",
    )
    output: EnumProperty(
        name="Paint Into",
        description="Image into which the projection is painted",
        items=(
            (
                "NEW",
                "New Image",
                "Make a new image, which is transparent where nothing is projected",
                "",
                0,
            ),
            ("EXISTING", "Existing Image", "Paint over the pixels of an existing image", "", 1),
        ),
        default="NEW",
    )
    target: StringProperty(
        name="Texture", description="Name of the image to paint into, or of the new image"
    )
    use_float: BoolProperty(
        name="32-bit Float",
        description="Make the new image with 32-bit float pixels instead of 8-bit ones",
        default=False,
    )
    opacity: FloatProperty(
        name="Opacity",
        description="Opacity of the projected image over the texture",
        default=1.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    extension: EnumProperty(
        name="Outside",
        description="What is projected outside the borders of the image",
        items=(
            ("CLIP", "Clip", "Project nothing", "", 0),
            ("EXTEND", "Extend", "Extend the pixels along its border", "", 1),
            ("REPEAT", "Repeat", "Repeat the image", "", 2),
            ("MIRROR", "Mirror", "Repeat the image and mirror every second copy", "", 3),
        ),
        default="CLIP",
    )
    facing: FloatVectorProperty(
        name="Facing",
        description="Two angles between the surface normal and the direction to the camera or "
        "other projector. Up to the first angle the image is projected fully, from the second one "
        "on not at all, and between them it fades",
        size=2,
        default=(np.radians(75), np.radians(88)),
        min=0.0,
        max=np.pi / 2,
        subtype="EULER",
        unit="ROTATION",
    )
    two_sided: BoolProperty(
        name="Two-Sided",
        description="Project onto the inner side of the surface, too",
        default=False,
    )
    occlusion: BoolProperty(
        name="Occlusion",
        description="Do not project onto parts that the surface itself hides",
        default=True,
    )
    occlusion_samples: EnumProperty(
        name="Samples",
        description="Number of rays for each texel. More rays make the borders of hidden parts "
        "smoother",
        items=(
            ("1", "1", "Cast one ray for each texel: the fastest choice", 1),
            ("4", "4", "Cast 4 rays for each texel", 4),
            ("16", "16", "Cast 16 rays for each texel: the smoothest choice", 16),
        ),
        default="4",
    )
    soft_edge: FloatProperty(
        name="Soft Edge",
        description="Share of the image's width and height over which it fades out towards its "
        "borders",
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
        description="The two distances, in world units along the empty's -Z axis",
        size=2,
        default=(0.0, 1.0),
        subtype="XYZ_LENGTH",
    )
    blend: FloatProperty(
        name="Blend",
        description="How softly the box's sides are blended. At 0 each place shows only the "
        "side that it faces most directly",
        default=0.2,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    max_distance: FloatProperty(
        name="Distance",
        description="Largest distance to the other surface, in world units. 0 means any distance",
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
    )
    direction: EnumProperty(
        name="Direction",
        description="Direction in which the other surface is searched for",
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
    decal_resolution: IntProperty(
        name="Resolution",
        description="Number of the decal's polygons along the longer side of the image",
        default=64,
        min=1,
        max=2048,
        soft_max=256,
    )
    decal_offset: FloatProperty(
        name="Offset",
        description="Distance of the decal above the surface, in world units",
        default=0.001,
        soft_min=-0.1,
        soft_max=0.1,
        precision=4,
        subtype="DISTANCE",
    )
    create_material: BoolProperty(
        name="Create Material",
        description="Show the result over the base color of the active material, or of a new one",
        default=False,
    )


def draw(layout: bpy.types.UILayout, properties: bpy.types.OperatorProperties) -> None:
    """Draws the properties that have an effect with the current choices."""
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
        column.prop(properties, "follow")
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
    if properties.source not in ALONG_RAYS:
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
