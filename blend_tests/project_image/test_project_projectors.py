# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras, views and empties as projectors, compared with Blender's own functions."""

from types import SimpleNamespace

import bpy
import numpy as np
import projection_truth as truth
import pytest
import scenes
from bpy_extras.object_utils import world_to_camera_view
from bpy_extras.view3d_utils import location_3d_to_region_2d
from limit_surface.errors import RefusalError
from limit_surface.project_image import empties, view
from limit_surface.reading import camera
from mathutils import Matrix, Vector

POINTS = np.random.default_rng(6).uniform(-1, 1, (20, 3))
SINGLE = 2e-6  # as a share of the image: cameras and views give their matrices in single precision

CAMERAS = {
    "plain": {},
    "long lens": {"lens": 135.0},
    "shifted": {"shift_x": 0.3, "shift_y": -0.2},
    "vertical fit": {"sensor_fit": "VERTICAL", "sensor_height": 20.0},
    "horizontal fit": {"sensor_fit": "HORIZONTAL", "sensor_width": 30.0},
    "orthographic": {"type": "ORTHO", "ortho_scale": 5.0, "shift_x": 0.1},
}


def depsgraph():
    return bpy.context.evaluated_depsgraph_get()


@pytest.mark.parametrize("size", [(300, 200), (128, 512)])
@pytest.mark.parametrize("name", CAMERAS)
def test_cameras_project_as_they_render(name, size):
    ob = truth.add_camera((3, -5, 4), **CAMERAS[name])
    ob.scale = (2, 1, 0.5)
    scene = bpy.context.scene
    scene.render.pixel_aspect_x = 1.25
    scene.render.resolution_x, scene.render.resolution_y = size
    bpy.context.view_layer.update()
    found = camera.projector(ob, depsgraph(), size)
    expected = [world_to_camera_view(scene, ob, Vector(point))[:2] for point in POINTS]
    np.testing.assert_allclose(found.places(POINTS), expected, atol=SINGLE)
    assert found.has_eye == (ob.data.type == "PERSP")


@pytest.mark.parametrize("name", CAMERAS)
def test_rays_of_cameras_leave_the_frame_that_is_drawn(name):
    ob, size = truth.add_camera((3, -5, 4), **CAMERAS[name]), (300, 200)
    ob.data.clip_start, ob.data.clip_end = 0.5, 30
    st = np.random.default_rng(7).random((20, 2))
    found = camera.projector(ob, depsgraph(), size)
    near, far = found.rays(st)
    origins, directions = truth.camera_rays(ob, st, size)
    unit = directions / np.linalg.norm(directions, axis=1)[:, None]
    along = far - near
    np.testing.assert_allclose(
        along / np.linalg.norm(along, axis=1)[:, None], unit, atol=10 * SINGLE
    )
    forward = -np.array(ob.matrix_world)[:3, 2]
    eye = np.array(ob.matrix_world)[:3, 3]
    for ends, depth in ((near, 0.5), (far, 30)):
        np.testing.assert_allclose((ends - eye) @ forward, depth, rtol=1e-3)
        off = ends - origins
        off -= unit * np.einsum("ij,ij->i", off, unit)[:, None]
        assert np.abs(off).max() < 1e-3


