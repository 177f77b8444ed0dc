# SPDX-License-Identifier: GPL-3.0-or-later
"""Density from vertex groups, images and colour attributes: locations in proportion to it."""

import areas
import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import region
from limit_surface.placing.density import Density, DensityChoice
from limit_surface.placing.mask import MaskChoice
from limit_surface.reading import attributes
from limit_surface.sources.values import ValueChoice
from refusals import check_refused
from scenes import add_points, add_subsurf, add_uv_map, locations

COUNT = 20_000
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def vertex_positions(ob):
    return attributes.read(ob.data, "position").astype(np.float64)


def corner_vertices(ob):
    return attributes.read(ob.data, ids.CORNER_VERTEX)


def linearly(ob, corner_values):
    """Returns a density that is bilinear on each face's Ptex faces."""
    ptex = scenes.ptex_corners(ob, np.asarray(corner_values, np.float64)[:, None])
    return lambda face, uv: scenes.bilinear(ptex, face, uv)[:, 0]


def weigh(ob, name="Where"):
    """Adds a vertex group, and returns its weights."""
    weights = np.random.default_rng(1).random(len(ob.data.vertices)).astype(np.float32)
    weights[::3] = 0
    group = ob.vertex_groups.new(name=name)
    for i, weight in enumerate(weights.tolist()):
        if weight:
            group.add([i], weight, "REPLACE")
    return weights.astype(np.float64)


def colour(ob, kind, domain, name="Colours"):
    """Adds a colour attribute, and returns its linear values."""
    layer = ob.data.color_attributes.new(name, kind, domain)
    colours = np.random.default_rng(2).random((len(layer.data), 4)).astype(np.float32)
    layer.data.foreach_set("color", colours.ravel())
    if kind == "FLOAT_COLOR":
        return colours.astype(np.float64)
    encoded = np.empty(colours.size, np.float32)  # the rounding of 8 bits
    layer.data.foreach_get("color_srgb", encoded)
    encoded = encoded.reshape(-1, 4).astype(np.float64)
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    linear[:, 3] = encoded[:, 3]
    np.testing.assert_allclose(linear, colours, atol=0.01)
    return linear


def check_density(ob, density, **properties):
    for distribution in ("JITTERED", "UNIFORM"):
        points = add_points(
            ob, distribution=distribution, count=COUNT, per_side=40, seed=1, **properties
        )
        face, uv = locations(points.data)
        if distribution == "UNIFORM":
            assert len(face) == COUNT
            areas.check_parts(face, areas.expected_parts(ob, density))
        else:
            on_grid = density(*areas.grid(face.max() + 1)).clip(0, 1)
            kept = on_grid.reshape(-1, areas.STEPS**2).mean(axis=1) * 40**2
            assert np.abs(np.bincount(face) - kept).max() < 4.5 * np.sqrt(400)
        assert (density(face, uv) > 0).all()


@pytest.mark.parametrize("invert", [False, True])
@pytest.mark.parametrize("scene", ["grid with holes", "mixed polygons"])
def test_vertex_groups(scene, invert):
    ob = scenes.SCENES[scene]()
    weights = weigh(ob)[corner_vertices(ob)]
    density = linearly(ob, 1 - weights if invert else weights)
    check_density(ob, density, density_source="VERTEX_GROUP", vertex_group="Where", invert=invert)


def test_vertex_groups_of_the_mesh_as_modifiers_leave_it():
    """The mirrored half has the mirrored weights."""
    ob = scenes.grid_with_holes()
    weights = weigh(ob)
    ob.modifiers.new("Mirror", "MIRROR").use_axis = (False, True, False)
    add_subsurf(ob)
    points = add_points(
        ob,
        distribution="UNIFORM",
        count=COUNT,
        density_source="VERTEX_GROUP",
        vertex_group="Where",
    )
    faces = len(ob.data.polygons)
    counts = np.bincount(locations(points.data)[0], minlength=2 * faces)
    first, second = counts[:faces], counts[faces:]
    assert first.sum() > COUNT * 0.45
    assert (np.abs(first - second) < 4.5 * np.sqrt(first + second + 1)).all()
    of_faces = np.add.reduceat(weights[corner_vertices(ob)], 4 * np.arange(faces))
    assert np.corrcoef(of_faces, first)[0, 1] > 0.9


