# SPDX-License-Identifier: Apache-2.0
"""The rooms of the library: includes go one way only, and no folder of the tests is overfull.

Every folder of `native/limitsurf` is a room and includes those that stand before it in LAYERS, with
one exception: `eigen` works on rings of numbers and knows no mesh. The headers beside the rooms
(types, errors, threads) include no room at all.
"""

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

NATIVE = Path(__file__).resolve().parents[2] / "native"
sys.path.insert(0, str(NATIVE.parent / "tools"))

import api_pages  # noqa: E402

LAYERS = (
    "precision",
    "rules",
    "mesh",
    "eigen",
    "patch",
    "surface",
    "tessellate",
    "search",
    "flow",
    "sample",
    "curves",
    "geodesic",
    "path",
    "uv",
    "image",
    "project",
    "displace",
)
UNKNOWN = {("eigen", "mesh")}
MOST_IN_FOLDER = 40
INCLUDE = re.compile(r'^#include "limitsurf/(?:(\w+)/)?[\w./]+"', re.MULTILINE)
OF_OTHERS = re.compile(r"pybind11|Python\.h|\bbpy\b")


def includes(root: Path) -> Iterator[tuple[Path, str, str]]:
    """Yields every source file with its room and the room that it includes, once for each
    include.
    """
    for path in sorted(root.rglob("*")):
        if path.suffix in (".h", ".cpp"):
            inside = path.relative_to(root)
            room = inside.parts[0] if len(inside.parts) > 1 else ""
            for match in INCLUDE.finditer(path.read_text()):
                yield inside, room, match.group(1) or ""


def is_allowed(room: str, included: str) -> bool:
    if room == included or not included:
        return True
    below = LAYERS[: LAYERS.index(room)] if room else ()
    return included in below and (room, included) not in UNKNOWN


def violations(root: Path) -> list[str]:
    return [
        f"{path} includes the room {included}"
        for path, room, included in includes(root)
        if not is_allowed(room, included)
    ]


def test_every_folder_is_a_room_that_is_known():
    folders = {path.name for path in (NATIVE / "limitsurf").iterdir() if path.is_dir()}
    assert folders == set(LAYERS)


def test_includes_between_rooms_go_one_way():
    assert not violations(NATIVE / "limitsurf")


def test_rooms_are_included_at_all():
    found = {(room, included) for _path, room, included in includes(NATIVE / "limitsurf")}
    assert {("eigen", "rules"), ("patch", "eigen"), ("displace", "surface")} <= found


def test_installed_headers_include_only_installed_ones():
    installed = set(api_pages.public_headers())
    assert "limitsurf/surface/limit_surface.h" in installed
    included = {
        (header, name)
        for header in installed
        for name in re.findall(r'^#include "(.+)"', (NATIVE / header).read_text(), re.MULTILINE)
    }
    assert sorted(pair for pair in included if pair[1] not in installed) == []


def test_the_library_knows_neither_python_nor_blender():
    lines = [
        f"{path.relative_to(NATIVE)}: {line}"
        for path in (NATIVE / "limitsurf").rglob("*")
        if path.suffix in (".h", ".cpp")
        for line in path.read_text().splitlines()
        if line.startswith("#include") and OF_OTHERS.search(line)
    ]
    assert not lines


def test_one_header_of_the_module_includes_pybind11():
    """So that its casters of numbers stand before all code that uses them."""
    including = [
        path.name
        for path in (NATIVE / "python/src").rglob("*")
        if path.suffix in (".h", ".cpp") and "#include <pybind11/" in path.read_text()
    ]
    assert including == ["numbers.h"]


def test_the_tests_have_the_folders_of_the_library():
    folders = {path.name for path in (NATIVE / "tests").iterdir() if path.is_dir()}
    assert folders - set(LAYERS) == {"consumer", "data", "fuzz", "truth"}


def test_no_folder_is_overfull():
    roots = (NATIVE / "limitsurf", NATIVE / "support", NATIVE / "tests")
    folders = {path.parent for root in roots for path in root.rglob("*") if path.is_file()}
    overfull = {
        str(folder.relative_to(NATIVE)): count
        for folder in folders
        if (count := sum(path.is_file() for path in folder.iterdir())) > MOST_IN_FOLDER
    }
    assert not overfull


@pytest.mark.parametrize(
    ("path", "line"),
    [
        ("rules/subdivision_rules.h", '#include "limitsurf/mesh/control_mesh.h"'),
        ("eigen/ring.h", '#include "limitsurf/mesh/topology.h"'),
        ("surface/limit_surface.h", '#include "limitsurf/tessellate/tessellation.h"'),
        ("uv/uv_map.cpp", '#include "limitsurf/image/filtered_image.h"'),
        ("types.h", '#include "limitsurf/mesh/control_mesh.h"'),
    ],
)
def test_a_wrong_include_is_found(tmp_path, path, line):
    (tmp_path / path).parent.mkdir(exist_ok=True)
    (tmp_path / path).write_text(f"{line}\n")
    assert len(violations(tmp_path)) == 1
