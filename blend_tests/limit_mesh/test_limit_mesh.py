# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh that object.limit_mesh makes is compared with Blender's own subdivision and with
explicit limits.
"""

import bpy
import limit_mesh_truth as truth
import numpy as np
import pytest
import scenes
from limit_mesh_truth import make, match
from limit_surface import ids
from limit_surface.reading import attributes
from mathutils import Matrix

LEVELS = 2
MESHES = {name: scenes.SCENES[name] for name in ("cross", "grid with holes", "mixed polygons")}
MIRRORED = Matrix.Rotation(0.6, 4, (1, 2, 0)) @ Matrix.Diagonal((-2.0, 0.5, 1.5, 1))


@pytest.fixture(params=MESHES)
def dressed(request):
    ob = truth.dress(MESHES[request.param]())
    subsurf = scenes.add_subsurf(ob)
    subsurf.quality, subsurf.levels = truth.BEST, LEVELS
    return ob


@pytest.fixture
def both(dressed):
    """Returns the new object, Blender's mesh, and the matching of the two."""
    made = make(dressed, levels=LEVELS)
    theirs = dressed.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return made, theirs, match(made.data, theirs)


@pytest.mark.every(7)
@pytest.mark.parametrize(
    ("domain", "kind"), [(d, k) for d, kinds in truth.KINDS.items() for k in kinds]
)
def test_attributes_are_those_of_blenders_subdivision(both, domain, kind):
    made, theirs, matched = both
    name = truth.name_of(domain, kind)
    attribute = made.data.attributes[name]
    assert (attribute.domain, attribute.data_type) == (domain, kind)
    ours, rows = attributes.read(made.data, name), matched.rows(domain, made.data, theirs)
    if attributes.LAYOUTS[kind].dtype is not np.float32 and domain in ("POINT", "CORNER"):
        check_nearest(made, ours, name)
        return
    if kind == "BYTE_COLOR":  # on faces other than quads Blender rounds twice
        ours, expected, tolerance = truth.bytes_of(made.data, name), truth.bytes_of(theirs, name), 2
    else:
        expected, tolerance = attributes.read(theirs, name).astype(float), 1e-5
    np.testing.assert_allclose(ours[rows[0]], expected[rows[1]], atol=tolerance)
    assert np.ptp(ours.astype(float)) > 0.5


def check_nearest(made, ours, name):
    """Integers are values of the cage, and at its corners they are the value there."""
    cage = made.parent.data
    theirs = attributes.read(cage, name)
    assert set(np.unique(ours)) <= set(np.unique(theirs))
    if cage.attributes[name].domain != "POINT":
        return
    surface = scenes.surface_without_addon(made.parent)
    at = surface.vertex_locations()
    corners = surface.evaluate(at.face, at.uv).position
    apart = np.linalg.norm(attributes.read(made.data, "position")[:, None] - corners, axis=2)
    assert (apart.min(axis=0) < 1e-6).all()
    np.testing.assert_array_equal(ours[apart.argmin(axis=0)], theirs)


@pytest.mark.parametrize("rule", ["NONE", "PRESERVE_CORNERS", "PRESERVE_BOUNDARIES", "SMOOTH_ALL"])
def test_uv_maps_follow_the_modifiers_rule(dressed, rule):
    dressed.modifiers[0].uv_smooth = rule
    made = make(dressed, levels=LEVELS)
    theirs = dressed.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    matched = match(made.data, theirs)
    assert set(made.data.uv_layers.keys()) == {"First", "Second"}
    for name in ("First", "Second"):
        ours = attributes.read(made.data, name)
        expected = attributes.read(theirs, name)[matched.corner]
        np.testing.assert_allclose(ours, expected, atol=2e-6)


def test_active_layers_stay_active(both):
    made = both[0].data
    assert made.uv_layers.active.name == "Second"
    assert [layer.name for layer in made.uv_layers if layer.active_render] == ["First"]
    assert made.color_attributes.active_color_name == truth.name_of("CORNER", "BYTE_COLOR")


def test_vertex_groups_are_those_of_blenders_subdivision(both, dressed):
    made, theirs, matched = both
    assert made.vertex_groups.keys() == list(truth.GROUPS)
    ours, expected = truth.weights(made, made.data), truth.weights(dressed, theirs)
    rows = matched.rows("POINT", made.data, theirs)
    np.testing.assert_allclose(ours[rows[0]], expected[rows[1]], atol=1e-5)
    assert not any(attribute.name.startswith(".limit") for attribute in made.data.attributes)


