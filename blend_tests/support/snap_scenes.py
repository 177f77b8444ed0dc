# SPDX-License-Identifier: GPL-3.0-or-later
"""Things for tests to snap: hair, points of meshes and curves, bones."""

import bpy
import numpy as np
import scenes
from limit_surface.reading import attributes
from snap_truth import add_object, near

SIZES = [4, 2, 5, 1, 3, 4]
BONES = {  # head, tail, parent, connected
    "root": ((0, 0, 0.3), (0.1, 0.5, 0.5), None, False),
    "middle": ((0.1, 0.5, 0.5), (0.2, 0.9, 0.3), "root", True),
    "other": ((0.1, 0.5, 0.5), (0.7, 0.6, 0.5), "root", True),
    "tip": ((0.2, 0.9, 0.3), (0.1, 1.2, 0.8), "middle", True),
    "loose": ((1, 0.2, 0.6), (1.2, 0.3, 0.9), "root", False),
}


def add_hair(target, sizes=SIZES, seed=1):
    """Adds strands of various lengths near the target, in a space of their own, and selects
    them.
    """
    rng = np.random.default_rng(seed)
    data = bpy.data.hair_curves.new("Hair")
    data.add_curves(sizes)
    ob = bpy.data.objects.new("Hair", data)
    ob.rotation_euler, ob.scale, ob.location = (0.2, 0.1, 0.3), (1, 2, 0.5), (0.1, 0.2, 0.3)
    bpy.context.collection.objects.link(ob)
    ob.select_set(True)
    bpy.context.view_layer.update()
    points = np.repeat(near(target, len(sizes), 0.3, seed), sizes, axis=0)
    points += 0.2 * rng.random((len(points), 3)).cumsum(axis=0) % 0.7
    local = scenes.transformed(ob.matrix_world.inverted(), points)
    data.points.foreach_set("position", local.astype(np.float32).ravel())
    return ob


def world_strands(ob):
    """Returns one array (points, 3) for each strand."""
    bpy.context.view_layer.update()
    points = attributes.read(ob.data, "position").astype(np.float64)
    points = scenes.transformed(ob.matrix_world, points)
    sizes = [curve.points_length for curve in ob.data.curves]
    return np.split(points, np.cumsum(sizes)[:-1])


def roots(strands):
    return np.array([strand[0] for strand in strands])


def choose_target(ob):
    bpy.context.scene.limit_surface.target = ob
    ob.select_set(False)
    bpy.context.view_layer.update()
    return ob


def add_cloud(target, count=12, spread=0.3):
    """Adds loose vertices around the target, in a stretched object of their own."""
    cloud = scenes.add_mesh("Cloud", near(target, count, spread), [])
    cloud.rotation_euler, cloud.scale = (0.3, 0.1, 0.2), (1, 2, 0.5)
    bpy.context.view_layer.update()
    return cloud


def world_vertices(ob):
    return scenes.transformed(ob.matrix_world, attributes.read(ob.data, "position"))


def add_curve(kind, points):
    data = bpy.data.curves.new("Curve", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new(kind)
    many = spline.bezier_points if kind == "BEZIER" else spline.points
    many.add(len(points) - 1)
    for point, co in zip(many, points, strict=True):
        point.co = co if kind == "BEZIER" else (*co, 1.5)
        if kind == "BEZIER":
            point.handle_left = np.add(co, (-0.1, 0.2, 0.1))
            point.handle_right = np.add(co, (0.2, 0.1, 0))
    ob = add_object((0.1, 0.2, 0.3), data, "Curve")
    ob.scale = (1, 2, 0.5)
    bpy.context.view_layer.update()
    return ob
