# SPDX-License-Identifier: GPL-3.0-or-later
"""Refusals: what the user asked for cannot be done, and the message says why."""


class RefusalError(Exception):
    """Reported as an error by operators, which leave the scene as it was."""


class CageError(RefusalError):
    """The object has no control mesh that can be evaluated."""


class DisplayedError(RefusalError):
    """The polygons that Blender shows cannot be had, or are not those of the subdivided cage."""


class TooLargeError(RefusalError):
    """More elements than anyone should get without having been asked."""


class CancelledError(RefusalError):
    """The user did not want to wait."""
