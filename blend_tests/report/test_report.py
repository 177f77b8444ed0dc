# SPDX-License-Identifier: GPL-3.0-or-later
"""The reported distances are compared with many points on the triangles that Blender draws and a
fine tessellation of the limit surface.
"""

import threading
from types import SimpleNamespace
from typing import NamedTuple
from unittest.mock import MagicMock

import bpy
import limitsurf
import numpy as np
import pages
import pytest
import scenes
from figures.parity import zoo as parity_zoo
from limit_surface import ids
from limit_surface.errors import CancelledError
from limit_surface.reading import attributes, cage, displayed_mesh, subdivided_mesh
from limit_surface.report import distances
from limit_surface.tasks import watched_operator as watched_module
from limit_surface.tasks.watched_operator import WatchedOperator
from mathutils import Matrix
from mathutils.bvhtree import BVHTree
from stand_ins import status_text
from waiting import LIMIT, wait_for

AMONG = 8  # number of parts along a side of each triangle
SINGLE = 1e-6  # the rounding error of Blender's coordinates up to 5


class Crowd(NamedTuple):
    """Points in the world on every triangle: the corners of its equal parts, which have no weight,
    and the middles of the parts.
    """

    apart: np.ndarray  # distances from the nearest point of the tessellated limit surface
    slide: np.ndarray  # distances from the same place on the limit surface
    weight: np.ndarray  # area
    face: np.ndarray
    uv: np.ndarray


def crowd(ob, level):
    matrix = np.array(ob.matrix_world)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    mesh = ob.evaluated_get(depsgraph).data
    mesh.calc_loop_triangles()
    corners = np.array([triangle.loops for triangle in mesh.loop_triangles])
    vertex = attributes.read(mesh, ids.CORNER_VERTEX)
    vertices = scenes.transformed(matrix, attributes.read(mesh, ids.POSITION).astype(float))
    triangles = vertices[vertex[corners]]
    places = subdivided_mesh.corner_locations(attributes.face_sizes(ob.data), level)

    x, y = np.mgrid[: AMONG + 1, : AMONG + 1].reshape(2, -1)
    x, y = x[x + y <= AMONG], y[x + y <= AMONG]
    upwards = np.stack([x, y], axis=1)[x + y < AMONG]
    downwards = np.stack([x, y], axis=1)[x + y < AMONG - 1]
    at = np.concatenate([np.stack([x, y], axis=1), upwards + 1 / 3, downwards + 2 / 3]) / AMONG
    weights = np.column_stack([1 - at.sum(axis=1), at])
    share = np.repeat([0, AMONG**-2], [len(x), AMONG**2])

    points = np.einsum("ki,tij->tkj", weights, triangles).reshape(-1, 3)
    uv = np.einsum("ki,tij->tkj", weights, places.uv[corners]).reshape(-1, 2)
    face = np.repeat(places.face[corners[:, 0]], len(weights))
    sides = triangles[:, 1:] - triangles[:, :1]
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2

    surface = limitsurf.LimitSurface(cage.read(ob, depsgraph).mesh)
    on_limit = scenes.transformed(matrix, surface.evaluate(face, uv).position)
    fine = surface.tessellate(6)
    tree = BVHTree.FromPolygons(
        scenes.transformed(matrix, np.asarray(fine.positions)).tolist(),
        np.asarray(fine.faces).tolist(),
    )
    return Crowd(
        apart=np.array([tree.find_nearest(point)[3] for point in points.tolist()]),
        slide=np.linalg.norm(points - on_limit, axis=1),
        weight=(area[:, None] * share).ravel(),
        face=face,
        uv=uv,
    )


def report(ob, **properties):
    scenes.activate(ob)
    assert bpy.ops.object.limit_report(**properties) == {"FINISHED"}
    return {name: dict(found) for name, found in ob[ids.REPORT].items()}


def stretched(ob):
    ob.matrix_world = (
        Matrix.Translation((3, -2, 1))
        @ Matrix.Rotation(0.7, 4, (1, 2, 3))
        @ Matrix.Diagonal((2.0, 0.5, 1.3, 1))
    )
    bpy.context.view_layer.update()
    return ob


