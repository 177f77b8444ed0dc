# SPDX-License-Identifier: GPL-3.0-or-later
"""What is placed on limit surfaces: where, how many, how densely, and how it is tied there."""
