# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading of Blender's data as arrays: cages, attributes, UV maps, displayed meshes and cameras."""
