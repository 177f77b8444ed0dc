# SPDX-License-Identifier: Apache-2.0
"""tools/checksums.py gives the same bits every time, and names each row that differs."""

import subprocess
import sys
from pathlib import Path

PROGRAM = Path(__file__).parents[1] / "checksums.py"


def run(*options):
    command = [sys.executable, PROGRAM, *options]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


def test_threads_do_not_change_the_bits(tmp_path):
    written = run("mapped_cube", "images")
    rows = written.stdout.splitlines()
    assert written.returncode == 0
    assert len(rows) > 10
    before = tmp_path / "before.txt"
    before.write_text(written.stdout)
    compared = run("mapped_cube", "images", "--threads", "2", "--check", before)
    assert compared.returncode == 0
    assert compared.stdout == f"{len(rows)} rows, 0 differences\n"


def test_rows_that_differ_are_named(tmp_path):
    rows = run("mapped_cube").stdout.splitlines()
    rows[3] = rows[3].replace(rows[3][:64], 64 * "0")
    before = tmp_path / "before.txt"
    before.write_text("\n".join(rows))
    compared = run("mapped_cube", "--check", before)
    assert compared.returncode == 1
    changed = rows[3].split(" ", 1)[1]
    assert compared.stdout == f"differs: {changed}\n{len(rows)} rows, 1 differences\n"


def test_unknown_meshes_are_refused():
    refused = run("no such mesh")
    assert refused.returncode == 2
    assert "no such mesh" in refused.stderr
