# SPDX-License-Identifier: GPL-3.0-or-later
"""What Cycles shades with a tangent-space normal map, found by its own baking."""

import bpy
import numpy as np
from limit_surface.images import image_pixels


def with_subsurf(ob: bpy.types.Object) -> bpy.types.Object:
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.levels, subsurf.render_levels = 1, 2
    return ob


def shaded(ob: bpy.types.Object, normal_map: bpy.types.Image) -> np.ndarray:
    """Returns the normals with which Cycles shades the object, in the object's space, 0 where it
    has no polygon. The image has as many texels as the map.
    """
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.bake.margin, scene.render.bake.normal_space = 0, "OBJECT"
    result = bpy.data.images.new("shaded", *normal_map.size, float_buffer=True, is_data=True)
    material = bpy.data.materials.new("shows the map")
    ob.data.materials.clear()
    ob.data.materials.append(material)
    material.use_nodes = True
    tree = material.node_tree
    nodes, links = tree.nodes, tree.links
    nodes.clear()
    into, texture, color, normal, diffuse, output = (
        nodes.new(f"ShaderNode{kind}")
        for kind in ("TexImage", "TexImage", "VectorMath", "NormalMap", "BsdfDiffuse",
                     "OutputMaterial")
    )  # fmt: skip
    texture.image, into.image, nodes.active = normal_map, result, into
    texture.interpolation = "Closest"  # bakes are 0.002 texels beside the centres
    color.operation = "MULTIPLY_ADD"
    color.inputs[1].default_value = color.inputs[2].default_value = (0.5, 0.5, 0.5)
    links.new(texture.outputs[0], color.inputs[0])
    links.new(color.outputs[0], normal.inputs["Color"])
    links.new(normal.outputs[0], diffuse.inputs["Normal"])
    links.new(diffuse.outputs[0], output.inputs[0])
    bpy.ops.object.bake(type="NORMAL")
    found = image_pixels.read(result)[..., :3]
    return np.where(found.any(axis=-1, keepdims=True), 2 * found - 1, 0)


def angles(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Returns angles in degrees."""
    one = one / np.linalg.norm(one, axis=-1, keepdims=True)
    return np.degrees(2 * np.arcsin((np.linalg.norm(one - other, axis=-1) / 2).clip(0, 1)))
