# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of a paraboloid. Subdivision does not change quadratic surfaces beyond a constant, so every
map has a formula. The UV map is the projection to the x-y plane.
"""

import threading
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import limitsurf
import numpy as np
import pytest
import scenes
from limit_surface.bake_maps import map_images
from limit_surface.bake_maps.maps import KINDS
from limit_surface.errors import RefusalError
from limit_surface.images import image_files, image_pixels
from limit_surface.reading import cage
from limit_surface.tasks import watched_operator as watched_module
from limit_surface.tasks.watched_operator import WatchedOperator
from mathutils import Matrix
from waiting import wait_for

SIDE = 8  # quads
SIZE = 64  # texels along a side of the image, 8 for each quad
INNER = slice(16, 48)  # texels that do not depend on the boundary
A, B = 0.06, -0.1  # z = A x^2 + B y^2 + (A + B) / 3, where subdivision adds the last term
SINGLE = 2e-6

ALL = set(KINDS)


def paraboloid() -> bpy.types.Object:
    ob = scenes.flat_grid(SIDE)
    ob.name = "Bowl"
    co = np.empty(3 * len(ob.data.vertices), np.float32)
    ob.data.vertices.foreach_get("co", co)
    co = co.reshape(-1, 3)
    co[:, :2] -= SIDE / 2
    co[:, 2] = A * co[:, 0] ** 2 + B * co[:, 1] ** 2
    ob.data.vertices.foreach_set("co", co.ravel())
    add_uv(ob, lambda xy: xy / SIDE + 0.5)
    ob.data.shade_smooth()
    subsurf = ob.modifiers.new("Subdivision", "SUBSURF")
    subsurf.levels = subsurf.render_levels = 2
    return ob


def add_uv(ob, of_plan) -> None:
    corner = np.array([loop.vertex_index for loop in ob.data.loops])
    co = np.array([v.co for v in ob.data.vertices])[corner]
    layer = ob.data.uv_layers.get("UVMap") or ob.data.uv_layers.new(name="UVMap")
    layer.uv.foreach_set("vector", of_plan(co[:, :2]).astype(np.float32).ravel())


def bake(**how) -> dict[str, np.ndarray]:
    """Bakes, and returns the inner texels by the map's key."""
    how = {"width": SIZE, "height": SIZE, **how}
    assert bpy.ops.object.limit_bake_maps(**how) == {"FINISHED"}
    name = how.get("name") or bpy.context.active_object.name
    return {
        key: image_pixels.read(bpy.data.images[f"{name} {KINDS[key].name}"])[INNER, INNER, :3]
        for key in how["maps"]
    }


class Truth:
    """The exact values at the inner texels, in the object's space."""

    def __init__(self, scale: float = 1.0) -> None:
        at = (np.arange(SIZE)[INNER] + 0.5) / SIZE * SIDE - SIDE / 2
        self.x, self.y = np.meshgrid(at, at)
        zx, zy = 2 * A * self.x, 2 * B * self.y
        length = np.sqrt(1 + zx**2 + zy**2)
        z = A * self.x**2 + B * self.y**2 + (A + B) / 3
        self.position = np.stack([self.x, self.y, z], axis=-1)
        self.normal = np.stack([-zx, -zy, np.ones_like(zx)], axis=-1) / length[..., None]
        # The second fundamental form relative to the first gives a 2 x 2 eigenvalue problem, solved
        # by formula.
        e, f, g = 1 + zx**2, zx * zy, 1 + zy**2
        xx, yy = 2 * A / length, 2 * B / length
        self.mean = (xx * g + yy * e) / (2 * length**2) / scale
        self.gaussian = xx * yy / length**2 / scale**2
        root = np.sqrt(self.mean**2 - self.gaussian)
        self.k1, self.k2 = self.mean + root, self.mean - root
        # The solution d of (second - k first) d = 0 points along the map's U, which is x; its image
        # is (1, 0, zx).
        self.directions = [self._along(k * scale, xx, e, f, zx, zy) for k in (self.k1, self.k2)]
        self.area = length
        half, apart = (e + g) / 2, np.hypot((e - g) / 2, f)
        self.high, self.low = np.sqrt(half + apart), np.sqrt(half - apart)

    def _along(self, k, xx, e, f, zx, zy):
        x, y = k * f, xx - k * e
        swap = np.hypot(x, y) < 1e-9 * np.hypot(k * f, 2 * B)
        x, y = np.where(swap, 1, x), np.where(swap, 0, y)
        d = np.stack([x, y, x * zx + y * zy], axis=-1)
        d /= np.linalg.norm(d, axis=-1, keepdims=True)
        return d * np.where(d[..., 0] + d[..., 2] * zx < 0, -1, 1)[..., None]


