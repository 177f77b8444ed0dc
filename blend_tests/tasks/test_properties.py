# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that scripts pass to operators."""

import bpy
import numpy as np
import pytest
import scenes

OPERATORS = {
    "limit_hair_add": ("length", "Length"),
    "limit_points_add": ("rotation", "Rotation"),
    "limit_mesh": ("tolerance", "Tolerance"),
    "limit_report": ("full_color", "Full Color"),
    "limit_snap": ("offset", "Offset"),
}


INFINITE = {"limit_hair_add", "limit_points_add", "limit_snap"}


@pytest.mark.parametrize(
    ("name", "wrong", "reason"),
    [
        *((name, np.nan, "is not a number") for name in OPERATORS),
        *((name, np.inf, "is infinite") for name in sorted(INFINITE)),
        ("limit_snap", -np.inf, "is infinite"),
    ],
)
def test_what_is_no_finite_number_is_refused(name, wrong, reason):
    ob = scenes.cross()
    if name == "limit_snap":
        scenes.cross()
        scenes.activate(ob)
    operator, (identifier, label) = getattr(bpy.ops.object, name), OPERATORS[name]
    size = operator.get_rna_type().properties[identifier].array_length
    value = [0.0] * (size - 1) + [wrong] if size else wrong
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match=f"{label}.* {reason}"):
        operator(**{identifier: value})
    assert scenes.file_contents() == before


def test_limits_may_be_infinite():
    scenes.cross()
    assert bpy.ops.object.limit_report(full_color=np.inf) == {"FINISHED"}
