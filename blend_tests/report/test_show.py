# SPDX-License-Identifier: GPL-3.0-or-later
"""object.limit_show, and what the panel says about what is shown."""

import re

import bpy
import numpy as np
import pages
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes, cage
from limit_surface.report import show_operator
from limit_surface.subsurf import setup, shown


def cube():
    bpy.ops.mesh.primitive_cube_add()
    return bpy.context.active_object


def farthest_vertex(ob):
    """Returns the largest distance of the displayed vertices from the limit surface."""
    evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    vertices = attributes.read(evaluated.data, ids.POSITION).astype(np.float64)
    return scenes.surface_without_addon(ob).closest(vertices).distance.max()


def show(capfd, **properties):
    """Calls the operator and returns its reports."""
    capfd.readouterr()
    assert bpy.ops.object.limit_show(**properties) == {"FINISHED"}
    return capfd.readouterr().out


def test_a_mesh_without_modifier_gets_one(capfd):
    ob = cube()
    text = show(capfd)
    (subsurf,) = ob.modifiers
    assert (subsurf.type, subsurf.name) == ("SUBSURF", "Subdivision")
    assert (subsurf.levels, subsurf.render_levels, subsurf.quality) == (3, 3, 10)
    assert subsurf.use_limit_surface
    assert farthest_vertex(ob) < 1e-6
    bpy.ops.object.limit_report(levels="VIEWPORT")
    largest, mean = (ob[ids.REPORT]["VIEWPORT"][name] for name in ("max", "mean"))
    percent = 100 * largest / (2 * 3**0.5)
    assert f"at level 3: the polygons are at most {largest:.3g} from it" in text
    assert f"({percent:.2g} % of the diagonal), {mean:.3g} on average" in text


def test_the_modifier_that_there_is_keeps_its_rules(capfd):
    ob = scenes.cross()
    ob.modifiers.new("Before", "ARRAY").count = 1
    subsurf = scenes.add_subsurf(ob, "PRESERVE_CORNERS")
    subsurf.use_limit_surface, subsurf.show_viewport = False, False
    subsurf.levels, subsurf.render_levels = 1, 2
    text = show(capfd, levels=4)
    assert [m.name for m in ob.modifiers] == ["Before", "Subdivision"]
    assert (subsurf.levels, subsurf.render_levels, subsurf.quality) == (4, 2, 10)
    assert subsurf.boundary_smooth == "PRESERVE_CORNERS"
    assert subsurf.show_viewport
    surface = scenes.surface_without_addon(ob, "PRESERVE_CORNERS")
    evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    vertices = attributes.read(evaluated.data, ids.POSITION).astype(np.float64)
    assert surface.closest(vertices).distance.max() < 1e-6
    assert "Cross shows its limit surface at level 4" in text


@pytest.mark.slow
def test_more_levels_come_closer(capfd):
    scenes.monkey()
    distances = []
    for levels in (1, 2, 3):
        text = show(capfd, levels=levels)
        distances.append(float(text.split("at most ")[1].split(" from")[0]))
    assert distances[0] > 2 * distances[1] > 4 * distances[2] > 0


@pytest.mark.parametrize("faces", ["fan", "polygon"])
def test_very_many_sides_get_a_low_quality(faces, capfd):
    """Blender's time grows with the cube of the sides: at the full quality 300 take a minute."""
    around = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    positions = [(np.cos(a), np.sin(a), 0.1 * np.cos(3 * a)) for a in around]
    if faces == "fan":
        positions.append((0, 0, 0.5))
        found = [(i, (i + 1) % 300, 300) for i in range(300)]
    else:
        found = [range(300)]
    ob = scenes.add_mesh("Disc", positions, found)
    text = show(capfd)
    assert (ob.modifiers[0].quality, ob.modifiers[0].levels) == (1, 3)
    assert "Warning: Quality is 1, because at a higher quality Blender would take seconds" in text
    assert farthest_vertex(ob) < 0.01


def test_many_sides_get_the_full_quality():
    ob = scenes.add_mesh("Disc", [(np.cos(a), np.sin(a), 0) for a in range(100)], [range(100)])
    found = cage.read(ob, bpy.context.evaluated_depsgraph_get())
    assert setup.fitting_quality(found) == 10


def test_later_modifiers_are_named(capfd):
    ob = cube()
    scenes.add_subsurf(ob)
    ob.modifiers.new("Shell", "SOLIDIFY")
    assert "not measured: Shell after Subdivision" in show(capfd)


