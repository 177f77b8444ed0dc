# SPDX-License-Identifier: GPL-3.0-or-later
"""Panel, menus and preferences, drawn into a layout that records calls."""

import os
import subprocess
import sys
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import limit_surface
import limitsurf
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import live_children, live_kept
from limit_surface.preferences import LimitSurfacePreferences
from processes import ROOT, run_python


def drawn(cls, method="draw"):
    layout = MagicMock()
    getattr(cls, method)(SimpleNamespace(layout=layout), bpy.context)
    return layout


def labels(layout):
    return [call.kwargs.get("text") for call in layout.label.call_args_list]


def test_panel_offers_the_operators():
    layout = drawn(bpy.types.VIEW3D_PT_limit_surface)
    assert "No active mesh" in labels(layout)
    assert layout.column().enabled is True
    offered = [call.args[0] for call in layout.column().operator.call_args_list]
    assert offered == [ids.HAIR_ADD, ids.POINTS_ADD, ids.DRAW]


def test_panel_shows_whose_rules_count():
    ob = scenes.cross()
    assert "No Subdivision Surface" in labels(drawn(bpy.types.VIEW3D_PT_limit_surface))
    subsurf = scenes.add_subsurf(ob)
    layout = drawn(bpy.types.VIEW3D_PT_limit_surface)
    assert "Subdivision" in labels(layout)
    assert shown_rules(layout, subsurf) == ["boundary_smooth", "uv_smooth", "use_creases"]
    subsurf.subdivision_type = "SIMPLE"
    layout = drawn(bpy.types.VIEW3D_PT_limit_surface)
    assert shown_rules(layout, subsurf) == []
    assert "Simple: bilinear faces" in labels(layout.column())


def test_panel_tells_whether_the_limit_is_shown():
    ob = scenes.cross()
    layout = drawn(bpy.types.VIEW3D_PT_limit_surface)
    assert "Cross" in labels(layout)
    assert "Control mesh: no modifier" in labels(layout.row())
    assert layout.row().alert is True
    assert layout.row().operator.call_args.args == (ids.SHOW,)
    bpy.ops.object.limit_show()
    layout = drawn(bpy.types.VIEW3D_PT_limit_surface)
    assert "Level 3, on limit surface" in labels(layout.row())
    assert layout.row().alert is False
    assert not layout.row().operator.called
    bpy.context.view_layer.objects.active = None
    assert "No active mesh" in labels(drawn(bpy.types.VIEW3D_PT_limit_surface))
    bpy.context.view_layer.objects.active = ob


def test_panel_tells_what_is_bound():
    ob = scenes.cross()
    assert "Nothing follows it" in labels(drawn(bpy.types.VIEW3D_PT_limit_surface))
    hair = scenes.add_hair(ob, follow="NODES")
    assert "1 object follows it" in labels(drawn(bpy.types.VIEW3D_PT_limit_surface))
    assert "Cross" in labels(drawn(bpy.types.VIEW3D_PT_limit_surface))  # though the hair is active
    scenes.add_points(ob, follow="LIVE")
    layout = drawn(bpy.types.VIEW3D_PT_limit_surface)
    assert "2 objects follow it" in labels(layout)
    assert "Cross" in labels(layout)
    assert not drawn(bpy.types.VIEW3D_PT_limit_follow, "draw_header_preset").row.called
    hair.modifiers.clear()
    row = drawn(bpy.types.VIEW3D_PT_limit_follow, "draw_header_preset").row()
    assert not row.label.called  # the active object follows live, and all is well there
    scenes.activate(ob)
    row = drawn(bpy.types.VIEW3D_PT_limit_follow, "draw_header_preset").row()
    assert labels(row) == ["1 problem"]
    assert row.alert is True


def test_a_surface_in_edit_mode_is_no_problem():
    ob = scenes.cross()
    hair = scenes.add_hair(ob, follow="LIVE")
    scenes.activate(ob)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.view_layer.update()
    assert "Edit Mode" in live_kept.trouble(hair)
    row = drawn(bpy.types.VIEW3D_PT_limit_follow, "draw_header_preset").row()
    assert not row.label.called
    column = drawn(bpy.types.VIEW3D_PT_limit_follow).column()
    said = " ".join(filter(None, labels(column)))
    assert "While Cross is in Edit Mode, what follows it live stays still" in said
    bpy.ops.object.mode_set(mode="OBJECT")


