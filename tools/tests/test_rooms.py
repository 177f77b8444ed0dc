# SPDX-License-Identifier: Apache-2.0
"""The rooms of the extension: few modules in its root, and imports that go one way only.

Every folder of `addon/limit_surface` is a room. A room imports the rooms that stand before it in
ROOMS. After them come the capabilities, one folder each, which know nothing of each other, and last
the user interface. The root's own modules stand below all rooms, except `__init__`, which registers
everything.
"""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ADDON = Path(__file__).resolve().parents[2] / "addon/limit_surface"
MOST_IN_ROOT = 6
ROOMS = ("reading", "subsurf", "tasks", "images", "nodes", "sources", "placing", "viewport")
CAPABILITIES = (
    "attach",
    "bake_displacement",
    "bake_frames",
    "bake_maps",
    "children",
    "curvature",
    "draw",
    "follow",
    "hair",
    "limit_mesh",
    "particles",
    "points",
    "project_image",
    "report",
    "sampling",
    "snap",
    "snap_modal",
)
LAST = "ui"
BETWEEN_CAPABILITIES = {("snap_modal", "snap")}


def room_of(parts: tuple[str, ...], root: Path = ADDON) -> str:
    """Returns the folder of a module whose path in the extension has these parts; "" for the
    root.
    """
    return parts[0] if parts and (root / parts[0]).is_dir() else ""


def imports(root: Path = ADDON) -> Iterator[tuple[Path, str, str]]:
    """Yields every file with its room and the room that it imports, once for each import."""
    for path in sorted(root.rglob("*.py")):
        inside = path.relative_to(root)
        if inside == Path("__init__.py"):
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            if not isinstance(node, ast.ImportFrom) or not node.level:
                continue
            base = inside.parent.parts[: len(inside.parent.parts) - (node.level - 1)]
            module = base + tuple(node.module.split(".") if node.module else ())
            for name in node.names:
                yield (
                    inside,
                    room_of(inside.parent.parts, root),
                    room_of((*module, name.name), root),
                )


def is_allowed(room: str, imported: str) -> bool:
    if room == imported or not imported or (room, imported) in BETWEEN_CAPABILITIES:
        return True
    if not room or imported == LAST:
        return False
    below = ROOMS[: ROOMS.index(room)] if room in ROOMS else ROOMS
    return imported in below


def violations(root: Path = ADDON) -> list[str]:
    return [
        f"{path} imports the room {imported}"
        for path, room, imported in imports(root)
        if not is_allowed(room, imported)
    ]


def test_the_root_holds_few_modules():
    modules = sorted(path.name for path in ADDON.glob("*.py"))
    assert len(modules) <= MOST_IN_ROOT, modules


def test_every_folder_is_a_room_that_is_known():
    folders = {path.name for path in ADDON.iterdir() if path.is_dir() and any(path.glob("*.py"))}
    assert folders == {*ROOMS, *CAPABILITIES, LAST}


def test_imports_between_rooms_go_one_way():
    assert not violations()


def test_rooms_are_imported_at_all():
    found = {(room, imported) for _path, room, imported in imports()}
    assert {("snap_modal", "snap"), ("placing", "reading"), ("hair", "placing")} <= found


@pytest.mark.parametrize(
    ("path", "line"),
    [
        ("reading/cage.py", "from ..tasks import job"),
        ("tasks/job.py", "from ..hair.strands import Shape"),
        ("hair/strands.py", "from ..points import operator"),
        ("hair/strands.py", "from ..snap import settings"),
        ("snap/aim.py", "from .. import snap_modal"),
        ("placing/roots.py", "from ..ui import menus"),
        ("errors.py", "from .reading import cage"),
        ("ids.py", "from . import hair"),
    ],
)
def test_a_wrong_import_is_found(tmp_path, path, line):
    for folder in (*ROOMS, *CAPABILITIES, LAST):
        (tmp_path / folder).mkdir()
    (tmp_path / path).write_text(f"{line}\n")
    assert len(violations(tmp_path)) == 1
