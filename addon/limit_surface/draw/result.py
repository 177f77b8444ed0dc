# SPDX-License-Identifier: GPL-3.0-or-later
"""From strokes to objects in the file."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import bpy
import numpy as np

from .. import native
from ..counting import counted
from ..errors import RefusalError
from . import curve_object, guides, stroke
from .fitting import Fit, Spline
from .ground import Ground
from .stroke import Stroke


def read_strokes(
    points: bpy.types.bpy_prop_collection, ground: Ground, tolerance: float
) -> list[Stroke]:
    """Returns the strokes of an operator's property, laid onto the surface between their points.
    Those whose points are all at one place are left out, like those of one point. Raises
    RefusalError for points that have no place on the surface.
    """
    found = []
    for face, uv, radius, is_closed, first in stroke.read(points):
        if np.isnan(radius).any():
            raise RefusalError("The radius of a point is not a number")
        with native.rows_called(partial(_point_called, first)):
            begun = ground.stroke(face, uv.astype(np.float64), radius)
        if np.ptp(begun.position.astype(np.float32), axis=0).any():
            found += ground.lay(begun.position, radius, tolerance, is_closed)
    if points and not found:
        raise RefusalError("A stroke needs at least two different points")
    return found


def with_mirror_images(
    operator: bpy.types.Operator, strokes: list[Stroke], ground: Ground, tolerance: float
) -> list[Stroke]:
    """Returns each stroke and its mirror image, and says it where the surface has no place for
    it.
    """
    found, lacking = [], 0
    for each in strokes:
        images, is_whole = ground.mirror_image(each, tolerance)
        found += [each, *images]
        lacking += not is_whole
    if lacking:
        have = counted(lacking, "strokes", "has", "have")
        operator.report(
            {"WARNING"},
            f"{have} no mirror image or only a part of it, because {ground.ob.name} has no surface "
            "at the mirrored place",
        )
    return found


def _point_called(first: int, row: int) -> str:
    return f"Point {first + row} of the strokes"


def make(
    context: bpy.types.Context,
    ground: Ground,
    edited: bpy.types.Object | None,
    strokes: Sequence[Stroke],
    removed: Sequence[int],
    how: Any,
) -> str:
    """Makes an object of the strokes, or changes the one that is edited. `how` holds the
    operator's properties. Returns the summary.
    """
    if edited is None and how.output == "GUIDES":
        guides.add_new(context, ground, strokes, how.points, how.offset, how.radius, how.follow)
        return f"{counted(len(strokes), 'guide strands')} on {ground.ob.name}"
    tolerance = ground.tolerance(how.tolerance)
    fit = Fit(how.spline, tolerance, how.offset)
    matrix = np.array((edited or ground.ob).matrix_world, np.float64)
    made = [fit.spline(each, ground, matrix) for each in strokes]
    if edited is None:
        thickness = curve_object.Thickness(how.radius, how.bevel_resolution)
        edited = curve_object.add_new(context, ground, made, thickness, how.follow)
    else:
        check_numbers(edited, removed)
        curve_object.change(context, edited, ground, removed, made)
    curve_object.store_offset(edited.data, how.offset)
    warn_of_deviation(how, tolerance, made)
    return summary(made, len(set(removed)), ground, how.offset)


def check_numbers(ob: bpy.types.Object, removed: Sequence[int]) -> None:
    count = len(ob.data.splines)
    for number in removed:
        if number >= count:
            raise RefusalError(f"{ob.name} has no spline {number}: it has {count}")


def summary(
    made: Sequence[Spline], removed: int, ground: Ground, offset: float, noun: str = "strokes"
) -> str:
    """Returns what was made; `noun` is what the new splines are called, in the plural."""
    if not made:
        return f"{counted(removed, 'splines')} removed"
    points = sum(len(spline.position) for spline in made)
    farthest = max(spline.deviation for spline in made)
    made_of = f"{counted(len(made), noun)} with {points:,} control points"
    if offset:
        return (
            f"{made_of}, {offset:.4g} away from {ground.ob.name} along its normal, at most "
            f"{farthest:.2g} from there"
        )
    return f"{made_of} on {ground.ob.name}, at most {farthest:.2g} from its limit surface"


def warn_of_deviation(
    operator: bpy.types.Operator, tolerance: float, made: Sequence[Spline]
) -> None:
    """Says it where an offset is larger than the surface's hollows are wide: curves cannot keep it
    there.
    """
    farthest = max((spline.deviation for spline in made), default=0.0)
    if farthest > tolerance:
        operator.report(
            {"WARNING"},
            f"Curves are up to {farthest:.2g} from where they should run, more than the tolerance "
            f"{tolerance:.2g}: the offset is larger than the surface's hollows or than the gap to "
            "another part of the surface, or the tolerance is too small",
        )


def warn_of_pieces(
    operator: bpy.types.Operator, laid: int, given: int, noun: str = "strokes"
) -> None:
    """Says it where strokes or curves were divided, because no short path was found."""
    if laid > given:
        were = counted(laid, "pieces", "was", "were")
        operator.report(
            {"WARNING"},
            f"{were} made of {counted(given, noun)}, because no short path along the surface "
            "joins the pieces",
        )


def warn_of_modifiers(operator: bpy.types.Operator, curves: Sequence[bpy.types.Object]) -> None:
    """Says it where modifiers may show curves elsewhere. Geometry Nodes are left out: they carry
    the curve with its surface, or give it thickness.
    """
    for ob in curves:
        names = [m.name for m in ob.modifiers if m.show_viewport and m.type != "NODES"]
        if names:
            operator.report(
                {"WARNING"},
                f"The curve of {ob.name} itself lies on the surface. It is shown as its modifiers "
                f"change it: {', '.join(names)}",
            )
