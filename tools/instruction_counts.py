# SPDX-License-Identifier: Apache-2.0
"""Counts the instructions that the library takes for a row, a point or a pose, under callgrind, and
compares them with those that are recorded: unlike times they do not depend on the machine.

    .venv/bin/python tools/instruction_counts.py            compares
    .venv/bin/python tools/instruction_counts.py --write    records the counts of now

Needs valgrind (Debian: `valgrind`) and the program limitsurf_instructions, in a release build.
Vector instructions that not every processor has are switched off, in the library and in those of
the system, but another compiler gives other counts: the record holds for one.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "build/cpp/native/bench/limitsurf_instructions"
RECORD = ROOT / "native/bench/instructions/counts.json"
#: The share by which a count may differ from the recorded one
TOLERANCE = 0.05
#: The work is done for both sizes: the difference leaves out what does not depend on the size
SIZES = (4000, 8000)
#: What the C library would choose by the processor it finds
PLAIN = "glibc.cpu.hwcaps=-AVX2,-AVX,-FMA,-FMA4,-AVX512F,-AVX512VL,-AVX512DQ,-AVX512BW,-ERMS,-FSRM"


def obstacle() -> str:
    """Returns why nothing can be counted here, or an empty text."""
    if shutil.which("valgrind") is None:
        return "valgrind is not installed"
    if not PROGRAM.exists():
        return f"{PROGRAM.name} has not been built"
    return ""


def tools() -> dict[str, str]:
    """Returns the versions of what the counts depend on."""
    found = {}
    for name, program in (("compiler", "c++"), ("valgrind", "valgrind"), ("C library", "ldd")):
        done = subprocess.run([program, "--version"], stdout=subprocess.PIPE, text=True, check=True)
        found[name] = done.stdout.splitlines()[0]
    return found


def kinds() -> list[str]:
    done = subprocess.run([PROGRAM], stdout=subprocess.PIPE, text=True, check=True)
    return done.stdout.splitlines()


def counted(kind: str) -> float:
    """Returns the instructions for one more row of this kind of work."""
    small, large = (_whole(kind, size) for size in SIZES)
    return (large - small) / (SIZES[1] - SIZES[0])


def _whole(kind: str, size: int) -> int:
    counter = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    done = subprocess.run(
        [*counter, PROGRAM, kind, str(size)],
        env={**os.environ, "GLIBC_TUNABLES": PLAIN},
        capture_output=True,
        text=True,
        check=True,
    )
    match = re.search(r"Collected : (\d+)", done.stderr)
    assert match, done.stderr
    return int(match[1])


def recorded() -> dict[str, Any]:
    return json.loads(RECORD.read_text())


def differing(found: dict[str, float], wanted: dict[str, float]) -> list[str]:
    """Returns a line for each count that differs too much, or that only one of both has."""
    lines = []
    for kind in found.keys() | wanted.keys():
        now, before = found.get(kind), wanted.get(kind)
        if now is None or before is None or abs(now - before) > TOLERANCE * before:
            lines.append(f"{kind}: {now} instructions, {before} are recorded")
    return sorted(lines)


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="record the counts")
    options = parser.parse_args(arguments)
    if reason := obstacle():
        print(reason, file=sys.stderr)
        return 2
    found = {}
    for kind in kinds():
        found[kind] = round(counted(kind))
        print(f"{found[kind]:>8} {kind}", flush=True)
    if options.write:
        record = {"tools": tools(), "instructions": found}
        RECORD.write_text(json.dumps(record, indent=2) + "\n")
        return 0
    record = recorded()
    if record["tools"] != tools():
        print(f"The record holds for {record['tools']}, and here are {tools()}", file=sys.stderr)
        return 2
    lines = differing(found, record["instructions"])
    print("\n".join(lines), file=sys.stderr)
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
