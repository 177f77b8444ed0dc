# SPDX-License-Identifier: GPL-3.0-or-later
"""All operators with long work, each in a scene in which it runs, and what somebody may change in
the file while it works.
"""

from collections.abc import Callable

import bmesh
import bpy
import children_scenes
import numpy as np
import particle_scenes
import projection_truth
import scenes
from limit_surface import ids
from limit_surface.attach.operator import OBJECT_OT_limit_attach
from limit_surface.bake_displacement.operator import OBJECT_OT_limit_bake_displacement
from limit_surface.bake_maps.operator import OBJECT_OT_limit_bake_maps
from limit_surface.children.operator import OBJECT_OT_limit_children_add
from limit_surface.curvature.operator import OBJECT_OT_limit_curvature
from limit_surface.draw.lay_operator import OBJECT_OT_limit_curve_lay
from limit_surface.follow.operator import OBJECT_OT_limit_follow
from limit_surface.follow.rebind_operator import OBJECT_OT_limit_rebind
from limit_surface.follow.unbind_operator import OBJECT_OT_limit_unbind
from limit_surface.hair.operator import OBJECT_OT_limit_hair_add
from limit_surface.limit_mesh.operator import OBJECT_OT_limit_mesh
from limit_surface.particles.from_hair_operator import OBJECT_OT_limit_particles_from_hair
from limit_surface.particles.to_hair_operator import OBJECT_OT_limit_hair_from_particles
from limit_surface.points.operator import OBJECT_OT_limit_points_add
from limit_surface.project_image.operator import OBJECT_OT_limit_project_image
from limit_surface.report.operator import OBJECT_OT_limit_report
from limit_surface.report.show_operator import OBJECT_OT_limit_show
from limit_surface.sampling.tables_operator import OBJECT_OT_limit_sample_tables
from limit_surface.snap.operator import OBJECT_OT_limit_snap
from stand_ins import stand_in_of

SURFACE = "Holes"


def surface() -> bpy.types.Object:
    ob = scenes.grid_with_holes()
    scenes.add_uv_map(ob, lambda p: p[:, :2] / 8)
    scenes.add_subsurf(ob)
    return ob


def select(ob: bpy.types.Object, things: list[bpy.types.Object]) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for each in (*things, ob):
        each.select_set(True)
    scenes.activate(ob)


def on_surface(cls: type, **chosen: object) -> Callable[[], object]:
    def case():
        select(surface(), [])
        return stand_in_of(cls, **chosen)

    return case


def children(mode):
    def case():
        guides = children_scenes.add_guides(surface())
        select(guides, [])
        chosen = {"guides": guides.name, "distribution": "UNIFORM", "count": 50, "mode": mode}
        return stand_in_of(OBJECT_OT_limit_children_add, **chosen)

    return case


def displacement():
    ob = surface()
    sculpt = ob.copy()
    sculpt.data, sculpt.name = ob.data.copy(), "Sculpt"
    bpy.context.collection.objects.link(sculpt)
    sculpt.data.vertices[8].co.z += 0.1
    select(ob, [sculpt])
    chosen = {"image_name": "Target", "width": 32, "height": 32, "margin": 2}
    return stand_in_of(OBJECT_OT_limit_bake_displacement, **chosen)


def displacement_again():
    displacement().execute(bpy.context)
    chosen = {"image_name": "Target", "width": 32, "height": 32, "margin": 2}
    return stand_in_of(OBJECT_OT_limit_bake_displacement, **chosen)


def maps():
    select(surface(), [])
    chosen = {"maps": {"POSITION"}, "width": 32, "height": 32, "margin": 2}
    return stand_in_of(OBJECT_OT_limit_bake_maps, **chosen)


def projection(**chosen):
    def case():
        ob = surface()
        projection_truth.add_camera((2.5, 2, 9), (2.5, 2, 0))
        bpy.data.images.new("Shown", 8, 8, alpha=True).generated_type = "COLOR_GRID"
        bpy.data.images.new("Target", 32, 32, alpha=True)
        select(ob, [])
        return stand_in_of(OBJECT_OT_limit_project_image, image="Shown", **chosen)

    return case


def curvature_of_roots():
    ob = surface()
    hair = scenes.add_hair(ob, per_side=2)
    select(hair, [])
    return stand_in_of(OBJECT_OT_limit_curvature, on="ROOTS")