@pytest.mark.every(3)
@pytest.mark.parametrize("level", [1, *scenes.slow(2)])
@pytest.mark.parametrize("name", ["cross", "sheet", "polygons", "prism", "fans"])
def test_distances_are_those_of_a_crowd_of_points(name, level):
    ob = stretched(parity_zoo.add(name))
    ob.modifiers[0].levels = level
    expected = crowd(ob, level)
    found = report(ob, levels="VIEWPORT")["VIEWPORT"]
    assert found["level"] == level
    for of, distance in (("", expected.apart), ("slide_", expected.slide)):
        assert found[f"{of}max"] == pytest.approx(distance.max(), rel=0.02)
        mean = np.average(distance, weights=expected.weight)
        assert found[f"{of}mean"] == pytest.approx(mean, rel=0.02)


def test_the_attribute_is_the_largest_distance_around_each_vertex():
    ob = stretched(parity_zoo.add("polygons"))
    ob.modifiers[0].levels = 2
    expected = crowd(ob, 2)
    report(ob, levels="VIEWPORT")
    sizes = attributes.face_sizes(ob.data)
    at = subdivided_mesh.cage_corners(sizes)
    near = np.zeros(len(ob.data.vertices))
    vertex = attributes.read(ob.data, ids.CORNER_VERTEX)
    for v, face, uv, size in zip(vertex, at.face, at.uv, np.repeat(sizes, sizes), strict=True):
        around = (expected.face == face) & (
            (size != 4) | (np.abs(expected.uv - uv) <= 0.5).all(axis=1)
        )
        near[v] = max(near[v], expected.apart[around].max())
    found = attributes.read(ob.data, ids.DISTANCE)
    np.testing.assert_allclose(found, near, rtol=0.1)
    assert ob.data.attributes[ids.DISTANCE].domain == "POINT"


def test_flat_faces_are_on_the_surface():
    """Simple subdivision has a limit surface that every level shows exactly."""
    ob = scenes.flat_grid(3)
    scenes.add_subsurf(ob).subdivision_type = "SIMPLE"
    found = report(ob)
    for name, level in (("VIEWPORT", 1), ("RENDER", 2)):
        assert found[name]["level"] == level
        assert max(found[name]["max"], found[name]["slide_max"]) < SINGLE
    assert attributes.read(ob.data, ids.DISTANCE).max() < SINGLE


def test_a_plane_with_rounded_corners_is_off_at_the_corners_only():
    """Inside, a flat grid is its own limit surface. At its corners the mesh at level 0 reaches
    beyond a curve that passes the corner at a distance of (1/6, 1/6).
    """
    ob = scenes.flat_grid(5)
    scenes.add_subsurf(ob).levels = 0
    found = report(ob, levels="VIEWPORT")["VIEWPORT"]
    assert found["level"] == 0
    assert found["max"] == pytest.approx(np.sqrt(2) / 6, rel=1e-6)
    distance = attributes.read(ob.data, ids.DISTANCE).reshape(6, 6)
    assert distance[2:-2, 2:-2].max() < SINGLE
    np.testing.assert_allclose(distance[::5, ::5], np.sqrt(2) / 6, rtol=1e-6)


def test_levels():
    ob = parity_zoo.add("cross")
    ob.modifiers[0].levels, ob.modifiers[0].render_levels = 1, 3
    both = report(ob)
    assert {name: found["level"] for name, found in both.items()} == {"VIEWPORT": 1, "RENDER": 3}
    in_viewport = attributes.read(ob.data, ids.DISTANCE)
    assert report(ob, levels="RENDER") == {"RENDER": both["RENDER"]}
    assert attributes.read(ob.data, ids.DISTANCE).max() < in_viewport.max() / 3
    assert report(ob, levels="LEVEL", level=3)["LEVEL"] == both["RENDER"]
    assert report(ob, levels="VIEWPORT") == {"VIEWPORT": both["VIEWPORT"]}
    np.testing.assert_array_equal(attributes.read(ob.data, ids.DISTANCE), in_viewport)
    assert both["VIEWPORT"]["max"] > 4 * both["RENDER"]["max"]


def colours(data):
    return attributes.read(data, ids.DISTANCE_COLOR)


def test_colours_tell_distances():
    ob = parity_zoo.add("sheet")
    report(ob)
    distance, colour = attributes.read(ob.data, ids.DISTANCE), colours(ob.data)
    brightness = colour[:, :3] @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(brightness[np.argsort(distance)]) >= -1e-6).all()
    yellow, violet = colour[distance.argmax()], colour[distance.argmin()]
    assert yellow[:2].min() > 0.7 > 0.1 > yellow[2]
    assert violet[2] > 2 * max(violet[1], 0.02)
    assert ob.data.color_attributes.active_color.name == ids.DISTANCE_COLOR
    # The viewport shows the subdivided mesh, which has the attribute, too.
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert colours(shown).shape == (len(shown.vertices), 4)
    np.testing.assert_allclose(colours(shown)[:, :3].max(), colour[:, :3].max(), atol=0.3)


