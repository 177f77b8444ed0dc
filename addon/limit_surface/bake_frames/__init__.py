# SPDX-License-Identifier: GPL-3.0-or-later
"""Caches of objects, one file for each frame, written from the command line."""

from .command import attach_command, detach_command

__all__ = ["attach_command", "detach_command"]

classes = ()
