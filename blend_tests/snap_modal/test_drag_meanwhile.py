# SPDX-License-Identifier: GPL-3.0-or-later
"""What playback, other windows, undo and scripts change while something is dragged."""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface.errors import RefusalError
from limit_surface.snap.surface import TargetSurface
from limit_surface.snap_modal.drag import Drag, Glide
from limit_surface.snap_modal.subject import find_subject

FACE, UV = 1, np.array([0.25, 0.625])
ELSEWHERE = (0.25, -0.5, 0.75)


@pytest.fixture
def sheet():
    ob = scenes.cross()
    scenes.add_subsurf(ob)
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Bent")
    for point in key.data:
        point.co.z += 0.5 + 0.1 * point.co.x
    key.value = 0
    bpy.context.scene.limit_surface.target = ob
    bpy.context.view_layer.update()
    return ob


@pytest.fixture
def pin(sheet):
    ob = bpy.data.objects.new("Pin", None)
    bpy.context.collection.objects.link(ob)
    ob.location = (5, 4, 3)
    ob.select_set(True)
    sheet.select_set(True)
    scenes.activate(sheet)
    bpy.context.view_layer.update()
    return ob


def begin(kind="LIMIT", element=-1):
    """Drags what is selected to a location, as a move of the mouse does."""
    subject = find_subject(bpy.context)
    surface = TargetSurface(subject.target, bpy.context.evaluated_depsgraph_get(), kind)
    glide = Glide(surface)
    drag = Drag(glide, subject.handle(element, surface))
    glide.go_to(FACE, UV)
    drag.put(0, "NONE", "STRAND")
    bpy.context.view_layer.update()
    return drag


def confirm(drag):
    drag.confirm(0, "NONE", "STRAND")
    bpy.context.view_layer.update()


def refused(drag, reason):
    with pytest.raises(RefusalError, match=reason):
        confirm(drag)


