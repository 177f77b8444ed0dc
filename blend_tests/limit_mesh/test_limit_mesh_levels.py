# SPDX-License-Identifier: GPL-3.0-or-later
"""The levels to which object.limit_mesh divides faces, and what it refuses."""

import bpy
import limit_mesh_truth as truth
import numpy as np
import pytest
import scenes
from bpy_extras.object_utils import world_to_camera_view
from limit_mesh_truth import make
from limit_surface import ids
from limit_surface.errors import CancelledError
from limit_surface.reading import attributes
from mathutils import Matrix, Vector

STRETCHED = Matrix.Translation((1, 2, 3)) @ Matrix.Diagonal((3.0, 2.0, 0.5, 1))


@pytest.fixture
def sheet():
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    return ob


def refused(match, **properties):
    before, active = scenes.file_contents(), bpy.context.active_object
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_mesh(**properties)
    assert scenes.file_contents() == before
    assert bpy.context.active_object == active


def polygons_of_faces(made, attribute="number"):
    """Returns how many polygons each face of the cage became."""
    return np.bincount(attributes.read(made.data, attribute))


def number_faces(ob):
    numbers = np.arange(len(ob.data.polygons))
    attributes.write(ob.data, "number", "INT", "FACE", numbers)


@pytest.mark.parametrize("levels", [0, 1, 3])
def test_uniform(sheet, levels):
    made = make(sheet, levels=levels)
    assert len(made.data.polygons) == 18 * 4**levels


def test_faces_other_than_quads_are_divided_once_at_least():
    ob = scenes.mixed_polygons()
    made = make(ob, levels=0)
    assert len(made.data.polygons) > sum(len(p.vertices) - 4 for p in ob.data.polygons)
    number_faces(ob)
    counts = polygons_of_faces(make(ob, levels=0))
    assert (counts >= [5, 1, 3, 3, 1]).all()
    # Next to them the edges of a quad have more parts than its own level gives.
    assert counts[1] > 1


@pytest.mark.parametrize("kind", ["INT", "FLOAT", "INT8"])
def test_an_attribute_of_faces(sheet, kind):
    levels = np.arange(18) % 4
    attributes.write(sheet.data, "fine", kind, "FACE", levels)
    number_faces(sheet)
    made = make(sheet, level_source="ATTRIBUTE", level_attribute="fine")
    counts = polygons_of_faces(made)
    assert (counts >= 4**levels).all()
    assert check_watertight(made.data) == check_watertight(sheet.data, levels)


def check_watertight(mesh, levels=None):
    """Checks how many edges have one polygon; the rest have two."""
    edge = attributes.read(mesh, ids.CORNER_EDGE)
    count = np.bincount(edge, minlength=len(mesh.edges))
    assert set(count) <= {1, 2}
    if levels is None:
        return np.count_nonzero(count == 1)
    face = np.repeat(np.arange(len(mesh.polygons)), attributes.face_sizes(mesh))
    return int((2 ** levels[face])[count[edge] == 1].sum())


def test_a_vertex_group(sheet):
    group = sheet.vertex_groups.new(name="fine")
    group.add([0, 1, 6, 7], 1.0, "REPLACE")
    group.add([29], 0.5, "REPLACE")
    number_faces(sheet)
    counts = polygons_of_faces(
        make(sheet, level_source="ATTRIBUTE", level_attribute="fine", levels=4)
    )
    assert counts[0] == 256
    assert 16 <= counts[17] < 40  # of weight 1/2
    assert np.count_nonzero(counts == 1) >= 8


def test_no_such_levels(sheet):
    properties = {"level_source": "ATTRIBUTE", "levels": 3}
    refused("Choose a face attribute or a vertex group", **properties)
    refused("neither a face attribute nor a vertex group named 'fine'",
            level_attribute="fine", **properties)  # fmt: skip
    sheet.vertex_groups.new(name="empty")
    refused("vertex group empty of Holes has no weights", level_attribute="empty", **properties)
    attributes.write(sheet.data, "point", "INT", "POINT", np.zeros(30))
    refused("point is INT on POINT", level_attribute="point", **properties)
    attributes.write(sheet.data, "high", "INT", "FACE", np.arange(18))
    refused(r"high is 9 on face 9 \(9 in all\): levels are 0 to 8", level_attribute="high",
            **properties)  # fmt: skip
    attributes.write(sheet.data, "nan", "FLOAT", "FACE", np.full(18, np.nan))
    refused("nan is nan on face 0", level_attribute="nan", **properties)


@pytest.mark.parametrize("tolerance", [0.02, 0.002])
@pytest.mark.parametrize("name", ["cross", "mixed polygons"])
def test_flatness_is_kept_in_the_world(name, tolerance):
    """The distance is measured from places all over the polygons, in the world."""
    ob = scenes.SCENES[name]()
    scenes.add_subsurf(ob)
    ob.matrix_world = STRETCHED
    made = make(ob, level_source="FLATNESS", tolerance=tolerance, most_levels=8)
    surface = scenes.surface_without_addon(ob)
    surface.set_positions(scenes.transformed(STRETCHED, surface.positions))
    made.data.calc_loop_triangles()
    corners = np.array([t.vertices for t in made.data.loop_triangles])
    rng = np.random.default_rng(0)
    weights = rng.dirichlet([1, 1, 1], (len(corners), 4))
    positions = scenes.transformed(STRETCHED, attributes.read(made.data, "position"))
    places = np.einsum("tkc,tcx->tkx", weights, positions[corners]).reshape(-1, 3)
    distance = surface.closest(places).distance.max()
    assert 0.05 * tolerance < distance <= tolerance


