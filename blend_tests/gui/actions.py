# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions that the window tests call within Blender."""

import sys
import time

import bpy
import numpy as np
from figures.meshes import grids
from mathutils import Euler

TIMES = []  # filled by time_moves


def new_file() -> None:
    bpy.ops.wm.read_homefile(use_empty=False)


def redraw() -> None:
    """Redraws: the main loop draws before it calls the tests' timer again."""
    for area in bpy.context.window.screen.areas:
        area.tag_redraw()


def time_of_drawing() -> float:
    """Draws the whole window and returns the seconds that this took."""
    start = time.perf_counter()
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    return time.perf_counter() - start


def smooth_lines(on: bool) -> None:
    """Sets anti-aliasing, with which the viewport is drawn once for each sample: without a graphics
    card that takes long.
    """
    bpy.context.preferences.system.viewport_aa = "8" if on else "OFF"


def view() -> tuple[bpy.types.Area, bpy.types.Region]:
    area = next(a for a in bpy.context.window.screen.areas if a.type == "VIEW_3D")
    return area, region(area, "WINDOW")


def region(area: bpy.types.Area, kind: str) -> bpy.types.Region:
    return next(r for r in area.regions if r.type == kind)


def view_centre() -> tuple[int, int]:
    _, window = view()
    return window.x + window.width // 2, window.y + window.height // 2


def version() -> str:
    return bpy.app.version_string


def modules() -> dict[str, str]:
    """Returns where the extension and its native module were loaded from."""
    import limitsurf

    addons = bpy.context.preferences.addons.keys()
    addon = next(name for name in addons if "limit_surface" in name)
    return {"addon": addon, "limitsurf": limitsurf._limitsurf.__file__}


def show_sidebar() -> None:
    area, _ = view()
    area.spaces.active.show_region_ui = True


def sidebar() -> dict[str, object]:
    """Returns the sidebar's edges, in the window's pixels, and the open tab."""
    area, _ = view()
    ui = region(area, "UI")
    return {
        "left": ui.x,
        "right": ui.x + ui.width,
        "bottom": ui.y,
        "top": ui.y + ui.height,
        "tab": ui.active_panel_category,
    }


def clear_clipboard() -> None:
    bpy.context.window_manager.clipboard = " "


def clipboard() -> str:
    return bpy.context.window_manager.clipboard


def objects() -> list[str]:
    return sorted(ob.name for ob in bpy.data.objects)


def curve_count(name: str) -> int:
    return len(bpy.data.objects[name].data.curves)


def sheet() -> list[list[float]]:
    """Adds an open sheet of 6 x 5 squares over the integers, bent as a quadric, alone in the file
    and seen from above; its matrix turns, stretches and moves it.
    """
    bpy.data.batch_remove(bpy.data.objects)
    rows, columns = 6, 7
    grid = [(x, y) for y in range(rows) for x in range(columns)]
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(
        [(x, y, bend(x, y)) for x, y in grid],
        [],
        grids.grid_faces(columns - 1, rows - 1).tolist(),
    )
    ob = bpy.data.objects.new("Sheet", mesh)
    ob.location, ob.rotation_euler, ob.scale = (-3, -1.5, 0.5), (0.2, -0.1, 0.3), (1.2, 0.9, 1.1)
    bpy.context.scene.collection.objects.link(ob)
    bpy.context.scene.limit_surface.target = ob
    activate(ob)
    _, window = view()
    window.data.view_rotation = Euler((0.5, 0.1, 0.4)).to_quaternion()
    window.data.view_distance = 11
    return [list(row) for row in ob.matrix_world]


def bend(x: float, y: float) -> float:
    return 0.06 * x * x - 0.08 * y * y + 0.03 * x * y


def activate(*objects: bpy.types.Object) -> None:
    """Selects all of the objects and makes the last one active."""
    bpy.context.view_layer.update()
    for ob in bpy.context.view_layer.objects:
        ob.select_set(ob in objects)
    bpy.context.view_layer.objects.active = objects[-1]


