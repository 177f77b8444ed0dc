# SPDX-License-Identifier: GPL-3.0-or-later
"""Strokes as the operator's properties keep them."""

import numpy as np
from limit_surface.draw import stroke
from limit_surface.draw.stroke import Stroke


class Points:
    """Stands in for a collection of LIMIT_PG_draw_point. It has no points by number, because
    Blender takes the longer for one the larger its number is: tens of thousands took minutes.
    """

    def __init__(self):
        self.clear()

    def __len__(self):
        return self.count

    def clear(self):
        self.count, self.values = 0, {}

    def add(self):
        self.count += 1

    def foreach_set(self, name, values):
        self.values[name] = np.array(values)

    def foreach_get(self, name, values):
        values[:] = self.values[name]


def made(count, is_closed):
    rng = np.random.default_rng(count)
    uv = rng.random((count, 2)).astype(np.float32)
    if is_closed:
        uv[-1] = uv[0]
    where = rng.random((count, 3))
    return Stroke(rng.integers(0, 9, count), uv, rng.random(count), where, where, is_closed)


def test_strokes_are_read_as_they_were_written():
    strokes, points = [made(5, False), made(4, True), made(2, False)], Points()
    stroke.write(strokes, points)
    assert len(points) == 5 + 3 + 2  # the repeated point of the closed stroke is left out
    assert stroke.count(points) == 3
    for before, (face, uv, radius, is_closed, _) in zip(strokes, stroke.read(points), strict=True):
        count = len(before) - before.is_closed
        assert is_closed == before.is_closed
        np.testing.assert_array_equal(face, before.face[:count])
        np.testing.assert_array_equal(uv, before.uv[:count])
        np.testing.assert_allclose(radius, before.radius[:count], rtol=1e-6)
    stroke.write([], points)
    assert stroke.read(points) == []