def test_panel_counts_live_children():
    ob = scenes.cross()
    scenes.add_hair(ob, follow="NODES")
    bpy.ops.object.limit_children_add(mode="LIVE")
    assert live_children.on_surface(ob)
    assert "2 objects follow it" in labels(drawn(bpy.types.VIEW3D_PT_limit_surface))


def test_panel_tells_where_hair_stands_that_does_not_follow():
    scenes.add_hair(scenes.cross(), follow="NONE")
    said = " ".join(labels(drawn(bpy.types.VIEW3D_PT_limit_follow).column()))
    assert said == "Limit Hair stands on Cross and does not follow it"


def test_following_is_offered_where_something_can_follow():
    ob = scenes.cross()
    offered = (
        bpy.ops.object.limit_follow,
        bpy.ops.object.limit_rebind,
        bpy.ops.object.limit_unbind,
    )
    assert [operator.poll() for operator in offered] == [False, False, False]
    hair = scenes.add_hair(ob, follow="NONE")
    assert [operator.poll() for operator in offered] == [True, True, False]
    hair.select_set(False)
    scenes.activate(ob)
    assert [operator.poll() for operator in offered] == [False, False, False]
    scenes.activate(hair)
    bpy.ops.object.limit_follow()
    hair.select_set(False)
    scenes.activate(ob)
    assert [operator.poll() for operator in offered] == [True, True, True]


def test_panel_asks_no_objects_where_nothing_can_follow(monkeypatch):
    scenes.cross()
    monkeypatch.setattr(limit_surface.ui.panel, "followers_of", lambda _surface: 1 / 0)
    assert "Nothing follows it" in labels(drawn(bpy.types.VIEW3D_PT_limit_surface))


def shown_rules(layout, subsurf):
    calls = layout.column().prop.call_args_list
    return [call.args[1] for call in calls if call.args[0] == subsurf]


def test_preferences_show_the_version():
    layout = drawn(LimitSurfacePreferences)
    assert labels(layout) == [f"Native module limitsurf {limitsurf.__version__}"]


def test_menu_offers_the_operators():
    layout = drawn(bpy.types.VIEW3D_MT_object_limit_surface)
    offered = [call.args[0] for call in layout.operator.call_args_list]
    first = [ids.HAIR_ADD, ids.POINTS_ADD, ids.CHILDREN_ADD, ids.SNAP, ids.SNAP_MODAL, ids.DRAW]
    first += [ids.CURVE_LAY, ids.SHOW, ids.REPORT_OPERATOR, ids.ATTACH]
    first += [ids.PARTICLES_FROM_HAIR, ids.HAIR_FROM_PARTICLES]
    first += [ids.SAMPLE_TABLES, ids.SAMPLE_REMOVE]
    first += [ids.FOLLOW, ids.REBIND, ids.UNBIND]
    textures = drawn(bpy.types.VIEW3D_PT_limit_textures).column()
    assert textures.enabled is True
    then = [call.args[0] for call in textures.operator.call_args_list]
    assert then == [
        ids.PROJECT_IMAGE,
        ids.BAKE_MAPS,
        ids.BAKE_DISPLACEMENT,
        ids.CURVATURE,
        ids.LIMIT_MESH,
    ]
    assert offered == first + then
    for operator in offered:
        assert properties_of(operator)


def shown_in_draw_panel():
    panel = bpy.types.VIEW3D_PT_limit_draw
    assert panel.poll(bpy.context)
    layout = drawn(panel)
    assert layout.operator.call_args.args == (ids.DRAW,)
    last = bpy.context.window_manager.operator_properties_last(ids.DRAW)
    every = layout.prop.call_args_list + layout.row().prop.call_args_list
    assert {call.args[0].bl_rna.identifier for call in every} == {last.bl_rna.identifier}
    return {call.args[1] for call in every}