def test_full_colour():
    ob = parity_zoo.add("sheet")
    report(ob, full_color=0.01)
    distance, colour = attributes.read(ob.data, ids.DISTANCE), colours(ob.data)
    full = distance >= 0.01
    assert 0 < full.sum() < len(full)
    np.testing.assert_allclose(colour[full], np.broadcast_to(colour[full][0], colour[full].shape))
    before = colour.copy()
    report(ob, full_color=1e9)
    assert np.ptp(colours(ob.data), axis=0).max() < 1e-6
    assert np.ptp(before, axis=0).max() > 0.5


def test_vertices_that_modifiers_make():
    """The numbers are reported, but the mesh has no vertices to store the attribute."""
    ob = parity_zoo.add("sheet")
    plain = report(ob)
    for name in (ids.DISTANCE, ids.DISTANCE_COLOR):
        ob.data.attributes.remove(ob.data.attributes[name])
    ob.modifiers.new("Mirror", "MIRROR").use_mirror_merge = False
    ob.modifiers.move(1, 0)
    found = report(ob)
    assert ids.DISTANCE not in ob.data.attributes
    for key in ("max", "mean", "slide_max", "slide_mean"):
        assert found["RENDER"][key] == pytest.approx(plain["RENDER"][key], rel=0.01)


def refusal(ob, pattern, **properties):
    scenes.activate(ob)
    before = scenes.file_contents(), sorted(ob.data.attributes.keys()), sorted(ob.keys())
    with pytest.raises(RuntimeError, match=pattern):
        bpy.ops.object.limit_report(**properties)
    assert (scenes.file_contents(), sorted(ob.data.attributes.keys()), sorted(ob.keys())) == before


def test_attributes_of_somebody_else():
    ob = parity_zoo.add("sheet")
    ob.data.attributes.new(ids.DISTANCE, "FLOAT", "FACE")
    refusal(ob, "sheet has an attribute limit_distance of another type or domain .FLOAT on FACE.")


@pytest.mark.parametrize("name", [ids.DISTANCE, ids.DISTANCE_COLOR])
def test_a_vertex_group_of_that_name(name):
    ob = parity_zoo.add("sheet")
    ob.vertex_groups.new(name=name)
    refusal(ob, f"sheet has a vertex group {name}: rename or remove it")


def test_render_that_cannot_be_had():
    ob = parity_zoo.add("sheet")
    ob.modifiers.new("Mirror", "MIRROR").show_viewport = False
    ob.modifiers.move(1, 0)
    refusal(ob, "the mesh that a render shows has 576 polygons")
    assert set(report(ob, levels="VIEWPORT")) == {"VIEWPORT"}


def test_modifiers_that_renders_alone_show_are_named(capfd):
    ob = scenes.cross()
    ob.modifiers.new("Bent", "SIMPLE_DEFORM")
    scenes.add_subsurf(ob)
    report(ob, levels="RENDER")
    assert "Renders do not show" not in capfd.readouterr().out
    ob.modifiers["Bent"].show_viewport = False
    report(ob, levels="VIEWPORT")
    assert "Renders do not show" not in capfd.readouterr().out
    report(ob, levels="RENDER")
    assert "modifiers of Cross in both, or in neither: Bent\n" in capfd.readouterr().out


def test_multiresolution():
    ob = scenes.cross()
    ob.modifiers.new("Multires", "MULTIRES")
    refusal(ob, "Multiresolution .Multires. is not supported")


def test_a_level_without_a_modifier():
    ob = scenes.cross()
    refusal(ob, "Cross has no Subdivision Surface modifier", levels="LEVEL")
    assert report(ob)["VIEWPORT"]["level"] == 0


def test_faces_without_a_limit_surface(capfd):
    square, fold = (0, 1, 2, 3), (4, 5, 6, 5)
    positions = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.5), (5, 0, 0), (6, 0, 1), (5, 2, 0)]
    found = []
    for faces in ([square], [square, fold]):
        ob = scenes.add_mesh("Square", positions, faces)
        scenes.add_subsurf(ob).levels = 0
        found.append(report(ob, levels="VIEWPORT")["VIEWPORT"])
    assert found[0] == pytest.approx(found[1])
    reported = capfd.readouterr().out
    assert "1 of 2 faces has no limit surface and was left out" in reported
    ob = scenes.add_mesh("Fold", positions, [fold])
    scenes.add_subsurf(ob).levels = 0
    refusal(ob, "No face has a limit surface: .*uses vertex 5 twice", levels="VIEWPORT")


