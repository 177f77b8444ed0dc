# SPDX-License-Identifier: Apache-2.0
"""Meshes that several figures, tests of figures or measurements share."""
