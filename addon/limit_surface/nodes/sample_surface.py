# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Sample Limit Surface*, for users' own trees: position and frame of the limit surface
at places that are given by face or by tile.
"""

import bpy

from .. import ids
from .groups import Kind
from .locate import LOCATE
from .sample import OUTPUTS, SAMPLE
from .tree import Socket, Tree

USE_TILE = "Use Tile"


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.SAMPLE_GROUP,
        [
            Socket("Surface", "Object", "Mesh whose limit surface is sampled"),
            Socket("Tiles", "Object", "Its table of all tiles, Limit All Tiles"),
            Socket("Face", "Int", "Face, counted from 0; other faces than quads have one a corner"),
            Socket("UV", "Vector", "Place on the face, each coordinate from 0 to 1"),
            Socket(USE_TILE, "Bool", "Take Tile and Tile UV instead of Face and UV"),
            Socket("Tile", "Int", "Tile, counted from 0"),
            Socket("Tile UV", "Vector", "Place in the tile, each coordinate from 0 to 1"),
        ],
        list(OUTPUTS),
    )
    found = tree.group_node(
        LOCATE.group(),
        Tiles=tree.inputs["Tiles"],
        Face=tree.inputs["Face"],
        UV=tree.inputs["UV"],
    )
    by_tile = tree.inputs[USE_TILE]
    tile = tree.switch(by_tile, found["Tile"], tree.inputs["Tile"], "INT")
    place = tree.switch(by_tile, found["Tile UV"], tree.inputs["Tile UV"], "VECTOR")
    sampled = tree.group_node(
        SAMPLE.group(),
        Surface=tree.inputs["Surface"],
        Tiles=tree.inputs["Tiles"],
        Tile=tile,
        Tile_UV=place,
    )
    exists = tree.switch(by_tile, found["Found"], True, "BOOLEAN")
    fits = tree.both(sampled["Fits"], exists)
    values = {name: sampled[name] for name, *_ in OUTPUTS if name != "Fits"}
    return tree.finish(**values, Fits=fits)


SAMPLE_SURFACE = Kind(ids.SAMPLE_GROUP, 1, _build)
