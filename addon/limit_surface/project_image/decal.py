# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons on the limit surface under an image: the points at which a grid of rays through the
image arrives, cut off exactly where the surface ends, turns away or hides itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..reading import ragged_rows
from ..tasks.job import Progress
from .rays import Hits, Rays, joined

# parts of the progress: for the grid, and for each end of the quads' sides
CAST, HALVED = 0.2, 0.35

# The corners of a quad, counter-clockwise from the lower left: their columns and rows relative to
# it
CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))


@dataclass(frozen=True)
class Decal:
    hits: Hits  # each hit is a vertex
    sizes: np.ndarray  # number of corners of each polygon
    vertices: np.ndarray  # the vertices of all corners, counter-clockwise in the image


@dataclass(frozen=True)
class Quads:
    """The quads of the grid of rays. Side i leads from corner i to the next."""

    corner: np.ndarray  # (n, 4) vertices
    valid: np.ndarray  # (n, 4) whether the corner lies on the surface
    goes_on: np.ndarray  # (n, 4) whether the surface goes on along the side
    here: np.ndarray  # (n, 4) vertices at which it ends, seen from the side's first corner,
    there: np.ndarray  # and from its second; -1 where it does not end


def make(rays: Rays, quads: tuple[int, int], progress: Progress) -> Decal:
    """Makes the decal on a grid of so many columns and rows of quads."""
    columns, rows = quads
    y, x = np.mgrid[: rows + 1, : columns + 1].reshape(2, -1)
    grid = rays.cast(np.stack([x / columns, y / rows], axis=1))
    progress(CAST)
    number = np.arange(len(grid)).reshape(rows + 1, columns + 1)
    along_rows = np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=1)
    along_columns = np.stack([number[:-1].ravel(), number[1:].ravel()], axis=1)
    sides = np.concatenate([along_rows, along_columns])

    goes_on, ends, parts = np.zeros(len(sides), bool), np.full((len(sides), 2), -1), [grid]
    for end in (0, 1):
        looked_at = np.flatnonzero(grid.valid[sides[:, end]] & ~goes_on)
        start, stop = (grid.take(sides[looked_at, some]) for some in (end, 1 - end))
        goes_on[looked_at], last = rays.furthest(start, stop)
        cut = ~goes_on[looked_at]
        ends[looked_at[cut], end] = sum(map(len, parts)) + np.arange(cut.sum())
        parts.append(last.take(cut))
        progress(CAST + HALVED * (end + 1))

    corner = np.stack([number[r : rows + r, c : columns + c].ravel() for c, r in CORNERS], axis=1)
    below = np.arange(len(along_rows)).reshape(rows + 1, columns)
    left = len(along_rows) + np.arange(len(along_columns)).reshape(rows, columns + 1)
    side = np.stack([below[:-1], left[:, 1:], below[1:], left[:, :-1]]).reshape(4, -1).T
    here, there = ends[side, 0], ends[side, 1]
    # The upper and the left side are stored in the direction opposite to that around the quad.
    here[:, 2:], there[:, 2:] = ends[side[:, 2:], 1], ends[side[:, 2:], 0]
    found = Quads(corner, grid.valid[corner], goes_on[side], here, there)
    return _polygons(rays, joined(parts), found)


def sag(rays: Rays, decal: Decal) -> float:
    """Returns how far the middle of a polygon with four corners lies below the surface, at most."""
    first = ragged_rows.starts(decal.sizes)[decal.sizes == 4]
    quads = decal.vertices[first[:, None] + np.arange(4)]
    middle = rays.cast(decal.hits.st[quads].mean(axis=1))
    below = middle.position - decal.hits.position[quads].mean(axis=1)
    depth = middle.facing * np.einsum("ij,ij->i", below, middle.normal)
    return float(depth[middle.valid].max(initial=0))


def _polygons(rays: Rays, hits: Hits, quads: Quads) -> Decal:
    whole = quads.goes_on.all(axis=1)
    slit, hits = _around_slits(rays, hits, quads)
    found = [quads.corner[whole], *_runs(quads), slit]
    sizes = np.concatenate([np.full(len(some), some.shape[1]) for some in found])
    used, vertices = np.unique(np.concatenate([f.ravel() for f in found]), return_inverse=True)
    return Decal(hits.take(used), sizes, vertices.ravel())


def _runs(quads: Quads) -> list[np.ndarray]:
    """Yields the polygon of each run of corners between which the surface goes on, with the points
    at which it ends before and after.
    """
    found = []
    for first in range(4):
        begins = quads.valid[:, first] & ~quads.goes_on[:, first - 1]
        for length in (1, 2, 3):
            of = [(first + k) % 4 for k in range(length)]
            runs = begins & quads.goes_on[:, of[:-1]].all(axis=1) & ~quads.goes_on[:, of[-1]]
            before, after = quads.there[runs, first - 1], quads.here[runs, of[-1]]
            found.append(np.column_stack([before, quads.corner[runs][:, of], after]))
    return found


def _around_slits(rays: Rays, hits: Hits, quads: Quads) -> tuple[np.ndarray, Hits]:
    """Returns triangles of the quads in which the surface ends on one side only. They join the
    middle and the quad's outline, as far as the surface goes on from the middle.
    """
    quad, side = np.nonzero(~quads.goes_on & (quads.goes_on.sum(axis=1) == 3)[:, None])
    corner = np.take_along_axis(quads.corner[quad], (side[:, None] + np.arange(4)) % 4, axis=1)
    middle = rays.cast(hits.st[corner].mean(axis=1))
    outline = np.column_stack(
        [quads.there[quad, side], np.roll(corner, -1, axis=1), quads.here[quad, side]]
    )
    number = len(hits) + np.arange(len(quad))
    spokes = np.repeat(np.arange(len(quad)), outline.shape[1])
    reached = np.zeros(len(spokes), bool)
    looked_at = np.flatnonzero(middle.valid[spokes])
    ends = hits.take(outline.ravel()[looked_at])
    reached[looked_at] = rays.furthest(middle.take(spokes[looked_at]), ends)[0]
    reached = reached.reshape(outline.shape)
    kept = reached[:, :-1] & reached[:, 1:]
    triangles = np.stack(
        [np.broadcast_to(number[:, None], kept.shape), outline[:, :-1], outline[:, 1:]], axis=-1
    )
    return triangles[kept], joined([hits, middle])
