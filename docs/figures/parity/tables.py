# SPDX-License-Identifier: Apache-2.0
"""Blender's Subdivision Surface against the limit surface, on many meshes.

Fills in the tables of docs/accuracy.md: the distances at Blender's best quality, which are its
rounding errors, and at its default quality, which are what its shortcuts cost. Fails where the
former are no rounding errors.
"""

from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np
from limit_surface.reading import rules

from figures import NotDrawnError, tables
from figures.parity import zoo
from figures.parity.distances import Comparison

BOUND = 1e-6  # some rounding errors of single precision
BEST, DEFAULT = 10, 3
LEVELS = 3
LEVELS_AT_DEFAULT = 5  # above the quality: vertices of lower levels are exact
LAGGING_QUALITIES = (4, 6, 8, 10)


class Row(NamedTuple):
    """One mesh with one kind of creases: the worst of all boundary and UV settings."""

    position: float
    uv: float
    lagging_position: dict[int, float]  # by quality
    lagging_uv: dict[int, float]
    default_position: float
    default_mean: float
    default_uv: float


def measure(name: str, kind: str) -> Row:
    position, uv, default, mean, default_uv = [], [], [], [], []
    lagging_position, lagging_uv = ({q: [0.0] for q in LAGGING_QUALITIES} for _ in range(2))
    for boundary in rules.BOUNDARIES:
        ob = zoo.add(name)
        zoo.crease(ob.data, kind)
        ob.modifiers[0].boundary_smooth = boundary
        found = Comparison(ob, LEVELS)
        slow_vertices, _ = found.lagging()
        position.append(worst(found.positions(BEST)[~slow_vertices]))
        for quality in LAGGING_QUALITIES:
            lagging_position[quality].append(worst(found.positions(quality)[slow_vertices]))
        for uv_smooth in rules.UV_INTERPOLATIONS:
            ob.modifiers[0].uv_smooth = uv_smooth
            found = Comparison(ob, LEVELS)
            _, slow_corners = found.lagging()
            uv.append(worst(found.uvs(BEST)[~slow_corners]))
            for quality in LAGGING_QUALITIES:
                lagging_uv[quality].append(worst(found.uvs(quality)[slow_corners]))
        ob.modifiers[0].uv_smooth = "PRESERVE_BOUNDARIES"
        found = Comparison(ob, LEVELS_AT_DEFAULT)
        distance = found.positions(DEFAULT)
        default.append(worst(distance))
        mean.append(float(np.nanmean(distance)))
        default_uv.append(worst(found.uvs(DEFAULT)))
        bpy.data.meshes.remove(ob.data)
    return Row(
        max(position),
        max(uv),
        {quality: max(distances) for quality, distances in lagging_position.items()},
        {quality: max(distances) for quality, distances in lagging_uv.items()},
        max(default),
        max(mean),
        max(default_uv),
    )


def worst(distance: np.ndarray) -> float:
    return float(np.nanmax(distance, initial=0))


def table(rows: dict[tuple[str, str], str]) -> str:
    meshes, kinds = (list(dict.fromkeys(key[i] for key in rows)) for i in (0, 1))
    lines = [
        "| | " + " | ".join(kinds) + " |",
        "|---" * (len(kinds) + 1) + "|",
        *(f"| {m} | " + " | ".join(rows[m, k] for k in kinds) + " |" for m in meshes),
    ]
    return "\n".join(lines)


def lagging_table(rows: dict[tuple[str, str], Row]) -> str:
    lines = [
        "| quality | " + " | ".join(str(q) for q in LAGGING_QUALITIES) + " |",
        "|---" * (len(LAGGING_QUALITIES) + 1) + "|",
    ]
    for said, part in (("positions", "lagging_position"), ("UVs", "lagging_uv")):
        most = [max(getattr(row, part)[q] for row in rows.values()) for q in LAGGING_QUALITIES]
        lines.append(f"| {said} | " + " | ".join(f"{d:.0e}" for d in most) + " |")
    return "\n".join(lines)


def make(folder: Path) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    rows = {}
    for name in zoo.MESHES:
        for kind in zoo.CREASES:
            rows[name, kind] = row = measure(name, kind)
            print(f"{name}, {kind}: {row.position:.1e}, UVs {row.uv:.1e}", flush=True)
    found = {
        "best positions": table({key: f"{row.position:.0e}" for key, row in rows.items()}),
        "best uvs": table({key: f"{row.uv:.0e}" for key, row in rows.items()}),
        "lagging": lagging_table(rows),
        "default positions": table(
            {k: f"{r.default_position:.0e} ({r.default_mean:.0e})" for k, r in rows.items()}
        ),
        "default uvs": table({key: f"{row.default_uv:.0e}" for key, row in rows.items()}),
    }
    tables.write("accuracy.md", found, folder)
    beyond = [key for key, row in rows.items() if max(row.position, row.uv) > BOUND]
    if beyond:
        names = "; ".join(", ".join(key) for key in beyond)
        raise NotDrawnError(
            f"The distances at the best quality are more than rounding errors: {names}"
        )
