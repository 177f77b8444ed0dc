# SPDX-License-Identifier: Apache-2.0
"""What pickles hold: it comes back to the bit, and what is no state is an error with a reason."""

import copy
import pickle

import limitsurf as ls
import numpy as np
import pytest
from hypothesis import strategies as st
from pickle_target import restored
from random_meshes import cages, holds_for, one_of, places, same_bits, seeds, whole

PROTOCOLS = range(2, pickle.HIGHEST_PROTOCOL + 1)

# What could stand where an array, a name or a tuple of arrays belongs.
strange = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**70), 2**70),
    st.floats(),
    st.text(max_size=4),
    st.binary(max_size=8),
    st.just(()),
    st.lists(st.integers(-3, 12), max_size=9),
    st.lists(st.floats(), max_size=9),
    st.lists(st.lists(st.floats(allow_nan=True), min_size=3, max_size=3), max_size=6),
    st.tuples(st.lists(st.integers(-1, 9), max_size=4), st.lists(st.floats(), max_size=4)),
    st.builds(np.zeros, st.sampled_from([(0,), (0, 3), (4, 3), (2, 2, 2), ()])),
    st.builds(lambda n: np.full(n, 2**31, np.uint64), st.integers(0, 5)),
)


def check_use(mesh):
    """A mesh that was accepted can be used as any other."""
    try:
        surface = ls.LimitSurface(mesh)
    except ls.MeshError:
        return
    face, uv = places(surface, 10, 0)
    assert np.isfinite(surface.evaluate(face, uv).position).all()


@holds_for(cage=cages(), seed=seeds, protocol=one_of(PROTOCOLS))
def test_pickles_come_back_to_the_bit(cage, seed, protocol):
    surface = cage.surface()
    surface.set_positions(cage.positions[::-1].copy() * 1.25)
    for again in (pickle.loads(pickle.dumps(surface, protocol)), copy.deepcopy(surface)):
        assert again.refused == surface.refused
        assert same_bits(again.positions, surface.positions)
        at = places(surface, 40, seed)
        assert same_bits(again.evaluate(*at, 2), surface.evaluate(*at, 2))
        assert same_bits(again.frames(*at), surface.frames(*at))
        points = np.random.default_rng(seed).normal(size=(10, 3))
        assert same_bits(again.closest(points), surface.closest(points))
    mesh, again = surface.mesh, pickle.loads(pickle.dumps(surface.mesh, protocol))
    for ours, theirs in zip(mesh.__getstate__(), again.__getstate__(), strict=True):
        parts = zip(ours, theirs, strict=True) if isinstance(ours, tuple) else [(ours, theirs)]
        assert all(np.array_equal(one, other) for one, other in parts)


@holds_for(cage=cages(), place=whole(0, 9), part=strange)
def test_a_mesh_of_a_changed_state_is_refused_or_whole(cage, place, part):
    state = list(cage.mesh().__getstate__())
    state[place] = part
    mesh = restored(ls.ControlMesh, tuple(state))
    if mesh is not None:
        check_use(mesh)


@holds_for(cage=cages(), place=whole(0, 4), index=seeds, value=st.integers(-(2**63), 2**63 - 1))
def test_a_mesh_with_a_changed_number_is_refused_or_whole(cage, place, index, value):
    state = list(copy.deepcopy(cage.mesh().__getstate__()))
    array = state[place][index % 2] if isinstance(state[place], tuple) else state[place]
    if not array.size:
        return
    with np.errstate(all="ignore"):
        array.reshape(-1)[index % array.size] = np.array(value).astype(array.dtype)
    mesh = restored(ls.ControlMesh, tuple(state))
    if mesh is not None:
        check_use(mesh)


@holds_for(cage=cages(), parts=st.lists(strange, max_size=12))
def test_what_is_no_state_is_refused(cage, parts):
    assert restored(ls.ControlMesh, tuple(parts)) is None
    assert restored(ls.LimitSurface, tuple(parts)) is None
    assert restored(ls.LimitSurface, (cage.mesh(), *parts[:2])) is None or len(parts) == 1


@holds_for(
    cage=cages(),
    cut=st.floats(0, 1),
    flips=st.lists(st.tuples(seeds, st.integers(1, 255)), max_size=3),
)
def test_broken_bytes_are_errors(cage, cut, flips):
    """Of the parts that are ours: the objects' states. (Bytes that name other functions are
    pickle's affair.)
    """
    whole = pickle.dumps([np.asarray(part) for part in cage.mesh().__getstate__()[:3]])
    broken = bytearray(whole[: int(cut * len(whole))])
    with pytest.raises((pickle.UnpicklingError, EOFError)):
        pickle.loads(bytes(broken) if cut < 1 else b"")
    positions, sizes, vertices = (
        bytearray(np.asarray(part).tobytes()) for part in pickle.loads(whole)
    )
    for place, change in flips:
        for data in (positions, sizes, vertices):
            data[place % len(data)] ^= change
    state = list(cage.mesh().__getstate__())
    state[0] = np.frombuffer(positions).reshape(-1, 3)
    state[1], state[2] = (np.frombuffer(data, np.int32) for data in (sizes, vertices))
    mesh = restored(ls.ControlMesh, tuple(state))
    if mesh is not None:
        check_use(mesh)
