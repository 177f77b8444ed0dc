# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of Blender as pixels, and the places of their texels on the limit surface."""
