# SPDX-License-Identifier: Apache-2.0
"""Blender's subdivided meshes measured against the limit surface, on many meshes."""