def loose_hair(ob):
    hair = scenes.add_hair(ob, per_side=2)
    for name in list(hair.data.attributes.keys()):
        if name.startswith("limit_"):
            hair.data.attributes.remove(hair.data.attributes[name])
    return hair


def follow(mode):
    def case():
        ob = surface()
        select(ob, [loose_hair(ob)])
        return stand_in_of(OBJECT_OT_limit_follow, mode=mode)

    return case


def bound(mode):
    ob = surface()
    hair = scenes.add_hair(ob, per_side=2)
    scenes.activate(hair)
    assert bpy.ops.object.limit_follow(mode=mode) == {"FINISHED"}
    ob.data.vertices[0].co.z += 0.3
    ob.data.update()
    bpy.context.view_layer.update()
    select(ob, [])
    return hair


def rebind(mode):
    def case():
        bound(mode)
        return stand_in_of(OBJECT_OT_limit_rebind)

    return case


def unbind():
    bound("NODES")
    return stand_in_of(OBJECT_OT_limit_unbind, shape="SHOWN")


def empties():
    things = [bpy.data.objects.new(f"Thing {i}", None) for i in range(3)]
    for i, thing in enumerate(things):
        bpy.context.collection.objects.link(thing)
        thing.location = (0.7 * i, 0.4, 1)
    return things


def with_empties(cls):
    def case():
        select(surface(), empties())
        bpy.context.view_layer.update()
        return stand_in_of(cls)

    return case


def snapped_hair():
    ob = surface()
    hair = scenes.add_hair(ob, per_side=2)
    hair.location.z += 0.3
    select(ob, [hair])
    bpy.context.view_layer.update()
    return stand_in_of(OBJECT_OT_limit_snap)


def add_cable() -> bpy.types.Object:
    """Adds six lines above the surface, to be laid onto it."""
    data = bpy.data.curves.new("Cable", "CURVE")
    data.dimensions = "3D"
    for i in range(6):
        spline = data.splines.new("POLY")
        spline.points.add(1)
        spline.points[0].co, spline.points[1].co = (0.4, 0.2 + 0.1 * i, 1, 1), (0.8, 0.3, 1, 1)
    cable = bpy.data.objects.new("Cable", data)
    bpy.context.collection.objects.link(cable)
    return cable


def laid_curve():
    ob = surface()
    select(ob, [add_cable()])
    return stand_in_of(OBJECT_OT_limit_curve_lay, spline="POLY")


def to_particles():
    ob = surface()
    select(particle_scenes.add_hair(ob, per_side=4), [])
    return stand_in_of(OBJECT_OT_limit_particles_from_hair, keys=0)


def from_particles():
    to_particles()
    assert bpy.ops.object.limit_particles_from_hair() == {"FINISHED"}
    bpy.data.objects.remove(bpy.context.active_object)
    select(bpy.data.objects[SURFACE], [])
    return stand_in_of(OBJECT_OT_limit_hair_from_particles, follow="NONE")


def instanced_points():
    ob = surface()
    bpy.context.collection.objects.link(bpy.data.objects.new("Scale", None))
    select(ob, [])
    return stand_in_of(OBJECT_OT_limit_points_add, per_side=2, instance="Scale")


def snapped_vertices():
    target = surface()
    ob = scenes.cross()
    bpy.context.scene.limit_surface.target = target
    select(ob, [])
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    return stand_in_of(OBJECT_OT_limit_snap)


def rebind_by_uv():
    bound("NODES")
    return stand_in_of(OBJECT_OT_limit_rebind, method="UV")


def follow_with_a_sharer():
    operator = follow("LIVE")()
    sharer = hair().copy()
    sharer.name = "Sharer"
    bpy.context.collection.objects.link(sharer)
    return operator


def limit_mesh():
    ob = surface()
    ob.data.materials.append(bpy.data.materials.new("Skin"))
    select(ob, [])
    return stand_in_of(OBJECT_OT_limit_mesh, levels=1)


