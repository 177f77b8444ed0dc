# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that scripts pass to operators."""

import bpy
import numpy as np
import pytest
import scenes

OPERATORS = {
    "limit_hair_add": ("length", "Length"),
    "limit_points_add": ("tilt", "Tilt"),
    "limit_mesh": ("tolerance", "Tolerance"),
    "limit_report": ("full_color", "Full Color"),
    "limit_snap": ("offset", "Offset"),
}


@pytest.mark.parametrize("name", OPERATORS)
def test_what_is_no_number_is_refused(name):
    ob = scenes.cross()
    if name == "limit_snap":
        scenes.cross()
        scenes.activate(ob)
    operator, (identifier, label) = getattr(bpy.ops.object, name), OPERATORS[name]
    size = operator.get_rna_type().properties[identifier].array_length
    value = [0.0] * (size - 1) + [np.nan] if size else np.nan
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match=f"{label}.* is not a number"):
        operator(**{identifier: value})
    assert scenes.file_contents() == before
