# SPDX-License-Identifier: GPL-3.0-or-later
"""Places on the mesh that Blender shows, compared with the triangles that Blender draws."""

import bpy
import numpy as np
import pytest
import scenes
from figures.parity import zoo as parity_zoo
from limit_surface import ids
from limit_surface.errors import CageError, DisplayedError
from limit_surface.reading import attributes, cage, displayed_mesh, subdivided_mesh

PER_FACE = 12


def read(ob, kind):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return displayed_mesh.read(ob, depsgraph, cage.read(ob, depsgraph), kind)


def shown_in_viewport(ob):
    return ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data


def polygon_of_face(ob):
    """Returns the polygon that each Ptex face belongs to."""
    return cage.read(ob, bpy.context.evaluated_depsgraph_get()).surface().base_face


def some_locations(ob, seed=0):
    """Returns locations on all Ptex faces: inside, on the borders of polygons, and at corners."""
    rng = np.random.default_rng(seed)
    face = np.repeat(np.arange(len(polygon_of_face(ob))), PER_FACE)
    uv = rng.random((len(face), 2))
    uv[::4, 0] = rng.integers(0, 9, len(uv[::4])) / 8
    uv[::3, 1] = rng.integers(0, 5, len(uv[::3])) / 4
    return face, uv


def triangles(mesh):
    mesh.calc_loop_triangles()
    corners = np.array([triangle.loops for triangle in mesh.loop_triangles])
    return corners, np.array([triangle.normal for triangle in mesh.loop_triangles])


def on_drawn_triangles(mesh, corner_locations, face, uv):
    """Finds positions by testing all of Blender's triangles in turn, and returns the triangles'
    normals (those of all that meet there are tested).
    """
    corners, normals = triangles(mesh)
    vertex = attributes.read(mesh, ids.CORNER_VERTEX)
    vertices = attributes.read(mesh, ids.POSITION).astype(np.float64)[vertex]
    on_face, at = corner_locations
    found, facing = np.empty((len(face), 3)), []
    for i, (one, place) in enumerate(zip(face, uv, strict=True)):
        mine = corners[on_face[corners[:, 0]] == one]
        rows = np.flatnonzero(on_face[corners[:, 0]] == one)
        a, b, c = at[mine].transpose(1, 0, 2)
        sides = np.stack([b - a, c - a], axis=2)
        weights = np.linalg.solve(sides, (place - a)[:, :, None])[:, :, 0]
        weights = np.column_stack([1 - weights.sum(axis=1), weights])
        inside = np.flatnonzero((weights > -1e-9).all(axis=1))
        assert len(inside)
        found[i] = weights[inside[0]] @ vertices[mine[inside[0]]]
        facing.append(normals[rows[inside]])
    return found, facing


@pytest.mark.every(3)
@pytest.mark.parametrize("level", [1, 2, 3, *scenes.slow(4)])
@pytest.mark.parametrize("name", ["cross", "sheet", "polygons", "prism", "fans", "fin", "monkey"])
def test_positions_are_on_the_triangles_that_are_drawn(name, level):
    ob = parity_zoo.add(name)
    ob.modifiers[0].levels = level
    face, uv = some_locations(ob)
    if name == "monkey":
        face, uv = face[::37], uv[::37]
    mesh = shown_in_viewport(ob)
    corners = subdivided_mesh.corner_locations(attributes.face_sizes(ob.data), level)
    expected, facing = on_drawn_triangles(mesh, corners, face, uv)

    shown = read(ob, "VIEWPORT")
    assert shown.level == level
    np.testing.assert_allclose(shown.positions(face, uv), expected, atol=1e-12)
    frames = shown.frames(face, uv)
    identity = np.broadcast_to(np.eye(3), frames.shape)
    np.testing.assert_allclose(frames.transpose(0, 2, 1) @ frames, identity, atol=1e-12)
    for frame, normals in zip(frames, facing, strict=True):
        # Blender's positions are rounded
        assert np.abs(normals - frame[:, 2]).max(axis=1).min() < 1e-4