def pin() -> None:
    """Adds a cone that can be dragged over the sheet, which is active."""
    mesh = bpy.data.meshes.new("Pin")
    ring = [
        (0.2, 0.1, 0),
        (0, 0.2, 0),
        (-0.2, 0.1, 0),
        (-0.2, -0.1, 0),
        (0, -0.2, 0),
        (0.2, -0.1, 0),
    ]
    mesh.from_pydata([*ring, (0, 0, 0.7)], [], [(i, (i + 1) % 6, 6) for i in range(6)])
    ob = bpy.data.objects.new("Pin", mesh)
    ob.location, ob.rotation_euler, ob.scale = (0.1, 0.7, 2), (0.3, 0.2, 0.1), (1, 0.7, 1.3)
    bpy.context.scene.collection.objects.link(ob)
    activate(ob, bpy.data.objects["Sheet"])


def hair(per_side: int) -> None:
    bpy.ops.object.limit_hair_add(per_side=per_side, length=0.5)
    bpy.context.active_object.name = "Hair"


def report() -> None:
    """Measures how far the displayed mesh of the active object is from its limit surface."""
    bpy.ops.object.limit_report()


def smooth_sheet() -> None:
    """Adds a sheet as users have it: subdivided and with smooth shading."""
    sheet = bpy.data.objects["Sheet"]
    sheet.modifiers.new("Subdivision", "SUBSURF").levels = 3
    sheet.data.shade_smooth()


def lock_location(name: str) -> None:
    bpy.data.objects[name].lock_location = (True, True, True)


def loose_vertices() -> None:
    """Adds a triangle above the sheet, in Edit Mode."""
    mesh = bpy.data.meshes.new("Triangle")
    mesh.from_pydata([(-1, 0, 1.5), (0.5, -0.5, 1.5), (0.3, 1, 1.5)], [], [(0, 1, 2)])
    ob = bpy.data.objects.new("Triangle", mesh)
    ob.scale = (1, 1.5, 1)
    bpy.context.scene.collection.objects.link(ob)
    activate(ob)
    bpy.ops.object.mode_set(mode="EDIT")


def subdivide(name: str) -> None:
    """Adds a modifier without which users are asked before anything is placed."""
    bpy.data.objects[name].modifiers.new("Subdivision", "SUBSURF")
    remember()


def modifiers(name: str) -> list[str]:
    return [modifier.name for modifier in bpy.data.objects[name].modifiers]


def remember() -> None:
    """Pushes an undo step after a script's change, as users' steps do."""
    bpy.ops.ed.undo_push(message="Before")


def start_drag(**properties: object) -> None:
    remember()
    area, window = view()
    with bpy.context.temp_override(area=area, region=window):
        bpy.ops.view3d.limit_snap_modal("INVOKE_DEFAULT", **properties)


def start_drawing(**properties: object) -> None:
    remember()
    area, window = view()
    with bpy.context.temp_override(area=area, region=window):
        bpy.ops.view3d.limit_draw("INVOKE_DEFAULT", **properties)


def splines(name: str) -> list[dict[str, object]]:
    """Returns the control points of a Curve object in the world, spline by spline."""
    ob = bpy.data.objects[name]
    found = []
    for spline in ob.data.splines:
        points = spline.bezier_points if spline.type == "BEZIER" else spline.points
        found.append(
            {
                "points": [tuple(ob.matrix_world @ point.co.to_3d()) for point in points],
                "closed": spline.use_cyclic_u,
                "radius": [point.radius for point in points],
            }
        )
    return found


def bevel_depth(name: str) -> float:
    return bpy.data.objects[name].data.bevel_depth


def drawn_points(name: str) -> list[tuple[float, ...]]:
    """Returns the points in the world through which a Curve object's lines are drawn."""
    ob = bpy.data.objects[name]
    depth, ob.data.bevel_depth = ob.data.bevel_depth, 0
    mesh = ob.to_mesh()
    found = [tuple(ob.matrix_world @ vertex.co) for vertex in mesh.vertices]
    ob.to_mesh_clear()
    ob.data.bevel_depth = depth
    return found


def symmetric_sheet() -> None:
    """Adds a bent sheet that is symmetric about its object's X axis, seen from above, active."""
    y, x = np.mgrid[:9, :9].reshape(2, -1) - 4.0
    bpy.data.batch_remove(bpy.data.objects)
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(np.stack([x, y, 0.05 * x * x], 1), [], grids.grid_faces(8, 8).tolist())
    ob = bpy.data.objects.new("Sheet", mesh)
    ob.rotation_euler = (0, 0, 0.3)
    bpy.context.scene.collection.objects.link(ob)
    activate(ob)


