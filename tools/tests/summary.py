# SPDX-License-Identifier: Apache-2.0
"""Adds up what tools/test.sh ran: `summary.py RESULTS < parts`.

Each line of the input is a part's name, exit status and seconds, separated by tabs. A part that ran
tests left RESULTS/<name>.xml (JUnit's format, as CTest and pytest write it); one that could not be
run on this machine ended with 77.
"""

import sys
import xml.etree.ElementTree as ET
from pathlib import Path


def count(report: Path) -> tuple[int, int, int]:
    """Returns the numbers of passed, failed and skipped tests in a JUnit report."""
    passed = failed = skipped = 0
    for case in ET.parse(report).iter("testcase"):
        if case.find("failure") is not None or case.find("error") is not None:
            failed += 1
        elif case.find("skipped") is not None or case.get("status") in ("disabled", "notrun"):
            skipped += 1
        else:
            passed += 1
    return passed, failed, skipped


CANNOT_RUN = "77"
OUTCOMES = {"0": "ok", CANNOT_RUN: "SKIPPED"}


def main() -> int:
    results = Path(sys.argv[1])
    total = [0, 0, 0]
    for line in sys.stdin:
        name, status, seconds = line.rstrip("\n").split("\t")
        report = results / f"{name}.xml"
        counts = count(report) if report.exists() else (0, 0, 0)
        if status == CANNOT_RUN:
            counts = (0, 0, 1)
        elif status != "0" and counts[1] == 0:
            counts = (counts[0], 1, counts[2])
        total = [a + b for a, b in zip(total, counts, strict=True)]
        outcome = OUTCOMES.get(status, "FAILED")
        tests = "{} passed, {} failed, {} skipped".format(*counts) if report.exists() else ""
        print(f"{name:<15} {outcome:<7} {seconds:>4} s  {tests}")
    print("{} passed, {} failed, {} skipped".format(*total))
    return 1 if total[1] else 0


if __name__ == "__main__":
    sys.exit(main())