@pytest.mark.parametrize("name", ["sheet", "polygons"])
def test_tangents_go_along_u(name):
    ob = parity_zoo.add(name)
    ob.modifiers[0].levels = 2
    shown = read(ob, "VIEWPORT")
    face, uv = some_locations(ob)
    uv = 0.001 + 0.99 * uv
    along = shown.positions(face, uv + [1e-7, 0]) - shown.positions(face, uv)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    assert np.median(np.abs(along - shown.frames(face, uv)[:, :, 0]).max(axis=1)) < 1e-6
    agree = np.abs(along - shown.frames(face, uv)[:, :, 0]).max(axis=1) < 1e-6
    assert agree.mean() > 0.99  # except where a step leaves the triangle


def test_any_level_without_changing_the_modifier():
    ob = parity_zoo.add("polygons")
    face, uv = some_locations(ob)
    for level in (1, 3):
        ob.modifiers[0].levels = level
        expected = read(ob, "VIEWPORT").positions(face, uv)
        ob.modifiers[0].levels = 2
        shown = read(ob, level)
        assert (shown.level, ob.modifiers[0].levels) == (level, 2)
        np.testing.assert_array_equal(shown.positions(face, uv), expected)


@pytest.mark.parametrize("name", ["polygons", "fans"])
def test_level_0_is_the_mesh_itself(name):
    """Quads are cut into two triangles; the parts of other polygons meet at the mean of their
    corners.
    """
    ob = parity_zoo.add(name)
    ob.modifiers[0].levels = 0
    shown = read(ob, "VIEWPORT")
    assert shown.level == 0
    face, uv = some_locations(ob)
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    bilinear = scenes.on_base_mesh(ob, np.repeat(face, 4), np.tile(corners, (len(face), 1)))
    at_corners = shown.positions(np.repeat(face, 4), np.tile(corners, (len(face), 1)))
    np.testing.assert_allclose(at_corners, bilinear, atol=1e-12)
    on_pentagon = attributes.face_sizes(ob.data)[polygon_of_face(ob)[face]] == 5
    for place in shown.positions(face[~on_pentagon], uv[~on_pentagon]):
        _, nearest, normal, _ = ob.closest_point_on_mesh(place)
        off = np.array(nearest) - place  # Blender calculates it in single precision
        assert np.linalg.norm(off) < 3e-5
        assert abs(off @ normal) < 3e-6


def test_without_a_modifier_it_is_the_mesh_itself():
    ob = scenes.mixed_polygons()
    for kind in ("VIEWPORT", "RENDER"):
        assert read(ob, kind).level == 0
    with pytest.raises(DisplayedError, match="Mixed has no Subdivision Surface modifier"):
        read(ob, 2)


def test_loose_edges_and_isolated_vertices():
    ob = parity_zoo.add("sheet")
    parity_zoo.crease(ob.data, "loose edges")
    ob.modifiers[0].levels = 2
    face, uv = some_locations(ob)
    corners = subdivided_mesh.corner_locations(attributes.face_sizes(ob.data), 2)
    expected, _ = on_drawn_triangles(shown_in_viewport(ob), corners, face, uv)
    np.testing.assert_allclose(read(ob, "VIEWPORT").positions(face, uv), expected, atol=1e-12)


class Snapshot(bpy.types.RenderEngine):
    """A render engine that renders nothing, and stores the meshes that it is given."""

    bl_idname = "SNAPSHOT"
    bl_label = "Snapshot"
    meshes: dict = {}

    def render(self, depsgraph):
        for ob in depsgraph.objects:
            if ob.type == "MESH":
                Snapshot.meshes[ob.name] = (
                    attributes.read(ob.data, ids.POSITION).astype(np.float64),
                    len(ob.data.polygons),
                )


