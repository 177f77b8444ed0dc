# SPDX-License-Identifier: GPL-3.0-or-later
"""Creases in attributes of other types and domains than usual are converted as Blender converts
them.
"""

import bpy
import numpy as np
import pytest
from figures.parity import zoo as parity_zoo
from figures.parity.distances import Comparison
from limit_surface import ids
from limit_surface.errors import CageError
from limit_surface.reading import attributes, cage, element_numbers

LEVELS = 2
BOUND = 1e-6
CREASES = {ids.EDGE_CREASE: "EDGE", ids.VERTEX_CREASE: "POINT"}
DOMAINS = ("POINT", "EDGE", "FACE", "CORNER")


def random_values(kind, count, rng):
    if kind == "FLOAT":
        return rng.uniform(0, 0.77, count)
    if kind == "BOOLEAN":
        return rng.random(count) < 0.6
    return rng.choice([-2, -1, 0, 0, 1, 2], count)


def add(mesh_name, name, kind, domain, seed):
    """Adds a mesh with such an attribute, and an edge without faces."""
    ob = parity_zoo.add(mesh_name)
    parity_zoo.crease(ob.data, "loose edges")
    attribute = ob.data.attributes.new(name, kind, domain)
    values = random_values(kind, len(attribute.data), np.random.default_rng(seed))
    attributes.write(ob.data, name, kind, domain, values)
    return ob


def shown(ob):
    ob.modifiers[0].levels = LEVELS
    mesh = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return attributes.read(mesh, ids.POSITION)


@pytest.mark.every(5)
@pytest.mark.parametrize("mesh_name", ["sheet", "polygons", "fin"])
@pytest.mark.parametrize("domain", DOMAINS)
@pytest.mark.parametrize("kind", element_numbers.TYPES)
@pytest.mark.parametrize("name", CREASES)
def test_blender_subdivides_as_with_the_adapted_values(name, kind, domain, mesh_name):
    effect = 0.0
    for seed in range(3):
        ob = add(mesh_name, name, kind, domain, seed)
        expected = shown(ob)
        values = element_numbers.numbers(ob.data, name, CREASES[name])
        ob.data.attributes.remove(ob.data.attributes[name])
        without = shown(ob)
        attributes.write(ob.data, name, "FLOAT", CREASES[name], values)
        assert np.abs(shown(ob) - expected).max() <= BOUND
        effect = max(effect, np.abs(without - expected).max())
    assert effect > 1e-3


@pytest.mark.parametrize("domain", DOMAINS)
@pytest.mark.parametrize("kind", element_numbers.TYPES)
@pytest.mark.parametrize("name", CREASES)
def test_the_limit_surface_follows(name, kind, domain):
    found = Comparison(add("sheet", name, kind, domain, 0), LEVELS)
    lagging, _ = found.lagging()
    assert np.nanmax(found.positions(10)[~lagging]) <= BOUND


@pytest.mark.parametrize("domain", DOMAINS)
@pytest.mark.parametrize("kind", element_numbers.WITHOUT_NUMBERS)
@pytest.mark.parametrize("name", CREASES)
def test_what_is_no_number_is_no_crease(name, kind, domain):
    ob = parity_zoo.add("sheet")
    without = shown(ob)
    attribute = ob.data.attributes.new(name, kind, domain)
    if kind == "QUATERNION":
        attributes.write(ob.data, name, kind, domain, np.ones((len(attribute.data), 4)))
    np.testing.assert_array_equal(shown(ob), without)
    assert np.nanmax(Comparison(ob, LEVELS).positions(10)) <= BOUND


@pytest.mark.parametrize("kind", ["FLOAT_VECTOR", "FLOAT2", "FLOAT_COLOR", "BYTE_COLOR"])
def test_types_that_blender_follows_and_we_do_not(kind):
    ob = parity_zoo.add("sheet")
    ob.data.attributes.new(ids.EDGE_CREASE, kind, "CORNER")
    pattern = f"sheet: the attribute crease_edge is of type {kind}.*not supported"
    with pytest.raises(CageError, match=pattern):
        cage.read(ob, bpy.context.evaluated_depsgraph_get())
    ob.modifiers[0].use_creases = False
    cage.read(ob, bpy.context.evaluated_depsgraph_get())


def test_not_a_number_among_others():
    ob = add("sheet", ids.EDGE_CREASE, "FLOAT", "POINT", 0)
    ob.data.attributes[ids.EDGE_CREASE].data[7].value = np.nan
    with pytest.raises(CageError, match="sheet: the crease of edge .* is not a number"):
        cage.read(ob, bpy.context.evaluated_depsgraph_get())
