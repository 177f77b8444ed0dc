# SPDX-License-Identifier: GPL-3.0-or-later
"""A user's first minute: hair on Blender's default cube, which has no Subdivision Surface."""

ADD_HAIR = "object.limit_hair_add"
SHOW = "object.limit_show"
HAIR = "Limit Hair"
FACES = 6
START = ["Camera", "Cube", "Light"]


def test_the_dialog_adds_a_modifier_in_the_same_undo_step(blender):
    blender.open_tab()
    before = blender.screenshot("first_minute_panel")
    blender.click(*blender.find_button(ADD_HAIR))
    confirmation = blender.await_dialog(before)
    blender.screenshot("first_minute_dialog")
    assert blender.call("objects") == START
    blender.click(*confirmation)
    blender.await_end(ADD_HAIR)
    assert blender.call("objects") == [*START, HAIR]
    assert blender.call("curve_count", HAIR) == FACES * 20**2
    assert blender.call("modifiers", "Cube") == ["Subdivision"]
    blender.screenshot("first_minute_hair")
    blender.open_redo_panel()
    blender.screenshot("first_minute_redo")
    blender.key("Escape")
    blender.move(*blender.call("view_centre"))
    blender.key("ctrl+z")
    assert blender.call("objects") == START
    assert blender.call("modifiers", "Cube") == []


def test_escape_in_the_dialog_makes_nothing(blender):
    blender.open_tab()
    before = blender.screenshot("before")
    blender.click(*blender.find_button(ADD_HAIR))
    blender.await_dialog(before)
    blender.key("Escape")
    assert blender.call("objects") == START
    assert blender.call("modifiers", "Cube") == []


def test_a_click_shows_the_limit_surface(blender):
    blender.open_tab()
    blender.click(*blender.find_button(SHOW))
    blender.await_end(SHOW)
    assert blender.call("modifiers", "Cube") == ["Subdivision"]
    blender.screenshot("first_minute_shown")
    blender.move(*blender.call("view_centre"))
    blender.key("ctrl+z")
    assert blender.call("modifiers", "Cube") == []
