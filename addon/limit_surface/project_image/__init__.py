# SPDX-License-Identifier: GPL-3.0-or-later
"""Images projected onto limit surfaces: into textures, or as decals."""

from .operator import OBJECT_OT_limit_project_image

classes = (OBJECT_OT_limit_project_image,)
