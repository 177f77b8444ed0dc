# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group Sample Limit Surface, its tables and its asset library."""

import subprocess
import sys
from collections import Counter
from pathlib import Path

import bpy
import build_assets
import follow_truth
import numpy as np
import pages
import pytest
import scenes
from follow_scenes import deforming
from limit_surface import ids
from limit_surface.nodes.sample_surface import SAMPLE_SURFACE
from limit_surface.nodes.tree import Socket, Tree
from limit_surface.placing import all_tiles
from limit_surface.reading import attributes
from limit_surface.sampling import library
from processes import ROOT

FRAMES = ((1, 0.0), (13, 0.5), (30, 0.0))
STORED = {
    "Position": "FLOAT_VECTOR",
    "Normal": "FLOAT_VECTOR",
    "Tangent": "FLOAT_VECTOR",
    "Rotation": "QUATERNION",
    "du": "FLOAT_VECTOR",
    "dv": "FLOAT_VECTOR",
    "Fits": "BOOLEAN",
}


def make_tables(ob: bpy.types.Object, **properties: object) -> bpy.types.Object:
    scenes.activate(ob)
    assert bpy.ops.object.limit_sample_tables(**properties) == {"FINISHED"}
    table = all_tiles.of_surface(ob)
    assert table is not None
    return table


def probes(
    ob: bpy.types.Object, face: np.ndarray, uv: np.ndarray, by_tile: bool = False
) -> bpy.types.Object:
    """Adds points with these locations, on which nodes store all that they sample."""
    mesh = bpy.data.meshes.new("Probes")
    mesh.vertices.add(len(face))
    attributes.write(mesh, "at", "INT", "POINT", face)
    attributes.write(mesh, "uv", "FLOAT2", "POINT", uv)
    made = bpy.data.objects.new("Probes", mesh)
    bpy.context.collection.objects.link(made)
    tree = Tree(
        "Probe",
        [Socket("Geometry", "Geometry", "")],
        [Socket("Geometry", "Geometry", "")],
        is_modifier=True,
    )
    number, place = tree.attribute("at", "INT"), tree.attribute("uv", "FLOAT_VECTOR")
    sampled = tree.group_node(
        SAMPLE_SURFACE.group(),
        Surface=ob,
        Tiles=all_tiles.of_surface(ob),
        Use_Tile=by_tile,
        **({"Tile": number, "Tile_UV": place} if by_tile else {"Face": number, "UV": place}),
    )
    geometry = tree.inputs["Geometry"]
    for name, kind in STORED.items():
        geometry = tree.store(geometry, f"seen {name}", sampled[name], kind)
    made.modifiers.new("Probe", "NODES").node_group = tree.finish(Geometry=geometry)
    return made


def seen(made: bpy.types.Object, name: str) -> np.ndarray:
    return follow_truth.shown(made, f"seen {name}")