def place_on(sheet):
    """Returns the location's place in the world, on the surface as it is now."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    (modifier,) = [each for each in sheet.modifiers if each.type == "SUBSURF"]
    modifier.show_viewport = False
    cage = sheet.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    positions = np.array([vertex.co for vertex in cage.vertices], np.float64)
    modifier.show_viewport = True
    surface = TargetSurface(sheet, depsgraph, "LIMIT").cage.surface()
    surface.set_positions(positions)
    found = surface.evaluate([FACE], [UV]).position
    return scenes.transformed(np.array(sheet.matrix_world, np.float64), found)[0]


def bend(sheet):
    sheet.data.shape_keys.key_blocks["Bent"].value = 1


def move(sheet):
    sheet.location = (0.5, -1, 2)


def play(sheet):
    """Goes to a frame in which both are different."""
    key = sheet.data.shape_keys.key_blocks["Bent"]
    for frame, value in ((1, 0), (20, 1)):
        key.value, sheet.location = value, (0, 0, value)
        key.keyframe_insert("value", frame=frame)
        sheet.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(20)


@pytest.mark.parametrize("change", [bend, move, play])
@pytest.mark.parametrize("kind", ["LIMIT", "VIEWPORT"])
def test_the_surface_moves(sheet, pin, change, kind):
    """The object is put at the same location of the surface as it is now."""
    drag = begin(kind)
    at = np.array(pin.matrix_world.translation)
    change(sheet)
    bpy.context.view_layer.update()
    confirm(drag)
    assert np.linalg.norm(np.array(pin.matrix_world.translation) - at) > 0.3
    wanted = place_on(sheet)
    if kind == "VIEWPORT":
        depsgraph = bpy.context.evaluated_depsgraph_get()
        shown = TargetSurface(sheet, depsgraph, kind)
        wanted = shown.places(np.array([FACE]), UV[None], np.eye(4)).position[0]
    np.testing.assert_allclose(pin.matrix_world.translation, wanted, atol=1e-6)


def test_what_was_made_on_a_surface_is_not_dragged_by_its_origin(sheet):
    scenes.activate(sheet)
    bpy.ops.object.limit_points_add(distribution="UNIFORM", count=9)
    sheet.select_set(True)
    scenes.activate(sheet)
    with pytest.raises(RefusalError, match="Limit Points cannot be dragged: the object's own"):
        find_subject(bpy.context)


def test_a_surface_that_stays_is_not_read_anew(sheet, pin):
    drag = begin()
    before = drag.glide.surface
    confirm(drag)
    assert drag.glide.surface is before
    np.testing.assert_allclose(pin.matrix_world.translation, place_on(sheet), atol=1e-6)


def follows_by_constraint(sheet, pin):
    constraint = sheet.constraints.new("COPY_LOCATION")
    constraint.target, constraint.use_offset = pin, True


def follows_by_shape_key(sheet, pin):
    """Subdivision is the first modifier then."""
    driver = sheet.data.shape_keys.key_blocks["Bent"].driver_add("value").driver
    variable = driver.variables.new()
    variable.type = "TRANSFORMS"
    variable.targets[0].id, variable.targets[0].transform_type = pin, "LOC_X"
    driver.expression = f"{variable.name} / 10"


def faces_depend(sheet, pin):
    """The pin removes faces where it is far."""
    mask = sheet.modifiers.new("Mask", "MASK")
    mask.vertex_group = sheet.vertex_groups.new(name="Some").name
    sheet.vertex_groups[0].add([0, 1, 2, 3], 1, "REPLACE")
    mask.invert_vertex_group = True
    sheet.modifiers.move(1, 0)
    driver = mask.driver_add("show_viewport").driver
    variable = driver.variables.new()
    variable.type = "TRANSFORMS"
    variable.targets[0].id, variable.targets[0].transform_type = pin, "LOC_X"
    driver.expression = f"{variable.name} < 4.5"


@pytest.mark.parametrize("depend", [follows_by_constraint, follows_by_shape_key, faces_depend])
def test_what_depends_is_refused_with_that_reason(sheet, pin, depend):
    depend(sheet, pin)
    bpy.context.view_layer.update()
    drag = begin()
    refused(drag, "Pin cannot be put there, because Cross depends on it")
    assert tuple(pin.location) == (5, 4, 3)


def test_other_faces(sheet, pin):
    drag = begin()
    sheet.shape_key_clear()
    scenes.activate(sheet)
    mesh = sheet.data.copy()
    mesh.clear_geometry()
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    sheet.data = mesh
    refused(drag, "Cross was given other data meanwhile: run the operator again")
    assert tuple(pin.location) == (5, 4, 3)


def test_the_surface_is_removed(sheet, pin):
    drag = begin()
    bpy.data.objects.remove(sheet)
    refused(drag, "Cross does not exist any more")
    assert tuple(pin.location) == (5, 4, 3)


def test_the_object_is_removed(sheet, pin):
    drag = begin()
    bpy.data.objects.remove(pin)
    refused(drag, "Pin does not exist any more")
    drag.handle.restore()


def test_the_object_is_moved(sheet, pin):
    """What somebody else has set stays."""
    drag = begin()
    pin.location = ELSEWHERE
    refused(drag, "Pin was moved meanwhile: run the operator again")
    assert tuple(pin.location) == ELSEWHERE


def test_undo_takes_all_references_away(sheet, pin):
    bpy.ops.ed.undo_push(message="Before")
    sheet["something"] = 1
    pin.location = ELSEWHERE
    bpy.ops.ed.undo_push(message="Moved")
    drag = begin()
    bpy.ops.ed.undo()
    pin = bpy.data.objects["Pin"]
    refused(drag, "Pin was moved meanwhile: run the operator again")
    assert tuple(pin.location) == (5, 4, 3)


def triangle(has_keys):
    ob = scenes.add_mesh("Triangle", [(0, 0, 5), (1, 0, 5), (0, 1, 5)], [(0, 1, 2)])
    if has_keys:
        ob.shape_key_add(name="Basis")
        ob.shape_key_add(name="Other").data[0].co.x = -1
        ob.active_shape_key_index = 1
    bpy.ops.object.select_all(action="DESELECT")
    scenes.activate(ob)
    ob.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    return ob


def points(ob):
    keys = ob.data.shape_keys.key_blocks if ob.data.shape_keys else ()
    return [
        [tuple(point.co) for point in block]
        for block in (ob.data.vertices, *(k.data for k in keys))
    ]


@pytest.mark.parametrize("has_keys", [False, True])
def test_edit_mode_is_left_while_a_vertex_is_dragged(sheet, has_keys):
    ob = triangle(has_keys)
    bpy.ops.object.mode_set(mode="OBJECT")
    before = points(ob)
    bpy.ops.object.mode_set(mode="EDIT")
    drag = begin(element=1)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert points(ob) != before
    refused(drag, "Triangle has left Edit Mode meanwhile: run the operator again")
    assert points(ob) == before


def test_undo_in_edit_mode(sheet):
    triangle(False)
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.translate(value=(0, 0, 1))
    bpy.ops.ed.undo_push(message="Moved")
    drag = begin(element=1)
    bpy.ops.ed.undo()
    refused(drag, "Triangle .* meanwhile|Points of Triangle were moved meanwhile")
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.data.objects["Triangle"].data.vertices[1].co.z in (5, 6)


def test_vertex_on_a_surface_that_moves(sheet):
    ob = triangle(False)
    drag = begin(element=1)
    bend(sheet)
    confirm(drag)
    bpy.ops.object.mode_set(mode="OBJECT")
    at = ob.matrix_world @ ob.data.vertices[1].co
    np.testing.assert_allclose(at, place_on(sheet), atol=2e-6)


def hair(sheet):
    made = scenes.add_hair(sheet, per_side=2, points=4)
    scenes.activate(made)
    return made


def test_strand_on_a_surface_that_moves(sheet):
    made = hair(sheet)
    drag = begin(element=3)
    bend(sheet)
    bpy.context.view_layer.update()
    confirm(drag)
    root = made.matrix_world @ made.data.curves[3].points[0].position
    np.testing.assert_allclose(root, place_on(sheet), atol=1e-6)
    assert made.data.attributes["limit_face"].data[3].value == FACE


def test_a_strand_is_combed(sheet):
    made = hair(sheet)
    drag = begin(element=3)
    made.data.curves[3].points[2].position = ELSEWHERE
    refused(drag, "Points of .* were moved meanwhile: run the operator again")
    assert tuple(made.data.curves[3].points[2].position) == ELSEWHERE


def test_hair_is_removed(sheet):
    made = hair(sheet)
    drag = begin(element=3)
    bpy.data.objects.remove(made)
    refused(drag, "does not exist any more")
