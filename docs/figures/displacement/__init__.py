# SPDX-License-Identifier: Apache-2.0
"""A displacement map: its picture, and how closely it reproduces the sculpt."""
