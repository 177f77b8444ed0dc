# SPDX-License-Identifier: Apache-2.0
"""Matplotlib without a window, and how its figures are saved."""

from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

__all__ = ["plt", "save"]


def save(figure: plt.Figure, path: Path, dpi: int = 88) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=dpi)
    plt.close(figure)
    print(f"{path}: {path.stat().st_size >> 10} KiB", flush=True)