@pytest.mark.parametrize("channel", ["LUMINANCE", "RED", "ALPHA"])
@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
@pytest.mark.parametrize("kind", ["FLOAT_COLOR", "BYTE_COLOR"])
def test_color_attributes(kind, domain, channel):
    ob = scenes.mixed_polygons()
    colours = colour(ob, kind, domain)
    if domain == "POINT":
        colours = colours[corner_vertices(ob)]
    values = {"LUMINANCE": colours[:, :3] @ LUMINANCE, "RED": colours[:, 0]}
    check_density(
        ob,
        linearly(ob, values.get(channel, colours[:, 3])),
        density_source="COLOR_ATTRIBUTE",
        color_attribute="Colours",
        channel=channel,
    )


def flat(positions):
    return positions[:, :2] @ [[0.11, 0.02], [-0.03, 0.13]] + [0.2, 0.1]


def large(positions):
    """Returns a map that reaches beyond the image on all sides."""
    return 3 * flat(positions) - 0.7


def image(values, name="Spots", is_float=True):
    """Makes an image of grey values (height, width)."""
    height, width = values.shape
    made = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float)
    pixels = np.ones((height, width, 4), np.float32)
    pixels[:, :, :3] = values[:, :, None]
    made.pixels.foreach_set(pixels.ravel())
    return made


def looked_up(values, uv, extension):
    """Looks values up pixel by pixel, by plain loops."""
    height, width = values.shape
    found = np.empty(len(uv))
    for row, (u, v) in enumerate(uv):
        if extension == "CLIP" and not (0 <= u <= 1 and 0 <= v <= 1):
            found[row] = 0
            continue
        if extension != "REPEAT":
            u, v = min(max(u, 0), 1), min(max(v, 0), 1)
        x, y = u * width - 0.5, v * height - 0.5
        total = 0.0
        for i in (int(np.floor(x)), int(np.floor(x)) + 1):
            for j in (int(np.floor(y)), int(np.floor(y)) + 1):
                weight = (1 - abs(x - i)) * (1 - abs(y - j))
                if extension == "REPEAT":
                    total += weight * values[j % height, i % width]
                else:
                    total += weight * values[min(max(j, 0), height - 1), min(max(i, 0), width - 1)]
        found[row] = total
    return found


@pytest.mark.parametrize("extension", ["REPEAT", "EXTEND", "CLIP"])
@pytest.mark.parametrize("name", ["", "Flat"])
def test_images(extension, name):
    """The UVs are not smoothed, so the UV of a place is the map of its position on the bare
    mesh.
    """
    ob = scenes.grid_with_holes()
    add_uv_map(ob, large)
    if name:
        ob.data.uv_layers.active = ob.data.uv_layers.new(name="Another")
    add_subsurf(ob).uv_smooth = "NONE"
    values = np.random.default_rng(3).random((5, 7)).astype(np.float32) ** 3
    image(values)

    def density(face, uv):
        return looked_up(values, large(scenes.on_base_mesh(ob, face, uv)), extension)

    check_density(
        ob, density, density_source="IMAGE", image="Spots", extension=extension, uv_map=name
    )


def test_images_of_bytes_count_as_their_numbers_are():
    ob = scenes.grid_with_holes()
    add_uv_map(ob, flat)
    add_subsurf(ob).uv_smooth = "NONE"
    values = np.array([[0.2, 0.8]], np.float32)
    image(values, is_float=False)

    def density(face, uv):
        return looked_up(values, flat(scenes.on_base_mesh(ob, face, uv)), "REPEAT")

    check_density(ob, density, density_source="IMAGE", image="Spots")


def test_images_are_placed_by_smoothed_uvs():
    """The image is placed as renders place it: it is half white and half black, and the border runs
    where the smoothed map has it.
    """
    ob = scenes.cross()
    add_uv_map(ob, lambda p: p[:, :2] * 0.2 + 0.5)
    add_subsurf(ob).uv_smooth = "SMOOTH_ALL"
    values = np.repeat([[0.0, 1.0]], 2, axis=0).repeat(64, axis=1).astype(np.float32)
    image(values)
    points = add_points(
        ob, distribution="UNIFORM", count=3000, density_source="IMAGE", image="Spots"
    )
    data = scenes.surface_without_addon(ob).vertex_data(vertex_positions(ob)[:, :2] * 0.2 + 0.5)
    smoothed = data.evaluate(*locations(points.data)).value
    assert smoothed[:, 0].min() > 0.5 - 1 / 64
    linear = scenes.on_base_mesh(ob, *locations(points.data))[:, 0] * 0.2 + 0.5
    assert np.abs(smoothed[:, 0] - linear).max() > 0.02


