# SPDX-License-Identifier: GPL-3.0-or-later
"""What the window tests ask Blender to do and to tell."""

import bpy


def new_file() -> None:
    bpy.ops.wm.read_homefile(use_empty=False)


def redraw() -> None:
    """The main loop draws before it calls the tests' timer again."""
    for area in bpy.context.window.screen.areas:
        area.tag_redraw()


def view() -> tuple[bpy.types.Area, bpy.types.Region]:
    area = next(a for a in bpy.context.window.screen.areas if a.type == "VIEW_3D")
    return area, region(area, "WINDOW")


def region(area: bpy.types.Area, kind: str) -> bpy.types.Region:
    return next(r for r in area.regions if r.type == kind)


def view_centre() -> tuple[int, int]:
    _, window = view()
    return window.x + window.width // 2, window.y + window.height // 2


def version() -> str:
    return bpy.app.version_string


def modules() -> dict[str, str]:
    """Where the extension and its native module were loaded from."""
    import limitsurf

    addon = next(name for name in bpy.context.preferences.addons if "limit_surface" in name)
    return {"addon": addon, "limitsurf": limitsurf._limitsurf.__file__}


def show_sidebar() -> None:
    area, _ = view()
    area.spaces.active.show_region_ui = True


def sidebar() -> dict[str, object]:
    """Its edges, in the window's pixels, and the open tab."""
    area, _ = view()
    ui = region(area, "UI")
    return {
        "left": ui.x,
        "right": ui.x + ui.width,
        "bottom": ui.y,
        "top": ui.y + ui.height,
        "tab": ui.active_panel_category,
    }


def clear_clipboard() -> None:
    bpy.context.window_manager.clipboard = " "


def clipboard() -> str:
    return bpy.context.window_manager.clipboard


def objects() -> list[str]:
    return sorted(ob.name for ob in bpy.data.objects)


def curve_count(name: str) -> int:
    return len(bpy.data.objects[name].data.curves)
