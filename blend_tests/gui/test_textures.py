# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that make textures and meshes, used by their panel, dialogs, redo panels and
menu.
"""

import numpy as np
import pytest
from quadric import Camera
from session import OUT, class_name, is_near

PROJECT = "object.limit_project_image"
BAKE_MAPS = "object.limit_bake_maps"
BAKE_DISPLACEMENT = "object.limit_bake_displacement"
CURVATURE = "object.limit_curvature"
MESH = "object.limit_mesh"
PANEL = "VIEW3D_PT_limit_textures"
MENU = "VIEW3D_MT_object_limit_surface"

WAVE = 0.35
BLANK = (255, 0, 255)
SQUARES = 8
FIRST, SECOND, MARK = (230, 60, 40), (40, 90, 220), (60, 200, 80)
FACE_ROWS = 8**2
#: A bake of this size takes minutes on two cores
LONG_BAKE = {
    "maps": {"POSITION", "NORMAL_TANGENT", "CURVATURE_MEAN", "CAVITY"},
    "width": 4096,
    "height": 4096,
}


@pytest.fixture
def sheet(blender):
    """Adds the sheet, which fills the view, and checks afterwards that Blender has reported no
    errors.
    """
    log = OUT / "blender.log"
    blender.call("flush")
    begin = log.stat().st_size
    blender.call("textured_sheet", WAVE)
    blender.call("remember")
    blender.settle()
    yield blender
    blender.call("flush")
    said = log.read_text()[begin:]
    assert not any(word in said for word in ("Traceback", "Error", "rna_")), said


def checker(side=256):
    """Returns pixels (rows, columns, 3) from 0 to 255, the lowest row first; one square shows the
    orientation.
    """
    y, x = np.mgrid[:side, :side] * SQUARES // side
    pixels = np.where(((x + y) % 2 == 0)[..., None], FIRST, SECOND)
    pixels[(x == 2) & (y == 4)] = MARK
    return pixels


@pytest.fixture
def image(sheet):
    """Makes the image that the next projection paints into the sheet's texture."""
    pixels = checker()
    sheet.call("new_image", "Checker", np.dstack([pixels / 255, np.ones(pixels.shape[:2])]))
    sheet.call("remember")
    chosen = {"source": "VIEW", "image": "Checker", "output": "EXISTING", "target": "Texture"}
    sheet.call("set_next", PROJECT, **chosen)
    return pixels


def project(sheet):
    """Projects by the button and the dialog that it opens; returns the view as it was before."""
    sheet.open_tab()
    top = sheet.open_panel(PANEL)
    blank = sheet.screenshot("project_before")
    before = sheet.call("image_digest", "Texture")
    sheet.click(*sheet.find_button(PROJECT, top))
    assert sheet.call("image_digest", "Texture") == before
    sheet.click(*sheet.await_dialog(blank))
    sheet.await_end(PROJECT)
    return blank


def test_projected_from_the_view_it_looks_like_the_image_and_is_undone(sheet, image):
    before, there = sheet.call("image_digest", "Texture"), sheet.call("contents")
    blank = project(sheet)
    after = sheet.call("image_digest", "Texture")
    assert after != before
    assert sheet.call("contents") == there
    sheet.move(*sheet.call("view_centre"))
    shown = sheet.screenshot("projected")
    assert_undistorted(shown, blank, sheet.call("camera"), image)

    sheet.key("ctrl+z")
    assert sheet.call("image_digest", "Texture") == before
    undone = sheet.screenshot("project_undone")
    assert is_near(undone, BLANK)[is_near(blank, BLANK)].mean() > 0.999
    sheet.key("ctrl+shift+z")
    assert sheet.call("image_digest", "Texture") == after
    redone = sheet.screenshot("project_redone")
    assert_undistorted(redone, blank, sheet.call("camera"), image)


@pytest.mark.slow
def test_projection_is_adjusted_in_the_redo_panel(sheet, image):
    """The redo panel starts from the pixels before the projection: painted over itself the image
    would change nothing.
    """
    before = sheet.call("image_digest", "Texture")
    project(sheet)
    after = sheet.call("image_digest", "Texture")
    fields = sheet.open_redo_panel()
    sheet.screenshot("project_redo")
    sheet.move(*sheet.find_field(*fields, value="1"))
    sheet.key("Return", "ctrl+a", "period", "5", "Return")
    sheet.await_end(PROJECT)
    assert sheet.call("image_digest", "Texture") not in (before, after)
    sheet.key("Return", "ctrl+a", "1", "Return")
    sheet.await_end(PROJECT)
    assert sheet.call("image_digest", "Texture") == after


