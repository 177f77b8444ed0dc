#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Turns golden values of the limit surface from JSON into the compact files the tests read.

    tools/compact_golden.py JSON_FOLDER native/tests/data/golden

The format is described in native/tests/data/golden/README.md. Every double keeps its bits: each
file is read back after it is written and compared with its JSON.
"""

import argparse
import json
import struct
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "native/python/tests"))
from golden import path_of, read_golden  # noqa: E402

QUANTITIES = ("position", "du", "dv", "duu", "duv", "dvv", "normal")
NONE, STORED, AS_BASE = 0, 1, 2


def base_name(name: str, names: set[str]) -> str:
    """Returns the name of the mesh that differs only by its boundary rule; most of its values are
    the same.
    """
    if name.startswith("boundary_corners_"):
        twin = name.replace("boundary_corners_", "boundary_smooth_")
    elif name.endswith("_corners"):
        twin = name.removesuffix("_corners") + "_smooth"
    else:
        return ""
    return twin if twin in names else ""


def row_bytes(row) -> bytes | None:
    return None if row is None else struct.pack("<3d", *row)


def encode(mesh: dict, base: dict | None) -> bytes:
    uv_rows = [tuple(map(float, uv)) for uv in mesh["uv"]]
    uv_table = list(dict.fromkeys(uv_rows))
    uv_index = {uv: i for i, uv in enumerate(uv_table)}
    same_samples = base is not None and base["face"] == mesh["face"] and base["uv"] == mesh["uv"]

    states = []
    values = []
    for sample in range(len(mesh["face"])):
        state = 0
        for shift, quantity in enumerate(QUANTITIES):
            row = row_bytes(mesh[quantity][sample])
            if row is None:
                code = NONE
            elif same_samples and row == row_bytes(base[quantity][sample]):
                code = AS_BASE
            else:
                code = STORED
                values.append(row)
            state |= code << (2 * shift)
        states.append(state)

    edges, vertices = mesh["edge_sharpness"], mesh["vertex_sharpness"]
    header = {
        "name": mesh["name"],
        "boundary": mesh["boundary"],
        "creasing": mesh["creasing"],
        "triangles": mesh["triangles"],
        "base": base["name"] if same_samples else "-",
        "positions": len(mesh["positions"]),
        "faces": len(mesh["faces"]),
        "face_vertices": sum(map(len, mesh["faces"])),
        "sharp_edges": len(edges),
        "sharp_vertices": len(vertices),
        "uvs": len(uv_table),
        "samples": len(states),
        "values": len(values),
    }
    text = "limitsurf-golden 1\n" + "".join(f"{k} {v}\n" for k, v in header.items()) + "end\n"
    arrays = [
        np.array(mesh["positions"], "<f8"),
        np.array([len(face) for face in mesh["faces"]], "<i4"),
        np.array([vertex for face in mesh["faces"] for vertex in face], "<i4"),
        np.array([edge[:2] for edge in edges], "<i4"),
        np.array([edge[2] for edge in edges], "<f8"),
        np.array([vertex[0] for vertex in vertices], "<i4"),
        np.array([vertex[1] for vertex in vertices], "<f8"),
        np.array(uv_table, "<f8"),
        np.array(mesh["face"], "<u2"),
        np.array([uv_index[uv] for uv in uv_rows], "<u2"),
        np.array(states, "<u2"),
    ]
    return text.encode("ascii") + b"".join(a.tobytes() for a in arrays) + b"".join(values)


def check(folder: Path, name: str, mesh: dict) -> None:
    """Reads the file as the Python tests do and compares every bit."""
    read = read_golden(path_of(name, folder))
    for quantity in QUANTITIES:
        for sample, row in enumerate(mesh[quantity]):
            expected = struct.pack("<3d", *(row or [np.nan] * 3))
            if read.values[quantity][sample].astype("<f8").tobytes() != expected:
                raise SystemExit(f"{name}: {quantity} of sample {sample} does not round-trip")
    same = (
        [list(face) for face in read.faces] == mesh["faces"]
        and np.array_equal(read.positions, np.array(mesh["positions"], float))
        and np.array_equal(read.uv, np.array(mesh["uv"], float))
        and np.array_equal(read.face, mesh["face"])
        and [
            [*e, s]
            for e, s in zip(read.sharp_edges.tolist(), read.edge_values.tolist(), strict=True)
        ]
        == mesh["edge_sharpness"]
        and [
            [v, s]
            for v, s in zip(read.sharp_vertices.tolist(), read.vertex_values.tolist(), strict=True)
        ]
        == mesh["vertex_sharpness"]
    )
    if not same:
        raise SystemExit(f"{name}: mesh or locations do not round-trip")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("json_folder", type=Path)
    parser.add_argument("out_folder", type=Path)
    arguments = parser.parse_args()

    meshes = {}
    for path in sorted(arguments.json_folder.glob("*.json")):
        meshes[path.stem] = {**json.loads(path.read_text()), "name": path.stem}
    for name, mesh in meshes.items():
        base = meshes.get(base_name(name, set(meshes)))
        path = path_of(name, arguments.out_folder)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(encode(mesh, base))
    total = 0
    for name, mesh in meshes.items():
        check(arguments.out_folder, name, mesh)
        total += path_of(name, arguments.out_folder).stat().st_size
    print(f"{len(meshes)} meshes, {total / 1e6:.2f} MB, read back bit for bit")


if __name__ == "__main__":
    main()
