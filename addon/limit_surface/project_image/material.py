# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials that show a projected image."""

from typing import Any

import bpy

from ..images import material_slots
from . import colours

SHADER = "BSDF_PRINCIPLED"
COLOR = "Base Color"


def check(ob: bpy.types.Object) -> None:
    """Raises RefusalError where the object cannot be given a material."""
    if _own(ob) is None:
        material_slots.check(ob)


def show(ob: bpy.types.Object, image: bpy.types.Image, uv_map: str) -> bpy.types.Material:
    """Lays the image over the base color of the object's active material, or of a new one where it
    has none with a suitable shader.
    """
    material = _own(ob)
    if material is None:
        material = bpy.data.materials.new(image.name)
        material.use_nodes = True
        material_slots.put(ob, material)
    if not _shows(_shader(material).inputs[COLOR], image):
        _link(material, image, uv_map)
    return material


def for_decal(ob: bpy.types.Object, image: bpy.types.Image, uv_map: str) -> bpy.types.Material:
    """Makes a material that is transparent where the image is."""
    material = bpy.data.materials.new(ob.name)
    material.use_nodes = True
    ob.data.materials.append(material)
    nodes, links, shader = material.node_tree.nodes, material.node_tree.links, _shader(material)
    texture = _texture(material.node_tree, image, uv_map, shader.location.x)
    texture.extension = "EXTEND"
    links.new(texture.outputs["Color"], shader.inputs[COLOR])
    if colours.alpha_covers(image):
        links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
    nodes.active = texture
    return material


def _own(ob: bpy.types.Object) -> bpy.types.Material | None:
    material = ob.active_material
    return material if material and material.is_editable and _shader(material) else None


def _shader(material: bpy.types.Material) -> Any:
    tree = material.node_tree
    return next((n for n in tree.nodes if n.type == SHADER), None) if tree else None


def _shows(socket: bpy.types.NodeSocket, image: bpy.types.Image) -> bool:
    """Tells whether the socket's value comes, through any nodes, from a texture with that image."""
    waiting, seen = [socket], set()
    while waiting:
        for node in (link.from_node for link in waiting.pop().links):
            if getattr(node, "image", None) == image:
                return True
            if node not in seen:
                seen.add(node)
                waiting += node.inputs
    return False


def _link(material: bpy.types.Material, image: bpy.types.Image, uv_map: str) -> None:
    """Links the image to the shader. Where the image is transparent, the previous color stays."""
    tree, shader = material.node_tree, _shader(material)
    base, x = shader.inputs[COLOR], shader.location.x
    mix = tree.nodes.new("ShaderNodeMix")
    mix.data_type, mix.location = "RGBA", (x - 200, shader.location.y)
    sockets = {s.identifier: s for s in (*mix.inputs, *mix.outputs)}
    if base.links:
        tree.links.new(base.links[0].from_socket, sockets["A_Color"])
    else:
        sockets["A_Color"].default_value = base.default_value
    texture = _texture(tree, image, uv_map, x - 220)
    tree.links.new(texture.outputs["Color"], sockets["B_Color"])
    if colours.alpha_covers(image):
        tree.links.new(texture.outputs["Alpha"], sockets["Factor_Float"])
    else:
        sockets["Factor_Float"].default_value = 1
    tree.links.new(sockets["Result_Color"], base)
    tree.nodes.active = texture


def _texture(
    tree: bpy.types.NodeTree, image: bpy.types.Image, uv_map: str, x: float
) -> bpy.types.Node:
    texture, places = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeUVMap")
    texture.image, places.uv_map = image, uv_map
    tree.links.new(places.outputs["UV"], texture.inputs["Vector"])
    y = min(
        (n.location.y - 300 for n in tree.nodes if n.type == "TEX_IMAGE" and n != texture),
        default=300,
    )
    texture.location, places.location = (x - 300, y), (x - 500, y - 120)
    return texture
