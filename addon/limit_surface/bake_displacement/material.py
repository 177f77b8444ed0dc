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
    nodes, links, output = material.node_tree.nodes, material.node_tree.links, _output(material)
    kind = "ShaderNodeVectorDisplacement" if is_vector else "ShaderNodeDisplacement"
    displacement = nodes.new(kind)
    displacement.space = space
    displacement.inputs["Midlevel"].default_value = 0.0
    displacement.inputs["Scale"].default_value = 1.0
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    texture.interpolation = "Linear"
    texture.extension = "EXTEND"
    places = nodes.new("ShaderNodeUVMap")
    places.uv_map = uv_map
    links.new(places.outputs["UV"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], displacement.inputs["Vector" if is_vector else "Height"])
    links.new(displacement.outputs["Displacement"], output.inputs["Displacement"])
    x, y = output.location
    for node, left in ((displacement, 220), (texture, 520), (places, 720)):
        node.location = (x - left, y - 260)
