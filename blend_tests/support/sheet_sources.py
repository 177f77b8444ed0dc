# SPDX-License-Identifier: GPL-3.0-or-later
"""Sources on a flat sheet that are linear functions of the place, so that all values are known."""

import bpy
import numpy as np
from limit_surface import ids
from limit_surface.reading import attributes
from scenes import add_uv_map

SIDE = 8
INNER = 1.0  # from the border the limit surface is the mesh itself, which the places stand for


def rising(positions):
    """Returns numbers from 0 on the left border of the sheet to 1 on the right."""
    return positions[:, 0] / SIDE


def vertex_positions(ob):
    return attributes.read(ob.data, "position").astype(np.float64)


def of_group(ob):
    group = ob.vertex_groups.new(name="Where")
    for i, weight in enumerate(rising(vertex_positions(ob)).tolist()):
        group.add([i], weight, "REPLACE")
    return {"source": "VERTEX_GROUP", "vertex_group": "Where"}


def of_attribute(ob, kind="FLOAT", domain="POINT"):
    places = vertex_positions(ob)
    if domain == "CORNER":
        places = places[attributes.read(ob.data, ids.CORNER_VERTEX)]
    values = rising(places)
    if kind == "FLOAT_COLOR":
        values = np.stack([0 * values, values, 0 * values, 0 * values], axis=1)
    attributes.write(ob.data, "where", kind, domain, values)
    return {"source": "ATTRIBUTE", "attribute": "where"}


def of_corners(ob):
    return of_attribute(ob, domain="CORNER")


def of_colors(ob):
    return of_attribute(ob, "FLOAT_COLOR") | {"channel": "GREEN"}


def of_image(ob):
    """A ramp is linear between the centres of its pixels."""
    add_uv_map(ob, lambda p: p[:, :2] / SIDE)
    add_image("Ramp", np.tile((np.arange(64) + 0.5) / 64, (4, 1)))
    return {"source": "IMAGE", "image": "Ramp"}


def add_image(name, values):
    height, width = values.shape
    pixels = np.ones((height, width, 4), np.float32)
    pixels[:, :, :3] = values[:, :, None]
    bpy.data.images.new(name, width, height, float_buffer=True).pixels.foreach_set(pixels.ravel())


SOURCES = {
    "vertex group": of_group,
    "attribute": of_attribute,
    "attribute of corners": of_corners,
    "color attribute": of_colors,
    "image": of_image,
}


def steered(prefix, chosen, low, high):
    named = {f"{prefix}_{name}": value for name, value in chosen.items()}
    return named | {f"{prefix}_range": (low, high)}
