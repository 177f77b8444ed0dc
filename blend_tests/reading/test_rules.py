# SPDX-License-Identifier: GPL-3.0-or-later
"""The arguments that the add-on passes to ControlMesh for an object: sharpness, scheme and boundary
as in Blender's own subdivision.
"""

from types import SimpleNamespace

import bpy
import limitsurf
import numpy as np
import pytest
import scenes
from limit_surface import native
from limit_surface.reading import cage, rules
from scenes import add_mesh, add_subsurf


@pytest.fixture
def told(monkeypatch):
    """Returns a function that takes an object and returns the keyword arguments of its ControlMesh,
    with sharpness as dictionaries.
    """
    keywords = {}

    def note(positions, face_sizes, face_vertices, **given):
        keywords.update(given)
        return limitsurf.ControlMesh(positions, face_sizes, face_vertices)

    monkeypatch.setattr(native, "limitsurf", SimpleNamespace(ControlMesh=note))

    def tell(ob):
        keywords.clear()
        cage.read(ob, bpy.context.evaluated_depsgraph_get())
        edges, edge_values = keywords["edge_sharpness"]
        vertices, vertex_values = keywords["vertex_sharpness"]
        assert edges.shape == (len(edge_values), 2)
        keywords["edges"] = {
            frozenset(e): v for e, v in zip(edges.tolist(), edge_values.tolist(), strict=True)
        }
        keywords["vertices"] = dict(zip(vertices.tolist(), vertex_values.tolist(), strict=True))
        return SimpleNamespace(**keywords)

    return tell


def crease_edges(ob, creases):
    """`creases` is {(vertex, vertex): crease}; the edges must exist."""
    index = {frozenset(edge.vertices): edge.index for edge in ob.data.edges}
    layer = ob.data.edge_creases_ensure()
    for ends, crease in creases.items():
        layer.data[index[frozenset(ends)]].value = crease


def crease_vertices(ob, creases):
    layer = ob.data.vertex_creases_ensure()
    for vertex, crease in creases.items():
        layer.data[vertex].value = crease


def single(x):
    return float(np.float32(x))


def block():
    """Adds 3 x 3 quads: vertices 0, 3, 12, 15 have two edges, 5, 6, 9, 10 have four."""
    positions = [(x, y, 0) for y in range(4) for x in range(4)]
    corners = [4 * y + x for y in range(3) for x in range(3)]
    ob = add_mesh("Block", positions, [(a, a + 1, a + 5, a + 4) for a in corners])
    add_subsurf(ob)
    return ob


def test_no_creases(told):
    assert (told(block()).edges, told(scenes.cross()).vertices) == ({}, {})


def test_crease_c_is_sharpness_10_c_squared_in_single_precision(told):
    ob = block()
    creases = {(5, 6): 0.1, (6, 10): 0.3, (9, 10): 1.0, (1, 5): 0.77}
    crease_edges(ob, creases)
    crease_vertices(ob, {5: 0.3, 9: 1.0, 10: 0.0})
    found = told(ob)
    ten = np.float32(10)
    assert found.edges == {
        frozenset(ends): float(np.float32(c) * np.float32(c) * ten) for ends, c in creases.items()
    }
    assert found.edges[frozenset((9, 10))] == 10
    # the result in double precision
    assert found.edges[frozenset((6, 10))] != 10 * single(0.3) ** 2
    assert found.vertices == {5: float(np.float32(0.3) * np.float32(0.3) * ten), 9: 10}


def test_a_vertex_of_two_edges_adds_the_lesser_of_their_sharpness(told):
    ob = block()
    crease_edges(ob, {(0, 1): 0.5, (0, 4): 0.8, (3, 2): 0.5, (15, 14): 1.0, (15, 11): 1.0})
    crease_vertices(ob, {0: 0.5, 15: 0.5, 12: 0.4})
    found = told(ob).vertices
    assert found == {
        0: 2.5 + 2.5,  # its own sharpness and the smaller one of its edges
        12: pytest.approx(1.6),  # its edges are not creased
        15: 10,  # the largest sharpness
    }  # 3: one of its edges is not creased
    assert type(found[0]) is float


