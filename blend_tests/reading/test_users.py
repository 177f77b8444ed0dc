# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that refer to a data-block are those that a look at all objects finds."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import pytest
import scenes
from limit_surface.placing import followers, live_children
from limit_surface.reading.users import objects_using, own_objects_using


def test_users_of_data_come_in_the_order_of_the_file():
    mesh = bpy.data.meshes.new("Shared")
    for name in ("b", "C", "a", "D"):
        bpy.data.objects.new(name, mesh)
    bpy.data.objects.new("other", bpy.data.meshes.new("Own"))
    assert objects_using(mesh) == [ob for ob in bpy.data.objects if ob.data == mesh]
    assert objects_using() == []
    assert own_objects_using() == []


def test_all_that_stands_on_a_surface_is_found():
    ob, other = scenes.cross(), scenes.cross()
    made = [scenes.add_hair(ob, follow=how) for how in ("NODES", "LIVE", "NONE")]
    scenes.add_hair(other, follow="NODES")
    child = bpy.data.objects.new("Child", None)
    child.parent = ob
    found = own_objects_using(ob)
    assert {*made, child} <= set(found)
    assert set(followers.followers_of(ob)) == {made[0]}
    assert set(followers.live_followers_of(ob)) == {made[1]}
    assert followers.strays_of(ob) == []
    made[0].modifiers.clear()
    assert followers.strays_of(ob) == [made[0]]
    assert live_children.on_surface(ob) == []


@pytest.mark.parametrize("panel", ["VIEW3D_PT_limit_surface", "VIEW3D_PT_limit_follow"])
def test_panels_do_not_look_at_objects_of_others(monkeypatch, panel):
    ob = scenes.cross()
    scenes.add_hair(ob, follow="NODES")
    scenes.activate(ob)

    def looks():
        seen = []
        monkeypatch.setattr(followers, "modifier_of", lambda ob: seen.append(ob) or plain(ob))
        getattr(bpy.types, panel).draw(SimpleNamespace(layout=MagicMock()), bpy.context)
        monkeypatch.undo()
        return len(seen)

    plain = followers.modifier_of
    before = looks()
    for i in range(20):
        bpy.data.objects.new(f"Other {i}", ob.data).modifiers.new("Subdivision", "SUBSURF")
    assert looks() == before > 0
