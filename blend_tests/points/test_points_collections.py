# SPDX-License-Identifier: GPL-3.0-or-later
"""Members of a collection on points: at random, or as a source says."""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from scenes import add_points, add_subsurf
from sheet_sources import INNER, SIDE, SOURCES, rising, steered

# in the order of their names, which is not that in which they are made
NAMES = ("Ash", "Birch", "Cedar", "Elm", "Fir")


@pytest.fixture
def trees():
    """Adds a collection, of which one member is a collection itself."""
    collection = bpy.data.collections.new("Trees")
    bpy.context.scene.collection.children.link(collection)
    for name in ("Fir", "Ash", "Elm", "Birch", "Cedar"):
        tree = scenes.add_mesh(name, [(0, 0, 0), (0.1, 0, 0), (0, 0, 1)], [(0, 1, 2)])
        tree.location = (5, 5, 5)
        bpy.context.collection.objects.unlink(tree)
        if name == "Cedar":
            inner = bpy.data.collections.new("Cedar")
            collection.children.link(inner)
            inner.objects.link(tree)
        else:
            collection.objects.link(tree)
    return collection


def add_trees(ob, **properties):
    return add_points(ob, **{"instances": "COLLECTION", "collection": "Trees"} | properties)


def shown(points):
    """Returns for each instance the place and the number of what stands there, by its name."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = [
        (np.array(i.matrix_world)[:3, 3], NAMES.index(i.object.original.name))
        for i in depsgraph.object_instances
        if i.is_instance and i.parent.original == points and i.object.type == "MESH"
    ]
    at, member = (np.array(column) for column in zip(*found, strict=True))
    return at, member


def stored(points):
    return attributes.read(points.data, ids.MEMBER)


def check_shown(points):
    """The members that are shown are those whose numbers are stored, each on its point."""
    at, member = shown(points)
    np.testing.assert_array_equal(member, stored(points))
    is_own = member != NAMES.index("Cedar")  # those of a collection keep their place in it
    root = attributes.read(points.data, "position")
    np.testing.assert_allclose(at[is_own], root[is_own], atol=1e-5)


def test_members_at_random(trees):
    ob = scenes.flat_grid(SIDE)
    points = add_trees(ob, per_side=4, seed=1)
    check_shown(points)
    counts = np.bincount(stored(points), minlength=5)
    total = counts.sum()
    # five members alike: within 4.5 standard deviations
    assert np.abs(counts - total / 5).max() < 4.5 * np.sqrt(total * 0.16)
    np.testing.assert_array_equal(stored(add_trees(ob, per_side=4, seed=1)), stored(points))
    assert (stored(add_trees(ob, per_side=4, seed=2)) != stored(points)).mean() > 0.5


@pytest.mark.parametrize("source", SOURCES)
def test_members_by_a_source(trees, source):
    ob = scenes.flat_grid(SIDE)
    add_subsurf(ob).uv_smooth = "NONE"
    points = add_trees(ob, **steered("index", SOURCES[source](ob), 0, 1))
    check_shown(points)
    root = attributes.read(points.data, "position").astype(np.float64)
    inner = ((root[:, :2] > INNER) & (root[:, :2] < SIDE - INNER)).all(axis=1)
    value = 5 * rising(root[inner])
    clear = np.abs(value - np.round(value)) > 1e-4
    assert clear.sum() > 400
    np.testing.assert_array_equal(stored(points)[inner][clear], np.floor(value[clear]))


def test_the_range_says_which_members(trees):
    ob = scenes.flat_grid(4)
    attributes.write(ob.data, "where", "FLOAT", "FACE", np.arange(16) / 15)
    source = {"source": "ATTRIBUTE", "attribute": "where"}
    points = add_trees(ob, **steered("index", source, 1.02, -0.5))
    face, _ = scenes.locations(points.data)
    expected = np.floor(5 * (1.02 - 1.52 * face / 15)).clip(0, 4)
    np.testing.assert_array_equal(stored(points), expected)


@pytest.mark.parametrize("kind", ["INT", "INT8"])
def test_whole_numbers_of_faces_are_the_numbers_of_members(trees, kind):
    ob = scenes.mixed_polygons()
    numbers = np.array([3, 0, 7, -1, 2])[: len(ob.data.polygons)]
    attributes.write(ob.data, "which", kind, "FACE", numbers)
    source = {"source": "ATTRIBUTE", "attribute": "which"}
    points = add_trees(ob, **steered("index", source, 0, 0.1))  # the range does not count
    check_shown(points)
    face, _ = scenes.locations(points.data)
    base = scenes.surface_without_addon(ob).base_face[face]
    np.testing.assert_array_equal(stored(points), numbers[base] % 5)


def test_between_vertices_the_number_of_the_nearest_corner_counts(trees):
    """No member stands between two vertices that only lies between their numbers."""
    ob = scenes.mixed_polygons()
    count = len(ob.data.vertices)
    numbers = np.where(np.arange(count) % 2, 0, 4)
    attributes.write(ob.data, "which", "INT", "POINT", numbers)
    source = {"source": "ATTRIBUTE", "attribute": "which"}
    points = add_trees(ob, per_side=8, **steered("index", source, 0, 1))
    assert set(stored(points)) == {0, 4}
    face, uv = scenes.locations(points.data)
    surface = scenes.surface_without_addon(ob)
    corner = np.where(surface.corner[face] >= 0, surface.corner[face], 0)
    for polygon in ob.data.polygons:
        rows = np.flatnonzero(surface.base_face[face] == polygon.index)
        if len(polygon.vertices) == 4:
            nearest = np.array([[0, 3], [1, 2]])[tuple((uv[rows] > 0.5).astype(int).T)]
        else:
            nearest = corner[rows]
        expected = numbers[np.array(polygon.vertices)[nearest]]
        np.testing.assert_array_equal(stored(points)[rows], expected)


def test_members_are_posed(trees):
    points = add_trees(scenes.flat_grid(2), scale=0.5)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    sizes = [
        np.linalg.det(np.array(i.matrix_world)[:3, :3])
        for i in depsgraph.object_instances
        if i.is_instance and i.parent.original == points
    ]
    np.testing.assert_allclose(sizes, 0.125, rtol=1e-5)


def test_refusals(trees):
    ob = scenes.flat_grid(2)
    before = scenes.file_contents()
    for match, properties in (
        ("no collection 'Wood' to put on the points", {"collection": "Wood"}),
        ("Choose the collection to put on the points", {"collection": ""}),
        ("Index: Flat has no attribute 'Nix'", {
            "collection": "Trees", "index_source": "ATTRIBUTE", "index_attribute": "Nix",
        }),
    ):  # fmt: skip
        scenes.activate(ob)
        with pytest.raises(RuntimeError, match=match):
            bpy.ops.object.limit_points_add(instances="COLLECTION", **properties)
        assert scenes.file_contents() == before
    bpy.data.collections.new("Empty")
    with pytest.raises(RuntimeError, match="The collection Empty is empty"):
        bpy.ops.object.limit_points_add(instances="COLLECTION", collection="Empty")
    # what chooses members does not matter where there are none
    assert "instance_index" not in add_points(ob, index_source="IMAGE").data.attributes


def test_save_and_load(trees, tmp_path):
    points = add_trees(scenes.flat_grid(2))
    name, before = points.name, shown(points)[1]
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "trees.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "trees.blend"))
    np.testing.assert_array_equal(shown(bpy.data.objects[name])[1], before)


@pytest.mark.parametrize("instances", ["COLLECTION", "OBJECT"])
def test_points_are_not_put_into_the_collection_that_they_show(trees, instances):
    """They would be instances of themselves."""
    ob = scenes.flat_grid(4)
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(empty)
    empty.instance_type, empty.instance_collection = "COLLECTION", trees
    layer = bpy.context.view_layer.layer_collection.children["Trees"]
    for active in (layer, layer.children["Cedar"]):
        bpy.context.view_layer.active_layer_collection = active
        points = add_trees(ob, per_side=1, instances=instances, instance="Empty")
        assert points.users_collection == (bpy.context.scene.collection,)
        assert bpy.context.active_object == points
        if instances == "COLLECTION":
            check_shown(points)
    bpy.context.view_layer.active_layer_collection = layer
    assert add_points(ob).users_collection == (trees,)