def test_every_map_is_what_the_formulas_say():
    paraboloid()
    got, truth = bake(maps=ALL, cavity_radius=2.0), Truth()

    def close(key, expected, tolerance=SINGLE):
        np.testing.assert_allclose(got[key], expected, rtol=0, atol=tolerance)

    close("POSITION", truth.position)
    close("NORMAL_OBJECT", truth.normal)
    close("CURVATURE_MEAN", truth.mean[..., None].repeat(3, -1))
    close("CURVATURE_GAUSSIAN", truth.gaussian[..., None].repeat(3, -1))
    half = (truth.k1 - truth.k2) / 2
    close("CURVATURE_PRINCIPAL", np.stack([truth.k1, truth.k2, half], axis=-1))
    close("CAVITY", (1 - (2 * truth.mean).clip(0, 1))[..., None].repeat(3, -1))
    # A direction at right angles to the map's U may point either way.
    for key, expected in zip(("DIRECTION_1", "DIRECTION_2"), truth.directions, strict=True):
        along = np.abs((got[key] * expected).sum(axis=-1))
        np.testing.assert_allclose(along, 1, atol=1e-6)
    sure = np.abs(truth.directions[0][..., 0]) > 0.1
    np.testing.assert_allclose(got["DIRECTION_1"][sure], truth.directions[0][sure], atol=1e-5)
    # Distortion is relative to the ratio of the whole map, to which the texels at the boundary
    # contribute.
    octaves = np.log2(np.stack([truth.area, truth.high, truth.low], axis=-1))
    apart = got["AREA_DISTORTION"] - octaves
    np.testing.assert_allclose(apart, np.broadcast_to(apart[0, 0], apart.shape), atol=1e-5)
    assert apart[0, 0, 1] == pytest.approx(apart[0, 0, 0] / 2, abs=1e-5)
    assert -1 < apart[0, 0, 0] < 0


def test_distortion_is_against_the_whole_map():
    paraboloid()
    bake(maps={"AREA_DISTORTION"})
    image = image_pixels.read(bpy.data.images["Bowl Distortion"])
    assert np.exp2(image[..., 0][image[..., 3] > 0]).mean() == pytest.approx(1, abs=1e-6)


@pytest.mark.parametrize("mirrored", [False, True])
def test_in_world_space(mirrored):
    """The object is scaled by 2, turned and moved, and also mirrored: outwards stays outwards."""
    ob = paraboloid()
    turn = np.array(Matrix.Rotation(0.7, 3, (1, 2, 3)))
    linear = turn @ np.diag([-2.0 if mirrored else 2.0, 2.0, 2.0])
    ob.matrix_world = Matrix(np.block([[linear, np.array([[1], [2], [3]])], [np.zeros(3), 1]]))
    bpy.context.view_layer.update()
    got, truth = bake(maps=ALL - {"NORMAL_TANGENT"}, space="WORLD"), Truth(scale=2.0)
    close = {"rtol": 0, "atol": 1e-5}
    np.testing.assert_allclose(got["POSITION"], truth.position @ linear.T + [1, 2, 3], **close)
    np.testing.assert_allclose(got["NORMAL_OBJECT"], truth.normal @ linear.T / 2, **close)
    np.testing.assert_allclose(got["CURVATURE_MEAN"][..., 0], truth.mean, **close)
    np.testing.assert_allclose(got["CURVATURE_PRINCIPAL"][..., 0], truth.k1, **close)
    np.testing.assert_allclose(got["CURVATURE_PRINCIPAL"][..., 1], truth.k2, **close)
    along = (got["DIRECTION_1"] * (truth.directions[0] @ linear.T / 2)).sum(axis=-1)
    np.testing.assert_allclose(np.abs(along), 1, atol=1e-5)


