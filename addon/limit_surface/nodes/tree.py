# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry Nodes groups that are built by code, of nodes that exist in Blender 4.2 and later.

Blender 4.2 has no integer arithmetic in nodes. Whole numbers therefore pass through Math nodes,
which calculate in single precision: they are exact below 2^24.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeAlias

import bpy

#: The socket of a node, or a constant
Value: TypeAlias = Any
#: The outputs of a node, by name or number
Outputs: TypeAlias = Any

COLUMN, ROW = 190, 160  # the distances between nodes in the editor


class Socket(NamedTuple):
    """An input or output of a group."""

    name: str
    kind: str  # the type without "NodeSocket": Geometry, Object, Int, Vector, ...
    description: str
    subtype: str = ""  # of numbers: DISTANCE, ANGLE, ...


class Tree:
    """A group under construction. The arguments of its methods are sockets or constants, and most
    methods return the socket of their result.
    """

    def __init__(
        self,
        name: str,
        inputs: Sequence[Socket],
        outputs: Sequence[Socket],
        is_modifier: bool = False,
    ) -> None:
        self.group = bpy.data.node_groups.new(name, "GeometryNodeTree")
        self.group.is_modifier = is_modifier
        for in_out, sockets in (("OUTPUT", outputs), ("INPUT", inputs)):
            for socket in sockets:
                made = self.group.interface.new_socket(
                    socket.name,
                    in_out=in_out,
                    socket_type=f"NodeSocket{socket.kind}",
                    description=socket.description,
                )
                if socket.subtype:
                    made.subtype = socket.subtype
        self.inputs = self.group.nodes.new("NodeGroupInput").outputs
        self._outputs = self.group.nodes.new("NodeGroupOutput").inputs

    def finish(self, **outputs: Value) -> bpy.types.NodeTree:
        """Connects the outputs, whose names have underscores for spaces, and arranges the nodes."""
        for name, value in outputs.items():
            self.set(self._outputs[name.replace("_", " ")], value)
        _arrange(self.group)
        return self.group

    def set(self, socket: bpy.types.NodeSocket, value: Value) -> None:
        if isinstance(value, bpy.types.NodeSocket):
            self.group.links.new(value, socket)
        else:
            socket.default_value = value

    def node(self, idname: str, *arguments: Value, **properties: Any) -> bpy.types.Node:
        """Adds a node with these properties, and connects the arguments to its inputs in order.
        Unavailable inputs, which depend on the properties, are skipped.
        """
        node = self.group.nodes.new(idname)
        for key, value in properties.items():
            setattr(node, key, value)
        available = [socket for socket in node.inputs if socket.enabled]
        for socket, value in zip(available, arguments, strict=False):
            self.set(socket, value)
        return node

    def get(self, idname: str, *arguments: Value, **properties: Any) -> bpy.types.NodeSocket:
        """Adds a node like `node`, and returns its first available output."""
        node = self.node(idname, *arguments, **properties)
        return next(socket for socket in node.outputs if socket.enabled)

    def group_node(self, group: bpy.types.NodeTree, **inputs: Value) -> Outputs:
        """Adds a node of another group, and returns its outputs. The names of inputs have
        underscores for spaces.
        """
        node = self.node("GeometryNodeGroup", node_tree=group)
        for name, value in inputs.items():
            self.set(node.inputs[name.replace("_", " ")], value)
        return node.outputs

    def object_info(self, ob: Value, space: str = "ORIGINAL") -> Outputs:
        return self.node("GeometryNodeObjectInfo", ob, transform_space=space).outputs

    def index(self) -> bpy.types.NodeSocket:
        return self.get("GeometryNodeInputIndex")

    def position(self) -> bpy.types.NodeSocket:
        return self.get("GeometryNodeInputPosition")

    def attribute(self, name: str, kind: str) -> bpy.types.NodeSocket:
        return self.get("GeometryNodeInputNamedAttribute", name, data_type=kind)

    def sample(
        self, geometry: Value, field: Value, index: Value, kind: str, domain: str = "POINT"
    ) -> bpy.types.NodeSocket:
        """Returns the field's value at one element of the geometry."""
        return self.get(
            "GeometryNodeSampleIndex", geometry, field, index, data_type=kind, domain=domain
        )

    def store(
        self, geometry: Value, name: str, value: Value, kind: str, domain: str = "POINT"
    ) -> bpy.types.NodeSocket:
        return self.get(
            "GeometryNodeStoreNamedAttribute",
            geometry,
            True,
            name,
            value,
            data_type=kind,
            domain=domain,
        )

    def capture(self, geometry: Value, domain: str, **fields: tuple[str, Value]) -> Outputs:
        """Evaluates fields, given as (type of socket, field), on the geometry. The outputs are the
        geometry and the fields.
        """
        node = self.node("GeometryNodeCaptureAttribute", geometry, domain=domain)
        for name, (kind, value) in fields.items():
            node.capture_items.new(kind, name)
            self.set(node.inputs[name], value)
        return node.outputs

    def set_position(
        self, geometry: Value, selection: Value, position: Value
    ) -> bpy.types.NodeSocket:
        return self.get("GeometryNodeSetPosition", geometry, selection, position)

    def repeat(
        self, iterations: Value, **items: tuple[str, Value]
    ) -> tuple[Outputs, Outputs, Outputs]:
        """Adds a Repeat Zone. Items are given as (type of socket, first value). Returns their
        values at the beginning of an iteration, the inputs for those at its end, and the last
        values.
        """
        begin = self.node("GeometryNodeRepeatInput")
        end = self.node("GeometryNodeRepeatOutput")
        begin.pair_with_output(end)
        end.repeat_items.clear()
        for name, (kind, _) in items.items():
            end.repeat_items.new(kind, name)
        self.set(begin.inputs["Iterations"], iterations)
        for name, (_, value) in items.items():
            self.set(begin.inputs[name], value)
        return begin.outputs, end.inputs, end.outputs

    def math(self, operation: str, *arguments: Value) -> bpy.types.NodeSocket:
        return self.get("ShaderNodeMath", *arguments, operation=operation)

    def compare(self, operation: str, a: Value, b: Value) -> bpy.types.NodeSocket:
        return self.get("FunctionNodeCompare", a, b, data_type="INT", operation=operation)

    def both(self, a: Value, b: Value) -> bpy.types.NodeSocket:
        return self.get("FunctionNodeBooleanMath", a, b, operation="AND")

    def either(self, a: Value, b: Value) -> bpy.types.NodeSocket:
        return self.get("FunctionNodeBooleanMath", a, b, operation="OR")

    def negated(self, a: Value) -> bpy.types.NodeSocket:
        return self.get("FunctionNodeBooleanMath", a, operation="NOT")

    def switch(self, test: Value, if_false: Value, if_true: Value, kind: str) -> Value:
        return self.get("GeometryNodeSwitch", test, if_false, if_true, input_type=kind)

    def vector(self, operation: str, *arguments: Value) -> bpy.types.NodeSocket:
        return self.get("ShaderNodeVectorMath", *arguments, operation=operation)

    def scaled(self, vector: Value, factor: Value) -> bpy.types.NodeSocket:
        """Returns the product of a vector and a number."""
        return self.vector("MULTIPLY", vector, _all_three(factor))

    def scaled_plus(self, vector: Value, factor: Value, plus: Value) -> bpy.types.NodeSocket:
        """Returns the product of a vector and a number, plus another vector."""
        return self.vector("MULTIPLY_ADD", vector, _all_three(factor), plus)

    def components(self, vector: Value) -> list[Value]:
        if isinstance(vector, bpy.types.NodeSocket):
            return list(self.node("ShaderNodeSeparateXYZ", vector).outputs)
        return list(vector)

    def combined(self, *components: Value) -> bpy.types.NodeSocket:
        return self.get("ShaderNodeCombineXYZ", *components)

    def matrix(self, *columns: Value) -> bpy.types.NodeSocket:
        """Returns the matrix of an affine map: three columns of its linear part, and the origin's
        image.
        """
        entries: list[Value] = []
        for column, last in zip(columns, (0.0, 0.0, 0.0, 1.0), strict=True):
            entries += [*self.components(column), last]
        return self.get("FunctionNodeCombineMatrix", *entries)

    def mapped_point(self, point: Value, matrix: Value) -> bpy.types.NodeSocket:
        return self.get("FunctionNodeTransformPoint", point, matrix)

    def mapped_direction(self, direction: Value, matrix: Value) -> bpy.types.NodeSocket:
        return self.get("FunctionNodeTransformDirection", direction, matrix)

    def warn(self, when: Value, text: str) -> None:
        """Shows a warning on the modifier. Blender 4.2 has no such node."""
        if hasattr(bpy.types, "GeometryNodeWarning"):
            self.node("GeometryNodeWarning", when, text, warning_type="WARNING")


def _all_three(factor: Value) -> Value:
    return factor if isinstance(factor, bpy.types.NodeSocket) else (factor,) * 3


def _arrange(group: bpy.types.NodeTree) -> None:
    """Places each node in a column to the right of all nodes that lead to it."""
    column = dict.fromkeys(group.nodes, 0)
    for _ in group.nodes:
        changed = False
        for link in group.links:
            least = column[link.from_node] + 1
            if column[link.to_node] < least:
                column[link.to_node], changed = least, True
        if not changed:
            break
    height: dict[int, int] = {}
    for node in group.nodes:
        x = column[node]
        node.location = (COLUMN * x, -ROW * height.get(x, 0))
        height[x] = height.get(x, 0) + 1
