# SPDX-License-Identifier: Apache-2.0
"""Eigenbases have the same bits on aarch64 as here: cross-compiled, and run by QEMU.

The C++ library itself is not linked, because OpenSubdiv and oneTBB for aarch64 would be needed;
eigenbases need only OpenSubdiv's headers.
"""

import shutil
import subprocess
from pathlib import Path

import pytest

NATIVE = Path(__file__).resolve().parents[2] / "native"
#: Headers that hold for every processor. The compiler must not see the rest of /usr/include.
HEADERS = (Path("/usr/include/eigen3"), Path("/usr/include/opensubdiv"))
CROSS_COMPILER, EMULATOR = "aarch64-linux-gnu-g++", "qemu-aarch64"


def compiling(compiler: str, headers: Path, program: Path) -> subprocess.Popen[str]:
    sources: list[str | Path] = [
        *sorted((NATIVE / "limitsurf/eigen").glob("*.cpp")),
        *sorted((NATIVE / "limitsurf/precision").glob("*.cpp")),
        NATIVE / "tests/eigen/eigenbasis_digest.cpp",
    ]
    includes: list[str | Path] = [
        f"-I{NATIVE}",
        "-isystem",
        headers,
        "-isystem",
        headers / "eigen3",
    ]
    # Sdc's functions for semi-sharp vertices stay undefined: no eigenbasis calls them.
    link: list[str | Path] = ["-static", "-Wl,--unresolved-symbols=ignore-all", "-o", program]
    return subprocess.Popen(
        [
            compiler,
            "-O1",
            "-DNDEBUG",
            "-std=c++17",
            "-ffp-contract=off",
            *includes,
            *sources,
            *link,
        ],
        stderr=subprocess.PIPE,
        text=True,
    )


def output(*command: str | Path) -> list[str]:
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=600)
    return done.stdout.splitlines()


@pytest.mark.slow
def test_eigenbases_have_the_same_bits_on_aarch64(tmp_path):
    missing = [name for name in (CROSS_COMPILER, EMULATOR, "g++") if not shutil.which(name)]
    missing += [str(path) for path in HEADERS if not path.is_dir()]
    if missing:
        pytest.skip(
            f"NOT RUN on aarch64, because these are missing: {', '.join(missing)}. On Debian: "
            "apt-get install g++-aarch64-linux-gnu qemu-user"
        )
    headers = tmp_path / "include"
    headers.mkdir()
    for path in HEADERS:
        (headers / path.name).symlink_to(path)
    here, there = tmp_path / "here", tmp_path / "there"
    compilers = [compiling("g++", headers, here), compiling(CROSS_COMPILER, headers, there)]
    for process in compilers:
        _nothing, errors = process.communicate(timeout=1800)
        assert process.returncode == 0, errors
    expected = output(here)
    assert len(expected) == 260
    assert len({line.split(": ")[1] for line in expected}) == len(expected)
    assert output(EMULATOR, there) == expected