def placed_density(ob, choice):
    everything = MaskChoice(frozenset(), "ALL", "")
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return region.read(ob, depsgraph, DensityChoice(choice), everything).density


def asked_for(monkeypatch, ob, **properties):
    """Adds points UNIFORM, and returns the densities that were asked for."""
    asked, call = [], Density.__call__

    def spy(density, face, uv):
        asked.append(call(density, face, uv))
        return asked[-1]

    with monkeypatch.context() as patch:
        patch.setattr(Density, "__call__", spy)
        add_points(ob, distribution="UNIFORM", **properties)
    return np.concatenate(asked)


@pytest.mark.parametrize("extension", ["REPEAT", "EXTEND", "CLIP"])
@pytest.mark.parametrize(("low", "high"), [(0, 1), (1, 0), (0.2, -3), (-1, 2)])
def test_densities_of_images_stay_below_their_limits(extension, low, high):
    ob = scenes.grid_with_holes()
    add_uv_map(ob, large)
    add_subsurf(ob)
    values = np.random.default_rng(4).random((9, 6)).astype(np.float32) ** 6
    image(values)
    choice = ValueChoice("", "IMAGE", image="Spots", extension=extension, low=low, high=high)
    density = placed_density(ob, choice)
    surface, limits = density.values.surface, density.limits
    at = surface.scatter_jittered(40, 1)
    square = (at.uv * limits.shape[1]).astype(int)
    assert (density(at.face, at.uv) <= limits[at.face, square[:, 1], square[:, 0]]).all()
    assert limits.shape[1] == limits.shape[2] > 8
    assert np.nanmax(limits) <= max(low, high) + 1e-5


def spot(radius):
    """Makes an image that is 1 in a disc and 0 elsewhere."""
    y, x = np.indices((512, 512)) + 0.5
    image((np.hypot(x - 200, y - 220) < radius).astype(np.float32))


def test_a_small_spot_needs_few_candidates(monkeypatch):
    ob = scenes.grid_with_holes()
    add_uv_map(ob, flat)
    add_subsurf(ob)
    spot(3)
    found = asked_for(monkeypatch, ob, count=500, density_source="IMAGE", image="Spots")
    assert (found > 0).sum() >= 500
    assert len(found) < 10_000


@pytest.mark.parametrize(("side", "precision"), [(32, 0.01), (4, 0.05), (2, 0.1)])
def test_density_in_a_small_spot(side, precision):
    """The count is that of the spot's area, which is 1.5e-5 of the surface's."""
    ob = scenes.flat_grid(side)
    add_uv_map(ob, lambda p: p[:, :2] / side)
    add_subsurf(ob).uv_smooth = "NONE"
    spot(1.5)
    points = add_points(
        ob,
        distribution="UNIFORM",
        density=1e9 / side**2,
        density_source="IMAGE",
        image="Spots",
    )
    values = np.zeros((512 * 512, 4), np.float32)
    bpy.data.images["Spots"].pixels.foreach_get(values.ravel())
    share = values[:, 0].sum() / 512**2  # linear between pixels: the same integral
    assert len(points.data.vertices) == pytest.approx(1e9 * share, rel=precision)


@pytest.mark.parametrize("weight", [0.25, 1.0])
def test_density_is_for_a_weight_of_1(weight):
    ob = scenes.grid_with_holes()
    group = ob.vertex_groups.new(name="Even")
    group.add(list(range(len(ob.data.vertices))), weight, "REPLACE")
    points = add_points(
        ob,
        distribution="UNIFORM",
        density=100,
        density_source="VERTEX_GROUP",
        vertex_group="Even",
    )
    expected = 100 * weight * areas.cell_areas(ob).sum()
    assert len(points.data.vertices) == pytest.approx(expected, rel=0.005)


