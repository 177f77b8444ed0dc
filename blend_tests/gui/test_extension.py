# SPDX-License-Identifier: GPL-3.0-or-later
"""The installed extension in its window: tab, button, undo, redo panel."""

ADD_HAIR = "object.limit_hair_add"
START = ["Camera", "Cube", "Light"]


def test_installed_with_its_native_module(blender):
    assert "Installed" in blender.installed
    found = blender.call("modules")
    assert found["addon"] == "bl_ext.user_default.limit_surface"
    assert found["limitsurf"].endswith("cpython-313-x86_64-linux-gnu.so")


def test_hair_by_a_click_and_ctrl_z(blender):
    blender.open_tab()
    blender.click(*blender.find_button(ADD_HAIR))
    assert blender.call("objects") == [*START[:2], "Light", "Limit Hair"]
    assert blender.call("curve_count", "Limit Hair") == 6 * 400
    blender.screenshot("hair")
    blender.move(*blender.call("view_centre"))
    blender.key("ctrl+z")
    assert blender.call("objects") == START
    blender.key("ctrl+shift+z")
    assert blender.call("curve_count", "Limit Hair") == 6 * 400


def test_redo_panel_changes_the_count(blender):
    blender.open_tab()
    blender.click(*blender.find_button(ADD_HAIR))
    blender.move(*blender.call("view_centre"))
    blender.key("F9")
    blender.screenshot("redo")
