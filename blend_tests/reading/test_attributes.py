# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes as arrays."""

import bpy
import numpy as np
import pytest
from limit_surface.errors import RefusalError
from limit_surface.reading import attributes


@pytest.mark.parametrize(
    ("kind", "width"),
    [("INT", 1), ("FLOAT", 1), ("FLOAT2", 2), ("FLOAT_VECTOR", 3), ("QUATERNION", 4)],
)
def test_attributes_come_back(kind, width):
    mesh = bpy.data.meshes.new("Points")
    mesh.vertices.add(5)
    values = np.arange(5 * width).reshape(5, width)
    attributes.write(mesh, "made", kind, "POINT", values)
    attributes.write(mesh, "made", kind, "POINT", values + 1)  # overwrites
    assert [a.name for a in mesh.attributes].count("made") == 1
    np.testing.assert_array_equal(attributes.read(mesh, "made").reshape(5, width), values + 1)


def test_attributes_of_another_kind_or_size_are_not_overwritten():
    mesh = bpy.data.meshes.new("Points")
    mesh.vertices.add(5)
    attributes.write(mesh, "made", "INT", "POINT", np.arange(5))
    with pytest.raises(RefusalError, match="an attribute made of another type or domain"):
        attributes.write(mesh, "made", "FLOAT", "POINT", np.arange(5))
    with pytest.raises(ValueError, match="for 5 elements"):
        attributes.write(mesh, "made", "INT", "POINT", np.arange(6))
    attributes.write(mesh, "limit_made", "INT", "POINT", np.arange(5))
    attributes.write(mesh, "limit_made", "FLOAT", "POINT", np.arange(5) / 2)  # the extension's own
    assert np.array_equal(attributes.read(mesh, "limit_made"), np.arange(5) / 2)


def test_names_of_vertex_groups_are_refused():
    bpy.ops.mesh.primitive_cube_add()
    ob = bpy.context.active_object
    ob.vertex_groups.new(name="taken")
    before = ob.data.attributes.keys()
    with pytest.raises(RefusalError, match="has a vertex group taken: rename or remove it"):
        attributes.write(ob.data, "taken", "FLOAT", "POINT", np.zeros(8))
    assert ob.data.attributes.keys() == before
