# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of things in reports."""


def counted(count: int, things: str) -> str:
    """Returns "1 strand", "2 strands", "1,000 strands" for the plural `things`, which ends in s."""
    return f"{count:,} {things.removesuffix('s') if count == 1 else things}"
