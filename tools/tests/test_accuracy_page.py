# SPDX-License-Identifier: Apache-2.0
"""The bounds of docs/accuracy.md are the constants of the library's headers."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
ROW = re.compile(r"^\| [^|]*\| `(k\w+Error)` \| ([0-9e./-]+)", re.MULTILINE)
CONSTANT = re.compile(r"^constexpr double (k\w+Error) = ([^;]+);", re.MULTILINE)


def number(text: str) -> float:
    dividend, _, divisor = text.partition("/")
    return float(dividend) / float(divisor or 1)


def test_bounds_are_those_of_the_headers():
    page = dict(ROW.findall((ROOT / "docs/accuracy.md").read_text()))
    headers: dict[str, str] = {}
    for header in (ROOT / "native/limitsurf").rglob("*.h"):
        headers |= CONSTANT.findall(header.read_text())
    assert {name: number(bound) for name, bound in page.items()} == {
        name: number(bound) for name, bound in headers.items()
    }
    assert len(page) > 10
