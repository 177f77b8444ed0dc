#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the fuzzers of native/fuzz/ (with Clang 19) and runs them from the inputs of its corpus.

    tools/fuzz.py [--seconds 15] [--target mesh | query | map | pickle] [--keep]

Each fuzzer runs for --seconds on each of the machine's cores. A finding ends the program with an
error and with the input's digits: append them to native/fuzz/corpus/TARGET.hex, below a line
"# Findings". --keep takes the new inputs that reach other parts of the library into these files.
Where Clang 19 is not installed, the program says so and ends with 77.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "fuzz"
PACKAGE = BUILD / "package"
PYTHON = ROOT / ".venv" / "bin" / "python"
# What the fuzzer of the Python module imports.
PYTHONPATH = (PACKAGE, ROOT / "native" / "fuzz", ROOT / "native" / "python" / "tests")
CORPUS = ROOT / "native" / "fuzz" / "corpus"
TARGETS = ("mesh", "query", "map", "pickle")
LONGEST_INPUT = 512  # bytes
# An input that takes longer is a finding. The slowest of the corpus takes 5 s of a processor, but
# the clock goes on while other programs have it.
SECONDS_FOR_ONE = 120
MEGABYTES = 4096
COMPILER = "clang++-19"  # that of the preset fuzz
CANNOT_RUN = 77


def build() -> None:
    def run(*command: object) -> None:
        subprocess.run([*map(str, command)], cwd=ROOT, check=True, stdout=sys.stderr)

    if not (BUILD / "build.ninja").exists():
        pybind11 = subprocess.run(
            [PYTHON, "-m", "pybind11", "--cmakedir"], check=True, stdout=subprocess.PIPE, text=True
        ).stdout.strip()
        run(
            "cmake", "--preset", "fuzz",
            "-D", f"Python_EXECUTABLE={PYTHON}", "-D", f"pybind11_DIR={pybind11}",
        )  # fmt: skip
    run("cmake", "--build", BUILD, "--target", "_limitsurf", *map(program, TARGETS))
    # The module that is fuzzed, as a package of its own.
    run("cmake", "--install", BUILD, "--component", "python", "--prefix", PACKAGE)
    for path in (ROOT / "native" / "python" / "limitsurf").glob("*.py"):
        shutil.copy(path, PACKAGE / "limitsurf")


def program(target: str) -> str:
    return f"limitsurf_fuzz_{target}"


def corpus_lines(target: str) -> list[str]:
    path = CORPUS / f"{target}.hex"
    return path.read_text().splitlines() if path.exists() else []


def unpack(target: str, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for number, line in enumerate(corpus_lines(target)):
        if line and not line.startswith("#"):
            (folder / f"kept-{number:04}").write_bytes(bytes.fromhex(line))


def pack(target: str, folder: Path) -> None:
    """The smallest set of inputs that reach everything that the folder's reach. Comments, and the
    findings below them, stay."""
    smallest = folder.with_name(f"{target}-smallest")
    smallest.mkdir(exist_ok=True)
    for old in smallest.iterdir():
        old.unlink()
    merging = start(target, ["-merge=1", smallest, folder])
    report = merging.communicate()[1]
    if merging.returncode != 0:
        sys.exit(f"{report[-6000:]}\nThe inputs of {target} could not be merged; nothing is kept.")
    lines = corpus_lines(target)
    begin = next((i for i, line in enumerate(lines) if line.startswith("# Findings")), len(lines))
    findings = lines[begin:]
    inputs = sorted({path.read_bytes() for path in smallest.iterdir()} - {b""}, key=len)
    kept = [data.hex() for data in inputs if data.hex() not in findings]
    (CORPUS / f"{target}.hex").write_text("\n".join([*kept, *findings]) + "\n")


def start(target: str, options: list) -> subprocess.Popen:
    return subprocess.Popen(
        [BUILD / "native" / "fuzz" / program(target), *options],
        cwd=BUILD,
        env=dict(
            os.environ,
            UBSAN_OPTIONS="print_stacktrace=1",
            # Python does not free all of its objects at the end.
            ASAN_OPTIONS=f"detect_leaks={int(target != 'pickle')}",
            PYTHONPATH=os.pathsep.join(map(str, PYTHONPATH)),
            PYTHONDONTWRITEBYTECODE="1",
        ),
        text=True,
        errors="replace",
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
    )


def fuzz(target: str, seconds: int, seed: int, keep: bool) -> bool:
    folder = BUILD / "corpus" / target
    unpack(target, folder)
    cores = os.cpu_count() or 1
    workers = [
        start(
            target,
            [
                f"-max_total_time={seconds}",
                f"-max_len={LONGEST_INPUT}",
                f"-timeout={SECONDS_FOR_ONE}",
                f"-rss_limit_mb={MEGABYTES}",
                f"-seed={seed + worker}",
                f"-artifact_prefix={target}-{worker}-",
                "-reload=1",
                "-print_final_stats=1",
                folder,
            ],
        )
        for worker in range(cores)
    ]
    good, executions = True, 0
    for worker in workers:
        report = worker.communicate()[1]
        found = re.search(r"number_of_executed_units: (\d+)", report)
        executions += int(found[1]) if found else 0
        if worker.returncode != 0:
            good = False
            print(report[-6000:])
            for written in re.findall(r"Test unit written to (\S+)", report):
                print(f"{target}: {(BUILD / written).read_bytes().hex()}")
    print(f"{target}: {executions} executions in {cores} x {seconds} s", flush=True)
    if keep and good:
        pack(target, folder)
    return good


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seconds", type=int, default=15, help="for each fuzzer, on each core")
    parser.add_argument("--target", choices=TARGETS, help="only this fuzzer")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", action="store_true", help="take new inputs into the corpus")
    options = parser.parse_args()
    if not shutil.which(COMPILER):
        print(f"Fuzzers: not run, since there is no {COMPILER} here (Debian: clang-19).")
        return CANNOT_RUN
    if not PYTHON.exists():
        sys.exit("The fuzzers need the environment .venv: run tools/setup.sh first.")
    build()
    results = [
        fuzz(target, options.seconds, options.seed, options.keep)
        for target in ([options.target] if options.target else TARGETS)
    ]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
