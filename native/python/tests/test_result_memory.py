# SPDX-License-Identifier: Apache-2.0
"""The memory of large results, which later results use again."""

import pickle
import subprocess
import sys
import tracemalloc

import limitsurf
import numpy as np
import pytest
import shapes

ROWS = 50_000  # 1.2 MB of positions


def evaluated(surface: limitsurf.LimitSurface, u: float, rows: int = ROWS) -> limitsurf.Evaluation:
    return surface.evaluate(np.zeros(rows, np.int32), np.full((rows, 2), u), 1)


@pytest.fixture
def surface() -> limitsurf.LimitSurface:
    return limitsurf.LimitSurface(limitsurf.ControlMesh.from_faces(*shapes.cube()))


def addresses(result: limitsurf.Evaluation) -> set[int]:
    arrays = (result.position, result.du, result.dv, result.normal)
    return {array.ctypes.data for array in arrays if array is not None}


def test_later_results_take_the_memory_of_freed_ones(surface):
    freed = addresses(evaluated(surface, 0.25))
    assert len(freed) == 4
    assert addresses(evaluated(surface, 0.5)) == freed


def test_results_of_almost_the_same_size_share_memory(surface):
    freed = addresses(evaluated(surface, 0.25))
    assert addresses(evaluated(surface, 0.25, ROWS - 1)) == freed


def test_a_view_keeps_its_memory(surface):
    view = evaluated(surface, 0.25).position[7:, 1:]
    expected = view.copy()
    others = [evaluated(surface, u) for u in (0.5, 0.75)]
    assert np.array_equal(view, expected)
    assert all(not np.shares_memory(view, other.position) for other in others)


def test_a_result_is_an_array_like_others(surface):
    array = evaluated(surface, 0.25).position
    assert type(array) is np.ndarray
    assert array.flags.c_contiguous
    assert array.flags.writeable
    assert array.flags.aligned
    assert array.flags.owndata
    array.setflags(write=False)
    array.setflags(write=True)
    array += 1
    assert np.array_equal(pickle.loads(pickle.dumps(array)), array)


@pytest.mark.parametrize("rows", [ROWS // 100, 3 * ROWS])
def test_a_result_can_be_resized(surface, rows):
    array = evaluated(surface, 0.25).position
    before = array.copy()
    array.resize((rows, 3), refcheck=False)
    both = min(rows, ROWS)
    assert np.array_equal(array[:both], before[:both])
    assert not array[both:].any()


def test_arrays_of_others_have_memory_of_numpy(surface):
    freed = addresses(evaluated(surface, 0.25))
    others = [np.empty((ROWS, 3)) for _ in range(8)]
    assert not freed & {array.ctypes.data for array in others}


def test_tracemalloc_counts_results_as_it_counts_arrays_of_numpy(surface):
    domain = [tracemalloc.DomainFilter(inclusive=True, domain=np.lib.tracemalloc_domain)]
    tracemalloc.start()
    try:
        result = evaluated(surface, 0.25)
        snapshot = tracemalloc.take_snapshot().filter_traces(domain)
        counted = sum(trace.size for trace in snapshot.traces)
        del result
        freed = tracemalloc.take_snapshot().filter_traces(domain)
    finally:
        tracemalloc.stop()
    assert counted >= 4 * 24 * ROWS
    assert sum(trace.size for trace in freed.traces) < 10_000


FREED = """
import os
import limitsurf, numpy as np, shapes
from pathlib import Path

def resident():
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

surface = limitsurf.LimitSurface(limitsurf.ControlMesh.from_faces(*shapes.cube()))
before = resident()
results = [surface.evaluate(np.zeros(n, np.int32), np.full((n, 2), 0.5)).position
           for n in range(10_000, 1_000_000, 30_000)]
held = resident() - before
del results
print(held >> 20, (resident() - before) >> 20)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_little_memory_of_freed_results_is_kept():
    path = str(shapes.__file__).rsplit("/", 1)[0]
    program = f"import sys; sys.path.insert(0, {path!r}){FREED}"
    text = subprocess.run(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, check=True
    ).stdout
    held, kept = (int(mib) for mib in text.split())
    assert held > 300  # the results have 370 MiB
    assert kept < 64 + 32  # what is kept of them, and the library's own
