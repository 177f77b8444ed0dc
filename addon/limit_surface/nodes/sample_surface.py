# SPDX-License-Identifier: GPL-3.0-or-later
"""The group *Sample Limit Surface*, for users' own trees: position and frame of the limit surface
at places that are given by face or by tile.
"""

import bpy

from .. import ids
from .groups import Kind
from .locate import ALL_TILES, FACE, LOCATE, UV
from .sample import OUTPUTS, SAMPLE, TILE, TILE_UV
from .tree import Socket, Tree

USE_TILE = "Use Tile"


def _build() -> bpy.types.NodeTree:
    tree = Tree(
        ids.SAMPLE_GROUP,
        [
            Socket(
                "Surface",
                "Object",
                "Mesh object whose limit surface is wanted: the smooth surface to which its "
                "subdivision comes closer with each level",
            ),
            ALL_TILES,
            FACE,
            UV,
            Socket(USE_TILE, "Bool", "Take the place from Tile and Tile UV, not from Face and UV"),
            TILE,
            TILE_UV,
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
