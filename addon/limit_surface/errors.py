# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that tell the user why something cannot be done."""


class RefusalError(Exception):
    """An error that operators report. They leave the scene as it was."""


class CageError(RefusalError):
    """The object has no control mesh that can be evaluated."""


class NotNowError(CageError):
    """The object has a control mesh, which cannot be read at the moment."""


class MultiresolutionError(CageError):
    """The object has no control mesh because of a Multiresolution modifier."""


class DisplayedError(RefusalError):
    """The polygons that Blender shows are not available, or are not those of the subdivided
    cage.
    """


class TooLargeError(RefusalError):
    """An operator would make more elements than are allowed without the user's confirmation."""


class CancelledError(RefusalError):
    """The user has cancelled the work."""