def test_edges_too_little_creased_for_blender_to_notice(told):
    ob = block()
    crease_edges(ob, {(5, 6): 3.1e-4, (6, 10): 3.2e-4, (0, 1): 3.1e-4, (0, 4): 1.0})
    found = told(ob)
    assert set(found.edges) == {frozenset((6, 10)), frozenset((0, 4))}
    assert found.vertices == {}


def test_a_vertex_of_two_edges_inside_the_mesh(told):
    """Two quads lie back to back along two edges that meet at vertex 0."""
    positions = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0.5), (1, 1, -0.5)]
    ob = add_mesh("Fold", positions, [(0, 1, 3, 2), (0, 2, 4, 1)])
    crease_edges(ob, {(0, 1): 0.5, (0, 2): 0.3})
    assert told(ob).vertices == {0: pytest.approx(0.9)}


@pytest.mark.parametrize("use_creases", [True, False])
def test_loose_edges_hold_the_vertices_that_they_touch(told, use_creases):
    ob = block()
    ob.modifiers[0].use_creases = use_creases
    mesh = ob.data
    mesh.vertices.add(2)  # vertices 16 and 17 are only on loose edges
    mesh.edges.add(3)
    for edge, ends in zip(mesh.edges[-3:], [(5, 16), (16, 17), (0, 10)], strict=True):
        edge.vertices = ends
    mesh.update()
    crease_edges(ob, {(5, 16): 0.5, (0, 10): 0.5})
    crease_vertices(ob, {16: 0.5, 6: 0.5})
    found = told(ob)
    assert found.edges == {}  # the creased edges are not part of the surface
    assert found.vertices == {5: 10, 0: 10, 10: 10} | ({6: 2.5} if use_creases else {})


def test_use_creases_off(told):
    ob = block()
    crease_edges(ob, {(0, 1): 1.0, (0, 4): 1.0, (5, 6): 0.5})
    crease_vertices(ob, {5: 0.5})
    assert len(told(ob).vertices) == 2
    ob.modifiers[0].use_creases = False
    assert (told(ob).edges, told(ob).vertices) == ({}, {})


def test_creases_of_the_mesh_behind_modifiers(told):
    ob = block()
    crease_edges(ob, {(5, 6): 0.5})
    array = ob.modifiers.new("Array", "ARRAY")
    array.relative_offset_displace = (2, 0, 0)
    ob.modifiers.move(1, 0)
    assert told(ob).edges == {frozenset((5, 6)): 2.5, frozenset((21, 22)): 2.5}


def test_simple_subdivision_is_bilinear(told):
    ob = block()
    crease_edges(ob, {(5, 6): 0.5})
    assert told(ob).scheme == "catmark"
    ob.modifiers[0].subdivision_type = "SIMPLE"
    found = told(ob)
    assert (found.scheme, found.edges, found.vertices) == ("bilinear", {}, {})
    assert cage.read(ob, bpy.context.evaluated_depsgraph_get()).rules.uv_interpolation == "all"


@pytest.mark.parametrize(("name", "expected"), scenes.BOUNDARIES.items())
def test_boundary(told, name, expected):
    ob = block()
    ob.modifiers[0].boundary_smooth = name
    assert told(ob).boundary == expected


def test_without_a_modifier_the_rules_are_a_new_one_s():
    ob = scenes.cross()
    bare = rules.read(rules.find_subsurf(ob))
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    assert rules.read(subsurf) == rules.Rules(**(vars(bare) | {"subsurf": "Subdivision"}))


def test_every_choice_of_the_modifier_is_known():
    properties = bpy.types.SubsurfModifier.bl_rna.properties
    for name, known in (
        ("boundary_smooth", rules.BOUNDARIES),
        ("subdivision_type", rules.SCHEMES),
        ("uv_smooth", rules.UV_INTERPOLATIONS),
    ):
        assert set(known) == {item.identifier for item in properties[name].enum_items}
        assert len(set(known.values())) == len(known)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("crease", [1.5, 1e20, np.inf, -1e20, -np.inf])
def test_creases_beyond_1_are_infinitely_sharp(told, crease):
    ob = block()
    crease_edges(ob, {(5, 6): crease})
    crease_vertices(ob, {9: crease})
    found = told(ob)
    assert (found.edges, found.vertices) == ({frozenset((5, 6)): 10}, {9: 10})
