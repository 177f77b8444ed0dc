# SPDX-License-Identifier: GPL-3.0-or-later
"""object.limit_mesh takes over as many vertex groups as rigs have."""

import bpy
import numpy as np
import pytest
import scenes
from limit_mesh_truth import make
from limit_surface.reading import attributes, vertex_weights


def with_groups(count: int, weights: np.ndarray) -> bpy.types.Object:
    """Adds a mesh with so many groups, and weights (groups, vertices) in the last of them."""
    ob = scenes.SCENES["grid with holes"]()
    scenes.add_subsurf(ob)
    for i in range(count):
        ob.vertex_groups.new(name=f"Bone.{i}")
    for group, row in zip(ob.vertex_groups[count - len(weights) :], weights, strict=True):
        for vertex in np.flatnonzero(row):
            group.add([int(vertex)], float(row[vertex]), "REPLACE")
    return ob


def groups_of(mesh: bpy.types.Mesh) -> list[dict[int, float]]:
    """Returns the weights of each vertex by the number of the group."""
    return [{e.group: e.weight for e in vertex.groups} for vertex in mesh.vertices]


@pytest.mark.parametrize(("count", "used"), [(7, 7), (8, 8), (9, 9), (40, 19), (40, 0)])
def test_weights_stay_in_their_groups(count, used):
    """Vertices of the new mesh that stand at vertices of the old one have their weights."""
    rng = np.random.default_rng(5)
    old_count = len(scenes.SCENES["grid with holes"]().data.vertices)
    weights = rng.random((used, old_count)).astype(np.float32)
    weights[rng.random(weights.shape) < 0.4] = 0
    ob = with_groups(count, weights)
    made = make(ob, levels=0, store_locations=True)
    assert made.vertex_groups.keys() == ob.vertex_groups.keys()
    faces = [list(polygon.vertices) for polygon in ob.data.polygons]
    face, uv = (attributes.read(made.data, name) for name in ("limit_face", "limit_uv"))
    assert set(map(len, faces)) == {4}
    corner = np.array([[0, 3], [1, 2]])[uv[:, 0].astype(int), uv[:, 1].astype(int)]
    theirs = groups_of(ob.data)
    expected = [theirs[faces[f][c]] for f, c in zip(face, corner, strict=True)]
    assert groups_of(made.data) == [
        {group: weight for group, weight in each.items() if weight} for each in expected
    ]
    assert not any(attribute.name.startswith(".limit") for attribute in made.data.attributes)


def test_a_thousand_groups_are_taken_over():
    made = make(with_groups(1000, np.full((300, 4), 0.5, np.float32)), levels=1)
    assert len(made.vertex_groups) == 1000


def test_no_node_tree_grows_with_the_number_of_groups():
    """At each change of a tree Blender looks at all of its nodes."""
    before = set(bpy.data.node_groups)
    with vertex_weights._copying([(f"Source {i}", f"Bone.{i}") for i in range(1000)]):
        sizes = [len(tree.nodes) for tree in bpy.data.node_groups if tree not in before]
    assert len(sizes) > 100
    assert max(sizes) < 40
