# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows that follow each other end to end: their first elements, and each element's neighbours."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from limit_surface.reading import ragged_rows

sizes_of_rows = st.lists(st.integers(1, 9), max_size=12).map(lambda s: np.array(s, np.int32))


def rows_of(sizes):
    """Returns the elements of each row, collected one by one."""
    rows, count = [], 0
    for size in sizes.tolist():
        rows.append(list(range(count, count + size)))
        count += size
    return rows


@given(sizes_of_rows)
def test_starts_and_places(sizes):
    rows = rows_of(sizes)
    assert ragged_rows.starts(sizes).tolist() == [row[0] for row in rows]
    assert ragged_rows.places(sizes).tolist() == [i for row in rows for i in range(len(row))]


@given(sizes_of_rows)
def test_neighbours_within_a_row(sizes):
    rows = rows_of(sizes)
    after = [row[(i + 1) % len(row)] for row in rows for i in range(len(row))]
    before = [row[i - 1] for row in rows for i in range(len(row))]
    assert ragged_rows.following(sizes).tolist() == after
    assert ragged_rows.preceding(sizes).tolist() == before
