# SPDX-License-Identifier: GPL-3.0-or-later
"""Operator node.limit_sample_add."""

from __future__ import annotations

import bpy

from .. import ids
from ..nodes.sample_surface import SAMPLE_SURFACE
from ..placing import all_tiles


class NODE_OT_limit_sample_add(bpy.types.Operator):
    """Add the node group Sample Limit Surface to the file, and a node of it to the tree in the
    editor. The node samples the active mesh if that has tables, or else the only mesh that has
    tables"""

    bl_idname = ids.SAMPLE_ADD
    bl_label = "Sample Limit Surface"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        group = SAMPLE_SURFACE.group()
        tree = _edited_tree(context)
        if tree is None:
            group.use_fake_user = True  # nothing else would keep it in the file
            self.report({"INFO"}, f"The file has the node group {group.name} now")
            return {"FINISHED"}
        for node in tree.nodes:
            node.select = False
        node = tree.nodes.new("GeometryNodeGroup")
        node.node_tree = group
        node.width = 200
        node.location = context.space_data.cursor_location
        tree.nodes.active = node
        surface = _sampled(context)
        if surface is not None:
            node.inputs["Surface"].default_value = surface
            node.inputs["Tiles"].default_value = all_tiles.of_surface(surface)
        return {"FINISHED"}


def _edited_tree(context: bpy.types.Context) -> bpy.types.NodeTree | None:
    space = context.space_data
    tree = getattr(space, "edit_tree", None) if space and space.type == "NODE_EDITOR" else None
    is_usable = tree is not None and tree.bl_idname == "GeometryNodeTree" and tree.is_editable
    return tree if is_usable else None


def _sampled(context: bpy.types.Context) -> bpy.types.Object | None:
    """Returns the active mesh if it has tables, or else the only surface that has some."""
    active = context.active_object
    if active is not None and all_tiles.of_surface(active):
        return active
    surfaces = [ob for ob in bpy.data.objects if ob.type == "MESH" and all_tiles.of_surface(ob)]
    return surfaces[0] if len(surfaces) == 1 else None
