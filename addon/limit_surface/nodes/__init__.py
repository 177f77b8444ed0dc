# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry Nodes trees that are built by code."""
