# SPDX-License-Identifier: GPL-3.0-or-later
"""The groups of a file that this extension has built, and the modifiers that use them.

A group carries its name and version as a custom property, because users may rename it. A group of
another version is left alone, and a new one is made beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import bpy

from .. import ids
from ..errors import RefusalError


class Kind(NamedTuple):
    """A group that is built when a file needs it."""

    name: str
    version: int
    build: Callable[[], bpy.types.NodeTree]

    @property
    def mark(self) -> str:
        return f"{self.name} {self.version}"

    def matches(self, group: bpy.types.NodeTree | None) -> bool:
        """Tells whether it is a group of this kind that has not lost a group within it."""
        return (
            group is not None
            and group.get(ids.GROUP_MARK) == self.mark
            and not has_lost_a_group(group)
        )

    def group(self) -> bpy.types.NodeTree:
        """Returns the file's own group of this kind, which is made if there is none."""
        for group in bpy.data.node_groups:
            if group.library is None and self.matches(group):
                return group
        group = self.build()
        group[ids.GROUP_MARK] = self.mark
        return group


def has_lost_a_group(group: bpy.types.NodeTree) -> bool:
    """Tells whether a group within it was deleted."""
    return any(n.bl_idname == "GeometryNodeGroup" and not n.node_tree for n in group.nodes)


def name_of(group: bpy.types.NodeTree | None) -> str:
    """Returns the name of one of our groups, whatever its version, or None for any other group."""
    mark = group.get(ids.GROUP_MARK, "") if group is not None else ""
    return mark.rpartition(" ")[0] if isinstance(mark, str) else ""


def is_of(group: bpy.types.NodeTree | None, name: str) -> bool:
    """Tells whether it is one of our groups of that name, whatever its version."""
    return name_of(group) == name


def modifiers(ob: bpy.types.Object, name: str) -> Iterator[bpy.types.NodesModifier]:
    """Yields the object's modifiers that use one of our groups of that name."""
    for modifier in ob.modifiers:
        if modifier.type == "NODES" and is_of(modifier.node_group, name):
            yield modifier


def without_group(ob: bpy.types.Object, name: str) -> Iterator[bpy.types.NodesModifier]:
    """Yields the object's modifiers that have lost one of our groups of that name. Their inputs are
    still there, and fit a new group.
    """
    for modifier in ob.modifiers:
        if modifier.type == "NODES" and modifier.node_group is None:
            own, dot, number = modifier.name.rpartition(".")
            if name in (modifier.name, own if dot and number.isdigit() else ""):
                yield modifier


def add_modifier(
    ob: bpy.types.Object, kind: Kind, place: int | None = None, **inputs: Any
) -> bpy.types.NodesModifier:
    """Adds a modifier at a place in the stack, or at its end. The names of inputs have underscores
    for spaces.
    """
    modifier = ob.modifiers.new(kind.name, "NODES")
    modifier.node_group = kind.group()
    modifier.show_in_editmode = True
    for name, value in inputs.items():
        set_input(modifier, name.replace("_", " "), value)
    if place is not None:
        ob.modifiers.move(len(ob.modifiers) - 1, place)
    return modifier


def set_input(modifier: bpy.types.NodesModifier, name: str, value: Any) -> None:
    key = _identifier(modifier, name)
    inputs = _inputs(modifier)
    if inputs is None:
        refers_anew = isinstance(value, bpy.types.ID) and modifier.get(key) != value
        modifier[key] = value
        if refers_anew:
            # Blender only notices by a property of its own that the modifier depends on another
            # object than before.
            modifier.node_group = modifier.node_group
    else:
        getattr(inputs, key).value = value
    modifier.id_data.update_tag()


def get_input(modifier: bpy.types.NodesModifier, name: str) -> Any:
    """Returns the value of an input, or None if the group has no input of that name."""
    key = _identifier(modifier, name)
    return _value(modifier, key) if key else None


def has_input(modifier: bpy.types.NodesModifier, name: str) -> bool:
    """Tells whether nobody has removed or renamed this input of the group."""
    return bool(_identifier(modifier, name))


def check_inputs(modifier: bpy.types.NodesModifier, *names: str) -> None:
    """Raises RefusalError if somebody has removed or renamed an input of the group."""
    for name in names:
        if not has_input(modifier, name):
            raise RefusalError(
                f"The node group {modifier.node_group.name} has been changed: it has no input "
                f"{name} any more. Give the input this name again, or delete the group and run "
                "Follow Limit Surface"
            )


def inputs_of(modifier: bpy.types.NodesModifier) -> Iterator[Any]:
    """Yields the values of a modifier's inputs, whatever its group."""
    for item in modifier.node_group.interface.items_tree if modifier.node_group else ():
        is_input = item.item_type == "SOCKET" and item.in_out == "INPUT"
        if is_input and item.socket_type != "NodeSocketGeometry":
            yield _value(modifier, item.identifier)


def paths_of_inputs(modifier: bpy.types.NodesModifier) -> Iterator[tuple[str, Any]]:
    """Yields the paths, as seen from the modifier, and the values of its inputs, whatever its
    group. An input may have an attribute instead of a value.
    """
    inputs = _inputs(modifier)
    for item in modifier.node_group.interface.items_tree if modifier.node_group else ():
        key = getattr(item, "identifier", "")
        if item.item_type != "SOCKET" or item.in_out != "INPUT":
            continue
        if inputs is None:
            for name in (key, f"{key}_use_attribute", f"{key}_attribute_name"):
                if name in modifier:
                    yield f'["{name}"]', modifier[name]
        elif hasattr(inputs, key):
            for name in ("value", "type", "attribute_name"):
                held = getattr(inputs, key)
                if hasattr(held, name):
                    yield f".properties.inputs.{key}.{name}", getattr(held, name)


def values_in(group: bpy.types.NodeTree | None) -> Iterator[Any]:
    """Yields the values of sockets within a group, and in groups within it."""
    waiting, seen = [group], set()
    while waiting:
        tree = waiting.pop()
        if tree is None or tree in seen:
            continue
        seen.add(tree)
        for node in tree.nodes:
            waiting.append(getattr(node, "node_tree", None))
            for socket in node.inputs:
                yield getattr(socket, "default_value", None)


def _inputs(modifier: bpy.types.NodesModifier) -> Any:
    """Returns the holder of the inputs from Blender 5.2 on; before, the modifier holds them."""
    return getattr(getattr(modifier, "properties", None), "inputs", None)


def _value(modifier: bpy.types.NodesModifier, identifier: str) -> Any:
    inputs = _inputs(modifier)
    return modifier.get(identifier) if inputs is None else getattr(inputs, identifier).value


def _identifier(modifier: bpy.types.NodesModifier, name: str) -> str:
    for item in modifier.node_group.interface.items_tree:
        if item.item_type == "SOCKET" and item.in_out == "INPUT" and item.name == name:
            return item.identifier
    return ""
