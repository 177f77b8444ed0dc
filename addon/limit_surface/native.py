# SPDX-License-Identifier: GPL-3.0-or-later
"""The native module `limitsurf`, or the reason why it cannot be used.

Nothing else imports it: an extension whose binary part does not fit the machine still registers,
and says what is wrong where the user looks for it.
"""

from types import ModuleType


def _load() -> tuple[ModuleType | None, str]:
    try:
        import limitsurf
    except Exception as error:  # whatever a broken binary raises is the reason to show
        return None, f"{type(error).__name__}: {error}"
    # A plain folder of that name on sys.path imports as an empty package.
    if not hasattr(limitsurf, "LimitSurface"):
        return None, f"{list(limitsurf.__path__)[0]} is not the native module"
    return limitsurf, ""


limitsurf, reason = _load()

#: What evaluation raises for meshes and locations that have no limit surface.
errors: tuple[type[Exception], ...] = (
    (limitsurf.MeshError, limitsurf.LocationError) if limitsurf else ()
)


def available() -> bool:
    return limitsurf is not None


def obstacle() -> str:
    """Why nothing can be done without it, if so."""
    return "" if available() else f"The native module does not load: {reason}"


def version() -> str:
    return getattr(limitsurf, "__version__", "unknown version")
