# SPDX-License-Identifier: GPL-3.0-or-later
"""Length, radius, tilt and random angles of strands that a source steers.

The sheet is flat and its sources are linear functions of the place, so that all values are known.
"""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.reading import attributes
from scenes import add_hair, add_subsurf, strands
from sheet_sources import (
    INNER,
    SIDE,
    SOURCES,
    add_image,
    of_attribute,
    of_group,
    rising,
    steered,
    vertex_positions,
)

PREFIXES = ("length", "radius", "tilt", "random")


def inner(hair):
    """Returns the strands away from the border, and where their roots are."""
    root = strands(hair)[:, 0].astype(np.float64)
    is_inner = ((root[:, :2] > INNER) & (root[:, :2] < SIDE - INNER)).all(axis=1)
    assert is_inner.sum() > 400
    return is_inner, root[is_inner]


def tips(hair, is_inner):
    points = strands(hair).astype(np.float64)[is_inner]
    return points[:, -1] - points[:, 0]


@pytest.mark.parametrize("source", SOURCES)
def test_length_and_radius_are_linear_between_the_ends_of_the_range(source):
    ob = scenes.flat_grid(SIDE)
    add_subsurf(ob).uv_smooth = "NONE"
    chosen = SOURCES[source](ob)
    hair = add_hair(
        ob,
        length=0.5,
        radius=0.01,
        **steered("length", chosen, 0.2, 1.2),
        **steered("radius", chosen, 1.0, 0.0),
    )
    is_inner, root = inner(hair)
    value = rising(root)
    tip = tips(hair, is_inner)
    np.testing.assert_allclose(tip[:, 2], 0.5 * (0.2 + value), atol=2e-6)
    radius = attributes.read(hair.data, "radius").reshape(len(is_inner), -1)
    np.testing.assert_allclose(radius[is_inner], 0.01 * np.c_[1 - value].repeat(5, 1), atol=1e-8)


@pytest.mark.parametrize("source", SOURCES)
def test_tilt_grows_with_its_source(source):
    ob = scenes.flat_grid(SIDE)
    add_subsurf(ob).uv_smooth = "NONE"
    chosen = SOURCES[source](ob)
    hair = add_hair(ob, length=1, tilt=(0.8, 0), **steered("tilt", chosen, -1, 1))
    is_inner, root = inner(hair)
    angle = 0.8 * (2 * rising(root) - 1)
    tip = tips(hair, is_inner)
    expected = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=1)
    np.testing.assert_allclose(tip, expected, atol=5e-6)


def test_random_parts_grow_with_their_source():
    """The same seed gives the same random numbers, of which the source takes a part."""
    ob = scenes.flat_grid(SIDE)
    chosen = of_group(ob)
    free = {"length": 1, "random": 0.6, "random_length": 0.5, "seed": 3}
    whole = add_hair(ob, **free)
    part = add_hair(ob, **free, **steered("random", chosen, 0, 1))
    is_inner, root = inner(whole)
    value = rising(root)
    whole_tip, part_tip = tips(whole, is_inner), tips(part, is_inner)
    lengths = [np.linalg.norm(tip, axis=1) for tip in (whole_tip, part_tip)]
    np.testing.assert_allclose(1 - lengths[1], value * (1 - lengths[0]), atol=5e-6)
    assert 0.5 <= lengths[0].min() < 0.51
    assert 0.99 < lengths[0].max() <= 1 + 1e-6
    angles = [
        np.arctan2(np.linalg.norm(tip[:, :2], axis=1), tip[:, 2]) for tip in (whole_tip, part_tip)
    ]
    np.testing.assert_allclose(angles[1], value * angles[0], atol=1e-5)


def test_attributes_of_faces_are_constant_on_each_face():
    ob = scenes.flat_grid(4)
    values = np.arange(16) / 16
    attributes.write(ob.data, "where", "FLOAT", "FACE", values)
    hair = add_hair(
        ob, length=1, **steered("length", {"source": "ATTRIBUTE", "attribute": "where"}, 0, 1)
    )
    face, _ = scenes.locations(hair.data)
    points = strands(hair)
    length = np.linalg.norm(points[:, -1] - points[:, 0], axis=1)
    np.testing.assert_allclose(length, values[face], atol=1e-6)


def test_numbers_of_whole_vertices_and_truth_count_as_0_and_1():
    ob = scenes.flat_grid(4)
    is_left = vertex_positions(ob)[:, 0] < 2.5
    lengths = {}
    for kind in ("INT", "BOOLEAN"):
        attributes.write(ob.data, kind, kind, "POINT", is_left)
        source = {"source": "ATTRIBUTE", "attribute": kind}
        hair = add_hair(ob, length=1, **steered("length", source, 0.25, 1))
        points = strands(hair)
        lengths[kind] = np.linalg.norm(points[:, -1] - points[:, 0], axis=1)
        left = points[:, 0, 0] < 1.5
        np.testing.assert_allclose(lengths[kind][left], 1, atol=1e-6)
        np.testing.assert_allclose(lengths[kind][points[:, 0, 0] > 3], 0.25, atol=1e-6)
    np.testing.assert_array_equal(*lengths.values())


