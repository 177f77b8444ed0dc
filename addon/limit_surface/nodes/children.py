# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Limit Children*, whose modifier grows strands between guides in each frame.

A child is a vertex of a table. Its position holds its place: u, v and the face. Each child has four
guides, by the numbers of their strands, and their weights; that of the last guide is what the other
three leave of 1. The strand of a child is the weighted mean of its guides' shapes, each relative to
its first point and turned by the smallest rotation from the surface's normal at the guide's root to
that at the child's, and scaled to the weighted mean of their lengths. Shapes, normals and lengths
are those in the world, because an object with an uneven scale would bend them.

Points are counted by numbers in single precision here: guides may have 2^24 points in all.
"""

import bpy

from .. import ids
from .groups import Kind
from .locate import LOCATE
from .sample import SAMPLE
from .tree import Outputs, Socket, Tree, Value

#: Names of the inputs
SURFACE, TILES, TABLE, GUIDES = "Surface", "Tiles", "Children", "Guides"
POINTS, SHARE, RADIUS, MATERIAL = "Points", "Viewport Share", "Radius", "Material"
GUIDE_COUNT, TOPOLOGY = "Guide Count", "Cage Topology"

#: Attributes of the table
GUIDE = ("guide0", "guide1", "guide2", "guide3")
WEIGHTS = "weights"


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.CHILDREN_GROUP,
        [
            Socket("Geometry", "Geometry", "Curves without strands"),
            Socket(SURFACE, "Object", "Mesh to grow on, which has the modifier Limit Capture"),
            Socket(TILES, "Object", "Hidden object that holds all tiles of its limit surface"),
            Socket(TABLE, "Object", "Hidden object that stores where the children grow"),
            Socket(GUIDES, "Object", "Hair curves that the children follow"),
            Socket(POINTS, "Int", "Number of points on each strand, including the root"),
            Socket(SHARE, "Float", "Share of the children that the viewport shows, from 0 to 1"),
            Socket(RADIUS, "Float", "Radius of the strands"),
            Socket(MATERIAL, "Material", "Material of the strands"),
            Socket(GUIDE_COUNT, "Int", "Number of guides at the time of making the children"),
            Socket(TOPOLOGY, "Int", "Checksum of the mesh's edges at that time, to notice changes"),
        ],
        [Socket("Geometry", "Geometry", "The children as the guides are in this frame")],
        is_modifier=True,
    )
    to_world = tree.object_info(tree.get("GeometryNodeSelfObject"))["Transform"]
    from_world = tree.get("FunctionNodeInvertMatrix", to_world)
    of_normals = tree.get("FunctionNodeTransposeMatrix", from_world)
    guides, on_guides = _guides(tree, to_world)
    children = _shown_children(tree)
    strands = _straight_strands(tree, children)

    place = _child(tree, children, tree.position())
    u, v, face = tree.components(place)
    root = _on_surface(tree, face, tree.combined(u, v, 0.0))
    weights = tree.components(_child(tree, children, tree.attribute(WEIGHTS, "FLOAT_VECTOR")))
    summed = tree.math("ADD", tree.math("ADD", weights[0], weights[1]), weights[2])
    weights.append(tree.math("SUBTRACT", 1.0, summed))
    of_curves: dict[str, tuple[str, Value]] = {"Root": ("VECTOR", root["Position"])}
    root_normal = _in_world(tree, root["Normal"], of_normals)
    length: Value = 0.0
    for k, weight in enumerate(weights):
        guide = _child(tree, children, tree.attribute(GUIDE[k], "INT"), "INT")
        normal = tree.sample(guides, on_guides["Normal"], guide, "FLOAT_VECTOR", "CURVE")
        normal = _in_world(tree, normal, of_normals)
        guide_length = tree.sample(guides, on_guides["Length"], guide, "FLOAT", "CURVE")
        length = tree.math("MULTIPLY_ADD", weight, guide_length, length)
        of_curves[f"First {k}"] = ("INT", tree.math("MULTIPLY", guide, tree.inputs[POINTS]))
        of_curves[f"Turn {k}"] = ("ROTATION", _smallest_turn(tree, normal, root_normal))
        of_curves[f"Weight {k}"] = ("FLOAT", weight)
    of_curves["Length"] = ("FLOAT", length)
    on = _captured(tree, strands, "CURVE", of_curves)

    step = tree.node("GeometryNodeSplineParameter").outputs["Index"]
    shape: Value = (0.0, 0.0, 0.0)
    for k in range(len(weights)):
        at = tree.math("ADD", on[f"First {k}"], step)
        offset = tree.sample(guides, tree.position(), at, "FLOAT_VECTOR")
        turned = tree.get("FunctionNodeRotateVector", offset, on[f"Turn {k}"])
        shape = tree.scaled_plus(turned, on[f"Weight {k}"], shape)
    blended = tree.set_position(on[0], True, shape)
    scaled = tree.capture(
        blended,
        "CURVE",
        Scale=("FLOAT", tree.math("DIVIDE", on["Length"], _length(tree))),
    )
    shape = tree.mapped_direction(tree.scaled(tree.position(), scaled["Scale"]), from_world)
    grown = tree.set_position(scaled[0], True, tree.vector("ADD", shape, on["Root"]))
    grown = tree.get("GeometryNodeSetCurveRadius", grown, True, tree.inputs[RADIUS])
    grown = tree.get("GeometryNodeSetMaterial", grown, True, tree.inputs[MATERIAL])

    fits = tree.both(root["Fits"], _same_guides(tree))
    fits = tree.both(fits, _same_topology(tree))
    tree.warn(
        tree.negated(fits),
        "The number of guides, or the faces or creases of the surface, have changed: run Rebind "
        "to Limit Surface",
    )
    return tree.finish(Geometry=tree.switch(fits, tree.inputs["Geometry"], grown, "GEOMETRY"))


def _guides(tree: Tree, to_world: Value) -> tuple[Value, Outputs]:
    """Returns the guides as polylines of equal numbers of points, relative to their first points as
    the world's axes measure them, with what is known of each.
    """
    guides = tree.object_info(tree.inputs[GUIDES], "RELATIVE")["Geometry"]
    at = _on_surface(tree, tree.attribute(ids.FACE, "INT"), tree.attribute(ids.UV, "FLOAT_VECTOR"))
    guides = tree.get("GeometryNodeCurveSplineType", guides, True, spline_type="POLY")
    # the segment that closes a cyclic strand is not part of its shape
    guides = tree.get("GeometryNodeSetSplineCyclic", guides, True, False)
    guides = tree.set_position(guides, True, tree.mapped_direction(tree.position(), to_world))
    resample = tree.node("GeometryNodeResampleCurve")
    if "Mode" in resample.inputs:  # from Blender 5.0 on
        resample.inputs["Mode"].default_value = "Count"
    else:
        resample.mode = "COUNT"
    tree.set(resample.inputs["Curve"], guides)
    tree.set(next(s for s in resample.inputs if s.name == "Count"), tree.inputs[POINTS])
    known = _captured(
        tree,
        resample.outputs["Curve"],
        "CURVE",
        {"Normal": ("VECTOR", at["Normal"]), "Length": ("FLOAT", _length(tree))},
    )
    curve = tree.node("GeometryNodeCurveOfPoint").outputs["Curve Index"]
    first = tree.math("MULTIPLY", curve, tree.inputs[POINTS])
    start = tree.node("GeometryNodeFieldAtIndex", data_type="FLOAT_VECTOR", domain="POINT")
    tree.set(start.inputs["Value"], tree.position())  # the second input in Blender 4.2
    tree.set(start.inputs["Index"], first)
    offset = tree.vector("SUBTRACT", tree.position(), start.outputs["Value"])
    return tree.set_position(known[0], True, offset), known


def _shown_children(tree: Tree) -> Value:
    """Returns the table of the children that are to be shown here."""
    table = tree.object_info(tree.inputs[TABLE])["Geometry"]
    chance = tree.node("FunctionNodeRandomValue", data_type="FLOAT").outputs
    drawn = next(socket for socket in chance if socket.enabled)
    left_out = tree.both(
        tree.get("GeometryNodeIsViewport"),
        tree.negated(tree.math("LESS_THAN", drawn, tree.inputs[SHARE])),
    )
    return tree.get("GeometryNodeDeleteGeometry", table, left_out, domain="POINT")


def _straight_strands(tree: Tree, children: Value) -> Value:
    """Returns a strand for each child, in their order."""
    line = tree.get("GeometryNodeMeshLine", tree.inputs[POINTS])
    strand = tree.get("GeometryNodeMeshToCurve", line)
    count = tree.get("GeometryNodeAttributeDomainSize", children, component="MESH")
    return tree.get("GeometryNodeDuplicateElements", strand, True, count, domain="SPLINE")


def _child(tree: Tree, children: Value, field: Value, kind: str = "FLOAT_VECTOR") -> Value:
    """Returns what the table holds for the child to which a strand belongs."""
    return tree.sample(children, field, tree.index(), kind)


def _on_surface(tree: Tree, face: Value, uv: Value) -> Outputs:
    found = tree.group_node(LOCATE.group(), Tiles=tree.inputs[TILES], Face=face, UV=uv)
    return tree.group_node(
        SAMPLE.group(),
        Surface=tree.inputs[SURFACE],
        Tiles=tree.inputs[TILES],
        Tile=found["Tile"],
        Tile_UV=found["Tile UV"],
    )


def _in_world(tree: Tree, normal: Value, of_normals: Value) -> Value:
    """Returns the unit normal that the matrix makes of a normal in the object's space."""
    return tree.vector("NORMALIZE", tree.mapped_direction(normal, of_normals))


