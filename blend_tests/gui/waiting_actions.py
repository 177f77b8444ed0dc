# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions for the window tests of work that takes long."""

import gc

import bpy
import numpy as np
from actions import activate, remember, sheet
from texture_actions import start

EXTENSION = "bl_ext.user_default.limit_surface"
KEPT = []  # filled by keep_job


def keep_job() -> None:
    """Keeps the one job that runs, also where the extension forgets it."""
    (job,) = (
        each
        for each in gc.get_objects()
        if type(each).__name__ == "Job" and type(each).__module__.startswith(EXTENSION)
        if not each.is_done
    )
    KEPT.append(job)


def kept_job_is_cancelled() -> bool:
    return KEPT[-1]._cancelled.is_set()


def points_above_sheet(count: int) -> None:
    """Adds so many loose vertices above a bent sheet, which is active, and selects both."""
    sheet()
    mesh = bpy.data.meshes.new("Cloud")
    mesh.vertices.add(count)
    at = np.random.default_rng(1).uniform((-3, -2, 0), (4, 4, 2), (count, 3))
    mesh.vertices.foreach_set("co", at.astype(np.float32).ravel())
    _add_to_sheet("Cloud", mesh)


def lines_above_sheet(count: int) -> None:
    """Adds a curve of so many splines above a bent sheet, which is active, and selects both."""
    sheet()
    curve = bpy.data.curves.new("Lines", "CURVE")
    curve.dimensions = "3D"
    for ends in np.random.default_rng(1).uniform((-1, -1, 0), (3, 3, 2), (count, 2, 3)):
        spline = curve.splines.new("POLY")
        spline.points.add(1)
        spline.points.foreach_set("co", np.insert(ends, 3, 1, axis=1).ravel())
    _add_to_sheet("Lines", curve)


def _add_to_sheet(name: str, data: bpy.types.ID) -> None:
    ob = bpy.data.objects.new(name, data)
    ob.display_type = "BOUNDS"  # drawing so many takes long without a graphics card
    bpy.context.scene.collection.objects.link(ob)
    activate(ob, bpy.data.objects["Sheet"])


def remember_and_start(operator: str) -> None:
    """Starts the operator after a step for undo."""
    remember()
    start(operator)


def parts_of_file() -> dict[str, object]:
    """Returns what the file has: all data-blocks by name, and what objects consist of."""
    kinds = [p.identifier for p in bpy.data.bl_rna.properties if p.type == "COLLECTION"]
    blocks = {kind: getattr(bpy.data, kind) for kind in kinds}
    found: dict[str, object] = {kind: sorted(b.name for b in blocks[kind]) for kind in kinds}
    for ob in bpy.data.objects:
        attributes = getattr(ob.data, "attributes", None)
        names = sorted(attributes.keys()) if attributes else []
        found[f"object {ob.name}"] = [[m.name for m in ob.modifiers], names]
        if ob.type == "CURVE":
            found[f"curve {ob.name}"] = [len(s.points or s.bezier_points) for s in ob.data.splines]
    return found
