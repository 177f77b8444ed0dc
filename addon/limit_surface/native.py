# SPDX-License-Identifier: GPL-3.0-or-later
"""The native module `limitsurf`, or the reason why it cannot be used.

Nothing else imports it: an extension whose binary part does not fit the machine still registers,
and says what is wrong where the user looks for it.
"""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING

from .errors import RefusalError

if TYPE_CHECKING:
    import limitsurf


def _load() -> tuple[ModuleType | None, str]:
    try:
        import limitsurf
    except Exception as error:  # whatever a broken binary raises is the reason to show
        return None, f"{type(error).__name__}: {error}"
    # A plain folder of that name on sys.path imports as an empty package.
    if not hasattr(limitsurf, "LimitSurface"):
        return None, f"{list(limitsurf.__path__)[0]} is not the native module"
    return limitsurf, ""


if TYPE_CHECKING:
    reason: str
else:
    limitsurf, reason = _load()

#: What evaluation raises for meshes and locations that have no limit surface.
errors: tuple[type[Exception], ...] = (
    (limitsurf.MeshError, limitsurf.LocationError) if limitsurf else ()
)
#: What an operator reports as the reason why it did nothing.
refusals: tuple[type[Exception], ...] = (RefusalError, *errors)


def available() -> bool:
    return limitsurf is not None


def obstacle() -> str:
    """Why nothing can be done without it, if so."""
    return "" if available() else f"The native module does not load: {reason}"


def version() -> str:
    return getattr(limitsurf, "__version__", "unknown version")