def test_the_surface_of_the_active_hair_is_shown(capfd):
    ob = cube()
    scenes.add_hair(ob)
    assert "Cube shows its limit surface" in show(capfd)
    assert len(ob.modifiers) == 1
    scenes.add_points(ob)
    assert "Cube shows its limit surface" in show(capfd)
    assert len(ob.modifiers) == 1


def test_simplify_is_told(capfd):
    cube()
    bpy.context.scene.render.use_simplify = True
    bpy.context.scene.render.simplify_subdivision = 1
    text = show(capfd)
    assert "Warning: Simplify shows level 1 instead of 3" in text
    assert "Cube shows its limit surface at level 1" in text


def check_refused(ob, match, **properties):
    before = [(m.name, m.type) for m in ob.modifiers]
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_show(**properties)
    assert [(m.name, m.type) for m in ob.modifiers] == before


def test_settings_that_are_driven_are_refused():
    ob = cube()
    subsurf = scenes.add_subsurf(ob)
    subsurf.driver_add("levels").driver.expression = "1"
    check_refused(ob, "Cube: the settings of Subdivision are animated or driven")
    assert subsurf.quality == 3


def test_millions_of_polygons_are_refused():
    ob = scenes.flat_grid(60)
    check_refused(ob, "14,745,600 polygons .*: turn on Allow Large Counts", levels=6)
    assert bpy.ops.object.limit_show(levels=2) == {"FINISHED"}


def test_a_mesh_without_faces_is_refused():
    check_refused(scenes.add_mesh("Dots", [(0, 0, 0)], []), "Dots has no faces")


def test_users_keep_finer_levels():
    ob = cube()
    assert show_operator._levels_for(ob) == 3
    scenes.add_subsurf(ob).levels = 5
    assert show_operator._levels_for(ob) == 5
    assert show_operator._levels_for(scenes.flat_grid(200)) == 2


#: The largest distances from the surface, in the unit of a face, of vertices that lie on it, and of
#: those that look as if they did
ON, NEAR = 1e-6, 0.02


def set_up(ob, **settings):
    subsurf = scenes.add_subsurf(ob)
    for name, value in {"levels": 2, "quality": 10, **settings}.items():
        setattr(subsurf, name, value)


@pytest.mark.parametrize(
    ("settings", "text", "least", "most"),
    [
        (None, "Control mesh: no modifier", NEAR, np.inf),
        ({"show_viewport": False}, "Control mesh: modifier is off", NEAR, np.inf),
        (
            {"show_viewport": False, "show_render": False},
            "Control mesh: no modifier",
            NEAR,
            np.inf,
        ),
        ({"levels": 0}, "Control mesh: level is 0", NEAR, np.inf),
        ({"use_limit_surface": False}, "Level 2, not on limit surface", NEAR, np.inf),
        ({"quality": 2}, "Level 2, near limit surface", ON, NEAR),
        ({}, "Level 2, on limit surface", 0, ON),
    ],
)
def test_what_is_shown(settings, text, least, most):
    ob = scenes.cross()
    if settings is not None:
        set_up(ob, **settings)
    found = shown.of(ob, bpy.context.scene)
    assert found == (text, most == ON, least == NEAR)
    evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    vertices = attributes.read(evaluated.data, ids.POSITION).astype(np.float64)
    distance = scenes.surface_without_addon(ob).closest(vertices).distance.max()
    assert least <= distance < most


def test_simple_subdivision_and_simplify_are_shown():
    ob = scenes.cross()
    set_up(ob, subdivision_type="SIMPLE")
    assert shown.of(ob, bpy.context.scene) == ("Level 2, simple", True, False)
    bpy.context.scene.render.use_simplify = True
    bpy.context.scene.render.simplify_subdivision = 0
    assert shown.of(ob, bpy.context.scene) == ("Control mesh: level is 0", False, True)


PAGE = pages.text("report").split("## Showing the limit surface")[1].split("\n## ")[0]


def test_page_lists_the_properties_and_has_an_example_that_runs(capsys):
    pages.check_properties(PAGE, "limit_show")
    (example,) = pages.examples(PAGE)
    exec(example, {})
    assert capsys.readouterr().out.splitlines()[-1] == "3 10 True"


def test_page_has_the_distances_of_a_cube(capfd):
    cube()
    levels, distances = re.findall(r"^\| (?:a cube|largest).*?\| (.*) \|$", PAGE, re.MULTILINE)
    for level, distance in zip(levels.split(" | "), distances.split(" | "), strict=True):
        assert f"at most {distance} from it" in show(capfd, levels=int(level))
