# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender holds, as arrays: cages, attributes, UV maps, displayed meshes and cameras."""
