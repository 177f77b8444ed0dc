# SPDX-License-Identifier: GPL-3.0-or-later
"""Lattices that deform a surface as its parent: Blender does not keep up with what changes them."""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.errors import CageError
from limit_surface.reading import attributes, cage

MOVED = 0.05  # a lattice's changes move the sheet by more than this


def sheet_in_lattice():
    ob = scenes.grid_with_holes()
    lattice = bpy.data.objects.new("Box", bpy.data.lattices.new("Box"))
    bpy.context.collection.objects.link(lattice)
    lattice.scale = (9, 9, 9)
    ob.parent, ob.parent_type = lattice, "LATTICE"
    return ob, lattice


def add_key(lattice):
    lattice.shape_key_add(name="Basis")
    key = lattice.shape_key_add(name="Bent")
    key.data[0].co.z += 0.5
    key.value = 1


def add_hook(lattice):
    hook = lattice.modifiers.new("Hook", "HOOK")
    hook.object = bpy.data.objects.new("Handle", None)
    bpy.context.collection.objects.link(hook.object)
    hook.vertex_indices_set([0])


def check_as_shown(ob):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    expected = attributes.read(ob.evaluated_get(depsgraph).data, ids.POSITION)
    found = np.array(cage.read(ob, depsgraph).mesh.positions)
    np.testing.assert_allclose(found, expected, atol=1e-5)
    assert np.abs(found - attributes.read(ob.data, ids.POSITION)).max() > MOVED


@pytest.mark.parametrize(
    ("change", "what"), [(add_key, "shape keys"), (add_hook, "Hook")], ids=["key", "hook"]
)
def test_a_lattice_that_changes_is_refused(change, what):
    ob, lattice = sheet_in_lattice()
    change(lattice)
    contents = scenes.file_contents()
    with pytest.raises(CageError, match=rf"Holes is deformed by .* Box, .*\({what}\): set Parent"):
        cage.read(ob, bpy.context.evaluated_depsgraph_get())
    assert scenes.file_contents() == contents


def test_unbinding_is_refused_and_places_are_kept():
    ob, lattice = sheet_in_lattice()
    lattice.data.points[0].co_deform.z += 0.5
    scenes.add_subsurf(ob)
    hair = scenes.add_hair(ob, per_side=1, follow="NODES")
    face = attributes.read(hair.data, ids.FACE)
    bpy.context.scene.frame_set(2)
    add_key(lattice)
    ob.data.vertices[0].co.z += 1  # so that the hair moves
    ob.data.update()
    scenes.activate(hair)
    with pytest.raises(RuntimeError, match="Holes is deformed by its parent"):
        bpy.ops.object.limit_unbind()
    np.testing.assert_array_equal(attributes.read(hair.data, ids.FACE), face)
    assert len(hair.modifiers) == 1


def test_what_the_message_advises():
    ob, lattice = sheet_in_lattice()
    add_key(lattice)
    ob.parent_type = "OBJECT"
    ob.modifiers.new("Lattice", "LATTICE").object = lattice
    check_as_shown(ob)


def test_a_lattice_with_moved_points_is_read():
    ob, lattice = sheet_in_lattice()
    lattice.data.points[0].co_deform.z += 0.5
    check_as_shown(ob)


def test_blender_does_not_keep_up():
    """The reason for the error. When this fails, Blender has learnt to, and the error can go."""
    ob, lattice = sheet_in_lattice()
    add_key(lattice)
    bpy.context.scene.frame_set(2)
    shown = []
    for _ in range(2):
        depsgraph = bpy.context.evaluated_depsgraph_get()
        shown.append(attributes.read(ob.evaluated_get(depsgraph).data, ids.POSITION))
        ob.update_tag()
    assert np.abs(shown[0] - shown[1]).max() > MOVED
