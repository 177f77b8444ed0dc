# SPDX-License-Identifier: GPL-3.0-or-later
"""The choices of what is done with elements, and the outcome for them."""

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from ..counting import counted


@dataclass(frozen=True)
class Choices:
    align: str  # NONE, NORMAL, NORMAL_DU
    keep_children: bool
    hair: str  # ROOT, STRAND, BLEND
    keep_length: bool
    follow: str  # how hair follows from then on that follows nothing yet


@dataclass
class Outcome:
    noun: str  # in the plural
    # distances in world units of all elements that were moved
    distances: list[np.ndarray] = field(default_factory=list)
    failures: Counter[str] = field(default_factory=Counter)  # reason -> number of elements
    notes: list[str] = field(default_factory=list)

    @property
    def placed(self) -> int:
        return sum(len(part) for part in self.distances)

    @property
    def failed(self) -> int:
        return self.failures.total()

    def reasons(self) -> str:
        return "; ".join(f"{reason} ({count:,})" for reason, count in self.failures.most_common())

    def lines(self) -> tuple[str, str]:
        """Returns lines for the report, where some elements were snapped."""
        moved = np.concatenate(self.distances)
        return (
            f"{len(moved):,} of {counted(len(moved) + self.failed, self.noun)} snapped",
            f"moved by {moved.mean():.4g} on average, {moved.max():.4g} at most",
        )


def merged(outcomes: list[Outcome]) -> list[Outcome]:
    """Merges the outcomes into one for each kind of elements."""
    found: dict[str, Outcome] = {}
    for outcome in outcomes:
        whole = found.setdefault(outcome.noun, Outcome(outcome.noun))
        whole.distances += outcome.distances
        whole.failures += outcome.failures
        whole.notes += [note for note in outcome.notes if note not in whole.notes]
    return list(found.values())
