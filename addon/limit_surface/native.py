# SPDX-License-Identifier: GPL-3.0-or-later
"""The native module `limitsurf`, or the reason why it cannot be used.

No other module imports `limitsurf`: an extension whose binary part does not fit the machine can
still be registered, and shows the reason in the sidebar and in the Preferences.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from .errors import RefusalError

if TYPE_CHECKING:
    import limitsurf


_MANIFEST = Path(__file__).parent / "blender_manifest.toml"


def _load() -> tuple[ModuleType | None, str]:
    try:
        import limitsurf
    except Exception as error:  # a broken binary may raise any error, which is the reason to show
        return None, f"{type(error).__name__}: {error}"
    # A folder of that name on sys.path would be imported as an empty package.
    if not hasattr(limitsurf, "LimitSurface"):
        return None, f"{list(limitsurf.__path__)[0]} is not the native module"
    # Blender does not load a binary part again that an update has replaced, and sys.path may have
    # another one. Their functions differ.
    found, needed = getattr(limitsurf, "__version__", "?"), _version()
    if found != needed:
        return None, (
            f"version {found} is in use, but {needed} is needed. Restart Blender, or remove "
            f"{limitsurf.__file__}"
        )
    return limitsurf, ""


def _version() -> str:
    """Returns the version of the extension, with which that of its binary part agrees."""
    with _MANIFEST.open("rb") as file:
        return str(tomllib.load(file)["version"])


if TYPE_CHECKING:
    reason: str
else:
    limitsurf, reason = _load()

#: The errors that evaluation raises for meshes and locations that have no limit surface
errors: tuple[type[Exception], ...] = (
    (limitsurf.MeshError, limitsurf.LocationError) if limitsurf else ()
)
#: The errors that an operator reports as the reason why it did nothing
refusals: tuple[type[Exception], ...] = (RefusalError, *errors)


# How errors of the library begin: with the row of an array, or with the name of an argument
_ROW = re.compile(r"row (\d+): (.*)", re.DOTALL)
_ARGUMENT = re.compile(r"[a-z]+(_[a-z]+)+\b")


def sentence(reason: object, called: Callable[[int], str] | None = None) -> str:
    """Returns the text of an error as a sentence for users: errors of the library begin with what
    is wrong, in lower case, and name rows of arrays and arguments. `called` says what Blender calls
    a row; without it the row is left out, because nobody knows of which array it is. Arguments are
    called as properties are. Texts of the add-on may begin with the name of an object.
    """
    text = str(reason)
    if not isinstance(reason, ValueError):
        return text
    row = None
    if found := _ROW.match(text):
        row, text = int(found[1]), found[2]
    if argument := _ARGUMENT.match(text):
        text = argument[0].replace("_", " ").title() + text[argument.end() :]
    if row is not None and called:
        return f"{called(row)}: {text}"
    return text[:1].upper() + text[1:]


@contextmanager
def rows_called(called: Callable[[int], str]) -> Iterator[None]:
    """Has errors of the library about rows of arrays begin with what Blender calls the row."""
    try:
        yield
    except ValueError as error:
        if not _ROW.match(str(error)):
            raise
        raise RefusalError(sentence(error, called)) from error


def available() -> bool:
    return limitsurf is not None


def obstacle() -> str:
    """Returns the reason why the native module cannot be used, or None."""
    return "" if available() else f"The native module could not be loaded: {reason}"


def version() -> str:
    return getattr(limitsurf, "__version__", "unknown version")