@pytest.mark.parametrize("where", ["other scene", "excluded", "nowhere"])
def test_what_the_scene_does_not_show_projects_from_where_it_is_now(where):
    """Blender leaves its matrix as it was when it was evaluated last."""
    rig = empty("Rig")
    seen = truth.add_camera((3, -5, 4))
    square = empty()
    bpy.context.scene.camera = None
    for ob in (seen, square):
        ob.parent = rig
    if where == "other scene":
        place = bpy.data.scenes.new("Other").collection
    else:
        place = bpy.data.collections.new("Place")
    if where == "excluded":
        bpy.context.scene.collection.children.link(place)
        bpy.context.view_layer.layer_collection.children["Place"].exclude = True
    for ob in (seen, square):
        bpy.context.scene.collection.objects.unlink(ob)
        place.objects.link(ob)
    rig.location = (10, 20, 30)
    for frame, x in ((1, 10), (2, 12)):
        rig.location.x = x
        rig.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(2)
    names = scenes.file_contents()
    moved = camera.projector(seen, depsgraph(), (300, 200)).matrix
    flat = empties.planar(square, depsgraph(), (1, 1), BOUNDS).matrix
    box = empties.to_box(square, depsgraph())
    assert scenes.file_contents() == names
    for ob in (seen, square):
        bpy.context.scene.collection.objects.link(ob)
    if where == "excluded":
        bpy.context.view_layer.layer_collection.children["Place"].exclude = False
    bpy.context.view_layer.update()
    expected = camera.projector(seen, depsgraph(), (300, 200)).matrix
    np.testing.assert_array_equal(moved, expected)
    np.testing.assert_array_equal(flat, empties.planar(square, depsgraph(), (1, 1), BOUNDS).matrix)
    np.testing.assert_array_equal(box, empties.to_box(square, depsgraph()))


def test_cameras_are_found_by_name_or_are_the_scenes():
    with pytest.raises(RefusalError, match="There is no camera: the scene has none"):
        camera.find(bpy.context, "")
    first, second = (truth.add_camera((0, 0, z)) for z in (1, 2))
    assert camera.find(bpy.context, "") == second
    assert camera.find(bpy.context, first.name) == first
    empty("Cube")
    for name in ("Cube", "nobody"):
        with pytest.raises(RefusalError, match=f"There is no camera '{name}'"):
            camera.find(bpy.context, name)


def test_panoramic_cameras_are_refused():
    ob = truth.add_camera((0, 0, 3), type="PANO")
    with pytest.raises(RefusalError, match="Camera is panoramic: only perspective and ortho"):
        camera.projector(ob, depsgraph(), (10, 10))


def test_cameras_without_extent_are_refused():
    ob = truth.add_camera((0, 0, 3))
    ob.scale = (1, 0, 1)
    bpy.context.view_layer.update()
    with pytest.raises(RefusalError, match="Camera has a scale of 0"):
        camera.projector(ob, depsgraph(), (10, 10))


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
@pytest.mark.parametrize("size", [(100, 100), (400, 100), (100, 400)])
def test_views_show_the_image_as_large_as_fits(kind, size):
    """Blender draws no views without a window, so a camera's matrices take the place of the
    view's.
    """
    region = SimpleNamespace(width=320, height=200)
    ob = truth.add_camera((3, -5, 4), type=kind)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    window = ob.calc_matrix_camera(depsgraph, x=region.width, y=region.height)
    shown = SimpleNamespace(
        perspective_matrix=window @ ob.matrix_world.inverted(), is_perspective=kind == "PERSP"
    )
    found = view.projector(shown, (region.width, region.height), size)
    pixels = np.array([location_3d_to_region_2d(region, shown, Vector(p)) for p in POINTS])
    room = np.array([region.width, region.height], float)
    scale = min(room / size)
    expected = (pixels - room / 2) / (scale * np.array(size)) + 0.5
    np.testing.assert_allclose(found.places(POINTS), expected, atol=20 * SINGLE)
    assert found.has_eye == shown.is_perspective


def test_without_a_view_there_is_nothing_to_project_from():
    nowhere = SimpleNamespace(space_data=None, area=None)
    with pytest.raises(RefusalError, match="There is no 3D view to project from"):
        view.from_context(nowhere, (10, 10))
    never_drawn = SimpleNamespace(perspective_matrix=Matrix.Diagonal((0, 0, 0, 0)))
    with pytest.raises(RefusalError, match="has not been drawn yet"):
        view.projector(never_drawn, (10, 10), (10, 10))