CASES: dict[str, Callable[[], object]] = {
    "hair": on_surface(OBJECT_OT_limit_hair_add, per_side=2),
    "points": on_surface(OBJECT_OT_limit_points_add, per_side=2),
    "children": children("MADE"),
    "live children": children("LIVE"),
    "displacement": displacement,
    "displacement again": displacement_again,
    "maps": maps,
    "new texture": projection(width=32, height=32, create_material=True),
    "texture": projection(output="EXISTING", target="Target"),
    "decal": projection(mode="DECAL", decal_resolution=8, follow="NODES"),
    "limit mesh": limit_mesh,
    "curvature": on_surface(OBJECT_OT_limit_curvature),
    "curvature of a new mesh": on_surface(OBJECT_OT_limit_curvature, on="TESSELLATION", levels=1),
    "curvature of roots": curvature_of_roots,
    "report": on_surface(OBJECT_OT_limit_report),
    "show": on_surface(OBJECT_OT_limit_show, levels=2),
    "tables": on_surface(OBJECT_OT_limit_sample_tables, depth=4, levels=1),
    "follow by nodes": follow("NODES"),
    "follow live": follow("LIVE"),
    "rebind": rebind("NODES"),
    "rebind by UV": rebind_by_uv,
    "rebind live": rebind("LIVE"),
    "unbind": unbind,
    "attach": with_empties(OBJECT_OT_limit_attach),
    "snap": with_empties(OBJECT_OT_limit_snap),
    "snap hair": snapped_hair,
    "lay curves": laid_curve,
    "particles from hair": to_particles,
    "hair from particles": from_particles,
}
#: Cases in which only what stands in OTHERS is changed
MORE_CASES = {
    "points with instances": instanced_points,
    "snap vertices": snapped_vertices,
    "follow live with a sharer": follow_with_a_sharer,
}


def change_faces() -> None:
    mesh = bpy.data.objects[SURFACE].data
    changed = bmesh.new()
    changed.from_mesh(mesh)
    bmesh.ops.subdivide_edges(changed, edges=changed.edges, cuts=1, use_grid_fill=True)
    changed.to_mesh(mesh)
    changed.free()


def enter_edit_mode() -> None:
    scenes.activate(bpy.data.objects[SURFACE])
    bpy.ops.object.mode_set(mode="EDIT")


def remove_surface() -> None:
    bpy.data.objects.remove(bpy.data.objects[SURFACE])


def rename_surface() -> None:
    bpy.data.objects[SURFACE].name = "Renamed"


def swap_names() -> None:
    """Gives the name of the surface to another mesh, a larger one with the same faces."""
    ob = bpy.data.objects[SURFACE]
    ob.name = "Renamed"
    other = ob.copy()
    other.data, other.name = ob.data.copy(), SURFACE
    bpy.context.collection.objects.link(other)
    other.scale = (2, 2, 2)


def move_surface() -> None:
    bpy.data.objects[SURFACE].location.x += 3
    bpy.context.view_layer.update()


def move_uv() -> None:
    layer = bpy.data.objects[SURFACE].data.uv_layers["Flat"]
    uv = np.empty(2 * len(layer.data), np.float32)
    layer.data.foreach_get("uv", uv)
    layer.data.foreach_set("uv", 0.5 * uv)


def rename_uv_map() -> None:
    bpy.data.objects[SURFACE].data.uv_layers["Flat"].name = "Other"


CHANGES = {
    "faces": change_faces,
    "Edit Mode": enter_edit_mode,
    "removed": remove_surface,
    "renamed": rename_surface,
    "swapped": swap_names,
    "moved": move_surface,
    "UV": move_uv,
    "UV map": rename_uv_map,
}
IN_WORLD = {"displacement", "displacement again", "attach", "snap", "snap hair", "lay curves"}
ON_UV_MAP = {
    *("hair", "points", "children", "live children", "hair from particles"),
    *("rebind", "rebind by UV", "rebind live"),
    *("displacement", "displacement again", "maps", "new texture", "texture"),
}


def refuses(case: str, change: str) -> bool:
    """Tells whether the result is of no use after the change."""
    if case == "unbind":  # things keep their shape without a surface, but would lose their places
        return change == "Edit Mode"
    if change in ("UV", "UV map"):
        return case in ON_UV_MAP
    return change in ("faces", "Edit Mode", "removed") or (change == "moved" and case in IN_WORLD)


def hair() -> bpy.types.Object:
    return next(ob for ob in bpy.data.objects if ob.type == "CURVES")


def remove_strands() -> None:
    ob = hair()
    ob.data.remove_curves(indices=[0, 3])
    ob.data.update_tag()


def resize_strands() -> None:
    ob = hair()
    ob.data.resize_curves([len(curve.points) + 1 for curve in ob.data.curves])


