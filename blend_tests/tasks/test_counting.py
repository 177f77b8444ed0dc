# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers in messages agree with their nouns and verbs."""

import re
from pathlib import Path

import limit_surface
import pytest
from limit_surface.bake_maps import text
from limit_surface.bake_maps.map_images import Baked
from limit_surface.counting import counted
from limit_surface.tasks.refused_faces import left_out, reasons


@pytest.mark.parametrize(
    ("count", "things", "expected"),
    [
        (0, "strands", "0 strands"),
        (1, "strands", "1 strand"),
        (1000, "strands", "1,000 strands"),
        (1, "vertices", "1 vertex"),
        (2, "vertices", "2 vertices"),
        (1, "children", "1 child"),
        (1, "control points", "1 control point"),
    ],
)
def test_nouns(count, things, expected):
    assert counted(count, things) == expected


def test_verbs():
    assert counted(1, "faces", "has", "have") == "1 face has"
    assert counted(2, "faces", "has", "have") == "2 faces have"


def test_one_face_without_area():
    (one,) = text.warnings(Baked(), 1)
    assert one == "1 face has no area on the UV map and is not in the images"
    (two,) = text.warnings(Baked(), 2)
    assert two == "2 faces have no area on the UV map and are not in the images"


def test_one_face_is_left_out():
    assert left_out(1, 2) == "1 of 2 faces has no limit surface and was left out"
    assert left_out(2, 3) == "2 of 3 faces have no limit surface and were left out"
    four = {i: f"reason {i}" for i in range(4)}
    assert reasons(four).endswith("; 1 more reason")


def test_no_message_has_a_plural_behind_any_number():
    """Numbers with separators are those of things, and stand in messages."""
    folder = Path(limit_surface.__file__).parent
    found = [
        f"{path.name}: {words}"
        for path in folder.rglob("*.py")
        for words in re.findall(r"(?<!x )\{[^{}]*:,\} \w+s\b", path.read_text())
    ]
    assert not found, "use counted()"