def test_lengths_never_fall_below_0():
    ob = scenes.flat_grid(SIDE)
    hair = add_hair(ob, length=1, **steered("length", of_group(ob), -1, 1))
    is_inner, root = inner(hair)
    np.testing.assert_allclose(
        tips(hair, is_inner)[:, 2], np.maximum(2 * rising(root) - 1, 0), atol=5e-6
    )


def test_several_groups_steer_at_once():
    ob = scenes.flat_grid(SIDE)
    falling = ob.vertex_groups.new(name="Falling")
    for i, weight in enumerate((1 - rising(vertex_positions(ob))).tolist()):
        falling.add([i], weight, "REPLACE")
    other = {"source": "VERTEX_GROUP", "vertex_group": "Falling"}
    hair = add_hair(
        ob,
        length=1,
        radius=1,
        density_source="VERTEX_GROUP",
        vertex_group="Falling",
        density_range=(1, 1),
        **steered("length", of_group(ob), 0, 1),
        **steered("radius", other, 0, 1),
    )
    assert len(hair.data.curves) == 16 * SIDE**2  # the density is 1 everywhere
    is_inner, root = inner(hair)
    np.testing.assert_allclose(tips(hair, is_inner)[:, 2], rising(root), atol=2e-6)
    radius = attributes.read(hair.data, "radius").reshape(len(is_inner), -1)
    np.testing.assert_allclose(radius[is_inner, 0], 1 - rising(root), atol=1e-6)


@pytest.mark.parametrize(("low", "high"), [(0.5, 1), (1, 0.5)])
def test_density_has_a_range(low, high):
    ob = scenes.flat_grid(SIDE)
    attributes.write(ob.data, "where", "FLOAT", "FACE", np.tile([0, 1], SIDE**2 // 2))
    hair = add_hair(
        ob,
        per_side=20,
        density_source="ATTRIBUTE",
        attribute="where",
        density_range=(low, high),
    )
    counts = np.bincount(scenes.locations(hair.data)[0], minlength=SIDE**2)
    for part, share in ((counts[::2], low), (counts[1::2], high)):
        deviation = np.sqrt(400 * share * (1 - share))
        assert np.abs(part - 400 * share).max() <= 4.5 * deviation


REFUSED = {
    "no vertex group 'Nix'": {"source": "VERTEX_GROUP", "vertex_group": "Nix"},
    "no image 'Nix'": {"source": "IMAGE", "image": "Nix"},
    "no attribute 'Nix'": {"source": "ATTRIBUTE", "attribute": "Nix"},
    "The image Ramp cannot be placed: Flat has no UV map": {"source": "IMAGE", "image": "Ramp"},
    "The attribute arrow is FLOAT_VECTOR on POINT": {"source": "ATTRIBUTE", "attribute": "arrow"},
    "The attribute edges is FLOAT on EDGE": {"source": "ATTRIBUTE", "attribute": "edges"},
    "The attribute hole has values that are not finite": {
        "source": "ATTRIBUTE",
        "attribute": "hole",
    },
}


@pytest.mark.parametrize("prefix", PREFIXES)
@pytest.mark.parametrize("match", REFUSED)
def test_sources_that_cannot_be_used(match, prefix):
    ob = scenes.flat_grid(2)
    add_image("Ramp", np.ones((2, 2)))
    attributes.write(ob.data, "arrow", "FLOAT_VECTOR", "POINT", np.ones((9, 3)))
    attributes.write(ob.data, "edges", "FLOAT", "EDGE", np.ones(12))
    attributes.write(ob.data, "hole", "FLOAT", "POINT", np.full(9, np.nan))
    check_hair_refused(f"{prefix.capitalize()}: .*{match}", **steered(prefix, REFUSED[match], 0, 1))


def test_an_attribute_that_modifiers_remove():
    ob = scenes.cross()
    chosen = of_attribute(ob)
    ob.modifiers.new("Remesh", "REMESH").mode = "BLOCKS"
    check_hair_refused(
        "Length: Cross: the modifiers remove the attribute where", **steered("length", chosen, 0, 1)
    )


def check_hair_refused(match, **properties):
    before, active = scenes.file_contents(), bpy.context.active_object
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_hair_add(**properties)
    assert scenes.file_contents() == before
    assert bpy.context.active_object == active
