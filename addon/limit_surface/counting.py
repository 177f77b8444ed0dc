# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of things in reports."""

_IRREGULAR = {
    "children": "child",
    "strands and points": "strand or point",
    "vertices": "vertex",
}


def counted(count: int, things: str, verb_of_one: str = "", verb_of_many: str = "") -> str:
    """Returns "1 strand", "2 strands", "1,000 strands" for the plural `things`, and the verb that
    goes with the number. A plural that does not only add an "s" must be known here.
    """
    words = [f"{count:,}", _one_of(things) if count == 1 else things]
    return " ".join([*words, *filter(None, [by_count(count, verb_of_one, verb_of_many)])])


def by_count(count: int, one: str, many: str) -> str:
    """Returns the words that go with a number of things: "has", or "have"."""
    return one if count == 1 else many


def _one_of(things: str) -> str:
    return _IRREGULAR.get(things) or things.removesuffix("s")
