# SPDX-License-Identifier: Apache-2.0
import sys
from pathlib import Path

import limitsurf as ls
import numpy as np
import pytest
import shapes

# The fuzzers' target of pickles.
sys.path.append(str(Path(__file__).resolve().parents[2] / "fuzz"))


@pytest.fixture(params=sorted(shapes.ALL))
def mesh(request):
    return ls.ControlMesh.from_faces(*shapes.ALL[request.param])


@pytest.fixture
def surface(mesh):
    return ls.LimitSurface(mesh)


@pytest.fixture
def cube():
    return ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.cube()))


@pytest.fixture
def anywhere():
    """anywhere(surface, n): n random locations."""

    def locations(surface, n, seed=0):
        rng = np.random.default_rng(seed)
        return rng.integers(0, surface.face_count, n), rng.random((n, 2))

    return locations
