# SPDX-License-Identifier: GPL-3.0-or-later
"""Decals: polygons on the limit surface that show an image as its camera sees it."""

import bpy
import numpy as np
import projection_truth as truth
import pytest
import scenes
from limit_surface import ids
from limit_surface.native import limitsurf
from limit_surface.reading import attributes, cage, ragged_rows
from mathutils import Matrix

SINGLE = 2e-6


def image(size=(64, 64)):
    return bpy.data.images.new("Shown", *size, alpha=True)


def add_decal(ob, **properties):
    scenes.activate(ob)
    given = {"mode": "DECAL", "image": "Shown", "decal_resolution": 32, "decal_offset": 0.0}
    assert bpy.ops.object.limit_project_image(**given | properties) == {"FINISHED"}
    made = bpy.context.active_object
    assert made.data.name.startswith(ids.DECAL_OBJECT)
    assert not made.data.validate()
    return made


class Made:
    """The arrays of a decal, in the world."""

    def __init__(self, ob):
        mesh = ob.data
        self.matrix = np.array(ob.matrix_world)
        self.local = attributes.read(mesh, ids.POSITION).astype(float)
        self.positions = scenes.transformed(self.matrix, self.local)
        self.sizes = attributes.face_sizes(mesh)
        self.vertices = attributes.read(mesh, ids.CORNER_VERTEX)
        self.face = attributes.read(mesh, ids.FACE)
        self.uv = attributes.read(mesh, ids.UV).astype(float)
        corner_st = attributes.read(mesh, ids.DECAL_UV)
        self.st = np.empty((len(self.local), 2))
        self.st[self.vertices] = corner_st
        np.testing.assert_array_equal(self.st[self.vertices], corner_st)  # one for each vertex

    def areas(self):
        """Returns the areas of the polygons in the image, positive for counter-clockwise ones."""
        a = self.st[self.vertices]
        b = a[ragged_rows.following(self.sizes)]
        strips = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        return np.add.reduceat(strips, ragged_rows.starts(self.sizes)) / 2


def surface_of(ob):
    return limitsurf.LimitSurface(cage.read(ob, bpy.context.evaluated_depsgraph_get()).mesh)


def seen_from_above(ob, **settings):
    matrix = np.array(ob.matrix_world)
    target = matrix[:3] @ (2.5, 2, 0.5, 1)
    axis = np.cross(matrix[:3, 0], matrix[:3, 1]) * np.sign(np.linalg.det(matrix[:3, :3]))
    return truth.add_camera(target + 7 * axis / np.linalg.norm(axis), target, **settings)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("settings", [{"lens": 45.0}, {"type": "ORTHO", "ortho_scale": 8.0}])
def test_vertices_lie_on_the_surface_under_their_pixels(settings, mirrored):
    ob = truth.posed(scenes.grid_with_holes(), mirrored)
    camera = seen_from_above(ob, **settings)
    image((80, 40))
    made = Made(add_decal(ob))
    surface = surface_of(ob)
    exact = surface.evaluate(made.face, made.uv).position
    assert np.abs(made.local - exact).max() < SINGLE * np.abs(exact).max()
    origins, directions = truth.camera_rays(camera, made.st, (80, 40))
    unit = directions / np.linalg.norm(directions, axis=1)[:, None]
    off = made.positions - origins
    off -= unit * np.einsum("ij,ij->i", off, unit)[:, None]
    assert np.abs(off).max() < 2e-5
    assert (made.areas() * (-1 if mirrored else 1)).min() > -1e-9


def test_first_hits_only():
    """No part of the surface lies between a vertex and the camera."""
    ob = scenes.monkey()
    camera = truth.add_camera((2, -5, 1), lens=70)
    image()
    made = Made(add_decal(ob, decal_resolution=48))
    eye = np.array(camera.matrix_world)[:3, 3]
    towards = eye - made.positions
    hits = surface_of(ob).ray_cast_all(made.positions + 1e-4 * towards, towards)
    assert (np.diff(hits.offsets) > 0).mean() < 2e-3


