# SPDX-License-Identifier: Apache-2.0
"""Blender's subdivided meshes beside the limit surface, one feature at a time."""