def test_only_on_a_mesh_in_object_mode():
    with pytest.raises(RuntimeError, match="Make a mesh object active first"):
        bpy.ops.object.limit_report()
    scenes.cross()
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Only available in Object Mode"):
        bpy.ops.object.limit_report()


def test_undo_takes_everything_back():
    ob = parity_zoo.add("sheet")
    bpy.ops.ed.undo_push(message="before")
    report(ob)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    ob = bpy.data.objects["sheet"]
    assert ids.DISTANCE not in ob.data.attributes
    assert ids.REPORT not in ob
    bpy.ops.ed.redo()
    ob = bpy.data.objects["sheet"]
    assert ob[ids.REPORT]["VIEWPORT"]["max"] == pytest.approx(
        float(attributes.read(ob.data, ids.DISTANCE).max())
    )


def test_linked_meshes_are_measured_and_left_alone(tmp_path):
    parity_zoo.add("sheet")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "library.blend"))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.meshes = ["sheet"]
    ob = bpy.data.objects.new("Local", wanted.meshes[0])
    bpy.context.collection.objects.link(ob)
    scenes.add_subsurf(ob)
    assert report(ob)["VIEWPORT"]["max"] > 0.01
    assert ids.DISTANCE not in ob.data.attributes


def test_the_file_keeps_it(tmp_path):
    found = report(parity_zoo.add("sheet"))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    ob = bpy.data.objects["sheet"]
    assert {name: dict(kept) for name, kept in ob[ids.REPORT].items()} == found
    assert ids.DISTANCE in ob.data.attributes


def drawn(cls, **own):
    layout = MagicMock()
    cls.draw(SimpleNamespace(layout=layout, **own), bpy.context)
    return layout


def test_panel_shows_the_numbers():
    panel = bpy.types.VIEW3D_PT_limit_report
    offered = [call.args[0] for call in drawn(panel).column().operator.call_args_list]
    assert offered == [ids.SHOW, ids.REPORT_OPERATOR]
    ob = parity_zoo.add("sheet")
    scenes.activate(ob)
    assert not drawn(panel).box.called
    found = report(ob)
    column = drawn(panel).box().column()
    assert column.label.call_args_list[0].kwargs["text"] == "Viewport, level 1"
    values = [call.kwargs["text"] for call in column.split().row().label.call_args_list]
    numbers = found["RENDER"]
    last = [f"{numbers[f'slide_{of}']:.3g}" for of in ("max", "mean")]
    assert values[-2:] == last


def test_redo_panel_shows_what_was_found():
    operator = bpy.types.OBJECT_OT_limit_report
    for levels, shown in (
        ("BOTH", ["levels", "full_color"]),
        ("LEVEL", ["levels", "level", "full_color"]),
    ):
        layout = drawn(operator, levels=levels, summary="one\ntwo")
        assert [call.args[1] for call in layout.prop.call_args_list] == shown
        assert [call.kwargs["text"] for call in layout.column().label.call_args_list] == [
            "one",
            "two",
        ]


PAGE = pages.text("report")


def test_page_lists_the_properties_and_their_defaults():
    pages.check_properties(PAGE.split("## Showing")[0], "limit_report")


def test_page_has_an_example_that_runs(capsys):
    scenes.activate(parity_zoo.add("sheet"))
    exec(pages.examples(PAGE)[0], {})
    largest, mean = (float(number) for number in capsys.readouterr().out.split()[-2:])
    assert largest > mean > 0


def watched(levels="VIEWPORT"):
    """Returns a stand-in for the operator in plain Python, because Blender makes no operators
    without a window, and a context whose window only records calls.
    """
    kind = bpy.types.OBJECT_OT_limit_report
    own = ("start", "finish", "_pieces", "_kinds", "_report", "too_large", "cancelled")
    cls = type("StandIn", (WatchedOperator,), {name: getattr(kind, name) for name in own})
    operator = cls()
    operator.properties, operator.bl_rna = operator, bpy.ops.object.limit_report.get_rna_type()
    operator.levels, operator.level, operator.full_color = levels, 3, 0.0
    operator.report = MagicMock()
    context = MagicMock(wraps=bpy.context)
    context.active_object, context.scene = bpy.context.active_object, bpy.context.scene
    context.window_manager, context.workspace = MagicMock(), MagicMock()
    return operator, context