def test_what_counts_while_drawing_is_set_beforehand():
    assert not bpy.types.VIEW3D_PT_limit_draw.poll(bpy.context)
    ob = scenes.cross()
    scenes.activate(ob)
    while_drawing = {"steadying", "use_pressure", "use_mirror", "use_join", "brush"}
    made = {"output", "spline", "tolerance", "offset", "radius", "bevel_resolution", "follow"}
    assert shown_in_draw_panel() == while_drawing | made
    last = bpy.context.window_manager.operator_properties_last(ids.DRAW)
    last.output = "GUIDES"
    try:
        as_strands = shown_in_draw_panel()
    finally:
        last.output = "CURVE"
    every = as_strands | while_drawing | made
    hidden = {"rna_type", "summary", "strokes", "removed", "changes_active", "is_drawn"}
    assert every == set(properties_of(ids.DRAW).keys()) - hidden
    point = {"name": "", "radius": 1.0, "is_closed": False}
    strokes = [
        point | {"face": 0, "uv": (0.2, 0.2), "is_first": True},
        point | {"face": 0, "uv": (0.8, 0.2), "is_first": False},
    ]
    bpy.ops.view3d.limit_draw(strokes=strokes)
    assert bpy.context.active_object.type == "CURVE"
    assert shown_in_draw_panel() == while_drawing | {"spline", "tolerance"}


def choices(name, operator=ids.HAIR_ADD):
    return properties_of(operator)[name].enum_items.keys()


def properties_of(operator):
    area, name = operator.split(".")
    return getattr(getattr(bpy.ops, area), name).get_rna_type().properties


def shown_in_redo_panel(operator=ids.HAIR_ADD, **chosen):
    """Returns the names of the properties that are shown with these choices."""
    last = getattr(bpy.types, operator.replace("object.", "OBJECT_OT_"))
    names = properties_of(operator).keys()
    values = {name: "NONE" if name.endswith("_source") else "" for name in names} | chosen
    self = MagicMock(
        summary="80 strands on 5 faces",
        properties=SimpleNamespace(**values),
        _question="",
        add_subsurf=False,
    )
    self.draw_own = last.draw_own
    last.draw(self, bpy.context)
    assert "80 strands on 5 faces" in labels(self.layout.column())
    laid_out = self.layout.prop.call_args_list + self.layout.column().prop.call_args_list
    return {call.args[1] for call in laid_out + self.layout.prop_search.call_args_list}


def test_redo_panel_shows_every_property_where_it_counts():
    ob = scenes.cross()
    for name in "AB":
        ob.data.materials.append(bpy.data.materials.new(name))
    distribution = {"distribution": "JITTERED", "density_source": "NONE", "faces": "ALL"}
    jittered = shown_in_redo_panel(**distribution)
    assert {"per_side", "seed", "target", "length", "points", "allow_large"} <= jittered
    assert not {"amount", "count", "density", "distance", "image"} & jittered
    every = set(jittered)
    assert not {"uv_map", "length_range", "tilt_image"} & jittered
    steered = [
        f"{name}_source" for name in ("density", "length", "radius", "tilt", "random", "flow")
    ]
    for name in (*steered, "faces"):
        for choice in choices(name):
            shown = shown_in_redo_panel(**distribution | {name: choice})
            assert ({"uv_map", "extension"} <= shown) == (choice == "IMAGE")
            every |= shown
    for amount in choices("amount"):
        shown = shown_in_redo_panel(
            **distribution | {"distribution": "BLUE_NOISE", "amount": amount}
        )
        assert {"count", "density", "distance"} & shown == {amount.lower()}
        every |= shown
    assert not {"border", "direction", "flow"} & every
    distribution |= {"distribution": "BORDER", "amount": "COUNT", "rows": 1}
    along = shown_in_redo_panel(**distribution)
    assert {"border", "border_jitter", "direction", "flow", "count"} <= along
    assert "lift" not in along
    every |= shown_in_redo_panel(**distribution | {"direction": "OUTWARDS", "rows": 2})
    assert every == set(properties_of(ids.HAIR_ADD).keys()) - {"rna_type", "summary", "surface"}


def test_redo_panel_of_points_shows_every_property_where_it_counts():
    ob = scenes.cross()
    for name in "AB":
        ob.data.materials.append(bpy.data.materials.new(name))

    def shown(**chosen):
        plain = {"distribution": "JITTERED", "faces": "ALL", "instances": "OBJECT"}
        return shown_in_redo_panel(ids.POINTS_ADD, **plain | {"flow_axis": "X"} | chosen)

    every = shown(instances="SCALE") | shown(flow_source="ATTRIBUTE", flow_axis="Z")
    assert "flow_angle" in every
    assert "flow_angle" not in shown(flow_source="ATTRIBUTE")
    assert not {"collection", "index_source", "flow_axis"} & shown()
    steered = [f"{name}_source" for name in ("scale", "rotation", "tilt", "random", "index")]
    for name in (*steered, "density_source", "flow_source", "faces"):
        for choice in choices(name, ids.POINTS_ADD):
            chosen = shown(instances="COLLECTION", **{name: choice})
            assert ({"uv_map", "extension"} <= chosen) == (choice == "IMAGE")
            every |= chosen
    for amount in choices("amount", ids.POINTS_ADD):
        every |= shown(distribution="BLUE_NOISE", amount=amount)
    border = {"distribution": "BORDER", "amount": "COUNT", "direction": "OUTWARDS", "rows": 2}
    every |= shown(**border) | shown()
    assert every == set(properties_of(ids.POINTS_ADD).keys()) - {"rna_type", "summary", "surface"}