@pytest.fixture
def rendered():
    """Returns what a render gets of an object: its vertices, and the number of its polygons."""

    def look(ob):
        scene = bpy.context.scene
        scene.render.engine = "SNAPSHOT"
        scene.render.resolution_x = scene.render.resolution_y = 8
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        scene.collection.objects.link(camera)
        scene.camera = camera
        Snapshot.meshes = {}
        bpy.ops.render.render()
        return Snapshot.meshes[ob.name]

    bpy.utils.register_class(Snapshot)
    yield look
    bpy.utils.unregister_class(Snapshot)


def check_render(ob, rendered, level):
    """Checks that all vertices of a render are found at their locations."""
    positions, polygons = rendered(ob)
    shown = read(ob, "RENDER")
    assert shown.level == level
    sizes = attributes.face_sizes(ob.data)
    corners = subdivided_mesh.corner_locations(sizes, level)
    assert polygons == len(corners.face) // 4
    found = shown.positions(*corners)
    assert {tuple(p) for p in found} <= {tuple(p) for p in positions}
    assert len(np.unique(found, axis=0)) == len(np.unique(positions, axis=0))


def test_a_render_shows_the_same(rendered):
    ob = parity_zoo.add("polygons")
    subsurf = ob.modifiers[0]
    subsurf.levels, subsurf.render_levels, subsurf.quality = 1, 3, 2
    check_render(ob, rendered, 3)


@pytest.mark.parametrize("kind", ["VIEWPORT", "RENDER"])
def test_simplify(rendered, kind):
    ob = parity_zoo.add("sheet")
    ob.modifiers[0].levels, ob.modifiers[0].render_levels = 3, 4
    render = bpy.context.scene.render
    render.use_simplify = True
    render.simplify_subdivision, render.simplify_subdivision_render = 1, 2
    if kind == "RENDER":
        check_render(ob, rendered, 2)
    else:
        assert read(ob, "VIEWPORT").level == 1
        assert read(ob, 3).level == 3
        render.simplify_subdivision = 0
        assert read(ob, "VIEWPORT").level == 0


def test_modifiers_that_only_a_render_shows(rendered):
    ob = parity_zoo.add("sheet")
    displace = ob.modifiers.new("Displace", "DISPLACE")
    displace.strength, displace.show_viewport = 0.3, False
    ob.modifiers.move(1, 0)
    check_render(ob, rendered, 2)
    face, uv = some_locations(ob)
    apart = read(ob, "RENDER").positions(face, uv) - read(ob, 2).positions(face, uv)
    assert np.abs(apart).max() > 0.1


def test_subdivision_that_only_a_render_shows(rendered):
    ob = parity_zoo.add("sheet")
    ob.modifiers[0].show_viewport = False
    check_render(ob, rendered, 2)
    assert read(ob, "VIEWPORT").level == 0


def test_subdivision_that_only_the_viewport_shows():
    ob = parity_zoo.add("sheet")
    ob.modifiers[0].show_render = False
    assert read(ob, "RENDER").level == 0


def test_modifiers_behind_the_subdivision_are_ignored():
    ob = parity_zoo.add("sheet")
    face, uv = some_locations(ob)
    before = read(ob, "VIEWPORT").positions(face, uv)
    ob.modifiers.new("Displace", "DISPLACE")
    ob.modifiers.new("Again", "SUBSURF")
    np.testing.assert_array_equal(read(ob, "VIEWPORT").positions(face, uv), before)