def test_blue_noise_is_denser_where_the_density_is():
    ob = scenes.flat_grid(8)
    group = ob.vertex_groups.new(name="Half")
    for vertex in ob.data.vertices:
        group.add([vertex.index], 1.0 if vertex.co.x < 4 else 0.25, "REPLACE")
    points = add_points(
        ob,
        distribution="BLUE_NOISE",
        distance=0.25,
        density_source="VERTEX_GROUP",
        vertex_group="Half",
    )
    p = attributes.read(points.data, "position")
    dense, sparse = p[(p[:, 0] > 0.5) & (p[:, 0] < 3)], p[(p[:, 0] > 5) & (p[:, 0] < 7.5)]
    assert len(dense) == pytest.approx(4 * len(sparse), rel=0.15)
    for part, distance in ((dense, 0.25), (sparse, 0.5)):
        apart = np.linalg.norm(part[:, None] - part[None], axis=2)
        np.fill_diagonal(apart, np.inf)
        assert apart.min() >= distance * (1 - 1e-5)


SOURCES = {
    "no vertex group 'Nix'": {"density_source": "VERTEX_GROUP", "vertex_group": "Nix"},
    "no image 'Nix'": {"density_source": "IMAGE", "image": "Nix"},
    "no color attribute 'Nix'": {"density_source": "COLOR_ATTRIBUTE", "color_attribute": "Nix"},
}


def test_without_a_name_the_active_vertex_group_and_color_attribute_are_used():
    ob = scenes.cross()
    ob.vertex_groups.new(name="Empty")
    weigh(ob)
    ob.vertex_groups.active = ob.vertex_groups["Where"]
    colour(ob, "FLOAT_COLOR", "CORNER", "Others")
    colour(ob, "FLOAT_COLOR", "POINT")
    ob.data.color_attributes.active_color = ob.data.color_attributes["Colours"]
    for source, name, value in (
        ("VERTEX_GROUP", "vertex_group", "Where"),
        ("COLOR_ATTRIBUTE", "color_attribute", "Colours"),
    ):
        stood = [
            locations(add_points(ob, density_source=source, **named).data)
            for named in ({}, {name: value})
        ]
        np.testing.assert_array_equal(stood[0][0], stood[1][0])
        np.testing.assert_array_equal(stood[0][1], stood[1][1])
    ob.vertex_groups.active = ob.vertex_groups["Empty"]
    scenes.activate(ob)
    check_refused("The density is 0 everywhere", density_source="VERTEX_GROUP")


@pytest.mark.parametrize("source", ["VERTEX_GROUP", "COLOR_ATTRIBUTE"])
def test_without_a_name_and_without_an_active_one_the_message_says_what_to_do(source):
    scenes.cross()
    what = source.replace("_", " ").lower()
    check_refused(f"Cross has no {what}: add one in its Object Data", density_source=source)


def test_without_any_image_the_message_says_what_to_do():
    scenes.cross()
    check_refused("The file has no image: open one in an Image Editor", density_source="IMAGE")


@pytest.mark.parametrize("distribution", ["JITTERED", "UNIFORM", "BLUE_NOISE"])
@pytest.mark.parametrize("match", SOURCES)
def test_sources_that_are_missing(match, distribution):
    scenes.cross()
    check_refused(match, distribution=distribution, **SOURCES[match])


def test_an_image_needs_a_uv_map():
    ob = scenes.cross()
    image(np.ones((2, 2), np.float32))
    of_image = {"density_source": "IMAGE", "image": "Spots"}
    check_refused("cannot be placed: Cross has no UV map", **of_image)
    add_uv_map(ob, flat)
    check_refused("no UV map 'Nix'", **of_image, uv_map="Nix")
    ob.modifiers.new("Remesh", "REMESH").mode = "BLOCKS"
    check_refused("the modifiers remove the UV map Flat", **of_image)


def test_an_image_without_pixels(tmp_path):
    add_uv_map(scenes.cross(), flat)
    missing = bpy.data.images.new("Gone", 4, 4)
    missing.source = "FILE"
    missing.filepath = str(tmp_path / "gone.png")
    check_refused("Gone has no pixels", density_source="IMAGE", image="Gone")


def test_tiled_images_are_refused():
    add_uv_map(scenes.cross(), flat)
    bpy.data.images.new("Tiles", 4, 4, tiled=True)
    check_refused("tiled", density_source="IMAGE", image="Tiles")


@pytest.mark.parametrize("distribution", ["JITTERED", "UNIFORM", "BLUE_NOISE"])
def test_density_0_everywhere(distribution):
    ob = scenes.cross()
    ob.vertex_groups.new(name="Empty")
    check_refused(
        "density is 0",
        distribution=distribution,
        density_source="VERTEX_GROUP",
        vertex_group="Empty",
    )


