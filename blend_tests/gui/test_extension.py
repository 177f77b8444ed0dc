# SPDX-License-Identifier: GPL-3.0-or-later
"""The installed extension in its window: tab, button, undo, redo panel."""

from session import ROW

ADD_HAIR = "object.limit_hair_add"
HAIR = "Limit Hair"
FACES = 6
START = ["Camera", "Cube", "Light"]


def test_installed_with_its_native_module(blender):
    assert "Installed" in blender.installed
    found = blender.call("modules")
    assert found["addon"] == "bl_ext.user_default.limit_surface"
    assert found["limitsurf"].endswith("cpython-313-x86_64-linux-gnu.so")


def test_hair_by_a_click_and_ctrl_z(blender):
    blender.call("subdivide", "Cube")
    blender.open_tab()
    blender.click(*blender.find_button(ADD_HAIR))
    blender.await_end(ADD_HAIR)
    assert blender.call("objects") == [*START, HAIR]
    assert blender.call("curve_count", HAIR) == FACES * 20**2
    blender.screenshot("hair")
    blender.move(*blender.call("view_centre"))
    blender.key("ctrl+z")
    assert blender.call("objects") == START
    blender.key("ctrl+shift+z")
    assert blender.call("curve_count", HAIR) == FACES * 20**2


def test_redo_panel_makes_it_anew(blender):
    blender.call("subdivide", "Cube")
    blender.open_tab()
    blender.click(*blender.find_button(ADD_HAIR))
    blender.await_end(ADD_HAIR)
    x, y = blender.open_redo_panel()
    blender.screenshot("redo")
    # the panel is so tall that it begins above the place of the mouse
    blender.move(*blender.find_field(x, y + 4 * ROW, value="20"))
    blender.key("Return", "ctrl+a", "2", "1", "Return")
    blender.await_end(ADD_HAIR)
    assert blender.call("curve_count", HAIR) == FACES * 21**2
    assert blender.call("objects") == [*START, HAIR]