def test_modifiers_that_make_vertices_before_the_subdivision():
    ob = parity_zoo.add("sheet")
    ob.modifiers.new("Mirror", "MIRROR").use_mirror_merge = False
    ob.modifiers.move(1, 0)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = cage.read(ob, depsgraph)
    shown = displayed_mesh.read(ob, depsgraph, found, "VIEWPORT")
    face, uv = some_locations(ob)
    face, uv = (rows[face < found.ptex_face_count // 2] for rows in (face, uv))
    # Mirrored faces start at the same corner and run the other way round.
    mirrored = shown.positions(face + found.ptex_face_count // 2, uv[:, ::-1])
    np.testing.assert_allclose(mirrored, shown.positions(face, uv) * [-1, 1, 1], atol=1e-6)


def test_the_file_is_left_alone():
    ob = parity_zoo.add("sheet")
    ob.modifiers[0].levels, ob.modifiers[0].render_levels = 1, 3
    before = scenes.file_contents(), ob.modifiers[0].levels, ob.modifiers[0].show_viewport
    for kind in ("VIEWPORT", "RENDER", 4):
        read(ob, kind)
    after = scenes.file_contents(), ob.modifiers[0].levels, ob.modifiers[0].show_viewport
    assert after == before


def refusal(ob, kind, pattern, error=DisplayedError):
    before = scenes.file_contents()
    with pytest.raises(error, match=pattern):
        read(ob, kind)
    assert scenes.file_contents() == before


def test_other_polygons_in_a_render():
    ob = parity_zoo.add("sheet")
    mirror = ob.modifiers.new("Mirror", "MIRROR")
    mirror.show_viewport = False
    ob.modifiers.move(1, 0)
    refusal(ob, "RENDER", "sheet: the mesh that a render shows has 576 polygons, which are not")
    assert read(ob, "VIEWPORT").level == 1


def test_simulations_in_a_render():
    ob = parity_zoo.add("sheet")
    ob.modifiers.new("Silk", "CLOTH").show_viewport = False
    ob.modifiers.move(1, 0)
    refusal(ob, "RENDER", "simulation Silk stands before", CageError)


def test_animated_levels():
    ob = parity_zoo.add("sheet")
    subsurf = ob.modifiers[0]
    subsurf.levels, subsurf.render_levels = 1, 3
    driver = subsurf.driver_add("levels").driver
    driver.expression = "2"
    assert read(ob, "VIEWPORT").level == 2
    refusal(
        ob, "RENDER", "cannot be measured, because levels or visibility of Subdivision are animated"
    )
    refusal(ob, 4, "the mesh of level 4 cannot be measured")


def test_adaptive_subdivision():
    ob = parity_zoo.add("sheet")
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    if hasattr(ob.modifiers[0], "use_adaptive_subdivision"):
        ob.modifiers[0].use_adaptive_subdivision = True
    else:
        scene.cycles.feature_set = "EXPERIMENTAL"
        ob.cycles.use_adaptive_subdivision = True
    refusal(ob, "RENDER", "sheet is rendered with adaptive subdivision")
    # Cycles dices only meshes whose last modifier is the subdivision
    ob.modifiers.new("Smooth", "SMOOTH")
    assert read(ob, "RENDER").level == 2


def test_frames_where_polygons_have_no_area():
    """Two corners, or all four, coincide: the frames are still rotations."""
    positions = [(0, 0, 0), (0, 0, 0), (1, 1, 0), (0, 1, 0), (3, 3, 3), (3, 3, 3)]
    ob = scenes.add_mesh("Pinched", positions, [(0, 1, 2, 3), (2, 4, 5, 2 + 1)])
    subsurf = scenes.add_subsurf(ob)
    subsurf.subdivision_type, subsurf.levels = "SIMPLE", 1
    positions[2] = positions[3] = (3, 3, 3)
    face, uv = np.repeat([0, 1], 100), np.random.default_rng(1).random((200, 2))
    for _ in range(2):
        frames = read(ob, "VIEWPORT").frames(face, uv)
        identity = np.broadcast_to(np.eye(3), frames.shape)
        np.testing.assert_allclose(frames.transpose(0, 2, 1) @ frames, identity, atol=1e-12)
        np.testing.assert_allclose(np.linalg.det(frames), 1)
        ob.data.vertices.foreach_set("co", np.ravel(positions))
        ob.data.update()
