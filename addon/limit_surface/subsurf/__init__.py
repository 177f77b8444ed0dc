# SPDX-License-Identifier: GPL-3.0-or-later
"""The Subdivision Surface modifier by which the viewport shows a limit surface."""
