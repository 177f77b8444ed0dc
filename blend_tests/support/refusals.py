# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that refuse with a reason, and change nothing."""

import bpy
import pytest
import scenes


def check_refused(match: str, **properties: object) -> None:
    before, active = scenes.file_contents(), bpy.context.active_object
    for operator in (bpy.ops.object.limit_hair_add, bpy.ops.object.limit_points_add):
        with pytest.raises(RuntimeError, match=match):
            operator(**properties)
        assert scenes.file_contents() == before
        assert bpy.context.active_object == active
