# SPDX-License-Identifier: Apache-2.0
"""Plots what verify_eigenbasis measured: errors over valence.

python tools/plot_eigenbasis.py BOUNDARY.csv INTERIOR.csv OUT.png
"""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

SERIES = (
    ("factorisation", "max |A − T J T⁻¹|", "tab:gray", "."),
    ("position", "position / diagonal", "tab:blue", "o"),
    ("derivative", "du, dv, relative", "tab:red", "^"),
)
PROMISED = (("position", 1e-13), ("derivative", 1e-12))


def main(boundary: Path, interior: Path, out: Path) -> None:
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), sharey=True, layout="constrained")
    colours = {name: colour for name, _, colour, _ in SERIES}
    for axis, path, title in zip(
        axes, (boundary, interior), ("boundary vertices", "interior vertices"), strict=True
    ):
        table = np.genfromtxt(path, delimiter=",", names=True)
        for name, label, colour, marker in SERIES:
            axis.semilogy(
                table["valence"],
                np.maximum(table[name], 1e-17),
                linestyle="none",
                marker=marker,
                markersize=3.5,
                color=colour,
                label=label,
            )
        for name, bound in PROMISED:
            axis.axhline(bound, color=colours[name], linewidth=0.8, linestyle="--")
        axis.set(title=title, xlabel="valence", ylim=(5e-18, 1e-11))
        axis.grid(alpha=0.25)
    axes[0].set_ylabel("error (dashed: the bound promised)")
    axes[0].legend(loc="upper left", fontsize=8, framealpha=1)
    out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(out, dpi=110)
    print(f"wrote {out}")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    main(*map(Path, sys.argv[1:]))