def _smallest_turn(tree: Tree, source: Value, target: Value) -> Value:
    """Returns the smallest rotation that turns a unit vector into another."""
    axis = tree.vector("CROSS_PRODUCT", source, target)
    sine = tree.node("ShaderNodeVectorMath", axis, operation="LENGTH").outputs["Value"]
    cosine = tree.node("ShaderNodeVectorMath", source, target, operation="DOT_PRODUCT").outputs
    angle = tree.math("ARCTAN2", sine, cosine["Value"])
    return tree.get("FunctionNodeAxisAngleToRotation", axis, angle)


def _length(tree: Tree) -> Value:
    return tree.node("GeometryNodeSplineLength").outputs["Length"]


def _captured(
    tree: Tree, geometry: Value, domain: str, fields: dict[str, tuple[str, Value]]
) -> Outputs:
    node = tree.node("GeometryNodeCaptureAttribute", geometry, domain=domain)
    for name, (kind, value) in fields.items():
        node.capture_items.new(kind, name)
        tree.set(node.inputs[name], value)
    return node.outputs


def _same_guides(tree: Tree) -> Value:
    guides = tree.object_info(tree.inputs[GUIDES])["Geometry"]
    size = tree.node("GeometryNodeAttributeDomainSize", guides, component="CURVE").outputs
    return tree.compare("EQUAL", size["Spline Count"], tree.inputs[GUIDE_COUNT])


def _same_topology(tree: Tree) -> Value:
    table = tree.object_info(tree.inputs[TILES])["Geometry"]
    topology = tree.sample(table, tree.attribute(ids.CAGE_TOPOLOGY, "INT"), 0, "INT")
    return tree.compare("EQUAL", topology, tree.inputs[TOPOLOGY])


CHILDREN = Kind(ids.CHILDREN_GROUP, 2, _build)
