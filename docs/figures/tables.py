# SPDX-License-Identifier: Apache-2.0
"""Tables of measurements in the pages of the documentation."""

import re
from pathlib import Path

from figures import ROOT

DOCS = ROOT / "docs"


def write(page: str, tables: dict[str, str], folder: Path) -> None:
    """Writes the page `docs/<page>` to the folder, with new tables in it."""
    path = folder / page
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(filled((DOCS / page).read_text(), tables))
    print(f"{path}: {', '.join(tables)}", flush=True)


def filled(page: str, tables: dict[str, str]) -> str:
    """The page's text with new tables between the comments that name them."""
    for name, lines in tables.items():
        page, count = re.subn(
            rf"(<!-- {name} -->\n).*?(\n<!-- end -->)",
            rf"\g<1>\n{lines}\n\g<2>",
            page,
            flags=re.DOTALL,
        )
        if count != 1:
            raise ValueError(f"the page has {count} places for the table {name!r}")
    return page