def test_levels_that_are_too_few_are_told(sheet, capfd):
    make(sheet, level_source="FLATNESS", tolerance=1e-6, most_levels=2)
    said = capfd.readouterr().out
    assert "faces deviate by more than the tolerance at level 2: raise Most Levels" in said
    one = scenes.flat_grid(1)  # its outline is round
    make(one, level_source="FLATNESS", tolerance=1e-7, most_levels=8)
    assert "at level 8, the highest one" in capfd.readouterr().out


def camera_at(location, kind="PERSP", towards=(2, 2, 0)):
    camera = bpy.data.cameras.new("Camera")
    camera.type, camera.ortho_scale, camera.shift_x = kind, 6, 0.1
    ob = bpy.data.objects.new("Camera", camera)
    ob.location = location
    ob.rotation_euler = (Vector(towards) - ob.location).to_track_quat("-Z", "Y").to_euler()
    scene = bpy.context.scene
    scene.collection.objects.link(ob)
    scene.camera = ob
    scene.render.resolution_x, scene.render.resolution_y = 640, 480
    scene.render.resolution_percentage = 50
    bpy.context.view_layer.update()
    return ob


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
def test_edges_are_as_short_as_asked_in_the_picture(sheet, kind):
    camera, pixels = camera_at((1, -4, 5), kind), 8.0
    made = make(sheet, level_source="PIXELS", pixels=pixels, most_levels=8)
    scene = bpy.context.scene
    seen = [
        world_to_camera_view(scene, camera, made.matrix_world @ v.co) for v in made.data.vertices
    ]
    at = np.array(seen)[:, :2] * (320, 240)
    length = np.linalg.norm(np.diff(at[[e.vertices[:] for e in made.data.edges]], axis=1), axis=2)
    assert np.quantile(length, 0.99) > pixels / 2
    # The diagonals of triangles between levels are longer than the sides of quads.
    assert length.max() <= 1.15 * pixels


def test_what_is_behind_the_camera_stays_coarse(sheet):
    camera_at((2, 2, 6), towards=(2, 2, 9))
    assert len(make(sheet, level_source="PIXELS", pixels=2).data.polygons) == 18
    bpy.context.scene.camera.rotation_euler = (0, 0, 0)
    bpy.context.view_layer.update()
    assert len(make(sheet, level_source="PIXELS", pixels=2).data.polygons) > 18 * 16


def test_pixels_need_a_camera(sheet):
    reason = "There is no camera: the scene has none. Add one, and make it the scene's camera$"
    refused(reason, level_source="PIXELS")


def test_faces_without_a_surface_are_left_out(capfd):
    positions = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)]
    ob = scenes.add_mesh("Twice", positions, [(0, 1, 2, 3), (1, 4, 5, 2)])
    vertex = truth.corner_vertices(ob.data)
    vertex[6] = 4
    attributes.write(ob.data, ids.CORNER_VERTEX, "INT", "CORNER", vertex)
    made = make(ob, levels=2)
    assert len(made.data.polygons) == 16
    assert "1 of 2 faces has no limit surface and was left out" in capfd.readouterr().out


def test_a_mesh_of_no_surface_is_refused():
    scenes.add_mesh("Lines", [(0, 0, 0), (1, 0, 0)], [], [(0, 1)])
    refused("has no faces")


def test_large_counts_have_to_be_asked_for(sheet):
    for _ in range(2):
        sheet.modifiers.new("More", "ARRAY").count = 2
    sheet.modifiers.move(0, 2)
    refused(r"4,718,592 polygons .*Allow Large Counts", levels=8)


def test_cancelled_work_makes_nothing(sheet, monkeypatch):
    from limit_surface.limit_mesh import tessellation

    def stop(*_arguments):
        raise CancelledError("Cancelled: nothing was made")

    monkeypatch.setattr(tessellation, "part_of", lambda *_: stop)
    refused("Cancelled", level_source="FLATNESS")


def test_shape_keys_and_odd_values_are_told(sheet, capfd):
    sheet.shape_key_add(name="Basis")
    values = np.zeros(30)
    values[3] = np.inf
    attributes.write(sheet.data, "odd", "FLOAT", "POINT", values)
    sheet.data.attributes.new("words", "STRING", "POINT")
    made = make(sheet, levels=1)
    said = capfd.readouterr().out
    assert "shape keys are not carried over" in said
    assert "odd is not carried over: it has values that are not finite" in said
    assert "words is not carried over: attributes of type string are not supported" in said
    assert not {"odd", "words"} & set(made.data.attributes.keys())
