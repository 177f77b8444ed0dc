# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that have no limit surface, in words."""

from collections import Counter


def reasons(refused: dict[int, str]) -> str:
    """The commonest reasons, each with a face for example."""
    example = {reason: face for face, reason in reversed(refused.items())}
    counted = Counter(refused.values()).most_common()
    parts = [f"{reason} (face {example[reason]}; {n} in all)" for reason, n in counted[:3]]
    if len(counted) > 3:
        parts.append(f"{len(counted) - 3} more reasons")
    return "; ".join(parts)
