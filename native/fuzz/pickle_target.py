# SPDX-License-Identifier: Apache-2.0
"""Turns a fuzzer's input into states of pickled objects, and checks what must hold of each: it is
refused with a reason, or it makes an object that can be used and pickled as any other.

The fuzzer limitsurf_fuzz_pickle calls `pickle_target` (python_fuzzer.cpp), and so do the module's
tests with the inputs of the corpus. Mutated bytes of pickles would mostly be errors of Python's
`pickle`; states are where the module's own code begins.
"""

import pickle
import struct
import warnings
from collections.abc import Callable
from functools import cache
from typing import Any

import limitsurf as ls
import numpy as np
import shapes

# Nothing else may come out of a state that makes no sense.
DOCUMENTED = (ValueError, TypeError)
LONGEST_MESSAGE = 1000  # characters

NUMBERS = ("f8", "f4", "f2", ">f8", "i8", "i4", "i1", "u8", "u4", ">i4")
DTYPES = (*NUMBERS, "?", "c16", "O", "U3", "M8[s]")
RULES = ("smooth", "corners", "uniform", "chaikin", "catmark", "bilinear", "SMOOTH", "")


class BrokenPropertyError(AssertionError):
    """A property that does not hold."""


def require(holds: bool, what: str) -> None:
    if not holds:
        raise BrokenPropertyError(what)


