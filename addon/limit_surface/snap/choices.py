# SPDX-License-Identifier: GPL-3.0-or-later
"""What becomes of elements at their places, and what became of them."""

from collections import Counter
from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class Choices:
    align: str  # NONE, NORMAL, NORMAL_DU
    keep_children: bool
    hair: str  # ROOT, STRAND, BLEND
    keep_length: bool


@dataclass
class Outcome:
    noun: str  # plural
    distances: list[np.ndarray] = field(default_factory=list)  # world units, of all that were put
    failures: Counter[str] = field(default_factory=Counter)  # reason -> number of elements
    notes: list[str] = field(default_factory=list)

    @property
    def placed(self) -> int:
        return sum(len(part) for part in self.distances)

    @property
    def failed(self) -> int:
        return self.failures.total()

    def reasons(self) -> str:
        return ", ".join(f"{count:,} {reason}" for reason, count in self.failures.most_common())

    def lines(self) -> tuple[str, str]:
        """Where something was placed."""
        moved = np.concatenate(self.distances)
        return (
            f"{len(moved):,} of {len(moved) + self.failed:,} {self.noun} snapped",
            f"moved by {moved.mean():.4g} on average, {moved.max():.4g} at most",
        )


def merged(outcomes: list[Outcome]) -> list[Outcome]:
    """One for each kind of elements."""
    found: dict[str, Outcome] = {}
    for outcome in outcomes:
        whole = found.setdefault(outcome.noun, Outcome(outcome.noun))
        whole.distances += outcome.distances
        whole.failures += outcome.failures
        whole.notes += [note for note in outcome.notes if note not in whole.notes]
    return list(found.values())
