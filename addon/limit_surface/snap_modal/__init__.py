# SPDX-License-Identifier: GPL-3.0-or-later
"""Dragging things over the limit surface with the mouse: view3d.limit_snap_modal."""

from .operator import VIEW3D_OT_limit_snap_modal

classes = (VIEW3D_OT_limit_snap_modal,)
