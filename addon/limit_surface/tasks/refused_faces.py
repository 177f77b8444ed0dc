# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts about faces that have no limit surface."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING

from ..counting import by_count, counted
from ..errors import RefusalError

if TYPE_CHECKING:
    import limitsurf


def check_some_left(surface: limitsurf.LimitSurface, whose: str) -> None:
    """Raises RefusalError where no face has a limit surface."""
    if len(surface.refused) == len(surface.mesh.face_sizes):
        raise RefusalError(f"No face of {whose} has a limit surface")


def left_out(count: int, faces: int, reasons: str = "") -> str:
    """Returns the warning that so many of a mesh's faces were left out."""
    have, were = by_count(count, "has", "have"), by_count(count, "was", "were")
    warning = f"{count:,} of {counted(faces, 'faces')} {have} no limit surface and {were} left out"
    return f"{warning}: {reasons}" if reasons else warning


def reasons(refused: Mapping[int, str]) -> str:
    """Returns the most frequent reasons, each with the number of a face as an example."""
    example = {reason: face for face, reason in reversed(tuple(refused.items()))}
    found = Counter(refused.values()).most_common()
    parts = [f"{reason} (face {example[reason]}; {n} in all)" for reason, n in found[:3]]
    if len(found) > 3:
        parts.append(counted(len(found) - 3, "more reasons"))
    return "; ".join(parts)