def running() -> list[str]:
    return [operator.bl_idname for operator in bpy.context.window.modal_operators]


def camera() -> dict[str, object]:
    """Returns where in the window the view is, and its matrix from the world to [-1, 1]^3."""
    _, window = view()
    return {
        "corner": (window.x, window.y),
        "size": (window.width, window.height),
        "matrix": [list(row) for row in window.data.perspective_matrix],
    }


def animate(name: str) -> None:
    """Lets the object move along X."""
    ob = bpy.data.objects[name]
    for frame, x in ((1, 0), (250, 5)):
        ob.location.x += x
        ob.keyframe_insert("location", frame=frame)


def play() -> None:
    bpy.ops.screen.animation_play()


def is_playing() -> bool:
    return bpy.context.screen.is_animation_playing


def set_frame(frame: int) -> None:
    bpy.context.scene.frame_set(frame)


def look_closely() -> None:
    """Brings the view so near that what lies in its middle fills it."""
    _, window = view()
    window.data.view_distance = 4


def area_count() -> int:
    return len(bpy.context.screen.areas)


def matrix(name: str) -> list[list[float]]:
    bpy.context.view_layer.update()
    return [list(row) for row in bpy.data.objects[name].matrix_world]


def transform(name: str) -> list[tuple[float, ...]]:
    ob = bpy.data.objects[name]
    return [tuple(ob.location), tuple(ob.rotation_euler), tuple(ob.scale)]


def vertices(name: str) -> list[tuple[float, ...]]:
    ob = bpy.data.objects[name]
    ob.update_from_editmode()
    return [tuple(vertex.co) for vertex in ob.data.vertices]


def strand(name: str, curve: int) -> list[tuple[float, ...]]:
    return [tuple(point.position) for point in bpy.data.objects[name].data.curves[curve].points]


def attribute(name: str, attribute: str, index: int) -> object:
    item = bpy.data.objects[name].data.attributes[attribute].data[index]
    return tuple(item.vector) if hasattr(item, "vector") else item.value


def large_sheet(side: int) -> int:
    """A wavy sheet of side x side faces that fills the view, active; the number of its faces. Only
    its bounds are drawn: without a graphics card each drawing of so many faces takes a second.
    """
    y, x = np.mgrid[: side + 1, : side + 1].reshape(2, -1) * (8 / side) - 4
    faces = grids.grid_faces(side, side)
    bpy.data.batch_remove(bpy.data.objects)
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(np.stack([x, y, 0.2 * np.sin(3 * x) * np.cos(2 * y)], 1), [], faces.tolist())
    ob = bpy.data.objects.new("Sheet", mesh)
    ob.display_type = "BOUNDS"
    bpy.context.scene.collection.objects.link(ob)
    activate(ob)
    return len(mesh.polygons)


def time_moves() -> None:
    """From now on TIMES holds the seconds that the operator spends at each move of the mouse."""
    operator = sys.modules["bl_ext.user_default.limit_surface.snap_modal.operator"]
    time_calls(operator.VIEW3D_OT_limit_snap_modal, "_follow")


def time_strokes() -> None:
    """From now on TIMES holds the seconds that drawing spends at each event of the mouse."""
    pen = sys.modules["bl_ext.user_default.limit_surface.draw.pen"]
    time_calls(pen.Pen, "take")


def time_calls(cls: type, name: str) -> None:
    own = getattr(cls, name)

    def timed(self, *arguments):
        start = time.perf_counter()
        answer = own(self, *arguments)
        TIMES.append(time.perf_counter() - start)
        return answer

    setattr(cls, name, timed)


def times() -> list[float]:
    return TIMES


def set_next(operator: str, **settings: object) -> None:
    """Sets the properties with which a button or menu entry will call the operator."""
    last = bpy.context.window_manager.operator_properties_last(operator)
    for name, value in settings.items():
        setattr(last, name, value)


def next_settings(operator: str, *names: str) -> list[object]:
    """Returns the properties with which a button or menu entry will call the operator."""
    last = bpy.context.window_manager.operator_properties_last(operator)
    return [getattr(last, name) for name in names]


def vertex_count(name: str) -> int:
    return len(bpy.data.objects[name].data.vertices)


def last_operator() -> str:
    return bpy.context.window_manager.operators[-1].bl_idname


def show_workspace(name: str) -> None:
    bpy.context.window.workspace = bpy.data.workspaces[name]