def test_colors_of_8_and_16_bits():
    ob = paraboloid()
    truth = Truth()
    found = bake(maps=ALL, format="PNG_16", curvature_range=0.5, distortion_range=4)
    # At the border the surface is not the paraboloid, so the module itself gives the exact box.
    mesh = cage.read(ob, bpy.context.evaluated_depsgraph_get()).mesh
    low, high = limitsurf.LimitSurface(mesh).bounds()
    expected = {
        "POSITION": (truth.position - low) / (high - low),
        "NORMAL_OBJECT": (truth.normal + 1) / 2,
        "CURVATURE_MEAN": (truth.mean[..., None] / 0.5 + 1) / 2,
        "CURVATURE_GAUSSIAN": (truth.gaussian[..., None] / 0.25 + 1) / 2,
    }
    for key, values in expected.items():
        wanted = np.broadcast_to(values.clip(0, 1), found[key].shape)
        np.testing.assert_allclose(found[key], wanted, atol=1e-5, err_msg=key)
    assert bpy.data.images["Bowl Normal"].is_float
    coarse = bake(maps=ALL, format="PNG_8", name="Coarse", curvature_range=0.5, distortion_range=4)
    for key, values in found.items():
        np.testing.assert_allclose(coarse[key], values, atol=0.5 / 255 + 1e-6, err_msg=key)
    assert not bpy.data.images["Coarse Normal"].is_float


def test_ranges_that_are_found_hold_most_values():
    paraboloid()
    bake(maps={"CURVATURE_MEAN"}, format="PNG_16")
    image = image_pixels.read(bpy.data.images["Bowl Mean Curvature"])
    values = image[..., 0][image[..., 3] > 0]
    at_ends = ((values == 0) | (values == 1)).mean()
    assert 0.03 < at_ends < 0.07


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("form", ["PNG_16", "PNG_8"])
@pytest.mark.parametrize("largest", [1e30, 1e-38])
def test_ranges_whose_squares_single_precision_does_not_hold(form, largest):
    paraboloid()
    got = bake(maps={"CURVATURE_GAUSSIAN"}, format=form, curvature_range=largest)
    expected = 0.5 if largest > 1 else 0.0  # the paraboloid is a saddle everywhere
    np.testing.assert_allclose(got["CURVATURE_GAUSSIAN"], expected, atol=1 / 255)


@pytest.mark.filterwarnings("error")
def test_positions_of_a_flat_mesh_far_from_the_origin():
    ob = paraboloid()
    for vertex in ob.data.vertices:
        vertex.co.z = 2**30
    got = bake(maps={"POSITION"}, format="PNG_16")["POSITION"]
    assert np.isfinite(got).all()
    assert np.ptp(got[..., 0]) > 0.4
    assert np.ptp(got[..., 2]) < 1e-6


def test_margin_and_what_is_not_covered():
    ob = paraboloid()
    add_uv(ob, lambda xy: xy / SIDE / 2 + 0.5)  # the middle quarter
    bake(maps={"POSITION"}, margin=4)
    alpha = image_pixels.read(bpy.data.images["Bowl Position"])[..., 3]
    rows = np.flatnonzero(alpha.any(axis=1))
    assert (rows[0], rows[-1]) == (16 - 4, 47 + 4)
    assert set(np.unique(alpha)) == {0, 1}
    assert not image_pixels.read(bpy.data.images["Bowl Position"])[0].any()


def test_new_images_or_those_of_the_name():
    paraboloid()
    bake(maps={"POSITION", "CAVITY"})
    first = bpy.data.images["Bowl Position"]
    first.pixels.foreach_set(np.zeros(SIZE * SIZE * 4, np.float32))
    bake(maps={"POSITION"})
    assert sorted(bpy.data.images.keys()) == ["Bowl Cavity", "Bowl Position"]
    assert image_pixels.read(first).any()
    bake(maps={"POSITION"}, reuse=False)
    assert "Bowl Position.001" in bpy.data.images
    assert first.colorspace_settings.name == "Non-Color"


def test_undo_takes_images_and_pixels_back():
    ob = paraboloid()
    bpy.ops.ed.undo_push(message="before")
    for scale in (1.0, 2.0):
        ob = bpy.data.objects["Bowl"]
        ob.scale = (scale,) * 3
        bpy.context.view_layer.update()
        bpy.ops.object.limit_bake_maps(
            "EXEC_DEFAULT", True, maps={"POSITION"}, width=8, height=8, space="WORLD"
        )

    def farthest():
        return np.abs(image_pixels.read(bpy.data.images["Bowl Position"])[..., :3]).max()

    twice = farthest()
    bpy.ops.ed.undo()
    assert farthest() == pytest.approx(twice / 2)
    bpy.ops.ed.undo()
    assert "Bowl Position" not in bpy.data.images
    bpy.ops.ed.redo()
    assert farthest() == pytest.approx(twice / 2)
    bpy.ops.ed.redo()
    assert farthest() == pytest.approx(twice)


