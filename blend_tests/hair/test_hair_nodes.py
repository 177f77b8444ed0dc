# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own hair nodes on our hair: clumps and noise move strands, and leave roots where they
are.
"""

from pathlib import Path

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes

ASSETS = Path(
    bpy.utils.resource_path("LOCAL"),
    "datafiles/assets/geometry_nodes/procedural_hair_node_assets.blend",
)
NODES = ("Clump Hair Curves", "Hair Curves Noise")
COUNT, POINTS, LENGTH = 500, 8, 0.3

pytestmark = pytest.mark.skipif(not ASSETS.exists(), reason=f"{ASSETS} is missing")


def shown(hair):
    evaluated = hair.evaluated_get(bpy.context.evaluated_depsgraph_get())
    position = attributes.read(evaluated.data, ids.POSITION).astype(np.float64)
    return position.reshape(COUNT, POINTS, 3)


def styled_hair(**properties):
    """Returns hair on a head, and how far each node has moved its tips on average."""
    ob = scenes.monkey()
    scenes.add_subsurf(ob)
    chosen = {"distribution": "BLUE_NOISE", "count": COUNT, "points": POINTS, "length": LENGTH}
    hair = scenes.add_hair(ob, **chosen | properties)
    with bpy.data.libraries.load(str(ASSETS)) as (_there, here):
        here.node_groups = list(NODES)
    moved = []
    for group in here.node_groups:
        before = shown(hair)
        hair.modifiers.new(group.name, "NODES").node_group = group
        moved.append(np.linalg.norm(shown(hair) - before, axis=2)[:, -1].mean())
    return ob, hair, moved


def test_clumps_and_noise_leave_roots_where_they_are():
    _ob, hair, (clumped, noisy) = styled_hair()
    assert clumped > 0.1 * LENGTH
    assert noisy > 0.01 * LENGTH
    np.testing.assert_array_equal(shown(hair)[:, 0], scenes.strands(hair)[:, 0])


def test_clumped_and_noisy_hair_follows_its_surface():
    ob, hair, _moved = styled_hair(follow="NODES")
    assert [m.name for m in hair.modifiers] == [ids.FOLLOW_HAIR_GROUP, *NODES]
    for vertex in ob.data.vertices:
        vertex.co.z *= 1.3
    ob.data.update()
    bpy.context.view_layer.update()
    roots = scenes.surface_without_addon(ob).evaluate(*scenes.locations(hair.data)).position
    np.testing.assert_allclose(shown(hair)[:, 0], roots, atol=1e-6)
