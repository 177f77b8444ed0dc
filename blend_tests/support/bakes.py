# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes for tests: running the command, and reading what it has written."""

import os
import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np
import scenes
from limit_surface.bake_frames import command
from limit_surface.reading import attributes

SUPPORT = Path(__file__).resolve().parent


def bake(folder: Path, *objects: str, frames: str = "1-3", options: tuple[str, ...] = ()) -> int:
    """Runs the command on the open file and returns its exit code."""
    where = ("--output", str(folder))
    return command.main(["bake", f"--frames={frames}", "--objects", *objects, *where, *options])


def saved(folder: Path) -> Path:
    """Saves the open file, so that several jobs can bake it into the folder that is returned."""
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "shot.blend"))
    return folder / "caches"


def blender_executable(folder: Path) -> Path:
    """Makes a program that takes the arguments of Blender's executable."""
    program = folder / "blender"
    program.write_text(f'#!/bin/sh\nexec {sys.executable} {SUPPORT}/module_blender.py "$@"\n')
    program.chmod(0o755)
    return program


def start(file: Path, *arguments: str) -> subprocess.Popen[str]:
    """Starts the command in a process of its own."""
    program = (sys.executable, SUPPORT / "module_blender.py", "-b", file)
    return subprocess.Popen(
        [*program, "--command", "limit_surface", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
    )


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def read_back(path: Path, kind: str) -> np.ndarray:
    """Imports a cache by Blender, or reads the arrays, and returns the positions in the world of
    its object of this kind ("CURVES" or "MESH").
    """
    if path.suffix == ".npz":
        with np.load(path) as arrays:
            return scenes.transformed(arrays["matrix_world"], arrays["position"])
    before = set(bpy.data.objects)
    if path.suffix == ".abc":
        bpy.ops.wm.alembic_import(
            filepath=str(path), as_background_job=False, set_frame_range=False
        )
    else:
        bpy.ops.wm.usd_import(filepath=str(path), set_frame_range=False)
    new = set(bpy.data.objects) - before
    (found,) = (ob for ob in new if ob.type == kind)
    evaluated = found.evaluated_get(bpy.context.evaluated_depsgraph_get())
    positions = attributes.read(evaluated.data, "position").astype(np.float64)
    result = scenes.transformed(evaluated.matrix_world, positions)
    for ob in new:
        bpy.data.objects.remove(ob)
    return result


def geometry_tree(name):
    """Returns a tree of Geometry Nodes for a modifier, its input and its output."""
    tree = bpy.data.node_groups.new(name, "GeometryNodeTree")
    tree.is_modifier = True
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("G", in_out=direction, socket_type="NodeSocketGeometry")
    return tree, tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