def test_a_vertex_group_that_would_be_taken_for_an_attribute():
    weigh(scenes.cross(), "position")
    check_refused(
        "Cross has an attribute with the same name as the vertex group position",
        density_source="VERTEX_GROUP",
        vertex_group="position",
    )


@pytest.mark.parametrize(
    ("distribution", "amount"),
    [
        ("JITTERED", "COUNT"),
        ("UNIFORM", "COUNT"),
        ("UNIFORM", "DENSITY"),
        ("BLUE_NOISE", "COUNT"),
        ("BLUE_NOISE", "DENSITY"),
        ("BLUE_NOISE", "DISTANCE"),
    ],
)
def test_an_image_that_is_black_where_the_surface_is(distribution, amount):
    ob = scenes.cross()
    add_uv_map(ob, lambda p: 0.1 + 0.01 * p[:, :2])
    values = np.zeros((8, 8), np.float32)
    values[7, 7] = 1
    image(values)
    check_refused(
        "The density is 0 everywhere",
        distribution=distribution,
        amount=amount,
        density_source="IMAGE",
        image="Spots",
        extension="EXTEND",
    )


def test_outside_a_clipped_image_inverted():
    """The image is white, so only what is outside it counts."""
    ob = scenes.grid_with_holes()
    add_uv_map(ob, large)
    add_subsurf(ob).uv_smooth = "NONE"
    image(np.ones((4, 4), np.float32))
    points = add_points(
        ob, density_source="IMAGE", image="Spots", extension="CLIP", invert=True, per_side=10
    )
    uv = large(scenes.on_base_mesh(ob, *locations(points.data)))
    assert ((uv < 0) | (uv > 1)).any(axis=1).all()
    assert len(uv) > 100


def test_values_that_are_not_finite():
    ob = scenes.cross()
    colour(ob, "FLOAT_COLOR", "POINT")
    ob.data.color_attributes["Colours"].data[3].color[0] = np.nan
    check_refused(
        "not finite", density_source="COLOR_ATTRIBUTE", color_attribute="Colours", channel="RED"
    )


def replace_by_cube(ob):
    group = bpy.data.node_groups.new("Cube", "GeometryNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    cube, output = group.nodes.new("GeometryNodeMeshCube"), group.nodes.new("NodeGroupOutput")
    group.links.new(cube.outputs["Mesh"], output.inputs[0])
    ob.modifiers.new("Nodes", "NODES").node_group = group


@pytest.mark.parametrize(
    ("source", "properties"),
    [
        (
            "vertex group Where",
            {"density_source": "VERTEX_GROUP", "vertex_group": "Where"},
        ),
        (
            "color attribute Colours",
            {"density_source": "COLOR_ATTRIBUTE", "color_attribute": "Colours"},
        ),
    ],
)
def test_sources_that_modifiers_drop(source, properties):
    ob = scenes.cross()
    weigh(ob)
    colour(ob, "FLOAT_COLOR", "CORNER")
    replace_by_cube(ob)
    check_refused(f"the modifiers remove the {source}", **properties)


@pytest.mark.parametrize("distribution", ["JITTERED", "BORDER"])
def test_candidates_that_a_density_drops_need_consent_too(monkeypatch, distribution):
    """They take memory before most of them are dropped."""
    ob = scenes.flat_grid(2)
    ob.vertex_groups.new(name="Few").add([0], 1e-3, "REPLACE")
    monkeypatch.setattr("limit_surface.tasks.request_size.LARGE_MEMORY", 1 << 20)
    many = {"density_source": "VERTEX_GROUP", "vertex_group": "Few", "distribution": distribution}
    check_refused("allow_large", per_side=60, count=20_000, **many)


def test_a_small_dense_part_gets_its_number():
    """A part of one face, such as an eyebrow in a map of the whole body."""
    ob = scenes.flat_grid(4)
    add_uv_map(ob, lambda p: p[:, :2] / 4)
    image = bpy.data.images.new("Small", 512, 512, float_buffer=True)
    pixels = np.zeros((512, 512, 4), np.float32)
    pixels[200:210, 200:210] = 1
    image.pixels.foreach_set(pixels.ravel())
    area = (10 * 4 / 512) ** 2
    points = add_points(
        ob, distribution="UNIFORM", density=300 / area, density_source="IMAGE", image="Small"
    )
    assert len(points.data.vertices) == pytest.approx(300, rel=0.08)
