# SPDX-License-Identifier: Apache-2.0
"""The plot of docs/accuracy.md: the errors that tools/verify_eigenbasis has measured."""

from pathlib import Path

import numpy as np

from figures import ROOT, NotDrawnError
from figures.plots import plt, save

#: Where tools/verify_eigenbasis writes what it measures
MEASURED = ROOT / "out"

SERIES = (
    ("factorisation", "max |A − T J T⁻¹|", "tab:gray", "."),
    ("position", "position / diagonal", "tab:blue", "o"),
    ("derivative", "du, dv, relative", "tab:red", "^"),
)
PROMISED = (("position", 1e-13), ("derivative", 1e-12))


def make(folder: Path) -> None:
    boundary, interior = (MEASURED / f"eigenbasis_{kind}.csv" for kind in ("boundary", "interior"))
    if not (boundary.is_file() and interior.is_file()):
        raise NotDrawnError(
            f"{boundary} is missing: tools/verify_eigenbasis measures and draws this."
        )
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
    save(figure, folder / "eigenbasis_error.png", dpi=110)
