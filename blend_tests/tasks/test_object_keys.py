# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that a task finds again by their names and libraries."""

import bpy
import pytest
import scenes
from limit_surface.errors import RefusalError
from limit_surface.tasks.object_keys import MaterialKey, ObjectKey


def test_an_object_is_found_again():
    ob = scenes.cross()
    key = ObjectKey.of(ob)
    assert key == ("Cross", None, ob.session_uid)
    assert key.find() == ob


def test_an_object_that_is_gone_is_refused():
    key = ObjectKey.of(scenes.cross())
    bpy.data.objects.remove(bpy.data.objects["Cross"])
    with pytest.raises(RefusalError, match="Cross does not exist any more"):
        key.find()


def test_an_object_is_told_from_another_that_has_got_its_name():
    ob = scenes.cross()
    key = ObjectKey.of(ob)
    ob.name = "Other"
    assert key.find() == ob
    scenes.cross()
    assert key.find() == ob


def test_a_linked_object_is_told_from_one_of_the_same_name(tmp_path):
    scenes.cross()
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    own = scenes.cross()
    with bpy.data.libraries.load(path, link=True) as (source, target):
        target.objects = list(source.objects)
    (linked,) = target.objects
    assert linked.name == own.name
    assert ObjectKey.of(linked).library == path
    assert ObjectKey.of(linked).find() == linked
    assert ObjectKey.of(own).find() == own


def test_a_material_is_found_again_until_it_is_removed():
    material = bpy.data.materials.new("Skin")
    key = MaterialKey.of(material)
    assert key.find() == material
    bpy.data.materials.remove(material)
    assert key.find() is None
