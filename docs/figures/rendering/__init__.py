# SPDX-License-Identifier: Apache-2.0
"""What pictures rendered by Blender share: the scene, and the sheet that holds the panels."""