def everywhere(ob: bpy.types.Object, count: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(4)
    face = rng.integers(scenes.surface_without_addon(ob).face_count, size=count)
    return face, rng.uniform(0.001, 0.999, (count, 2)).astype(np.float32)


def check(ob: bpy.types.Object, made: bpy.types.Object, face: np.ndarray, uv: np.ndarray) -> None:
    matrix = np.array(ob.matrix_world)
    linear = matrix[:3, :3]
    scale = max(1.0, np.abs(linear).max())
    bound = scale * follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        surface = scenes.surface_without_addon(ob)
        at = surface.evaluate(face, uv.astype(np.float64), derivatives=1)
        error = seen(made, "Position") - scenes.transformed(matrix, at.position)
        assert np.abs(error).max() < bound
        for name, exact in (("du", at.du), ("dv", at.dv)):
            size = np.abs(exact).max()
            assert np.abs(seen(made, name) - exact @ linear.T).max() < 1e-4 * scale * size
        tangent, normal = at.du @ linear.T, at.normal @ np.linalg.inv(linear)
        for name, exact in (("Tangent", tangent), ("Normal", normal)):
            exact = exact / np.linalg.norm(exact, axis=1)[:, None]
            assert np.abs(seen(made, name) - exact).max() < follow_truth.FRAME_BOUND
        assert seen(made, "Fits").all()


@pytest.mark.parametrize("mirrored", [False, *scenes.slow(True)])
@pytest.mark.parametrize("scene", scenes.SMALL_FIRST)
def test_samples_are_those_of_limitsurf(scene, mirrored):
    ob = deforming(scene, mirrored)
    make_tables(ob)
    face, uv = everywhere(ob, 3000)
    check(ob, probes(ob, face, uv), face, uv)


def test_places_may_be_given_by_tile():
    ob = deforming("mixed polygons")
    make_tables(ob, depth=16)
    bpy.context.scene.frame_set(1)
    face, uv = everywhere(ob, 500)
    tree = scenes.surface_without_addon(ob).tile_quadtree(16)
    # the table's own tiles: found as the nodes find them
    node, rest = face.copy(), uv.astype(np.float64)
    for _ in range(tree.levels):
        below, upper = tree.child[node], np.minimum(np.floor(2 * rest), 1)
        chosen = below + (upper @ [1, 2]).astype(int)
        rest = np.where((below >= 0)[:, None], 2 * rest - upper, rest)
        node = np.where(below >= 0, chosen, node)
    tile = -1 - tree.child[node]
    scale = np.zeros_like(tree.origin)
    scale[tree.tiles.tile] = tree.tiles.scale
    made = probes(ob, tile, (uv - tree.origin[tile]) * scale[tile], by_tile=True)
    check(ob, made, face, uv)


@pytest.mark.parametrize("depth", [4, 10, 24])
def test_depth_bounds_the_error_at_irregular_vertices(depth):
    ob = deforming("mixed polygons")
    ob.matrix_world.identity()
    make_tables(ob, depth=depth)
    surface = scenes.surface_without_addon(ob)
    at = surface.vertex_locations()
    face, uv = np.asarray(at.face), np.asarray(at.uv)
    error = np.abs(seen(probes(ob, face, uv), "Position") - surface.evaluate(face, uv).position)
    assert error.max() < 16 * 2.0**-depth + follow_truth.POSITION_BOUND * 8
    # beyond that distance nothing is lost
    inside = np.clip(uv, 2.0**-depth, 1 - 2.0**-depth).astype(np.float32)
    exact = surface.evaluate(face, inside.astype(np.float64)).position
    assert np.abs(seen(probes(ob, face, inside), "Position") - exact).max() < 2e-5


def test_what_does_not_exist_does_not_fit():
    ob = deforming("cross")
    make_tables(ob)
    made = probes(ob, np.array([0, 4, 5, -1]), np.full((4, 2), 0.5))
    np.testing.assert_array_equal(seen(made, "Fits"), [True, True, False, False])
    ob.modifiers.new("Mirror", "MIRROR")
    ob.modifiers.move(len(ob.modifiers) - 1, 0)
    bpy.context.view_layer.update()
    assert not seen(made, "Fits").any()


def test_tables_are_made_anew_in_the_same_objects():
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="NODES")
    table = make_tables(ob, depth=3)
    objects = set(bpy.data.objects)
    ob.modifiers["Subdivision"].boundary_smooth = "PRESERVE_CORNERS"
    assert make_tables(ob, depth=9) == table
    assert set(bpy.data.objects) == objects
    assert len(table.data.vertices) > 1000
    face, uv = everywhere(ob, 200)
    made = probes(ob, face, uv)
    exact = follow_truth.diagonal(ob) * follow_truth.POSITION_BOUND * 1.2
    at = scenes.surface_without_addon(ob, "PRESERVE_CORNERS").evaluate(face, uv.astype(float))
    expected = scenes.transformed(ob.matrix_world, at.position)
    assert np.abs(seen(made, "Position") - expected).max() < exact
    # tables of followers are others
    scenes.activate(hair)
    hair.select_set(True)
    assert bpy.ops.object.limit_unbind(shape="REST") == {"FINISHED"}
    assert seen(made, "Fits").all()


def test_the_pages_example_is_exact():
    ob = deforming("mixed polygons")
    scenes.activate(ob)
    (example,) = pages.examples(pages.text("sampling"))
    exec(example, {})
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        found = np.array(
            [
                np.array(instance.matrix_world)  # which ends with the iteration
                for instance in depsgraph.object_instances
                if instance.is_instance and instance.parent.name == "Pebbles"
            ],
            np.float64,
        )
        assert len(found) > 50
        surface = scenes.surface_without_addon(ob)
        surface.set_positions(scenes.transformed(ob.matrix_world, surface.positions))
        hits = surface.closest(found[:, :3, 3])
        assert hits.distance.max() < 2e-6 * follow_truth.diagonal(ob) * 1.2
        away = np.isfinite(hits.normal).all(axis=1)
        assert np.abs(found[away, :3, 2] - hits.normal[away]).max() < 1e-3