def test_the_outline_is_the_surfaces():
    """A square fills a part of the image: the decal covers exactly that part."""
    ob = scenes.add_mesh("Square", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    scenes.add_subsurf(ob).subdivision_type = "SIMPLE"
    ob.rotation_euler.z = 0.3
    truth.add_camera((0.5, 0.5, 5), (0.5, 0.5, 0), type="ORTHO", ortho_scale=3)
    image()
    made = Made(add_decal(ob, decal_resolution=31))
    # Each border point is within 2^-16 of a quad's side; corners of the square are cut off.
    assert made.areas().sum() == pytest.approx(1 / 9, abs=4 * 0.5 / 31**2)
    uncut = add_decal(ob, decal_resolution=310)
    assert Made(uncut).areas().sum() == pytest.approx(1 / 9, abs=4 * 0.5 / 310**2)
    radius = Made(uncut).local[:, :2]
    assert radius.min() > -1e-6
    assert radius.max() < 1 + 1e-6


def sphere():
    """Adds the limit surface of a cube that is subdivided once and cast to a sphere, which is
    rounder than that of a cube.
    """
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    return bpy.context.active_object


@pytest.mark.slow
def test_silhouettes_are_followed():
    ob = sphere()
    camera = truth.add_camera((0, -6, 0), lens=80)
    image()
    areas = []
    for resolution in (16, 32, 64):
        made = Made(add_decal(ob, decal_resolution=resolution, facing=(1.5, np.pi / 2)))
        areas.append(made.areas().sum())
    # The outline of the fine mesh gives the disc that the camera sees.
    truth.fine_subsurf(ob, 5)
    bpy.context.view_layer.update()
    st = np.stack(np.meshgrid(*[(np.arange(120) + 0.5) / 120] * 2), axis=-1).reshape(-1, 2)
    origins, directions = truth.camera_rays(camera, st, (64, 64))
    disc = np.isfinite(truth.FineMesh(ob).seen(origins, directions)[:, 0]).mean()
    assert areas[2] == pytest.approx(disc, rel=5e-3)
    assert abs(areas[1] - areas[2]) < abs(areas[0] - areas[1])


def test_angles_bound_the_decal():
    """On a sphere seen from far away, angles up to 45 degrees give a disc of half the area."""
    ob = sphere()
    truth.add_camera((0, -60, 0), type="ORTHO", ortho_scale=2.4)
    image()
    whole, half = (
        Made(add_decal(ob, facing=np.radians((0, angle)), decal_resolution=64)).areas().sum()
        for angle in (89.9, 45)
    )
    assert half / whole == pytest.approx(0.5, rel=0.03)


def stairs(gap):
    """Adds a small square above a large one; its edges lie between the rays of the grid."""
    square = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float)
    positions = np.concatenate([3 * square, 0.937 * square + (0.1, 0.05, gap)])
    ob = scenes.add_mesh("Stairs", positions, [(0, 1, 2, 3), (4, 5, 6, 7)])
    scenes.add_subsurf(ob).subdivision_type = "SIMPLE"
    return ob


@pytest.mark.parametrize("gap", [0.02, 0.5])
def test_no_polygon_joins_two_sheets(gap):
    ob = stairs(gap)
    truth.add_camera((0, 0, 9), type="ORTHO", ortho_scale=5)
    image()
    made = Made(add_decal(ob, decal_resolution=40))
    starts = ragged_rows.starts(made.sizes)
    height = made.local[made.vertices, 2]
    spread = np.maximum.reduceat(height, starts) - np.minimum.reduceat(height, starts)
    assert spread.max() < 1e-6
    # Both sheets reach up to the edge between them: only its four corners are missing.
    assert made.areas().sum() == pytest.approx(1, abs=4 * 0.5 / 40**2 + 1e-6)
    upper = made.areas()[np.maximum.reduceat(height, starts) > gap / 2].sum()
    assert upper == pytest.approx((2 * 0.937 / 5) ** 2, abs=4 * 0.5 / 40**2)


def test_creases_do_not_cut():
    """Two walls meet at a right angle; the decal goes on from one to the other, wherever the rays
    are.
    """
    positions = [(-1, -1, 1), (0.013, -1, 0), (0.013, 1, 0), (-1, 1, 1), (1, -1, 1), (1, 1, 1)]
    ob = scenes.add_mesh("Roof", positions, [(0, 1, 2, 3), (1, 4, 5, 2)])
    scenes.add_subsurf(ob).subdivision_type = "SIMPLE"
    truth.add_camera((0, 0, 9), type="ORTHO", ortho_scale=1.9)
    image()
    made = Made(add_decal(ob, decal_resolution=20))
    assert len(made.sizes) == 400
    assert made.areas().sum() == pytest.approx(1, abs=1e-6)


def test_offsets_are_along_the_normal_in_world_units():
    ob = truth.posed(scenes.grid_with_holes())
    seen_from_above(ob)
    image()
    flat, raised = (Made(add_decal(ob, decal_offset=offset)) for offset in (0.0, 0.125))
    lift = raised.positions - flat.positions
    np.testing.assert_allclose(np.linalg.norm(lift, axis=1), 0.125, rtol=1e-5)
    surface = surface_of(ob)
    at = surface.evaluate(flat.face, flat.uv, derivatives=1)
    for tangent in (at.du, at.dv):
        along = tangent @ flat.matrix[:3, :3].T
        cosine = np.einsum("ij,ij->i", along, lift) / np.linalg.norm(along, axis=1) / 0.125
        assert np.nanmax(np.abs(cosine)) < 1e-4


