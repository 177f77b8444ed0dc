# SPDX-License-Identifier: Apache-2.0
"""Reads the golden values in native/tests/data/golden (its README.md describes the format)."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

FOLDER = Path(__file__).parents[2] / "tests" / "data" / "golden"
QUANTITIES = ("position", "du", "dv", "duu", "duv", "dvv", "normal")


@dataclass
class Golden:
    name: str
    boundary: str
    creasing: str
    triangles: str
    positions: np.ndarray
    faces: list
    sharp_edges: np.ndarray
    edge_values: np.ndarray
    sharp_vertices: np.ndarray
    vertex_values: np.ndarray
    face: np.ndarray
    uv: np.ndarray
    values: dict  # quantity -> (samples, 3), NaN where there is none


def names() -> list[str]:
    return sorted(path.stem for path in FOLDER.glob("*/*.golden"))


def family(name: str) -> str:
    """The sub-folder of a mesh: fans of all valences of one kind stand in one of their own."""
    return name.partition("_valence")[0] if "_valence" in name else "meshes"


def path_of(name: str, folder: Path = FOLDER) -> Path:
    return folder / family(name) / f"{name}.golden"


def read_golden(path: Path) -> Golden:
    data = path.read_bytes()
    text, _, _ = data.partition(b"end\n")
    magic, *lines = text.decode("ascii").splitlines()
    if magic != "limitsurf-golden 1":
        raise ValueError(f"{path} is no golden file")
    header = dict(line.split(" ", 1) for line in lines)
    offset = len(text) + len(b"end\n")

    def take(dtype: str, count: int) -> np.ndarray:
        nonlocal offset
        array = np.frombuffer(data, dtype, count, offset)
        offset += array.nbytes
        return array.copy()

    n = {key: int(value) for key, value in header.items() if value.isdigit()}
    positions = take("<f8", 3 * n["positions"]).reshape(-1, 3)
    sizes = take("<i4", n["faces"])
    face_vertices = take("<i4", n["face_vertices"])
    sharp_edges = take("<i4", 2 * n["sharp_edges"]).reshape(-1, 2)
    edge_values = take("<f8", n["sharp_edges"])
    sharp_vertices = take("<i4", n["sharp_vertices"])
    vertex_values = take("<f8", n["sharp_vertices"])
    uvs = take("<f8", 2 * n["uvs"]).reshape(-1, 2)
    face = take("<u2", n["samples"]).astype(np.int32)
    uv = uvs[take("<u2", n["samples"])]
    states = take("<u2", n["samples"])
    stored = take("<f8", 3 * n["values"]).reshape(-1, 3)
    if offset != len(data):
        raise ValueError(f"{path} has {len(data) - offset} bytes too many")

    codes = (states[:, None] >> (2 * np.arange(len(QUANTITIES)))) & 3
    table = np.full((len(states), len(QUANTITIES), 3), np.nan)
    table[codes == 1] = stored
    if header["base"] != "-":
        base = read_golden(path_of(header["base"], path.parents[1]))
        others = np.stack([base.values[quantity] for quantity in QUANTITIES], axis=1)
        table[codes == 2] = others[codes == 2]

    return Golden(
        header["name"],
        header["boundary"],
        header["creasing"],
        header["triangles"],
        positions,
        [part.tolist() for part in np.split(face_vertices, np.cumsum(sizes)[:-1])],
        sharp_edges,
        edge_values,
        sharp_vertices,
        vertex_values,
        face,
        uv,
        {quantity: table[:, i] for i, quantity in enumerate(QUANTITIES)},
    )
