# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the library, as operators report them."""

import numpy as np
import pytest
import scenes
from limit_surface import native
from limit_surface.errors import RefusalError

FACE = np.array([0, 99])
UV = np.full((2, 2), 0.5)


def test_rows_of_arrays_that_nobody_knows_are_left_out():
    surface = scenes.surface_without_addon(scenes.cross())
    with pytest.raises(native.refusals) as raised:
        surface.evaluate(FACE, UV)
    assert native.sentence(raised.value) == "Face 99 is not among the 5 Ptex faces"


def test_rows_are_called_as_in_blender():
    surface = scenes.surface_without_addon(scenes.cross())
    reason = "^Strand 1 of Fur: face 99 is not among"
    with (
        pytest.raises(RefusalError, match=reason),
        native.rows_called(lambda row: f"Strand {row} of Fur"),
    ):
        surface.evaluate(FACE, UV)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("row_distance is 0; it must be above 0", "Row Distance is 0; it must be above 0"),
        ("the surface has no area", "The surface has no area"),
        ("count is -1; it must be at least 0", "Count is -1; it must be at least 0"),
    ],
)
def test_arguments_are_called_as_properties(text, sentence):
    assert native.sentence(ValueError(text)) == sentence


def test_other_errors_stay_as_they_are():
    with pytest.raises(ValueError, match="^vertex 5"), native.rows_called(str):
        raise ValueError("vertex 5 is wrong")
    assert native.sentence(RefusalError("row_5 is hidden")) == "row_5 is hidden"
