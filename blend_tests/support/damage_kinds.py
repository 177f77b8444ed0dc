# SPDX-License-Identifier: GPL-3.0-or-later
"""What all damage to scenes has in common."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import bpy

NAN, INF = float("nan"), float("inf")


class DoesNotApplyError(Exception):
    """There is nothing of this kind to damage."""


Damage = Callable[[bpy.types.Object, Path], None]


def needs(ob: bpy.types.Object, kind: str) -> None:
    if ob.type != kind:
        raise DoesNotApplyError