@pytest.fixture
def slowly(monkeypatch):
    """Measuring stops half way until the event is set."""
    go_on = threading.Event()
    measure = distances.measure

    def wait(surface, found, shown, progress):
        progress(0.5)
        wait_for(go_on)
        return measure(surface, found, shown, progress)

    monkeypatch.setattr(distances, "measure", wait)
    monkeypatch.setattr(watched_module, "PATIENCE", 0.01)
    yield go_on
    go_on.set()


def event(kind):
    return SimpleNamespace(type=kind, value="PRESS")


def test_long_work_is_waited_for(slowly):
    ob = parity_zoo.add("sheet")
    scenes.activate(ob)
    operator, context = watched()
    assert operator.invoke(context, event("LEFTMOUSE")) == {"RUNNING_MODAL"}
    assert operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
    assert "Measuring sheet: 50%" in status_text(context)
    assert operator.modal(context, event("WHEELUPMOUSE")) == {"PASS_THROUGH"}
    assert ids.DISTANCE not in ob.data.attributes
    slowly.set()
    wait_for(operator._job)
    assert operator.modal(context, event("TIMER")) == {"FINISHED"}
    context.window_manager.event_timer_remove.assert_called_once()
    waited_for = dict(ob[ids.REPORT]["VIEWPORT"])
    assert waited_for == report(ob, levels="VIEWPORT")["VIEWPORT"]


def test_escape_leaves_nothing(slowly):
    ob = parity_zoo.add("sheet")
    scenes.activate(ob)
    before = scenes.file_contents(), sorted(ob.data.attributes.keys())
    operator, context = watched()
    assert operator.invoke(context, event("LEFTMOUSE")) == {"RUNNING_MODAL"}
    job = operator._job
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    operator.report.assert_called_with({"INFO"}, "Cancelled: nothing was measured")
    context.window_manager.event_timer_remove.assert_called_once()
    slowly.set()
    wait_for(job)
    with pytest.raises(CancelledError):
        job.result()
    assert (scenes.file_contents(), sorted(ob.data.attributes.keys())) == before
    assert ids.REPORT not in ob


def test_escape_is_heard_between_the_meshes(monkeypatch):
    """Blender may take seconds to make each of them."""
    ob = parity_zoo.add("sheet")
    scenes.activate(ob)
    monkeypatch.setattr(watched_module, "PATIENCE", 0.0)
    read = []
    monkeypatch.setattr(displayed_mesh, "read", lambda *arguments: read.append(arguments[-1]))
    operator, context = watched("BOTH")
    assert operator.invoke(context, event("LEFTMOUSE")) == {"RUNNING_MODAL"}
    operator._job._step()
    assert read == ["VIEWPORT"]
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    assert read == ["VIEWPORT"]
    assert ids.REPORT not in ob


def test_meshes_of_different_frames_are_not_compared(monkeypatch):
    scenes.activate(parity_zoo.add("sheet"))
    monkeypatch.setattr(watched_module, "PATIENCE", 0.0)
    operator, context = watched("BOTH")
    assert operator.invoke(context, event("LEFTMOUSE")) == {"RUNNING_MODAL"}
    operator._job._step()
    bpy.context.scene.frame_set(5)
    assert operator.modal(context, event("TIMER")) == {"CANCELLED"}
    (_kind, reason), _ = operator.report.call_args
    assert reason == "The frame has changed meanwhile: stop the playback first"


def test_what_has_gone_meanwhile(slowly):
    ob = parity_zoo.add("sheet")
    scenes.activate(ob)
    operator, context = watched()
    assert operator.invoke(context, event("LEFTMOUSE")) == {"RUNNING_MODAL"}
    bpy.data.objects.remove(ob)
    slowly.set()
    wait_for(operator._job)
    assert operator.modal(context, event("TIMER")) == {"CANCELLED"}
    operator.report.assert_called_with({"ERROR"}, "sheet does not exist any more")


def test_little_work_is_done_at_once():
    ob = scenes.flat_grid(1)
    scenes.activate(ob)
    operator, context = watched()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(watched_module, "PATIENCE", LIMIT)
        assert operator.invoke(context, event("LEFTMOUSE")) == {"FINISHED"}
    assert ids.REPORT in ob
