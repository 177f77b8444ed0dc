# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers and directions over a surface, from what a mesh or an image holds."""
