# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab shows the next run's settings, and how many things it will make."""

import re
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import distribution_properties, live_count
from scenes import add_hair, add_points, add_subsurf
from waiting import wait_until


@pytest.fixture(autouse=True)
def _forget():
    live_count._forget()


def settings_of(operator, **chosen):
    settings = bpy.context.window_manager.operator_properties_last(operator)
    names = [prop.identifier for prop in settings.bl_rna.properties]
    for name in names:
        if name != "rna_type":
            settings.property_unset(name)
    for name, value in chosen.items():
        setattr(settings, name, value)
    return settings


def drawn(panel):
    layout = MagicMock()
    getattr(bpy.types, panel).draw(
        SimpleNamespace(
            layout=layout,
            operator=getattr(bpy.types, panel).operator,
            noun=getattr(bpy.types, panel).noun,
            presets=getattr(bpy.types, panel).presets,
        ),
        bpy.context,
    )
    return layout


def shown_count(panel):
    lines = [call.kwargs["text"] for call in drawn(panel).column().label.call_args_list]
    return " ".join(lines)


def answered(panel):
    """Returns what is shown when Blender's timers have run."""
    said = shown_count(panel)
    for count in live_count._counts.values():
        if not bpy.app.timers.is_registered(count._look_later):
            continue
        bpy.app.timers.unregister(count._look_later)
        wait_until(lambda count=count: count._look() is None, "the count is known")
        said = shown_count(panel)
    return said


DISTRIBUTIONS = [
    {"per_side": 7},
    {"distribution": "UNIFORM", "amount": "COUNT", "count": 1234},
    {"distribution": "BLUE_NOISE", "amount": "COUNT", "count": 321},
    {"distribution": "UNIFORM", "amount": "DENSITY", "density": 123.4},
    {"distribution": "BLUE_NOISE", "amount": "DENSITY", "density": 70.0},
    {"distribution": "BLUE_NOISE", "amount": "DISTANCE", "distance": 0.07},
    {"per_side": 9, "faces": "SELECTED"},
    {"per_side": 9, "density_source": "VERTEX_GROUP", "vertex_group": "Some"},
    {
        "distribution": "BLUE_NOISE",
        "amount": "DISTANCE",
        "distance": 0.05,
        "density_source": "VERTEX_GROUP",
        "vertex_group": "Some",
        "faces": "SELECTED",
    },
]


@pytest.mark.parametrize("properties", DISTRIBUTIONS)
def test_so_many_are_made(properties):
    ob = scenes.grid_with_holes()
    ob.scale = (0.7, 1.2, 1)
    ob.vertex_groups.new(name="Some").add(list(range(14)), 0.8, "REPLACE")
    ob.data.polygons.foreach_set("select", [i % 2 == 0 for i in range(len(ob.data.polygons))])
    add_subsurf(ob)
    settings_of(ids.POINTS_ADD, **properties)
    said = answered(ids.POINTS_PANEL)
    count = int(re.search(r"([\d,]+) points$", said)[1].replace(",", ""))
    made = len(add_points(ob, **properties).data.vertices)
    if said.startswith("About"):
        assert made == pytest.approx(count, rel=0.1)
        assert "DISTANCE" in properties.values() or "density_source" in properties
    else:
        assert made == count


def test_settings_are_those_of_the_next_run():
    scenes.cross()
    settings = settings_of(ids.HAIR_ADD, per_side=3)
    offered = [call.args for call in drawn(ids.HAIR_PANEL).prop.call_args_list]
    assert (settings, "per_side") in offered
    assert answered(ids.HAIR_PANEL) == "45 strands"
    assert answered(ids.POINTS_PANEL) != "45 strands"


def test_counting_touches_nothing():
    ob = scenes.cross()
    add_subsurf(ob)
    settings_of(ids.HAIR_ADD)
    before = scenes.file_contents()
    assert shown_count(ids.HAIR_PANEL) == "Counting"
    assert answered(ids.HAIR_PANEL) == "2,000 strands"
    assert scenes.file_contents() == before


def test_changes_are_noticed():
    ob = scenes.cross()
    settings_of(ids.HAIR_ADD, distribution="UNIFORM", amount="DENSITY", density=100.0)
    first = answered(ids.HAIR_PANEL)
    assert answered(ids.HAIR_PANEL) == first
    ob.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    assert answered(ids.HAIR_PANEL) != first
    settings_of(ids.HAIR_ADD, per_side=2, faces="SELECTED")
    ob.data.polygons.foreach_set("select", [True, True, False, False, False])
    assert answered(ids.HAIR_PANEL) == "8 strands"


def test_counting_is_no_change():
    """In a window Blender updates all objects after the surface was read, which must not have it
    counted again without end.
    """
    ob = scenes.cross()
    add_subsurf(ob)
    bpy.context.view_layer.update()
    settings_of(ids.HAIR_ADD)
    answered(ids.HAIR_PANEL)
    bpy.context.view_layer.update()
    assert not any(count._is_stale for count in live_count._counts.values())
    ob.data.vertices[0].co.z += 1
    ob.data.update()
    bpy.context.view_layer.update()
    assert all(count._is_stale for count in live_count._counts.values())


def test_both_panels_at_once():
    scenes.cross()
    settings_of(ids.HAIR_ADD, per_side=2)
    settings_of(ids.POINTS_ADD, per_side=3)
    for _ in range(2):
        assert answered(ids.HAIR_PANEL) == "20 strands"
        assert answered(ids.POINTS_PANEL) == "45 points"
    assert shown_count(ids.HAIR_PANEL) == "20 strands"


def test_the_active_vertex_group_counts():
    ob = scenes.cross()
    for name, weight in (("All", 1.0), ("None", 1e-3)):
        ob.vertex_groups.new(name=name).add(range(12), weight, "REPLACE")
    ob.vertex_groups.active_index = 0
    settings_of(ids.HAIR_ADD, per_side=20, density_source="VERTEX_GROUP")
    assert answered(ids.HAIR_PANEL) == "About 2,000 strands"
    ob.vertex_groups.active_index = 1
    bpy.context.view_layer.update()
    assert answered(ids.HAIR_PANEL) == "About 2 strands"


def test_why_there_is_no_telling():
    ob = scenes.cross()
    settings_of(ids.HAIR_ADD, density_source="VERTEX_GROUP", vertex_group="Nix")
    assert answered(ids.HAIR_PANEL) == "Cross has no vertex group 'Nix'"
    ob.vertex_groups.new(name="Nix").add([0, 1], 1.0, "REPLACE")
    ob.update_tag()
    bpy.context.view_layer.update()
    assert answered(ids.HAIR_PANEL).startswith("About ")


def test_no_panel_without_a_mesh():
    for panel in (ids.HAIR_PANEL, ids.POINTS_PANEL):
        assert not getattr(bpy.types, panel).poll(bpy.context)
        ob = scenes.cross()
        assert getattr(bpy.types, panel).poll(bpy.context)
        bpy.data.objects.remove(ob)


def test_the_redo_panel_finds_the_surface_of_what_was_made():
    """After the run the hair is active, but the vertex groups are still searched on the mesh."""
    ob = scenes.cross()
    ob.vertex_groups.new(name="Some").add([0, 1], 1.0, "REPLACE")
    hair = add_hair(ob, density_source="VERTEX_GROUP", vertex_group="Some")
    assert bpy.context.active_object == hair
    found = distribution_properties.surface_object(SimpleNamespace(surface="Cross"), bpy.context)
    assert found == ob
