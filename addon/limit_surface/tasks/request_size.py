# SPDX-License-Identifier: GPL-3.0-or-later
"""The size of an operator's result, and the limits beyond which the user has to confirm it."""

from dataclasses import dataclass

from ..counting import counted
from ..errors import TooLargeError

LARGE_COUNT = 3_000_000  # more elements than this are made only if the user confirms
LARGE_MEMORY = 4 << 30  # in bytes
MOST_ELEMENTS = 2**31 - 1  # the largest number that Blender's element counts can hold

# All are measured at the peak. The first counts attributes and the arrays from which they are
# filled, the second positions and the finer curve that Blender evaluates between them, and the
# third a location that is made although a density may not keep it.
BYTES_PER_LOCATION = 130
BYTES_PER_ELEMENT = 200
BYTES_PER_CANDIDATE = 180


def memory_text(size: int) -> str:
    """Returns the text for an amount of memory, which is given in bytes."""
    return f"about {size / 2**30:.1f} GiB of memory"


@dataclass(frozen=True)
class RequestSize:
    noun: str
    count: int
    elements_per_location: int
    is_exact: bool = True
    candidates: int = 0

    @property
    def elements(self) -> int:
        return self.count * self.elements_per_location

    @property
    def memory(self) -> int:
        """The expected memory in bytes."""
        made = self.count * BYTES_PER_LOCATION + self.elements * BYTES_PER_ELEMENT
        return max(made, self.candidates * BYTES_PER_CANDIDATE)

    @property
    def is_large(self) -> bool:
        return self.count > LARGE_COUNT or self.memory > LARGE_MEMORY

    def check(self, allow_large: bool) -> None:
        if self.elements > MOST_ELEMENTS:
            raise TooLargeError(f"{self} are more than the {MOST_ELEMENTS:,} that Blender holds")
        if self.is_large and not allow_large:
            raise TooLargeError(f"{self}: turn on Allow Large Counts (allow_large) to make them")

    @property
    def how_many(self) -> str:
        return f"{'' if self.is_exact else 'about '}{counted(self.count, self.noun)}"

    def __str__(self) -> str:
        many = f" of {self.elements_per_location} points" if self.elements_per_location > 1 else ""
        return f"{self.how_many}{many} ({memory_text(self.memory)})"
