# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that may take long: the operators that do it, how much it is, and how far it has got."""