def test_files(tmp_path):
    paraboloid()
    for form, suffix in (("EXR_32", "exr"), ("EXR_16", "exr"), ("PNG_16", "png"), ("PNG_8", "png")):
        got = bake(maps={"NORMAL_OBJECT"}, format=form, name=form, folder=str(tmp_path))
        path = tmp_path / f"{form}_Normal.{suffix}"
        image = bpy.data.images[f"{form} Normal"]
        assert bpy.path.abspath(image.filepath) == str(path)
        loaded = bpy.data.images.load(str(path))
        loaded.colorspace_settings.name = "Non-Color"
        np.testing.assert_array_equal(
            image_pixels.read(loaded)[INNER, INNER, :3], got["NORMAL_OBJECT"]
        )
        values = got["NORMAL_OBJECT"] if suffix == "exr" else 2 * got["NORMAL_OBJECT"] - 1
        step = {"EXR_32": SINGLE, "EXR_16": 5e-4, "PNG_16": 2e-5, "PNG_8": 4e-3}[form]
        np.testing.assert_allclose(values, Truth().normal, atol=step)
    # Bake into the same image and file again.
    bake(maps={"NORMAL_OBJECT"}, format="EXR_32", name="EXR_32", folder=str(tmp_path))
    assert not bpy.data.images["EXR_32 Normal"].is_dirty


def test_images_of_long_names_are_found_again():
    """Blender cuts off names that are longer than 63 bytes."""
    how = {"width": 8, "height": 8, "maps": {"POSITION", "NORMAL_TANGENT"}}
    for name in ("Bowl" * 15, "Schüssel" * 6 + "ü", "Bowl" * 15 + "B"):
        ob = paraboloid()
        ob.name = name
        before = set(bpy.data.images)
        assert bpy.ops.object.limit_bake_maps(**how) == {"FINISHED"}
        made = set(bpy.data.images) - before
        assert len(made) == 2
        assert all(image.name.startswith(name[:30]) for image in made)
        assert {image.name.split(" ", 1)[1] for image in made} == {"Position", "Tangent Normal"}
        bpy.data.objects.remove(ob)
        ob = paraboloid()
        ob.name = name
        assert bpy.ops.object.limit_bake_maps(**how) == {"FINISHED"}
        assert set(bpy.data.images) - before == made
        bpy.data.objects.remove(ob)


def test_files_of_different_names_are_different(tmp_path):
    names = ("a/b", "a\\b", "a_b", "../a", "頭", "手", "c.001", "c_001")
    paraboloid()
    for name in names:
        bake(maps={"POSITION"}, name=name, folder=str(tmp_path))
        path = Path(bpy.path.abspath(bpy.data.images[f"{name} Position"].filepath))
        assert path.parent == tmp_path
    found = sorted(path.name for path in tmp_path.iterdir())
    assert len(found) == len(names)
    assert {"a_b_Position.exr", "c.001_Position.exr", "頭_Position.exr"} <= set(found)
    assert [path.name for path in tmp_path.parent.glob("*.exr")] == []


