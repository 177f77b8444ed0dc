# SPDX-License-Identifier: GPL-3.0-or-later
"""Ordinary objects that stay on the limit surface of a mesh that deforms."""

from .operator import OBJECT_OT_limit_attach

classes = (OBJECT_OT_limit_attach,)
