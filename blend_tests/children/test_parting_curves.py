# SPDX-License-Identifier: GPL-3.0-or-later
"""Partings by curve objects of all types, on closed forms: a plane and a cylinder."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import numpy as np
import pytest
import scenes
from children_scenes import add_children, add_guides, check_parted, lengths, sheet, two_sided
from limit_surface import ids
from limit_surface.children.operator import OBJECT_OT_limit_children_add
from limit_surface.reading import curve_lines


def add_curve(
    points: list[tuple[float, ...]], kind: str = "POLY", cyclic: bool = False
) -> bpy.types.Object:
    data = bpy.data.curves.new("Parting", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new(kind)
    if kind == "BEZIER":
        spline.bezier_points.add(len(points) - 1)
        for point, position in zip(spline.bezier_points, points, strict=True):
            point.co = position
            point.handle_left_type = point.handle_right_type = "AUTO"
    else:
        spline.points.add(len(points) - 1)
        for point, position in zip(spline.points, points, strict=True):
            point.co = (*position, 1)
    spline.use_cyclic_u = cyclic
    return linked(data)


def add_hair_curve(points: list[tuple[float, ...]]) -> bpy.types.Object:
    data = bpy.data.hair_curves.new("Parting")
    data.add_curves([len(points)])
    data.points.foreach_set("position", np.array(points, np.float32).ravel())
    return linked(data)


def linked(data: bpy.types.ID) -> bpy.types.Object:
    ob = bpy.data.objects.new("Parting", data)
    bpy.context.collection.objects.link(ob)
    return ob


ACROSS = [(2, -0.2, 0), (2, 1, 0), (2, 4.2, 0)]


@pytest.mark.parametrize("make", ["POLY", "BEZIER", "hair"])
def test_curves_of_all_types_part(make):
    guides = two_sided(sheet())
    curve = add_hair_curve(ACROSS) if make == "hair" else add_curve(ACROSS, make)
    check_parted(add_children(guides, parting="CURVES", parting_curves=curve.name, count=1000))


def test_partings_of_billions_of_faces_are_refused():
    guides = two_sided(sheet())
    curve = add_curve([(2, -0.2, 0), (2, 1e9, 0)])
    with pytest.raises(RuntimeError, match="The partings are too long for .*, whose faces are"):
        add_children(guides, parting="CURVES", parting_curves=curve.name, count=1000)


def test_curves_part_live_children():
    guides = two_sided(sheet())
    curve = add_curve(ACROSS)
    live = add_children(guides, parting="CURVES", parting_curves=curve.name, mode="LIVE")
    table = bpy.data.objects[f"{ids.CHILDREN_TABLE} of Flat"].data
    assert live.name.startswith(ids.CHILDREN_OBJECT)
    place = np.array([vertex.co for vertex in table.vertices])
    right = (place[:, 2].astype(int) % 4 >= 2).astype(bool)
    first = np.empty(len(place), np.int32)
    table.attributes["guide0"].data.foreach_get("value", first)
    of_guide = scenes.strands(guides)[:, 0, 0] > 2
    np.testing.assert_array_equal(of_guide[first], right)


def test_curves_count_where_they_are_evaluated_in_the_world():
    """The object is moved and scaled, floats above the sheet, has a bevel, and a modifier moves it
    the rest of the way.
    """
    ob = sheet()
    guides = two_sided(ob)
    ob.location, ob.scale = (0, 0, 1), (2, 2, 2)
    curve = add_curve([(0, y - 1, 0) for y in range(12)])
    curve.data.bevel_depth = 0.3
    curve.location = (1, -1, 1.3)
    hook = curve.modifiers.new("Move", "HOOK")
    empty = linked(None)
    hook.object = empty
    hook.vertex_indices_set(range(12))
    bpy.context.view_layer.update()
    hook.matrix_inverse = curve.matrix_world
    empty.location.x = 3
    bpy.context.view_layer.update()
    made = add_children(guides, parting="CURVES", parting_curves=curve.name)
    check_parted(made)


def test_the_side_of_the_curve_counts_and_not_that_of_edges():
    """A slanted line from border to border, across faces."""
    ob = sheet()
    guides = add_guides(ob, count=60)
    strands = scenes.strands(guides)

    def is_left(roots: np.ndarray) -> np.ndarray:
        return roots[:, 0] < 1.3 + 0.37 * roots[:, 1]

    lean = np.where(is_left(strands[:, 0]), -1, 1)[:, None] * np.linspace(0, 1, 8)
    strands[:, :, 0] = strands[:, :1, 0] + lean
    guides.data.points.foreach_set("position", strands.ravel())
    guides.data.update_tag()
    curve = add_curve([(1.3 + 0.37 * y, y, 0) for y in (-1, 5)])
    made = add_children(guides, parting="CURVES", parting_curves=curve.name, count=2000)
    strands = scenes.strands(made)
    leans = strands[:, -1, 0] - strands[:, 0, 0]
    np.testing.assert_array_equal(np.sign(leans), np.where(is_left(strands[:, 0]), -1, 1))
    assert (np.abs(leans) / lengths(strands)).min() > 0.9


def cylinder(sides: int = 16) -> bpy.types.Object:
    turn = 2 * np.pi * np.arange(sides) / sides
    positions = [(np.cos(angle), np.sin(angle), z) for z in np.linspace(0, 4, 5) for angle in turn]
    faces = [
        (j * sides + i, j * sides + (i + 1) % sides, (j + 1) * sides + (i + 1) % sides,
         (j + 1) * sides + i)
        for j in range(4)
        for i in range(sides)
    ]  # fmt: skip
    ob = scenes.add_mesh("Cylinder", positions, faces)
    scenes.add_subsurf(ob)
    return ob


def test_a_ring_around_a_cylinder_parts():
    ob = cylinder()
    guides = add_guides(ob, count=80, length=0.2)
    strands = scenes.strands(guides)
    above = strands[:, 0, 2] > 1.7
    strands[:, :, 2] += np.where(above, 1, -1)[:, None] * np.linspace(0, 1, 8)
    guides.data.points.foreach_set("position", strands.ravel())
    guides.data.update_tag()
    turn = 2 * np.pi * np.arange(64) / 64
    ring = add_curve([(1.1 * np.cos(a), 1.1 * np.sin(a), 1.7) for a in turn], cyclic=True)
    made = add_children(guides, parting="CURVES", parting_curves=ring.name, count=2000)
    strands = scenes.strands(made)
    rises = strands[:, -1, 2] - strands[:, 0, 2]
    np.testing.assert_array_equal(rises > 0, strands[:, 0, 2] > 1.7)
    assert np.abs(rises).min() > 0.9


def test_hair_closes_gradually_behind_the_end_of_a_curve():
    guides = two_sided(sheet())
    curve = add_curve([(2, -0.2, 0), (2, 2, 0)])
    made = add_children(guides, parting="CURVES", parting_curves=curve.name, count=3000)
    strands = scenes.strands(made)
    leans = (strands[:, -1, 0] - strands[:, 0, 0]) / lengths(strands)
    x, y = strands[:, 0, :2].T
    near = np.abs(x - 2) < 0.3
    before, behind = near & (y < 1), near & (y > 3)
    np.testing.assert_array_equal(np.sign(leans[before]), np.where(x[before] < 2, -1, 1))
    assert np.abs(leans[before]).min() > 0.9
    assert np.abs(leans[behind]).min() < 0.5


def refused(match: str, guides: bpy.types.Object, **properties: object) -> None:
    scenes.activate(guides)
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_children_add(parting="CURVES", **properties)
    assert scenes.file_contents() == before


def test_refusals_change_nothing():
    ob = sheet()
    guides = add_guides(ob)
    refused("Parting: Choose curves along which hair is parted", guides)
    refused("Parting: Flat is neither a curve object nor hair", guides, parting_curves=ob.name)
    empty = linked(bpy.data.curves.new("Empty", "CURVE"))
    refused("Parting: .* has no curves", guides, parting_curves=empty.name)
    lost = add_curve([*ACROSS, (float("nan"), 0, 0)])
    refused("coordinates that are not finite numbers", guides, parting_curves=lost.name)


def test_the_redo_panel_asks_for_the_curves():
    sheet()
    kind = bpy.ops.object.limit_children_add.get_rna_type()
    settings = {p.identifier: getattr(p, "default", None) for p in kind.properties}
    layout = MagicMock()
    OBJECT_OT_limit_children_add.draw_own(
        layout, SimpleNamespace(**settings | {"parting": "CURVES"})
    )
    searched = {call.args[1] for call in layout.prop_search.call_args_list}
    assert searched == {"guides", "parting_curves"}


def test_lines_are_joined_to_curves():
    x = np.array([[0, 1], [1, 2], [5, 6]])
    lines = x[:, :, None] * [1.0, 0, 0]
    points, offsets = curve_lines.joined(lines)
    np.testing.assert_array_equal(points[:, 0], [0, 1, 2, 5, 6])
    np.testing.assert_array_equal(offsets, [0, 3, 5])
    points, offsets = curve_lines.joined(np.empty((0, 2, 3)))
    assert points.shape == (0, 3)
    np.testing.assert_array_equal(offsets, [0])