def empty(name="Empty", **settings):
    ob = bpy.data.objects.new(name, None)
    for key, value in settings.items():
        setattr(ob, key, value)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.update()
    return ob


BOUNDS = np.array([[-1, -1, -1], [1, 1, 1.0]])


def places_of(found, local, ob):
    """Returns the places in the image of points in the empty's space, and where they lie between
    the depths.
    """
    points = np.array([ob.matrix_world @ Vector(p) for p in local])
    clip = points @ found.matrix[:, :3].T + found.matrix[:, 3]
    return found.places(points), clip[:, 2] / clip[:, 3]


def test_empties_project_from_their_square():
    ob = empty(
        empty_display_size=1.5,
        location=(1, 2, 3),
        rotation_euler=(0.3, 0.4, 0.5),
        scale=(2, 3, 1.5),
    )
    found = empties.planar(ob, depsgraph(), (200, 100), BOUNDS)
    corners = [(-1.5, -0.75, 4), (1.5, -0.75, -2), (0, 0.75, 0)]
    places, _ = places_of(found, corners, ob)
    np.testing.assert_allclose(places, [(0, 0), (1, 0), (0.5, 1)], atol=SINGLE)
    assert not found.has_eye


def test_image_empties_project_from_what_they_show():
    """Blender draws the longer side as long as the size says, and puts the origin at minus the
    offset, in sides."""
    image = bpy.data.images.new("Shown", 40, 80)
    ob = empty(empty_display_type="IMAGE", empty_display_size=4.0)
    ob.data = image
    for offset in ((-0.5, -0.5), (0.0, 0.25)):
        ob.empty_image_offset = offset
        found = empties.planar(ob, depsgraph(), (10, 10), BOUNDS)
        low = np.array(offset) * (2, 4)
        local = [(*low, 0), (*(low + (2, 4)), 0)]
        np.testing.assert_allclose(places_of(found, local, ob)[0], [(0, 0), (1, 1)], atol=SINGLE)


def test_depths_of_empties():
    ob = empty(location=(0, 0, 5), scale=(1, 1, 2))
    whole = empties.planar(ob, depsgraph(), (1, 1), BOUNDS)
    near, far = whole.rays([[0.5, 0.5]])
    assert near[0, 2] > 1
    assert far[0, 2] < -1
    limited = empties.planar(ob, depsgraph(), (1, 1), BOUNDS, depth=(0.5, 7))
    near, far = limited.rays([[0.5, 0.5], [1, 1]])
    np.testing.assert_allclose(near[:, 2], 4.5)
    np.testing.assert_allclose(far[:, 2], -2)
    with pytest.raises(RefusalError, match="There is no space between the depths 1 and 1"):
        empties.planar(ob, depsgraph(), (1, 1), BOUNDS, depth=(1, 1))


def test_boxes_are_the_empties_cubes():
    ob = empty(empty_display_size=0.5, location=(1, 0, 0), scale=(1, 2, 3))
    to_box = empties.to_box(ob, depsgraph())
    points = np.array([(1.5, 0, 0, 1), (1, 1, 0, 1), (1, 0, 1.5, 1)]).T
    np.testing.assert_allclose((to_box @ points)[:3], np.eye(3), atol=1e-12)


def test_empties_without_extent_are_refused():
    ob = empty(scale=(1, 1, 0))
    with pytest.raises(RefusalError, match="Empty has a scale of 0"):
        empties.planar(ob, depsgraph(), (1, 1), BOUNDS)
    with pytest.raises(RefusalError, match="Empty has a scale of 0"):
        empties.to_box(ob, depsgraph())


def test_empties_are_found_by_name():
    truth.add_camera((0, 0, 1))
    with pytest.raises(RefusalError, match="No empty is chosen"):
        empties.find("")
    with pytest.raises(RefusalError, match="There is no empty 'Camera'"):
        empties.find("Camera")