def test_seams_and_materials(both, dressed):
    made, theirs, matched = both
    one, other = matched.rows("EDGE", made.data, theirs)
    seams = [np.array([e.use_seam for e in mesh.edges]) for mesh in (made.data, theirs)]
    np.testing.assert_array_equal(seams[0][one], seams[1][other])
    assert made.data.materials.keys() == ["Red", "Blue", "Own"]
    index = [np.array([p.material_index for p in mesh.polygons]) for mesh in (made.data, theirs)]
    np.testing.assert_array_equal(index[0], index[1][matched.polygon])


def test_materials_of_the_object(dressed):
    slot = dressed.material_slots[1]
    slot.link = "OBJECT"
    slot.material = bpy.data.materials.new("Object's")
    made = make(dressed, levels=1)
    slots = [(s.link, s.material.name) for s in made.material_slots]
    assert slots == [("DATA", "Red"), ("OBJECT", "Object's"), ("DATA", "Own")]
    assert dressed.data.materials[1].name == "Blue"


def test_materials_that_modifiers_set(dressed):
    """Their faces have slots that the object itself does not have."""
    gold = bpy.data.materials.new("Gold")
    group = bpy.data.node_groups.new("Gilded", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    kinds = ("NodeGroupInput", "GeometryNodeSetMaterial", "NodeGroupOutput")
    begin, gilded, end = (group.nodes.new(kind) for kind in kinds)
    gilded.inputs["Material"].default_value = gold
    group.links.new(begin.outputs[0], gilded.inputs[0])
    group.links.new(gilded.outputs[0], end.inputs[0])
    dressed.modifiers.new("Gilded", "NODES").node_group = group
    dressed.modifiers.move(1, 0)
    mesh = make(dressed, levels=1, follow="NONE").data
    assert {mesh.materials[polygon.material_index] for polygon in mesh.polygons} == {gold}


@pytest.mark.parametrize("matrix", [Matrix.Identity(4), MIRRORED], ids=["as it is", "mirrored"])
def test_vertices_and_normals_are_the_surfaces(dressed, matrix):
    dressed.matrix_world = matrix
    made = make(dressed, levels=LEVELS, store_locations=True)
    np.testing.assert_allclose(made.matrix_world, matrix, atol=1e-6)
    mesh, surface = made.data, scenes.surface_without_addon(dressed)
    face, uv = scenes.locations(mesh)
    here = surface.evaluate(face, uv, 1)
    np.testing.assert_allclose(attributes.read(mesh, "position"), here.position, atol=1e-6)
    shown = truth.corner_normals(mesh)
    expected = here.normal[truth.corner_vertices(mesh)]
    known = ~np.isnan(expected[:, 0])
    assert known.mean() > 0.8
    np.testing.assert_allclose(shown[known], expected[known], atol=ENCODED)
    np.testing.assert_allclose(np.linalg.norm(shown, axis=1), 1, atol=1e-4)


#: Before 4.5 Blender stores custom normals as two angles of 16 bits
ENCODED = 1e-6 if bpy.app.version >= (4, 5) else 2e-4


def creased_cube():
    bpy.ops.mesh.primitive_cube_add()
    ob = bpy.context.active_object
    around = ob.data.polygons[0].edge_keys
    creases = np.array([edge.key in around for edge in ob.data.edges], np.float32)
    attributes.write(ob.data, ids.EDGE_CREASE, "FLOAT", "EDGE", creases)
    scenes.add_subsurf(ob)
    return ob


def test_normals_at_creases_are_those_of_either_side():
    """The rim of the lid has two normals at each point; the mesh shows both, each on the polygons
    of its own side.
    """
    ob = creased_cube()
    made = make(ob, levels=3)
    mesh = made.data
    shown, vertex = truth.corner_normals(mesh), truth.corner_vertices(mesh)
    position = attributes.read(mesh, "position")
    polygon = np.repeat(np.arange(len(mesh.polygons)), 4)
    flat = np.array([p.normal for p in mesh.polygons])[polygon]
    # Exact normals differ from those of small polygons by their size, not by a crease.
    assert (shown * flat).sum(axis=1).min() > 0.8
    smooth = np.zeros((len(position), 3))
    np.add.at(smooth, vertex, flat)
    smooth /= np.linalg.norm(smooth, axis=1, keepdims=True)
    apart = np.linalg.norm(shown - smooth[vertex], axis=1)
    assert np.count_nonzero(apart > 0.2) >= 4 * 8 * 2


def test_edges_are_sharp_where_they_part_normals():
    """No other edges are sharp, because renderers split vertices at sharp edges."""
    ob = creased_cube()
    mesh = make(ob, levels=3).data
    crease = attributes.read(mesh, ids.EDGE_CREASE) == 1
    sharp = np.array([edge.use_edge_sharp for edge in mesh.edges])
    assert crease.sum() == 4 * 8
    np.testing.assert_array_equal(sharp, crease)
    cross = scenes.cross()
    assert not any(e.use_edge_sharp for e in make(cross, levels=2).data.edges)
    cross.data.edges[3].use_edge_sharp = True
    assert sum(e.use_edge_sharp for e in make(cross, levels=2).data.edges) == 4


def test_normals_are_blenders_own_without_exact_ones(dressed):
    dressed.data.polygons.foreach_set("use_smooth", np.arange(len(dressed.data.polygons)) % 2 == 0)
    made = make(dressed, levels=1, exact_normals=False)
    assert not made.data.has_custom_normals
    smooth = [p.use_smooth for p in made.data.polygons]
    assert set(smooth) == {True, False}
    assert make(dressed, levels=1).data.has_custom_normals


def test_the_original_is_left_alone(dressed):
    before = scenes.file_contents()
    make(dressed, levels=1)
    after = scenes.file_contents()
    assert {k for k in after if after[k] != before[k]} == {"objects", "meshes"}
    assert not dressed.hide_get()
    assert not dressed.hide_render
    make(dressed, levels=1, hide_original=True)
    assert dressed.hide_get()
    assert dressed.hide_render


def test_the_mesh_is_sound(dressed):
    for properties in ({"levels": 2}, {"level_source": "FLATNESS", "tolerance": 0.02}):
        mesh = make(dressed, **properties).data
        assert not mesh.validate(verbose=True)


def test_edges_are_selected_and_can_be_deselected(dressed):
    mesh = make(dressed, levels=LEVELS).data
    assert attributes.read(mesh, ids.EDGE_SELECTION).all()
    mesh.edges.foreach_set("select", [False] * len(mesh.edges))
    assert not attributes.read(mesh, ids.EDGE_SELECTION).any()


def test_undo(dressed):
    bpy.ops.ed.undo_push()
    before = scenes.file_contents()
    scenes.activate(dressed)
    bpy.ops.object.limit_mesh(levels=1)
    bpy.ops.ed.undo_push()
    bpy.ops.ed.undo()
    assert scenes.file_contents() == before


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_locations_on_another_surface_are_not_carried_over(follow):
    """Or else a mesh of a mesh would follow it by the locations of that one's own surface."""
    ob = scenes.grid_with_holes()
    first = make(ob, levels=1, store_locations=True, follow="NONE")
    bpy.ops.object.limit_follow(mode=follow)
    second = make(first, levels=1, follow="NONE")
    names = second.data.attributes.keys()
    assert not [name for name in names if name.startswith(("limit_", "rest_", "tile_"))]
    before = attributes.read(second.data, "position")
    first.select_set(True)
    scenes.activate(first)
    bpy.ops.object.limit_follow(mode="NODES")
    shown = second.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    np.testing.assert_allclose(attributes.read(shown, "position"), before, atol=2e-6)


@pytest.mark.parametrize(
    ("kind", "domain"), [("FLOAT", "POINT"), ("BOOLEAN", "EDGE"), ("FLOAT_VECTOR", "CORNER")]
)
@pytest.mark.parametrize("name", ["limit_face", "limit_uv", "rest_root", "rest_rot", "limit_seal"])
@pytest.mark.parametrize("follow", ["NONE", "NODES"])
def test_reserved_names_of_any_type_are_not_carried_over(name, kind, domain, follow, capfd):
    ob = scenes.grid_with_holes()
    ob.data.attributes.new(name, kind, domain)
    stored = make(ob, levels=1, store_locations=True, follow=follow).data.attributes
    assert (stored["rest_rot"].data_type, stored["rest_rot"].domain) == ("QUATERNION", "POINT")
    assert (stored["limit_face"].data_type, stored["limit_face"].domain) == ("INT", "POINT")
    if name != "limit_seal":
        assert f"{name} is not carried over: the name is reserved" in capfd.readouterr().out
    assert name not in make(ob, levels=1, follow="NONE").data.attributes


def test_what_is_not_as_asked_for_a_linked_mesh_is_told(tmp_path, capfd):
    ob = scenes.flat_grid(2)
    ob.shape_key_add(name="Basis")
    path = str(tmp_path / "asset.blend")
    bpy.data.libraries.write(path, {ob})
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (_there, here):
        here.objects = ["Flat"]
    bpy.context.collection.objects.link(here.objects[0])
    make(here.objects[0], levels=1, hide_original=True)
    said = capfd.readouterr().out
    assert "Flat is linked from another file. Renders do not show it now, but they will" in said
    assert "it does not follow the surface: Flat is linked from another file" in said


def test_what_followers_need_is_not_carried_over():
    ob = scenes.cross()
    scenes.add_subsurf(ob)
    scenes.add_hair(ob, follow="NODES")
    scenes.activate(ob)
    bpy.ops.object.limit_mesh()
    names = bpy.context.active_object.data.attributes.keys()
    assert not [name for name in names if name.startswith("cage_")]