class ByteReader:
    """Reads the bytes of an input as numbers. After the last byte everything is 0."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    def byte(self) -> int:
        self._at += 1
        return self._data[self._at - 1] if self._at <= len(self._data) else 0

    def below(self, count: int) -> int:
        return self.byte() % count

    def one_of(self, choices: Any) -> Any:
        return choices[self.below(len(choices))]

    def integer(self) -> int:
        """Mostly a small one; sometimes at or beyond the ends of the types of integers."""
        kind = self.byte()
        if kind < 200:
            return kind - 20
        sign = 1 if kind % 2 else -1
        return sign * (1 << self.below(70)) + self.below(3) - 1

    def real(self) -> float:
        """Mostly of moderate size; sometimes with any bits at all."""
        kind = self.byte()
        if kind < 220:
            return (kind - 110) / 32
        return float(struct.unpack("d", bytes(self.byte() for _ in range(8)))[0])


@cache
def cages() -> tuple[ls.ControlMesh, ...]:
    """Valid meshes that together have every part of a state."""
    make: Callable[..., ls.ControlMesh] = ls.ControlMesh.from_faces
    grid, house = shapes.grid(2, 2), shapes.house()
    edges = [[0, 1], [1, 2], [1, 4]]
    return (
        make(*grid),
        make(*grid, edge_sharpness=(edges, [1.5, 0.25, 9]), creasing="chaikin"),
        make(*shapes.cube(), vertex_sharpness=([0, 3], [2, 10]), edge_sharpness=([[0, 1]], [3])),
        make(*house, holes=[3, 5], boundary="corners", triangles="smooth"),
        make(*house, scheme="bilinear"),
        make(*shapes.fan(5, closed=False)),
    )


def converted(array: Any, dtype: str) -> Any:
    """The array itself where numpy does not convert it, as text that is no number."""
    try:
        return array.astype(dtype)
    except (ValueError, TypeError, RuntimeError, OverflowError):
        return array


def array(read: ByteReader) -> Any:
    dtype = read.one_of(DTYPES)
    shape = tuple(read.below(6) for _ in range(read.below(4)))
    numbers = [read.real() if read.below(2) else read.integer() for _ in range(read.below(9))]
    return changed(read, converted(np.resize(np.array(numbers or [0], float), shape), dtype))


def changed(read: ByteReader, array: Any) -> Any:
    """The array, perhaps with a number, its type, its shape or its layout changed."""
    array = array.copy()
    for _ in range(read.below(4)):
        change = read.below(9)
        if change < 3 and array.size and array.dtype.kind in "fiu":
            value = np.array(read.real() if change else read.integer(), float)
            array.flat[read.byte() % array.size] = value.astype(array.dtype)
        elif change == 3:
            array = converted(array, read.one_of(DTYPES))
        elif change == 4:
            array = array.reshape(array.shape[::-1])
        elif change == 5:
            array = array[: read.below(9)] if array.ndim else array
        elif change == 6:
            array = array[::-1].T if array.ndim else array
        elif change == 7:
            array = np.ma.masked_array(array, mask=read.below(2) == 1)
        elif change == 8:
            array = np.repeat(array, 1 + read.below(3))
    return array


def anything(read: ByteReader, depth: int = 2) -> Any:
    """A value of any kind, where a state has an array, a pair of arrays, a name or a mesh."""
    make: tuple[Callable[[], Any], ...] = (
        lambda: None,
        lambda: bool(read.below(2)),
        read.integer,
        read.real,
        lambda: read.one_of(RULES),
        lambda: bytes(read.byte() for _ in range(read.below(6))),
        lambda: array(read),
        lambda: array(read),
        lambda: memoryview(bytes(read.below(7))),
        lambda: range(read.below(7)),
        lambda: {read.integer(): read.real()},
        lambda: read.one_of(cages()),
        lambda: ls.LimitSurface(read.one_of(cages())),
        lambda: ls.ControlMesh.__new__(ls.ControlMesh),
        lambda: [anything(read, depth - 1) for _ in range(read.below(6) if depth else 0)],
        lambda: tuple(anything(read, depth - 1) for _ in range(read.below(6) if depth else 0)),
    )
    return read.one_of(make)()


def part(read: ByteReader, original: Any) -> Any:
    """What stands in a state in place of a part of a valid one."""
    kind = read.below(4)
    if kind == 0:
        return anything(read)
    if isinstance(original, tuple):
        return tuple(part(read, one) for one in original)
    return changed(read, original) if isinstance(original, np.ndarray) else read.one_of(RULES)


def mesh_state(read: ByteReader) -> Any:
    if read.below(8) == 0:
        return anything(read)
    state = list(read.one_of(cages()).__getstate__())
    for _ in range(read.below(4)):
        place = read.below(len(state))
        state[place] = part(read, state[place])
    if read.below(8) == 0:
        state = state[: read.below(len(state))]
    return tuple(state)


def surface_state(read: ByteReader) -> Any:
    if read.below(8) == 0:
        return anything(read)
    mesh = read.one_of(cages())
    positions = part(read, mesh.positions) if read.below(2) else mesh.positions
    return (anything(read) if read.below(4) == 0 else mesh, positions)


def restored(cls: Any, state: Any) -> Any:
    """An object made of `state` as pickle makes it; None if it is refused."""
    blank, reason = cls.__new__(cls), None
    try:
        blank.__setstate__(state)
    except DOCUMENTED as error:
        reason = str(error)
    if reason is None:
        return blank
    require(0 < len(reason) < LONGEST_MESSAGE, "an error says why, and is short")
    try:
        repr(blank)
    except TypeError as error:
        require("__init__" in str(error), "an object that was refused is said to be no object")
        return None
    raise BrokenPropertyError("an object that was refused cannot be used")


def check_surface(surface: ls.LimitSurface, protocol: int) -> None:
    """A surface can be used as any other, and comes back from a pickle to the bit."""
    again = pickle.loads(pickle.dumps(surface, protocol))
    require(again.refused == surface.refused, "a pickled surface refuses the same faces")
    face = np.flatnonzero(~np.isin(surface.base_face, list(surface.refused)))[:4]
    uv = np.resize([[0.0, 0.0], [0.25, 0.5], [1.0, 0.125]], (len(face), 2))
    here, there = surface.evaluate(face, uv).position, again.evaluate(face, uv).position
    require(bool(np.isfinite(here).all()), "positions are finite")
    require(here.tobytes() == there.tobytes(), "a pickled surface has the same positions")


def check_mesh(mesh: ls.ControlMesh, protocol: int) -> None:
    again = pickle.loads(pickle.dumps(mesh, protocol))
    require(
        pickle.dumps(again.__getstate__()) == pickle.dumps(mesh.__getstate__()),
        "a pickled mesh has the same state",
    )
    try:
        surface = ls.LimitSurface(mesh)
    except ls.MeshError:
        return
    check_surface(surface, protocol)


def pickle_target(data: bytes) -> None:
    read = ByteReader(data)
    protocol = read.below(pickle.HIGHEST_PROTOCOL + 1)
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # numpy's, about its conversions
        if read.below(3):
            mesh = restored(ls.ControlMesh, mesh_state(read))
            if mesh is not None:
                check_mesh(mesh, protocol)
        else:
            surface = restored(ls.LimitSurface, surface_state(read))
            if surface is not None:
                check_surface(surface, protocol)
