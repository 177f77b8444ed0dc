# SPDX-License-Identifier: GPL-3.0-or-later
"""For each operator scenes in which it works: what other tests then damage.

Each stage adds a surface, and what else the operator takes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from particle_scenes import add_system

SMALL_IMAGE = {"width": 16, "height": 16}


@dataclass(frozen=True)
class Scene:
    surface: bpy.types.Object
    thing: bpy.types.Object | None  # what the operator works on besides the surface


@dataclass(frozen=True)
class Stage:
    operator: str
    build: Callable[[], Scene]
    properties: dict[str, object]

    def run(self) -> set[str]:
        area, _, verb = self.operator.partition(".")
        return getattr(getattr(bpy.ops, area), verb)("EXEC_DEFAULT", **self.properties)


def surface() -> bpy.types.Object:
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    scenes.add_uv_map(ob, lambda at: 0.05 + 0.9 * at[:, :2] / (5, 4))
    group = ob.vertex_groups.new(name="Group")
    group.add(range(len(ob.data.vertices)), 0.5, "REPLACE")
    weights = np.linspace(0.1, 1, len(ob.data.vertices))
    attributes.write(ob.data, "weight", "FLOAT", "POINT", weights)
    levels = np.arange(len(ob.data.polygons)) % 3
    attributes.write(ob.data, "level", "INT", "FACE", levels)
    attributes.write(ob.data, "part", "BOOLEAN", "FACE", np.arange(len(ob.data.polygons)) % 2 == 0)
    return ob


def picture() -> bpy.types.Image:
    bpy.data.images.new("Texture", 16, 16)
    image = bpy.data.images.new("Picture", 8, 8)
    image.pixels.foreach_set(np.linspace(0, 1, 8 * 8 * 4, dtype=np.float32))
    return image


def select(*objects: bpy.types.Object) -> None:
    """Selects these alone; the last becomes active."""
    bpy.context.view_layer.update()
    for ob in bpy.context.view_layer.objects:
        ob.select_set(ob in objects)
    scenes.activate(objects[-1])


def alone() -> Scene:
    ob = surface()
    picture()
    return Scene(ob, None)


def _hair(**properties: object) -> Callable[[], Scene]:
    def build() -> Scene:
        ob = surface()
        hair = scenes.add_hair(ob, per_side=2, points=3, **properties)
        select(hair)
        return Scene(ob, hair)

    return build


def _points() -> Scene:
    ob = surface()
    points = scenes.add_points(ob, per_side=2, follow="NONE", instances="SCALE")
    select(points)
    return Scene(ob, points)


def _bound_points() -> Scene:
    found = _points()
    bpy.ops.object.limit_follow()
    return found


def _strange_hair() -> Scene:
    """Hair from elsewhere, and the surface active."""
    ob = surface()
    data = bpy.data.hair_curves.new("Hair")
    data.add_curves([3, 2])
    at = np.linspace([1, 1, 1], [2, 2, 1.5], 5, dtype=np.float32)
    data.points.foreach_set("position", at.ravel())
    hair = bpy.data.objects.new("Hair", data)
    bpy.context.collection.objects.link(hair)
    select(hair, ob)
    return Scene(ob, hair)


def _strange_points() -> Scene:
    ob = surface()
    cloud = scenes.add_mesh("Cloud", [(1, 1, 1), (2, 2, 1)], [])
    select(cloud, ob)
    return Scene(ob, cloud)


def _curve(kind: str = "BEZIER") -> Callable[[], Scene]:
    def build() -> Scene:
        ob = surface()
        data = bpy.data.curves.new("Curve", "CURVE")
        data.dimensions = "3D"
        spline = data.splines.new(kind)
        many = spline.bezier_points if kind == "BEZIER" else spline.points
        many.add(2)
        for i, point in enumerate(many):
            at = (1 + i, 1 + 0.5 * i, 1)
            point.co = at if kind == "BEZIER" else (*at, 1)
            if kind == "BEZIER":
                point.handle_left_type = point.handle_right_type = "AUTO"
        curve = bpy.data.objects.new("Curve", data)
        bpy.context.collection.objects.link(curve)
        select(curve, ob)
        return Scene(ob, curve)

    return build


def _empty() -> Scene:
    ob = surface()
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.collection.objects.link(empty)
    empty.location = (1, 2, 1)
    select(empty, ob)
    return Scene(ob, empty)


def _bound_curve() -> Scene:
    found = _curve()()
    bpy.ops.object.limit_follow()
    return found


def _snapped_curve() -> Scene:
    found = _curve()()
    bpy.context.scene.limit_surface.target = found.surface
    select(found.thing)
    return found


def _image(**properties: object) -> Callable[[], Scene]:
    def build() -> Scene:
        ob = surface()
        picture()
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        bpy.context.collection.objects.link(camera)
        camera.location = (2.5, 2, 8)
        empty = bpy.data.objects.new("Empty", None)
        bpy.context.collection.objects.link(empty)
        empty.location = (2.5, 2, 3)
        bpy.context.view_layer.update()
        select(ob)
        projector = camera if properties["source"] == "CAMERA" else empty
        return Scene(ob, projector)

    return build


def _displaced() -> Scene:
    ob = surface()
    picture()
    other = ob.copy()
    other.data = ob.data.copy()
    other.name = "Sculpt"
    bpy.context.collection.objects.link(other)
    for vertex in other.data.vertices:
        vertex.co.z += 0.1
    select(ob)
    return Scene(ob, other)


def _instances(**properties: object) -> Callable[[], Scene]:
    def build() -> Scene:
        ob = surface()
        pebble = scenes.add_mesh("Pebble", [(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0)], [(0, 1, 2)])
        collection = bpy.data.collections.new("Pebbles")
        bpy.context.scene.collection.children.link(collection)
        collection.objects.link(pebble)
        select(ob)
        return Scene(ob, pebble)

    return build


def _flow() -> Scene:
    found = _curve("POLY")()
    select(found.surface)
    return found


def _parting() -> Scene:
    found = _hair(follow="NONE")()
    data = bpy.data.curves.new("Parting", "CURVE")
    data.dimensions = "3D"
    data.splines.new("POLY").points.add(1)
    data.splines[0].points[1].co = (5, 4, 0, 1)
    curve = bpy.data.objects.new("Parting", data)
    bpy.context.collection.objects.link(curve)
    return found


def _particles() -> Scene:
    ob = surface()
    add_system(ob, "Fur", 6)
    select(ob)
    return Scene(ob, None)


def _live_children() -> Scene:
    found = _hair(follow="NODES")()
    bpy.ops.object.limit_children_add(mode="LIVE", per_side=2, allow_large=True)
    return Scene(found.surface, bpy.context.object)


def _tables() -> Scene:
    ob = surface()
    bpy.ops.object.limit_sample_tables()
    return Scene(ob, None)


def _of(operator: str, build: Callable[..., Scene], **properties: object) -> Stage:
    return Stage(operator, build, properties)


_STEERED = {
    f"{what}_{name}": value
    for what, how in (("length", "IMAGE"), ("radius", "ATTRIBUTE"), ("tilt", "VERTEX_GROUP"))
    for name, value in (
        ("source", how),
        ("image", "Picture"),
        ("attribute", "weight"),
        ("vertex_group", "Group"),
    )
}

STAGES: dict[str, Stage] = {
    "hair": _of(ids.HAIR_ADD, alone, per_side=2),
    "hair uniform": _of(ids.HAIR_ADD, alone, distribution="UNIFORM", count=20, follow="NODES"),
    "hair blue noise": _of(
        ids.HAIR_ADD, alone, distribution="BLUE_NOISE", count=20, density_source="IMAGE",
        image="Picture", follow="LIVE",
    ),
    "hair border": _of(ids.HAIR_ADD, alone, distribution="BORDER", count=20),
    "hair steered": _of(ids.HAIR_ADD, alone, per_side=2, **_STEERED),
    "hair flow": _of(ids.HAIR_ADD, _flow, per_side=2, flow_source="CURVES", flow_curves="Curve"),
    "hair flow image": _of(
        ids.HAIR_ADD, alone, per_side=2, flow_source="IMAGE", flow_image="Picture"
    ),
    "hair on displayed": _of(ids.HAIR_ADD, alone, per_side=2, target="VIEWPORT"),
    "hair on faces": _of(
        ids.HAIR_ADD, alone, per_side=2, faces="ATTRIBUTE", face_attribute="part",
        density_source="VERTEX_GROUP", vertex_group="Group",
    ),
    "points": _of(ids.POINTS_ADD, alone, per_side=2),
    "points objects": _of(
        ids.POINTS_ADD, _instances(), per_side=2, instances="OBJECT", instance="Pebble"
    ),
    "points collection": _of(
        ids.POINTS_ADD, _instances(), per_side=2, instances="COLLECTION", collection="Pebbles",
        index_source="ATTRIBUTE", index_attribute="weight",
    ),
    "snap objects": _of(ids.SNAP, _empty, align="NORMAL"),
    "snap objects along": _of(ids.SNAP, _empty, mode="AXIS", orientation="LOCAL"),
    "snap hair": _of(ids.SNAP, _strange_hair, hair="BLEND", follow="NODES"),
    "snap strands": _of(ids.SNAP, _strange_hair, hair="STRAND", keep_length=True, mode="NORMAL"),
    "snap hair displayed": _of(ids.SNAP, _strange_hair, target="VIEWPORT"),
    "lay": _of(ids.CURVE_LAY, _curve()),
    "lay poly": _of(ids.CURVE_LAY, _curve("POLY"), spline="POLY", offset=0.1),
    "lay bound": _of(ids.CURVE_LAY, _bound_curve),
    "report": _of(ids.REPORT_OPERATOR, alone),
    "show": _of(ids.SHOW, alone, levels=1),
    "bake maps": _of(
        ids.BAKE_MAPS, alone, maps={"POSITION", "NORMAL_TANGENT", "CAVITY"}, **SMALL_IMAGE
    ),
    "bake maps displayed": _of(
        ids.BAKE_MAPS, alone, maps={"NORMAL_OBJECT", "AREA_DISTORTION"}, tiles="ALL",
        target="VIEWPORT", **SMALL_IMAGE,
    ),
    "project camera": _of(
        ids.PROJECT_IMAGE, _image(source="CAMERA"), source="CAMERA", image="Picture",
        camera="Camera", occlusion=True, **SMALL_IMAGE,
    ),
    "project planar": _of(
        ids.PROJECT_IMAGE, _image(source="PLANAR"), source="PLANAR", image="Picture",
        empty="Empty", **SMALL_IMAGE,
    ),
    "project decal": _of(
        ids.PROJECT_IMAGE, _image(source="PLANAR"), source="PLANAR", image="Picture",
        empty="Empty", mode="DECAL", decal_resolution=4,
    ),
    "project existing": _of(
        ids.PROJECT_IMAGE, _image(source="CAMERA"), source="CAMERA", image="Picture",
        camera="Camera", output="EXISTING", target="Texture",
    ),
    "project normals": _of(
        ids.PROJECT_IMAGE, _displaced, source="NORMALS", from_object="Sculpt", image="Picture",
        **SMALL_IMAGE,
    ),
    "curvature": _of(ids.CURVATURE, alone),
    "curvature tessellation": _of(ids.CURVATURE, alone, on="TESSELLATION", levels=1),
    "curvature roots": _of(ids.CURVATURE, _hair(follow="NONE"), on="ROOTS"),
    "displacement": _of(ids.BAKE_DISPLACEMENT, _displaced, target="Sculpt", **SMALL_IMAGE),
    "displacement polygons": _of(
        ids.BAKE_DISPLACEMENT, _displaced, target="Sculpt", mode="SCALAR",
        target_shape="POLYGONS", layout_kind="PTEX", face_resolution="4",
    ),
    "limit mesh": _of(ids.LIMIT_MESH, alone, levels=1, store_locations=True, follow="NODES"),
    "limit mesh attribute": _of(
        ids.LIMIT_MESH, alone, level_source="ATTRIBUTE", level_attribute="level"
    ),
    "limit mesh flat": _of(ids.LIMIT_MESH, alone, level_source="FLATNESS", most_levels=2),
    "follow hair": _of(ids.FOLLOW, _hair(follow="NONE")),
    "follow strange hair": _of(ids.FOLLOW, _strange_hair),
    "follow live": _of(ids.FOLLOW, _strange_hair, mode="LIVE"),
    "follow points": _of(ids.FOLLOW, _strange_points),
    "follow curve": _of(ids.FOLLOW, _curve("POLY")),
    "follow proxy": _of(ids.FOLLOW, _points, use_proxy=True),
    "unbind": _of(ids.UNBIND, _hair(follow="NODES")),
    "unbind at rest": _of(ids.UNBIND, _bound_points, shape="REST"),
    "unbind live": _of(ids.UNBIND, _hair(follow="LIVE")),
    "unbind curve": _of(ids.UNBIND, _bound_curve, shape="REST"),
    "unbind children": _of(ids.UNBIND, _live_children),
    "rebind": _of(ids.REBIND, _hair(follow="NODES")),
    "rebind face": _of(ids.REBIND, _bound_points, method="FACE"),
    "rebind uv": _of(ids.REBIND, _hair(follow="LIVE"), method="UV"),
    "rebind curve": _of(ids.REBIND, _bound_curve),
    "rebind children": _of(ids.REBIND, _live_children),
    "attach": _of(ids.ATTACH, _empty),
    "children": _of(ids.CHILDREN_ADD, _hair(follow="NODES"), per_side=2),
    "children live": _of(ids.CHILDREN_ADD, _hair(follow="NONE"), per_side=2, mode="LIVE"),
    "children parted": _of(
        ids.CHILDREN_ADD, _parting, per_side=2, parting="CURVES", parting_curves="Parting"
    ),
    "particles": _of(ids.PARTICLES_FROM_HAIR, _hair(follow="NONE")),
    "hair from particles": _of(ids.HAIR_FROM_PARTICLES, _particles, snap_roots=True),
    "sample tables": _of(ids.SAMPLE_TABLES, alone),
    "sample remove": _of(ids.SAMPLE_REMOVE, _tables),
}  # fmt: skip