def assert_undistorted(shown, blank, camera, image):
    """Checks that the image is wherever the sheet was seen, as large as fits into the middle of the
    view.
    """
    rows, columns = np.nonzero(is_near(blank, BLANK))
    (left, bottom), (width, height) = camera["corner"], camera["size"]
    side = min(width, height)
    st = np.stack(
        [
            (columns + 0.5 - left - width / 2) / side + 0.5,
            (len(blank) - rows - 0.5 - bottom - height / 2) / side + 0.5,
        ],
        axis=1,
    )
    square = st * SQUARES
    # in pixels of the screen
    from_border = np.abs(square - np.rint(square)).min(axis=1) * side / SQUARES
    inside = ((st > 0) & (st < 1)).all(axis=1)
    seen = shown[rows, columns].astype(int)
    clear = inside & (from_border > 3)
    assert np.count_nonzero(clear) > 30_000
    y, x = (st[clear] * len(image)).astype(int).T[::-1]
    right = (np.abs(seen[clear] - image[y, x]) < 12).all(axis=1)
    assert right.mean() > 0.995
    outside = ~((st > -0.01) & (st < 1.01)).all(axis=1)
    if outside.any():
        assert (np.abs(seen[outside] - BLANK) < 12).all(axis=1).mean() > 0.99


@pytest.mark.parametrize("operator", [PROJECT, BAKE_MAPS, BAKE_DISPLACEMENT])
def test_dialogs_are_left_by_esc(sheet, operator):
    there = sheet.call("contents")
    before = sheet.screenshot("dialog_before")
    sheet.call("start", operator)
    # Blender's dialogs ignore ESC while the mouse is over a search field.
    sheet.move(*sheet.await_dialog(before))
    sheet.screenshot(f"dialog_{operator.removeprefix('object.limit_')}")
    sheet.key("Escape")
    assert sheet.find_confirmation(before) is None
    assert not sheet.call("running")
    assert sheet.call("contents") == there


def test_esc_ends_a_long_bake_and_leaves_nothing(sheet, tmp_path):
    """How soon the window answers, and ESC is obeyed, is measured by tools/bench_window.py."""
    there, digest = sheet.call("contents"), sheet.call("image_digest", "Texture")
    threads = sheet.call("threads")
    before = sheet.screenshot("dialog_before")
    sheet.call("start", BAKE_MAPS, **LONG_BAKE, folder=str(tmp_path))
    sheet.await_dialog(before)
    sheet.key("Return")
    sheet.await_value([class_name(BAKE_MAPS)], "running")
    distance = sheet.call("view_distance")
    sheet.wheel(1)
    assert sheet.call("view_distance") < distance
    sheet.picture("baking")
    assert sheet.call("running") == [class_name(BAKE_MAPS)]
    sheet.key("Escape")
    sheet.await_value([], "running")
    sheet.await_value(threads, "threads")
    assert sheet.call("contents") == there
    assert sheet.call("image_digest", "Texture") == digest
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_mesh_is_adjusted_in_the_redo_panel(sheet):
    there = sheet.call("contents")
    sheet.open_tab()
    top = sheet.open_panel(PANEL)
    sheet.click(*sheet.find_button(MESH, top))
    sheet.await_end(MESH)
    assert sheet.call("mesh_size", "Limit Mesh") == ((8 * 8 + 1) ** 2, FACE_ROWS * 4**3)
    made = sheet.call("contents")
    assert sheet.call("objects") == ["Limit Mesh", "Sheet"]
    fields = sheet.open_redo_panel()
    sheet.screenshot("mesh_redo")
    sheet.move(*sheet.find_field(*fields, value="3"))
    sheet.key("Return", "ctrl+a", "4", "Return")
    sheet.await_end(MESH)
    assert sheet.call("mesh_size", "Limit Mesh") == ((8 * 16 + 1) ** 2, FACE_ROWS * 4**4)
    assert sheet.call("contents") == made
    sheet.key("Escape")
    sheet.move(*sheet.call("view_centre"))
    sheet.key("ctrl+z")
    assert sheet.call("contents") == there


@pytest.mark.slow
def test_curvature_is_seen(sheet):
    """The sheet is blue where it bulges, and red where it is hollow."""
    there = sheet.call("contents")
    sheet.open_tab()
    top = sheet.open_panel(PANEL)
    sheet.click(*sheet.find_button(CURVATURE, top))
    sheet.await_end(CURVATURE)
    assert sheet.call("contents") == there
    sheet.call("show_flat", "VERTEX")
    sheet.settle()
    shown = sheet.screenshot("curvature")
    camera = Camera(**sheet.call("camera"))
    tops = [(np.pi / 2, 0, WAVE), (-np.pi / 2, 0, -WAVE)]
    bulge, hollow = (
        shown[len(shown) - 1 - round(y), round(x)].astype(int)
        for x, y in map(camera.pixel, sheet.call("world_points", "Sheet", tops))
    )
    assert bulge[2] > bulge[0] + 60
    assert hollow[0] > hollow[2] + 60


def test_menu_has_them_all(sheet):
    sheet.call("open_menu", MENU)
    sheet.settle()
    sheet.screenshot("textures_menu")
    found = sheet.operators_in_menu()
    for operator in (PROJECT, BAKE_MAPS, BAKE_DISPLACEMENT, CURVATURE, MESH):
        assert found.count(operator) == 1
    sheet.key("Escape")