def test_faces_lie_on_the_surface():
    ob = deforming("mixed polygons")
    make_tables(ob, levels=1)
    faces = bpy.data.objects[f"{ids.FACES_TABLE} of {ob.name}"]
    assert faces.parent == ob
    corner_face = np.repeat(attributes.read(faces.data, ids.FACE), 4)
    uv = attributes.read(faces.data, ids.UV)
    corners = attributes.read(faces.data, ids.CORNER_VERTEX)
    surface = scenes.surface_without_addon(ob)
    assert len(faces.data.polygons) == 4 * surface.face_count
    exact = surface.evaluate(corner_face, uv.astype(np.float64)).position
    np.testing.assert_allclose(attributes.read(faces.data, ids.POSITION)[corners], exact, atol=1e-6)


def test_the_group_is_added_once():
    for _ in range(2):
        assert bpy.ops.node.limit_sample_add() == {"FINISHED"}
    names = [group.name for group in bpy.data.node_groups]
    assert sorted(names) == sorted([ids.SAMPLE_GROUP, ids.SAMPLE_TILE_GROUP, ids.LOCATE_GROUP])


def contents(path: Path) -> dict[str, tuple]:
    """Returns what matters of the node groups in a file."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(path)) as (there, here):
        here.node_groups = there.node_groups
    return {
        group.name: (
            group[ids.GROUP_MARK],
            group.asset_data and (group.asset_data.description, group.asset_data.author),
            [
                (item.name, item.in_out, item.socket_type, item.description)
                for item in group.interface.items_tree
            ],
            Counter(node.bl_idname for node in group.nodes),
            Counter(
                (link.from_node.bl_idname, link.from_socket.name, link.to_node.bl_idname,
                 link.to_socket.name)
                for link in group.links
            ),
        )
        for group in here.node_groups
    }  # fmt: skip


def test_the_asset_library_is_what_the_program_writes(tmp_path):
    program = ROOT / "tools/build_assets.py"
    subprocess.run([sys.executable, program, tmp_path / "new.blend"], check=True)
    new, shipped = contents(tmp_path / "new.blend"), contents(library.FILE)
    assert new == shipped
    assets = {name for name, (_mark, asset, *_rest) in shipped.items() if asset}
    assert assets == {kind.name for kind in build_assets.DESCRIPTIONS}


def test_the_shipped_group_works():
    with bpy.data.libraries.load(str(library.FILE)) as (there, here):
        here.node_groups = [ids.SAMPLE_GROUP]
    (group,) = here.node_groups
    assert SAMPLE_SURFACE.group() == group
    ob = deforming("grid with holes")
    make_tables(ob)
    face, uv = everywhere(ob, 300)
    check(ob, probes(ob, face, uv), face, uv)


def test_the_library_is_listed_once_and_only_while_the_extension_is_enabled():
    def listed() -> list[str]:
        libraries = bpy.context.preferences.filepaths.asset_libraries
        return [x.path for x in libraries if x.name == ids.ASSET_LIBRARY]

    assert listed() == [str(library.FOLDER)]
    library.attach_library()
    assert len(listed()) == 1
    library.detach_library()
    assert listed() == []
    library.detach_library()
    library.attach_library()
    assert len(listed()) == 1


def refused(ob: bpy.types.Object, match: str) -> None:
    scenes.activate(ob)
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_sample_tables()
    assert scenes.file_contents() == before


def test_refusals():
    refused(scenes.add_mesh("Loose", [(0, 0, 0), (1, 0, 0)], [], [(0, 1)]), "Loose has no faces")
    ob = scenes.cross()
    ob.modifiers.new("Multires", "MULTIRES")
    refused(ob, "Multiresolution")


def test_table_lists_the_properties_and_their_defaults():
    section = pages.text("sampling").split("## `object.limit_sample_")[1]
    pages.check_properties(section, "limit_sample_tables")


def test_tooltips_of_sockets_need_no_knowledge_of_the_extension():
    """They are whole phrases, and say in which objects, groups or attributes the values are."""
    sockets = {
        item.name: item.description
        for kind in build_assets.DESCRIPTIONS
        for item in kind.group().interface.items_tree
    }
    for name, words in sockets.items():
        assert len(words.split()) > 4, name
        assert not words.endswith("."), name
        assert not set(words.lower().split()) & {"ptex", "cage", "u", "v"}, name
    assert "the attribute limit_face" in sockets["Face"]
    assert "the attribute limit_uv" in sockets["UV"]
    assert "operator Tables for Sample Limit Surface" in sockets["Tiles"]
