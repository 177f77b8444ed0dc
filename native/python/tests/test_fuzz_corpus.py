# SPDX-License-Identifier: Apache-2.0
"""The inputs that the fuzzer of pickles starts from, and what it found."""

from pathlib import Path

import limitsurf as ls
import pickle_target
import pytest
import shapes

CORPUS = Path(pickle_target.__file__).parent / "corpus" / "pickle.hex"
INPUTS = [line for line in CORPUS.read_text().splitlines() if line and not line.startswith("#")]


def test_pickles():
    assert len(INPUTS) >= 30, "the corpus of pickles is missing"
    for digits in INPUTS:
        try:
            pickle_target.pickle_target(bytes.fromhex(digits))
        except Exception as error:
            error.add_note(f"with the input {digits}")
            raise


class Lenient:
    """Makes an object of any state, and can be used before that."""

    def __setstate__(self, state):
        if state == "wrong":
            raise ValueError("a reason")


class Chatty:
    def __setstate__(self, state):
        raise ValueError(state * 1000)


def test_properties_that_do_not_hold_are_noticed(monkeypatch):
    assert isinstance(pickle_target.restored(Lenient, ()), Lenient)
    with pytest.raises(pickle_target.BrokenPropertyError, match="cannot be used"):
        pickle_target.restored(Lenient, "wrong")
    for message in ("", "long"):
        with pytest.raises(pickle_target.BrokenPropertyError, match="says why, and is short"):
            pickle_target.restored(Chatty, message)
    mesh = ls.ControlMesh.from_faces(*shapes.cube())
    other = ls.ControlMesh.from_faces(*shapes.grid(1, 1))
    monkeypatch.setattr(pickle_target.pickle, "loads", lambda _: other)
    with pytest.raises(pickle_target.BrokenPropertyError, match="same state"):
        pickle_target.check_mesh(mesh, 2)
