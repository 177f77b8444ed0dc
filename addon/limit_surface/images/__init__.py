# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of Blender as pixels, and where their texels lie on the limit surface."""
