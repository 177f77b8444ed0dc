# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets: those that are shipped, how the sidebar shows them, and the user's own."""

from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import limit_surface
import pytest
import scenes
from limit_surface import ids
from processes import ROOT, run_python

FOLDER = ROOT / "addon/limit_surface/presets/operator"
SHIPPED = {
    ids.HAIR_ADD: ["Eyebrows", "Grass", "Lashes", "Long_Hair", "Short_Fur"],
    ids.POINTS_ADD: ["Scales"],
}
ALL = [(operator, name) for operator, names in SHIPPED.items() for name in names]
PANELS = {ids.HAIR_ADD: ids.HAIR_PRESETS, ids.POINTS_ADD: ids.POINTS_PRESETS}


def path_of(operator, name):
    return FOLDER / operator / f"{name}.py"


def settings_of(operator):
    return bpy.context.window_manager.operator_properties_last(operator)


def choose(operator, name):
    """Chooses a preset for the next run, as the menu of the sidebar does."""
    settings = settings_of(operator)
    for prop in settings.bl_rna.properties:
        settings.property_unset(prop.identifier)
    with bpy.context.temp_override(active_operator=settings):
        bpy.ops.script.execute_preset(
            filepath=str(path_of(operator, name)), menu_idname=PANELS[operator]
        )
    return settings


def assignments(path):
    return [line.split(" = ")[0] for line in path.read_text().splitlines() if line[:3] == "op."]


def test_these_are_shipped():
    for operator, names in SHIPPED.items():
        assert sorted(path.stem for path in (FOLDER / operator).glob("*.py")) == names
    assert {path.name for path in FOLDER.iterdir()} == set(SHIPPED)


def test_blender_finds_them_while_the_extension_is_on():
    for operator in SHIPPED:
        assert str(FOLDER / operator) in bpy.utils.preset_paths(f"operator/{operator}")
    limit_surface.unregister()
    try:
        for operator in SHIPPED:
            assert str(FOLDER / operator) not in bpy.utils.preset_paths(f"operator/{operator}")
    finally:
        limit_surface.register()


@pytest.mark.parametrize("operator", SHIPPED)
def test_all_presets_of_an_operator_set_the_same_properties(operator):
    first, *others = (assignments(path_of(operator, name)) for name in SHIPPED[operator])
    assert all(other == first for other in others)
    known = settings_of(operator).bl_rna.properties
    assert {name.removeprefix("op.") for name in first} <= set(known.keys())
    # what belongs to a scene stays as it is: where things stand, and where they are dense
    kept = {"op.seed", "op.faces", "op.density_source", "op.vertex_group", "op.image", "op.target"}
    assert not kept & set(first)


@pytest.mark.parametrize(("operator", "name"), ALL)
def test_every_preset_can_be_run(operator, name):
    scenes.add_subsurf(scenes.monkey())  # it has open boundaries: the eyes
    settings = choose(operator, name)
    chosen = {
        line.removeprefix("op."): getattr(settings, line.removeprefix("op."))
        for line in assignments(path_of(operator, name))
    }
    plain = {key: v if isinstance(v, str | int | float) else tuple(v) for key, v in chosen.items()}
    area, short = operator.split(".")
    assert getattr(getattr(bpy.ops, area), short)(**plain) == {"FINISHED"}
    made = bpy.context.active_object
    if operator == ids.HAIR_ADD:
        assert len(made.data.curves) == chosen["count"]
        assert scenes.strands(made).shape[1] == chosen["points"]
    else:
        assert made.modifiers[0].name == ids.SCALES_GROUP


def test_the_menu_offers_them_for_the_next_run():
    for operator, panel in PANELS.items():
        cls = getattr(bpy.types, panel)
        layout = MagicMock()
        menu = SimpleNamespace(
            layout=layout,
            operator=operator,
            bl_idname=panel,
            preset_subdir=cls.preset_subdir.fget(SimpleNamespace(operator=operator)),
            preset_operator=cls.preset_operator,
            preset_add_operator=cls.preset_add_operator,
            preset_add_operator_properties=cls.preset_add_operator_properties.fget(
                SimpleNamespace(operator=operator)
            ),
        )
        menu.path_menu = lambda *paths, menu=menu, **more: bpy.types.Menu.path_menu(
            menu, *paths, **more
        )
        cls.draw(menu, bpy.context)
        pointer = layout.context_pointer_set.call_args.args
        assert pointer[0] == "active_operator"
        assert pointer[1].bl_rna.identifier == settings_of(operator).bl_rna.identifier
        row = layout.column().row()
        texts = [call.kwargs["text"] for call in row.operator.call_args_list]
        assert [text for text in texts if text] == [
            name.replace("_", " ") for name in SHIPPED[operator]
        ]


OWN = f"""
import sys
from pathlib import Path
sys.path.insert(0, {str(ROOT / "addon")!r})
import bpy, limit_surface
limit_surface.register()
settings = bpy.context.window_manager.operator_properties_last("object.limit_hair_add")
settings.length = 0.25
with bpy.context.temp_override(active_operator=settings):
    bpy.ops.wm.operator_preset_add(name="My own", operator="OBJECT_OT_limit_hair_add")
(own,) = Path({{user!r}}).rglob("*.py")
print("OWN", own.relative_to({{user!r}}))
settings.length = 0.5
with bpy.context.temp_override(active_operator=settings):
    bpy.ops.script.execute_preset(filepath=str(own), menu_idname="{ids.HAIR_PRESETS}")
print("LENGTH", settings.length)
folders = bpy.utils.preset_paths("operator/object.limit_hair_add")
print("FOUND", str(own.parent) in folders, len(folders))
limit_surface.unregister()
"""


def contents(folder):
    return {
        path: path.read_bytes()
        for path in Path(folder).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def test_users_keep_their_own_in_their_own_folder(tmp_path):
    before = contents(ROOT / "addon/limit_surface")
    done = run_python(OWN.format(user=str(tmp_path)), BLENDER_USER_RESOURCES=str(tmp_path))
    said = dict(
        line.split(" ", 1)
        for line in done.stdout.splitlines()
        if line.startswith(("OWN", "LENGTH", "FOUND"))
    )
    assert said == {
        "OWN": "scripts/presets/operator/object.limit_hair_add/My_own.py",
        "LENGTH": "0.25",
        "FOUND": "True 2",
    }, done.stdout + done.stderr
    assert contents(ROOT / "addon/limit_surface") == before