def move_roots() -> None:
    ob = hair()
    if ids.FACE not in ob.data.attributes:
        return
    values = np.empty(len(ob.data.curves), np.int32)
    ob.data.attributes[ids.FACE].data.foreach_get("value", values)
    ob.data.attributes[ids.FACE].data.foreach_set("value", values[::-1].copy())


def remove_hair() -> None:
    bpy.data.objects.remove(hair())


def rename_hair() -> None:
    hair().name = "Other hair"


HAIR_CHANGES = {
    "strands": remove_strands,
    "points": resize_strands,
    "roots": move_roots,
    "removed": remove_hair,
    "renamed": rename_hair,
}
#: The operators that work on hair, and the changes of it that do not matter
ON_HAIR = {
    "children": {"renamed"},
    "live children": {"renamed"},
    "curvature of roots": {"renamed"},
    "follow by nodes": {"renamed", "roots"},
    "follow live": {"renamed", "roots"},
    "rebind": {"renamed"},
    "rebind live": {"renamed"},
    "unbind": {"renamed"},
    "snap hair": {"renamed", "roots"},
    "particles from hair": {"renamed", "strands", "points", "roots", "removed"},
}


def remove_thing() -> None:
    bpy.data.objects.remove(bpy.data.objects["Thing 1"])


def remove_spline() -> None:
    data = bpy.data.objects["Cable"].data
    data.splines.remove(data.splines[0])


def move_spline() -> None:
    bpy.data.objects["Cable"].data.splines[5].points[0].co.x += 0.1


def remove_cable() -> None:
    bpy.data.objects.remove(bpy.data.objects["Cable"])


def remove_sculpt() -> None:
    bpy.data.objects.remove(bpy.data.objects["Sculpt"])


def change_sculpt() -> None:
    bpy.data.objects["Sculpt"].data.clear_geometry()


def remove_target() -> None:
    bpy.data.images.remove(bpy.data.images["Target"])


def rename_target() -> None:
    bpy.data.images["Target"].name = "Other"


def swap_targets() -> None:
    bpy.data.images["Target"].name = "Other"
    bpy.data.images.new("Target", 32, 32, alpha=True)


def paint_target() -> None:
    image = bpy.data.images["Target"]
    image.pixels.foreach_set(np.full(4 * 32 * 32, 0.25, np.float32))


def resize_target() -> None:
    bpy.data.images["Target"].scale(16, 16)


def remove_system() -> None:
    ob = bpy.data.objects[SURFACE]
    ob.modifiers.remove(ob.modifiers[-1])


def rename_shown() -> None:
    bpy.data.images["Shown"].name = "Other"


def remove_instance() -> None:
    bpy.data.objects.remove(bpy.data.objects["Scale"])


def rename_instance() -> None:
    bpy.data.objects["Scale"].name = "Other"


def remove_sharer() -> None:
    bpy.data.objects.remove(bpy.data.objects["Sharer"])


def leave_edit_mode() -> None:
    bpy.ops.object.mode_set(mode="OBJECT")


def rename_material() -> None:
    bpy.data.materials["Skin"].name = "Other"


#: Other changes, and what the report names where they are refused
OTHERS = [
    ("points with instances", remove_instance, "Scale does not exist"),
    ("points with instances", rename_instance, ""),
    ("attach", remove_thing, "Thing 1 does not exist"),
    ("snap", remove_thing, "Thing 1 does not exist"),
    ("snap vertices", leave_edit_mode, "has left Edit Mode"),
    ("lay curves", remove_spline, "The splines of Cable were changed"),
    ("lay curves", move_spline, "Points of Cable were moved"),
    ("lay curves", remove_cable, "Cable does not exist"),
    ("displacement", remove_sculpt, "Sculpt does not exist"),
    ("displacement", change_sculpt, "The faces of Sculpt were changed"),
    ("displacement again", resize_target, "has 16 x 16 pixels"),
    ("texture", remove_target, "Target does not exist"),
    ("texture", rename_target, ""),
    ("texture", swap_targets, ""),
    ("texture", paint_target, "The pixels of Target were changed"),
    ("texture", resize_target, "The size of Target"),
    ("decal", rename_shown, ""),
    ("limit mesh", rename_material, ""),
    ("follow live with a sharer", remove_sharer, "Sharer does not exist"),
    ("hair from particles", remove_system, "no particle system"),
]
