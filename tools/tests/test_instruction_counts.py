# SPDX-License-Identifier: Apache-2.0
"""The speed of the library by counts of instructions, which do not depend on the clock."""

import instruction_counts
import pytest


@pytest.mark.slow
def test_instructions_are_as_recorded():
    """After a change that was made for speed: `tools/instruction_counts.py --write`."""
    if reason := instruction_counts.obstacle():
        pytest.skip(reason)
    record = instruction_counts.recorded()
    if instruction_counts.tools() != record["tools"]:
        pytest.skip(f"the counts are recorded for {record['tools']}")
    found = {kind: instruction_counts.counted(kind) for kind in instruction_counts.kinds()}
    assert instruction_counts.differing(found, record["instructions"]) == []


def test_what_differs_is_named():
    wanted = {"same": 100, "slower": 100, "faster": 100, "gone": 100}
    found = {"same": 104.9, "slower": 106, "faster": 94, "new": 3}
    assert instruction_counts.differing(found, wanted) == [
        "faster: 94 instructions, 100 are recorded",
        "gone: None instructions, 100 are recorded",
        "new: 3 instructions, None are recorded",
        "slower: 106 instructions, 100 are recorded",
    ]