@pytest.mark.parametrize("projector", [False, True])
@pytest.mark.parametrize("mirrored", [False, True])
def test_normals_are_the_surfaces(mirrored, projector):
    ob = truth.posed(scenes.grid_with_holes(), mirrored)
    camera = seen_from_above(ob)
    camera.scale.x = -1 if projector else 1
    bpy.context.view_layer.update()
    image()
    decal = add_decal(ob)
    made = Made(decal)
    exact = surface_of(ob).frames(made.face, made.uv)[:, :, 2]
    corner = np.empty(3 * len(decal.data.loops), np.float32)
    decal.data.corner_normals.foreach_get("vector", corner)
    cosine = np.einsum("ij,ij->i", corner.reshape(-1, 3), exact[made.vertices])
    assert cosine.min() > 1 - 1e-6
    flat = np.array([polygon.normal for polygon in decal.data.polygons])
    starts = ragged_rows.starts(made.sizes)
    assert (np.einsum("ij,ij->i", flat, exact[made.vertices[starts]]) > 0).mean() > 0.99


@pytest.mark.parametrize("mirrored", [False, True])
def test_planar_decals_of_mirrored_empties_face_outwards(mirrored):
    ob = truth.posed(scenes.grid_with_holes(), mirrored)
    camera = seen_from_above(ob)
    empty = bpy.data.objects.new("E", None)
    bpy.context.collection.objects.link(empty)
    empty.matrix_world = camera.matrix_world @ Matrix.Diagonal((-2, 2, 2, 1))
    bpy.context.view_layer.update()
    image()
    decal = add_decal(ob, source="PLANAR", empty="E")
    flat = np.array([polygon.normal for polygon in decal.data.polygons])
    corner = np.empty(3 * len(decal.data.loops), np.float32)
    decal.data.corner_normals.foreach_get("vector", corner)
    first = corner.reshape(-1, 3)[[polygon.loop_start for polygon in decal.data.polygons]]
    assert (np.einsum("ij,ij->i", flat, first) > 0).mean() > 0.99


def test_a_decal_can_be_evaluated_again():
    """The decal stores the same attributes as hair and points."""
    ob = scenes.grid_with_holes()
    seen_from_above(ob)
    image()
    decal = add_decal(ob, decal_offset=0.1)
    made, surface = Made(decal), surface_of(ob)
    at = surface.evaluate(made.face, made.uv)
    root = attributes.read(decal.data, ids.REST_ROOT)
    np.testing.assert_allclose(root, at.position, atol=SINGLE * 5)
    rotation = attributes.read(decal.data, ids.REST_ROTATION)
    expected = limitsurf.quaternions(surface.frames(made.face, made.uv))
    np.testing.assert_allclose(np.abs(np.einsum("ij,ij->i", rotation, expected)), 1, atol=1e-5)
    assert decal.parent == ob
    assert decal.matrix_world == ob.matrix_world
    assert decal.select_get()
    assert not ob.select_get()


def test_planar_decals_with_a_material():
    ob = scenes.grid_with_holes()
    frame = bpy.data.objects.new("Empty", None)
    frame.location, frame.empty_display_size = (2, 2, 3), 0.8
    bpy.context.collection.objects.link(frame)
    bpy.context.view_layer.update()
    shown = image()
    decal = add_decal(ob, source="PLANAR", empty="Empty", create_material=True)
    made = Made(decal)
    np.testing.assert_allclose(made.positions[:, :2], 1.6 * (made.st - 0.5) + 2, atol=1e-5)
    nodes = decal.active_material.node_tree.nodes
    shader = next(n for n in nodes if n.type == "BSDF_PRINCIPLED")
    for socket in ("Base Color", "Alpha"):
        texture = shader.inputs[socket].links[0].from_node
        assert texture.image == shown
        assert texture.inputs["Vector"].links[0].from_node.uv_map == ids.DECAL_UV


def test_refusals():
    ob = scenes.grid_with_holes()
    camera = truth.add_camera((2.5, 2, -9), (2.5, 2, -20))
    image()
    before = scenes.file_contents()
    for match, properties in (
        ("The image cannot be seen on the surface: no part of the image Shown", {}),
        ("A decal can be made only from a camera, a view or a planar empty", {"source": "BOX"}),
        ("4,194,304 polygons.*allow_large", {"decal_resolution": 2048}),
    ):
        scenes.activate(ob)
        with pytest.raises(RuntimeError, match=match):
            bpy.ops.object.limit_project_image(mode="DECAL", image="Shown", **properties)
        assert scenes.file_contents() == before
    camera.rotation_euler.x += np.pi
    with pytest.raises(RuntimeError, match="The image cannot be seen on the surface"):
        bpy.ops.object.limit_project_image(mode="DECAL", image="Shown")  # from below: one-sided
    assert add_decal(ob, two_sided=True)


def test_sunken_polygons_are_told_of(capfd):
    ob = sphere()
    truth.add_camera((0, -6, 0), lens=80)
    image()
    add_decal(ob, decal_resolution=8, decal_offset=0.001)
    said = capfd.readouterr()
    assert "below the surface: raise the resolution, or the offset to " in said.out + said.err
    add_decal(ob, decal_resolution=8, decal_offset=0.2)
    said = capfd.readouterr()
    assert "below the surface" not in said.out + said.err
