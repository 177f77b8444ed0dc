# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons on the limit surface as a mesh of their own."""

from .operator import OBJECT_OT_limit_mesh

classes = (OBJECT_OT_limit_mesh,)
