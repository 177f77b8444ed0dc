# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials that show a projected image."""

import bpy

SHADER = "BSDF_PRINCIPLED"


def show(ob: bpy.types.Object, image: bpy.types.Image, uv_map: str) -> bpy.types.Material:
    """As base color of the object's active material, or of a new one where it has none that has a
    shader for it."""
    material = ob.active_material
    if material is None or not material.is_editable or _shader(material) is None:
        material = bpy.data.materials.new(image.name)
        material.use_nodes = True
        _put(ob, material)
    _link(material, image, uv_map, with_alpha=False)
    return material


def for_decal(ob: bpy.types.Object, image: bpy.types.Image, uv_map: str) -> bpy.types.Material:
    """Transparent where the image is."""
    material = bpy.data.materials.new(ob.name)
    material.use_nodes = True
    ob.data.materials.append(material)
    _link(material, image, uv_map, with_alpha=True)
    return material


def _put(ob: bpy.types.Object, material: bpy.types.Material) -> None:
    """Into the active slot where that is empty, else into a new one, which all faces take only if
    there was none before."""
    if ob.active_material is None and ob.material_slots:
        ob.active_material = material
        return
    ob.data.materials.append(material)
    ob.active_material_index = len(ob.material_slots) - 1


def _shader(material: bpy.types.Material) -> bpy.types.Node | None:
    tree = material.node_tree
    return next((n for n in tree.nodes if n.type == SHADER), None) if tree else None


def _link(
    material: bpy.types.Material, image: bpy.types.Image, uv_map: str, with_alpha: bool
) -> None:
    nodes, links, shader = material.node_tree.nodes, material.node_tree.links, _shader(material)
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    texture.extension = "EXTEND" if with_alpha else "REPEAT"
    places = nodes.new("ShaderNodeUVMap")
    places.uv_map = uv_map
    links.new(places.outputs["UV"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    if with_alpha:
        links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
    x, y = shader.location
    texture.location, places.location = (x - 300, y), (x - 500, y - 120)
    nodes.active = texture
