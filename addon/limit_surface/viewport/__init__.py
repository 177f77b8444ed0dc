# SPDX-License-Identifier: GPL-3.0-or-later
"""What modal operators see and draw in a 3D viewport."""
