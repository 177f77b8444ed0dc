# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that may take long: its operators, its size and its progress."""
