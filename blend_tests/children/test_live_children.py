# SPDX-License-Identifier: GPL-3.0-or-later
"""Live children: what they store, where nodes grow them in each frame, and what stops them."""

import bakes
import bpy
import children_truth
import follow_truth
import numpy as np
import pytest
import scenes
from figures.meshes import grids
from follow_scenes import deforming
from limit_surface import ids
from limit_surface.nodes import children as nodes
from limit_surface.placing import all_tiles, followers
from limit_surface.reading import attributes
from processes import run_python

FRAMES = ((1, 0.0), (17, 0.25), (30, 0.0))
#: Positions in single precision, as a share of the diagonal
BOUND = 4e-6


def add_guides(ob: bpy.types.Object, **properties: object) -> bpy.types.Object:
    settings = {"distribution": "UNIFORM", "count": 12, "points": 8, "length": 0.3}
    return scenes.add_hair(ob, **settings | {"random": 0.8, "follow": "NODES"} | properties)


def add_live(guides: bpy.types.Object, **properties: object) -> bpy.types.Object:
    scenes.activate(guides)
    settings = {"distribution": "UNIFORM", "count": 300, "viewport_share": 1.0}
    assert bpy.ops.object.limit_children_add(mode="LIVE", **settings | properties) == {"FINISHED"}
    return bpy.context.active_object


def check(live: bpy.types.Object, guides: bpy.types.Object, ob: bpy.types.Object) -> None:
    found = children_truth.shown_strands(live)
    assert found.shape == (len(children_truth.table_of(live).data.vertices), 8, 3)
    away = np.abs(found - children_truth.expected(live, guides, ob)).max()
    assert away < BOUND * follow_truth.diagonal(ob)


@pytest.mark.parametrize("name", ["cross", "grid with holes", "mixed polygons"])
def test_they_follow_animated_guides(name):
    ob = deforming(name)
    guides = add_guides(ob)
    live = add_live(guides)
    for frame, subframe in FRAMES:
        bpy.context.scene.frame_set(frame, subframe=subframe)
        check(live, guides, ob)


def test_they_are_the_curves_that_the_other_mode_makes():
    ob = deforming("grid with holes")
    guides = add_guides(ob)
    live = add_live(guides)
    scenes.activate(guides)
    bpy.ops.object.limit_children_add(distribution="UNIFORM", count=300, follow="NONE")
    made = scenes.strands(bpy.context.active_object)
    away = np.abs(children_truth.shown_strands(live) - made).max()
    assert away < BOUND * follow_truth.diagonal(ob)


def test_they_follow_combed_guides():
    ob = deforming("cross")
    guides = add_guides(ob)
    live = add_live(guides)
    strands = scenes.strands(guides)
    strands[:, :, 0] += np.linspace(0, 0.7, 8)
    guides.data.points.foreach_set("position", strands.ravel())
    guides.data.update_tag()
    check(live, guides, ob)


def test_cyclic_guides_have_the_shape_of_open_ones():
    ob = deforming("cross")
    guides = add_guides(ob)
    live = add_live(guides)
    cyclic = guides.data.attributes.new("cyclic", "BOOLEAN", "CURVE")
    cyclic.data.foreach_set("value", np.ones(len(guides.data.curves), bool))
    guides.data.update_tag()
    check(live, guides, ob)


def test_a_child_stores_few_bytes_and_no_points():
    live = add_live(add_guides(deforming("cross")))
    data = children_truth.table_of(live).data
    assert sum(attributes.size_in_bytes(a) for a in data.attributes) <= 48 * 300
    assert not len(live.data.points)


def test_the_viewport_shows_a_share_and_renders_show_all(tmp_path):
    live = add_live(add_guides(deforming("cross")), count=2000, viewport_share=0.1)
    shown = children_truth.shown_strands(live)
    assert 120 < len(shown) < 280
    children_truth.set_input(live, nodes.SHARE, 0.0)
    assert len(children_truth.shown_strands(live)) == 0
    live.select_set(True)
    bpy.ops.wm.usd_export(
        filepath=str(tmp_path / "r.usdc"), selected_objects_only=True, evaluation_mode="RENDER"
    )
    strands = bakes.read_back(tmp_path / "r.usdc", "CURVES")
    assert len(strands) == 2000 * 8


def test_guides_that_do_not_follow_are_bound():
    ob = deforming("cross")
    guides = add_guides(ob, follow="NONE")
    assert followers.modifier_of(guides) is None
    live = add_live(guides)
    assert followers.modifier_of(guides) is not None
    bpy.context.scene.frame_set(20)
    check(live, guides, ob)


def test_rest_without_follow():
    ob = scenes.cross()
    scenes.add_subsurf(ob)
    guides = add_guides(ob, follow="NONE")
    check(add_live(guides), guides, ob)
    assert followers.modifier_of(guides) is None


def test_tables_are_shared_and_may_be_made_again():
    ob = deforming("cross")
    guides = add_guides(ob)
    first, second = add_live(guides), add_live(guides, seed=3)
    assert len([o for o in bpy.data.objects if ids.ALL_TILES_MARK in o]) == 1
    assert all_tiles.faces_of(ob) is None
    scenes.activate(ob)
    assert bpy.ops.object.limit_sample_tables(depth=20) == {"FINISHED"}
    for live in (first, second):
        check(live, guides, ob)


@pytest.mark.skipif(bpy.app.version < (4, 3), reason="Python cannot do that before Blender 4.3")
def test_other_numbers_of_guides_stop_them():
    ob = deforming("cross")
    guides = add_guides(ob)
    live = add_live(guides)
    guides.data.remove_curves(indices=[3])
    guides.data.update_tag()
    assert len(children_truth.shown_strands(live)) == 0


def test_another_topology_stops_them_even_with_new_tables():
    ob = deforming("grid with holes")
    live = add_live(add_guides(ob))
    ob.shape_key_clear()
    ob.modifiers.clear()
    scenes.add_subsurf(ob)
    ob.data.clear_geometry()
    positions = [(x, y, 0) for y in range(6) for x in range(6)]
    ob.data.from_pydata(positions, [], grids.grid_faces(5, 5).tolist())
    scenes.activate(ob)
    assert bpy.ops.object.limit_sample_tables() == {"FINISHED"}
    assert len(children_truth.shown_strands(live)) == 0


PLAY = """
import bpy, numpy as np, sys
bpy.ops.wm.open_mainfile(filepath={path!r})
assert "limit_surface" not in sys.modules
found = []
for frame in (1, 20):
    bpy.context.scene.frame_set(frame)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    data = bpy.data.objects[{name!r}].evaluated_get(depsgraph).data
    values = np.empty(3 * len(data.points), np.float32)
    data.attributes["position"].data.foreach_get("vector", values)
    found.append(values)
np.save({out!r}, found)
"""


def test_files_play_without_the_extension(tmp_path):
    ob = deforming("cross")
    live = add_live(add_guides(ob))
    path, out = str(tmp_path / "live.blend"), str(tmp_path / "live.npy")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    run_python(PLAY.format(path=path, out=out, name=live.name))
    for frame, found in zip((1, 20), np.load(out), strict=True):
        bpy.context.scene.frame_set(frame)
        here = children_truth.shown_strands(live)
        np.testing.assert_allclose(found.reshape(here.shape), here, atol=1e-6)


def test_materials_of_guides_are_taken():
    ob = deforming("cross")
    guides = add_guides(ob)
    material = bpy.data.materials.new("Fur")
    guides.data.materials.append(material)
    live = add_live(guides)
    data = live.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert [slot.name for slot in data.materials] == ["Fur"]
