# SPDX-License-Identifier: GPL-3.0-or-later
"""Assets are evaluated by the workers of Dask: the same bits as here."""

import re

import pages
import pytest
from farm_software import python_environment, run

pytestmark = pytest.mark.slow

# Which workers have taken part, and whether some bits differ
WATCHED = """
from dask.distributed import get_worker


def watched(surface, at):
    return get_worker().address, surface.evaluate(at.face, at.uv, derivatives=2, threads=1)


if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1) as cluster, Client(cluster) as client:
        results = client.gather(client.map(watched, surfaces, places))
    addresses = {address for address, _ in results}
    assert len(addresses) == 2, addresses
    for (_, there), surface, at in zip(results, surfaces, places):
        here = surface.evaluate(at.face, at.uv, derivatives=2)
        for name in ("position", "du", "dv", "duu", "duv", "dvv"):
            assert getattr(there, name).tobytes() == getattr(here, name).tobytes(), name
    print("two workers, the same bits")
"""


def test_example_of_the_page(tmp_path):
    (example,) = re.findall(
        r"^```python dask\n(.*?)^```$", pages.text("farm"), re.MULTILINE | re.DOTALL
    )
    program = tmp_path / "assets.py"
    program.write_text(example + WATCHED)
    done = run([python_environment() / "bin/python", program], cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "20 assets, all equal: True" in done.stdout
    assert "two workers, the same bits" in done.stdout
