# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials that displace the surface when it is rendered."""

from typing import Any

import bpy

from ..images import material_slots

OUTPUT = "OUTPUT_MATERIAL"


def check(ob: bpy.types.Object) -> None:
    """Raises RefusalError where the object cannot be given a material."""
    if _own(ob) is None:
        material_slots.check(ob)


def show(
    ob: bpy.types.Object, image: bpy.types.Image, uv_map: str, *, is_vector: bool, space: str
) -> bpy.types.Material:
    """Links the image to the object's active material, or to a new one where it has none that can
    be changed.
    """
    material = _own(ob)
    if material is None:
        material = bpy.data.materials.new(image.name)
        material.use_nodes = True
        material_slots.put(ob, material)
    _link(material, image, uv_map, is_vector, space)
    material.displacement_method = "DISPLACEMENT"
    return material


def _own(ob: bpy.types.Object) -> bpy.types.Material | None:
    material = ob.active_material
    return material if material and material.is_editable and _output(material) else None


def _output(material: bpy.types.Material) -> Any:
    tree = material.node_tree
    outputs = [node for node in tree.nodes if node.type == OUTPUT] if tree else []
    return next((node for node in outputs if node.is_active_output), None)


def _link(
    material: bpy.types.Material, image: bpy.types.Image, uv_map: str, is_vector: bool, space: str
) -> None:
    """Links the image to the displacement. Nodes that an earlier bake of the same image has linked
    are used again, with the scale that the user has set.
    """
    tree, output = material.node_tree, _output(material)
    node, texture = _linked(output, image)
    kind = "ShaderNodeVectorDisplacement" if is_vector else "ShaderNodeDisplacement"
    if node is not None and node.bl_idname != kind:
        tree.nodes.remove(node)
        node = None
    if texture is None:
        texture = _texture(tree, image, output)
    _show_by(tree, texture, uv_map)
    if node is None:
        node = tree.nodes.new(kind)
        node.inputs["Midlevel"].default_value = 0.0
        node.inputs["Scale"].default_value = 1.0
        node.location = _left_of(output, 220)
        tree.links.new(texture.outputs["Color"], node.inputs["Vector" if is_vector else "Height"])
        tree.links.new(node.outputs["Displacement"], output.inputs["Displacement"])
    node.space = space


def _linked(output: Any, image: bpy.types.Image) -> tuple[Any, Any]:
    """Returns the output's displacement node and its texture if they show the image."""
    for link in output.inputs["Displacement"].links:
        node = link.from_node
        if node.type in ("DISPLACEMENT", "VECTOR_DISPLACEMENT"):
            for color in node.inputs[0].links:
                if getattr(color.from_node, "image", None) == image:
                    return node, color.from_node
    return None, None


def _texture(tree: bpy.types.NodeTree, image: bpy.types.Image, output: Any) -> Any:
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    texture.interpolation = "Linear"
    texture.extension = "EXTEND"
    texture.location = _left_of(output, 520)
    return texture


def _show_by(tree: bpy.types.NodeTree, texture: Any, uv_map: str) -> None:
    """Has the texture take its places from the UV map, unless other nodes give them."""
    vector = texture.inputs["Vector"]
    if not vector.links:
        places = tree.nodes.new("ShaderNodeUVMap")
        places.location = (texture.location.x - 200, texture.location.y)
        tree.links.new(places.outputs["UV"], vector)
    if vector.links[0].from_node.type == "UVMAP":
        vector.links[0].from_node.uv_map = uv_map


def _left_of(output: Any, distance: float) -> tuple[float, float]:
    return output.location.x - distance, output.location.y - 260
