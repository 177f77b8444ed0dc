# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions that the window tests of textures and meshes call within Blender."""

import ctypes
import hashlib
import sys
import threading

import bpy
import numpy as np
from actions import activate, view
from figures.meshes import grids
from mathutils import Euler, Vector

FACES = 8  # faces of the sheet along each side
TEXELS = 512  # pixels of its texture along each side
BLANK = (1.0, 0.0, 1.0, 1.0)
DRAWN = {}  # panel -> how often it was drawn


def textured_sheet(wave: float) -> None:
    """Adds a wavy sheet with a UV map, alone in the file and active. It is seen at an angle, and
    the view shows only its texture, which has one color.
    """
    bpy.data.batch_remove(bpy.data.objects)
    mesh = _grid(wave)
    ob = bpy.data.objects.new("Sheet", mesh)
    ob.location, ob.rotation_euler, ob.scale = (0.3, -0.2, 0.1), (0.1, -0.15, 0.2), (1.1, 0.9, 1)
    bpy.context.scene.collection.objects.link(ob)
    ob.modifiers.new("Subdivision", "SUBSURF").levels = 4
    mesh.materials.append(_showing(_blank("Texture")))
    activate(ob)
    area, window = view()
    window.data.view_rotation = Euler((0.5, 0.1, 0.4)).to_quaternion()
    window.data.view_distance, window.data.view_location = 11, (0, 0, 0)
    show_flat("TEXTURE")


def _grid(wave: float) -> bpy.types.Mesh:
    side = FACES + 1
    y, x = np.mgrid[:side, :side].reshape(2, -1) * (6 / FACES) - 3
    faces = grids.grid_faces(FACES, FACES)
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(np.stack([x, y, wave * np.sin(x) * np.cos(y)], 1), [], faces.tolist())
    uv = np.stack([x, y], 1)[faces.ravel()] / 6.2 + 0.5
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", uv.astype(np.float32).ravel())
    return mesh


def _blank(name: str) -> bpy.types.Image:
    image = bpy.data.images.new(name, TEXELS, TEXELS, alpha=True)
    image.pixels.foreach_set(np.tile(np.array(BLANK, np.float32), TEXELS * TEXELS))
    image.pack()
    return image


def _showing(image: bpy.types.Image) -> bpy.types.Material:
    material = bpy.data.materials.new("Textured")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    nodes.active = texture
    return material


def show_flat(color_type: str) -> None:
    """Uses Solid shading without lights and overlays."""
    area, _ = view()
    space = area.spaces.active
    space.shading.type, space.shading.light = "SOLID", "FLAT"
    space.shading.color_type = color_type
    space.overlay.show_overlays = space.show_gizmo = False


def new_image(name: str, pixels: np.ndarray) -> None:
    """Makes an 8-bit image of pixels (rows, columns, 4), the lowest row first."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=True)
    image.pixels.foreach_set(pixels.astype(np.float32).ravel())
    image.pack()


def image_digest(name: str) -> str:
    """Returns a digest of all bits of the image's pixels."""
    image = bpy.data.images[name]
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    return hashlib.sha256(pixels.tobytes()).hexdigest()


def contents() -> dict[str, list[str]]:
    """Returns the names of what is in the file, by type."""
    kinds = ("images", "meshes", "curves", "objects", "materials", "node_groups", "textures")
    kinds += ("scenes",)
    return {kind: sorted(item.name for item in getattr(bpy.data, kind)) for kind in kinds}


def start(operator: str, **properties: object) -> None:
    """Starts the operator as a button does, in the viewport, with these properties; dialogs open at
    the mouse.
    """
    area, window = view()
    name = operator.removeprefix("object.")
    with bpy.context.temp_override(area=area, region=window):
        getattr(bpy.ops.object, name)("INVOKE_DEFAULT", **properties)


def open_menu(name: str) -> None:
    area, window = view()
    with bpy.context.temp_override(area=area, region=window):
        bpy.ops.wm.call_menu(name=name)


def count_draws(panel: str) -> None:
    """From now on `draws` returns how often the panel was drawn; closed panels are not drawn."""
    cls = getattr(bpy.types, panel)
    draw = cls.draw
    DRAWN[panel] = 0

    def counted(self, context):
        DRAWN[panel] += 1
        draw(self, context)

    cls.draw = counted


def draws(panel: str) -> int:
    return DRAWN[panel]


def threads() -> int:
    return threading.active_count()


def view_distance() -> float:
    return view()[1].data.view_distance


def mesh_size(name: str) -> tuple[int, int]:
    """Returns the numbers of vertices and faces."""
    mesh = bpy.data.objects[name].data
    return len(mesh.vertices), len(mesh.polygons)


def world_points(name: str, points: list[tuple[float, float, float]]) -> list[tuple[float, ...]]:
    matrix = bpy.data.objects[name].matrix_world
    return [tuple(matrix @ Vector(point)) for point in points]


def flush() -> None:
    """Writes Blender's messages to its log."""
    sys.stdout.flush()
    ctypes.CDLL(None).fflush(None)
