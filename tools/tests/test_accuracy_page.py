# SPDX-License-Identifier: Apache-2.0
"""The bounds of docs/accuracy.md are the constants of the library's headers."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/accuracy.md"
ROW = re.compile(r"^\| [^|]*\| `(k\w+Error)` \| ([0-9e./-]+)", re.MULTILINE)
LINKED_ROW = re.compile(
    r"^\| \[[^]]+\]\(#([\w-]+)\) \| `(k\w+Error)` \|.*\| ([^|]+) \|$", re.MULTILINE
)
HEADING = re.compile(r"^### (.+)$", re.MULTILINE)
CONSTANT = re.compile(r"^constexpr double (k\w+Error) = ([^;]+);", re.MULTILINE)


def number(text: str) -> float:
    dividend, _, divisor = text.partition("/")
    return float(dividend) / float(divisor or 1)


def test_bounds_are_those_of_the_headers():
    page = dict(ROW.findall(PAGE.read_text()))
    headers: dict[str, str] = {}
    for header in (ROOT / "native/limitsurf").rglob("*.h"):
        headers |= CONSTANT.findall(header.read_text())
    assert {name: number(bound) for name, bound in page.items()} == {
        name: number(bound) for name, bound in headers.items()
    }
    assert len(page) > 10


def test_every_bound_has_a_section_that_says_how_it_is_known():
    text = PAGE.read_text()
    headings = {heading.lower().replace(" ", "-") for heading in HEADING.findall(text)}
    rows = LINKED_ROW.findall(text)
    assert {name for _, name, _ in rows} == {name for name, _ in ROW.findall(text)}
    for anchor, name, how in rows:
        assert anchor in headings, name
        assert re.search("derived|estimated|measured", how), name
