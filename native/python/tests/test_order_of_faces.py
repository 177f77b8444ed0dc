# SPDX-License-Identifier: Apache-2.0
"""Where the order of faces decides about face-varying data, as the docstring of face_varying()
says: OpenSubdiv goes counter-clockwise around a vertex inside, from the face of the lowest number.
"""

import itertools

import limitsurf as ls
import numpy as np
import pytest

PLACES = np.array([[0.3, 0.4], [0.9, 0.8], [0, 0], [1, 0], [0, 1]])


def fan(valence, closed):
    """Positions, and the quads around vertex 0, counter-clockwise."""
    rim = 2 * valence + (not closed)
    angles = 2 * np.pi * np.arange(rim) / rim
    positions = np.array([[0, 0, 0.5], *((np.cos(a), np.sin(a), 0) for a in angles)])
    quads = [[0, 1 + 2 * i, 2 + 2 * i, 1 + (2 * i + 2) % rim] for i in range(valence)]
    return positions, np.array(quads)


def values_of(valence, closed, rows, rule, order):
    """The data at places of each quad; rows[i] is the row of quad i at the vertex."""
    positions, quads = fan(valence, closed)
    indices = quads.copy()
    indices[:, 0] = len(positions) + np.array(rows)
    values = np.random.default_rng(1).random((len(positions) + valence, 2))
    order = np.array(order)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, quads[order]))
    data = surface.face_varying(values, indices[order].ravel(), rule)
    face = np.repeat(np.argsort(order), len(PLACES))
    return data.evaluate(face, np.tile(PLACES, (valence, 1))).value


def patterns(valence):
    """Every way to share three rows out among the quads, but for the rows' names."""
    for rest in itertools.product(range(3), repeat=valence - 1):
        rows = (0, *rest)
        if all(row <= max(rows[:i]) + 1 for i, row in enumerate(rows) if i > 0):
            yield rows


def runs_of(rows):
    """(row, number of faces) of each run around the vertex."""
    start = next((i for i in range(len(rows)) if rows[i] != rows[i - 1]), 0)
    turned = rows[start:] + rows[:start]
    return [(row, len(list(faces))) for row, faces in itertools.groupby(turned)]


def depends_on_order(rows, rule):
    """Whether there are runs A, B, A, B. By 'corners_only' a part of B that OpenSubdiv takes for a
    row of its own must also have more than one face.
    """
    runs = runs_of(rows)
    if len(runs) < 4:
        return False
    for i in range(len(runs)):
        (a, _), (b, first), (c, _), (d, last) = (runs[(i + j) % len(runs)] for j in range(4))
        other = sum(row == b for row, _ in runs) > 2
        if a == c and b == d and (rule == "none" or last > 1 or (first > 1 and not other)):
            return True
    return False


def turned(valence, by):
    return [(i + by) % valence for i in range(valence)]


@pytest.mark.parametrize("rule", ["none", "corners_only"])
@pytest.mark.parametrize("valence", [3, 4, 5, 6, 7])
def test_where_the_order_of_faces_decides(valence, rule):
    for rows in patterns(valence):
        results = [
            values_of(valence, True, rows, rule, turned(valence, by)) for by in range(valence)
        ]
        differ = any(abs(found - results[0]).max() > 1e-12 for found in results)
        assert differ == depends_on_order(rows, rule), rows


@pytest.mark.parametrize("rule", ["none", "corners_only"])
def test_only_the_face_of_the_lowest_number_decides(rule):
    rng = np.random.default_rng(2)
    for rows in patterns(5):
        order = rng.permutation(5)
        np.testing.assert_allclose(
            values_of(5, True, rows, rule, order),
            values_of(5, True, rows, rule, turned(5, order[0])),
            atol=1e-13,
        )


@pytest.mark.parametrize(
    ("rule", "closed"),
    [
        ("corners_plus1", True),
        ("corners_plus2", True),
        ("boundaries", True),
        ("all", True),
        ("none", False),
        ("corners_only", False),
    ],
)
def test_where_the_order_of_faces_never_decides(rule, closed):
    for rows in patterns(5):
        results = [values_of(5, closed, rows, rule, turned(5, by)) for by in range(5)]
        np.testing.assert_allclose(results[1:], np.array(results[:1] * 4), atol=1e-13)
