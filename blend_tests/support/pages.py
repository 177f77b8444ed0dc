# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages of the documentation: their examples, and their tables of an operator's properties."""

import re
from collections.abc import Collection

import bpy
import numpy as np
from processes import ROOT


def text(name: str) -> str:
    return (ROOT / f"docs/{name}.md").read_text()


def examples(page: str) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)


def check_properties(
    section: str,
    operator: str,
    empty: str = "none",
    only: Collection[str] | None = None,
    category: str = "object",
) -> None:
    """The section's table lists the properties of `bpy.ops.<category>.<operator>`, or `only` some
    of them, with their defaults, and the labels that differ from their names. `empty` is how it
    shows an empty name."""
    rows: dict[str, str] = {}
    labels: dict[str, list[str]] = {}
    row = r"^\| (`[^|]+`)(?: \(([^|]+)\))? \| *`?([^|`]*?)`? *\|"
    for names, called, said in re.findall(row, section, re.MULTILINE):
        named = re.findall(r"`(\w+)`", names)
        rows |= dict.fromkeys(named, said)
        labels |= dict.fromkeys(named, re.findall(r"\*([^*]+)\*", called))
    properties = getattr(getattr(bpy.ops, category), operator).get_rna_type().properties
    shown = {p.identifier: p for p in properties if not p.is_hidden and p.identifier != "rna_type"}
    if only is not None:
        shown = {name: rna for name, rna in shown.items() if name in only}
    assert rows == {name: default_of(rna, empty) for name, rna in shown.items()}
    for name, rna in shown.items():
        assert is_plain(name, rna.name) or rna.name in labels[name], name


def is_plain(identifier: str, label: str) -> bool:
    """Whether one can tell the label of a property from its name."""
    return label.lower().replace("-", " ") == identifier.replace("_", " ")


def default_of(rna: bpy.types.Property, empty: str) -> str:
    if rna.type == "BOOLEAN":
        return "on" if rna.default else "off"
    if rna.type == "ENUM" and rna.is_enum_flag:
        return ", ".join(sorted(rna.default_flag)) or empty
    if rna.type == "FLOAT" and rna.array_length:
        values = np.degrees(rna.default_array) if rna.unit == "ROTATION" else rna.default_array
        sign = "°" if rna.unit == "ROTATION" else ""
        return ", ".join(f"{value:g}{sign}" for value in np.round(values, 5))
    return rna.default or empty if isinstance(rna.default, str) else f"{rna.default:g}"