def test_registering_again():
    for _ in range(2):
        limit_surface.unregister()
        assert not hasattr(bpy.types, ids.PANEL)
        limit_surface.register()
    assert hasattr(bpy.types, ids.PANEL)


WITHOUT_NATIVE = f"""
import sys
sys.path.insert(0, {str(ROOT / "addon")!r})
{{spoil}}
import bpy, limit_surface
from types import SimpleNamespace
from unittest.mock import MagicMock
from limit_surface.preferences import LimitSurfacePreferences
limit_surface.register()
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
mesh = bpy.data.meshes.new("M")
mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
ob = bpy.data.objects.new("M", mesh)
bpy.context.collection.objects.link(ob)
bpy.context.view_layer.objects.active = ob
for operator in (bpy.ops.object.limit_hair_add, bpy.ops.object.limit_points_add):
    assert not operator.poll()
    try:
        operator()
    except RuntimeError as error:
        print("POLL", error)
for cls in (bpy.types.VIEW3D_PT_limit_surface, LimitSurfacePreferences):
    layout = MagicMock()
    cls.draw(SimpleNamespace(layout=layout), bpy.context)
    print("DRAWN", " ".join(call.kwargs["text"] for call in layout.box().label.call_args_list))
    if cls is not LimitSurfacePreferences:
        assert layout.column().enabled is False
limit_surface.unregister()
"""


def check_reason_is_shown(spoil, reason):
    done = run_python(WITHOUT_NATIVE.format(spoil=spoil))
    lines = [line for line in done.stdout.splitlines() if line.startswith(("POLL", "DRAWN"))]
    assert len(lines) == 4
    for line in lines:
        assert "could not be loaded" in line
        assert reason in line
    assert "Traceback" not in done.stdout + done.stderr


@pytest.mark.parametrize("again", ["", "limit_surface.unregister(); limit_surface.register()"])
def test_scripts_that_do_not_unregister_end(again):
    """The bpy module by itself does not end while classes are registered."""
    program = f"import limit_surface; limit_surface.register(); {again}\nprint('made', flush=True)"
    path = os.pathsep.join([str(ROOT / "addon"), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, "-c", program],
        env=os.environ | {"PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    assert "made" in done.stdout.splitlines()  # Blender may print lines of its own
    assert "Traceback" not in done.stderr


def test_missing_native_module():
    check_reason_is_shown("sys.modules['limitsurf'] = None", "ModuleNotFoundError")


def test_broken_native_module(tmp_path):
    (tmp_path / "limitsurf.py").write_text("raise OSError('wrong ELF class')")
    check_reason_is_shown(f"sys.path.insert(0, {str(tmp_path)!r})", "OSError: wrong ELF class")


def test_native_module_of_another_version(tmp_path):
    """It is still in use after an update, until Blender is started again."""
    (tmp_path / "limitsurf.py").write_text("__version__ = '0.0.1'\nclass LimitSurface: pass")
    reason = f"version 0.0.1 is in use, but {limitsurf.__version__} is needed. Restart Blender"
    check_reason_is_shown(f"sys.path.insert(0, {str(tmp_path)!r})", reason)


def test_a_folder_of_that_name_is_not_the_module(tmp_path):
    (tmp_path / "limitsurf").mkdir()
    without = "not (os.path.exists(p + '/limitsurf') or 'site-packages' in p)"
    spoil = f"sys.path = [{str(tmp_path)!r}, *(p for p in sys.path if {without})]"
    # Blender itself comes from site-packages, and is imported before they are removed.
    check_reason_is_shown(
        f"import bpy, gpu_extras.batch, numpy, os; {spoil}", "is not the native module"
    )