def test_tiles(tmp_path):
    ob = paraboloid()
    add_uv(ob, lambda xy: xy / SIDE * (2, 1) + (1, 0.5))  # two tiles
    half = {"width": SIZE // 2, "height": SIZE}
    bake(maps={"POSITION"}, tiles="ALL", **half)
    image = bpy.data.images["Bowl Position"]
    assert image.source == "TILED"
    both = np.concatenate([image_pixels.read(image, tile) for tile in (1001, 1002)], axis=1)
    np.testing.assert_allclose(both[INNER, INNER, :3], Truth().position, atol=SINGLE)
    bake(maps={"POSITION"}, tiles="ALL", folder=str(tmp_path), reuse=False, **half)
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "Bowl_Position.1001.exr",
        "Bowl_Position.1002.exr",
    ]
    saved = bpy.data.images["Bowl Position.001"]
    np.testing.assert_array_equal(image_pixels.read(saved, 1002), image_pixels.read(image, 1002))
    bake(maps={"POSITION"}, name="First", **half)
    first = image_pixels.read(bpy.data.images["First Position"])
    np.testing.assert_allclose(first, image_pixels.read(image, 1001), atol=SINGLE)
    # Bake into the existing image: both tiles change.
    ob.location.x = 5
    bpy.context.view_layer.update()
    bake(maps={"POSITION"}, tiles="ALL", space="WORLD", **half)
    moved = image_pixels.read(image, 1002)[INNER, : SIZE // 4, 0]
    np.testing.assert_allclose(moved, both[INNER, SIZE // 2 : 3 * SIZE // 4, 0] + 5, atol=1e-5)


def refused(match, **how):
    before = scenes.file_contents()
    kept = {image.name: image_pixels.read(image) for image in bpy.data.images}
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_bake_maps(**{"width": 16, "height": 16, "maps": {"POSITION"}, **how})
    assert scenes.file_contents() == before
    for name, pixels in kept.items():
        np.testing.assert_array_equal(image_pixels.read(bpy.data.images[name]), pixels)


def test_refusals(tmp_path):
    ob = paraboloid()
    refused("No map is chosen", maps=set())
    refused("Bowl has no UV map 'Other'", uv_map="Other")
    refused("There is no folder", folder=str(tmp_path / "nothing"))
    refused(
        "//maps is relative to the .blend file, which has not been saved: save it first",
        folder="//maps",
    )
    refused("take about .* GiB of memory", width=16384, height=16384)
    bake(maps={"POSITION"})
    refused("The existing image Bowl Position has 64 x 64 pixels: set .* or turn Reuse Images off")
    refused(
        "has float pixels, which do not fit the chosen format",
        width=64,
        height=64,
        format="PNG_8",
    )
    bpy.data.images["Bowl Position"].colorspace_settings.name = "sRGB"
    refused("but data need Non-Color", width=64, height=64)
    bpy.data.images.remove(bpy.data.images["Bowl Position"])
    add_uv(ob, np.zeros_like)
    refused("no face has an area on the UV map")
    add_uv(ob, lambda xy: xy / SIDE + 3.5)
    refused("covers no texel of tile 1001")
    add_uv(ob, lambda xy: np.abs(xy) / SIDE)
    refused(r"overlaps itself at \d+ of \d+ texels")
    ob.data.uv_layers.remove(ob.data.uv_layers["UVMap"])
    refused("there is no UV map")


def test_a_folder_that_cannot_be_written(tmp_path, monkeypatch):
    """Writing the second file fails, so the first file is removed again, and no image is made."""
    paraboloid()
    save, calls = image_files.save_pixels, []

    def fails(pixels, path, kind):
        calls.append(path)
        if len(calls) == 2:
            raise RefusalError("no space is left")
        save(pixels, path, kind)

    monkeypatch.setattr(image_files, "save_pixels", fails)
    refused("no space is left", maps={"POSITION", "CAVITY"}, folder=str(tmp_path))
    assert not list(tmp_path.iterdir())


def test_warnings(capfd):
    ob = paraboloid()
    add_uv(ob, lambda xy: np.abs(xy) / SIDE)
    bpy.ops.object.limit_bake_maps(maps={"POSITION"}, width=16, height=16, overlap="ALLOW")
    assert "overlaps itself at" in capfd.readouterr().out
    add_uv(ob, lambda xy: (xy / SIDE + 0.5).clip(0.25, 1))
    bpy.ops.object.limit_bake_maps(maps={"POSITION"}, width=16, height=16)
    assert "28 faces have no area on the UV map" in capfd.readouterr().out


def test_escape_leaves_everything(monkeypatch):
    paraboloid()
    bake(maps={"POSITION"}, width=16, height=16)
    before, pixels = scenes.file_contents(), image_pixels.read(bpy.data.images["Bowl Position"])
    kind, go_on = bpy.types.OBJECT_OT_limit_bake_maps, threading.Event()
    own = ("start", "finish", "_output", "too_large", "cancelled")
    operator = type("StandIn", (WatchedOperator,), {name: getattr(kind, name) for name in own})()
    operator.properties, operator.bl_rna = operator, bpy.ops.object.limit_bake_maps.get_rna_type()
    for prop in operator.bl_rna.properties:
        if prop.identifier not in ("rna_type", "maps"):
            setattr(operator, prop.identifier, prop.default)
    operator.maps, operator.width, operator.height = {"POSITION"}, 16, 16
    operator.report = MagicMock()
    context = MagicMock(wraps=bpy.context)
    context.active_object = bpy.context.active_object
    context.window_manager, context.workspace = MagicMock(), MagicMock()
    bake_all = map_images.bake

    def slowly(order, progress):
        wait_for(go_on)
        return bake_all(order, progress)

    monkeypatch.setattr("limit_surface.bake_maps.operator.bake", slowly)
    monkeypatch.setattr(watched_module, "PATIENCE", 0.01)
    operator._someone_waits = True
    assert operator.execute(context) == {"RUNNING_MODAL"}
    job = operator._job
    press = SimpleNamespace(type="ESC", value="PRESS")
    assert operator.modal(context, press) == {"CANCELLED"}
    go_on.set()
    wait_for(job)
    operator.report.assert_called_with({"INFO"}, "Cancelled: nothing was baked")
    assert scenes.file_contents() == before
    np.testing.assert_array_equal(image_pixels.read(bpy.data.images["Bowl Position"]), pixels)
