# SPDX-License-Identifier: GPL-3.0-or-later
"""The placing of things on limit surfaces: their places, number, density and binding."""
