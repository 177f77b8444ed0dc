# SPDX-License-Identifier: GPL-3.0-or-later
"""What types of modifiers, and of parents, do to the faces of a mesh."""

#: The types of modifiers that move vertices, or change their data, and nothing else
DEFORMING = {
    *("ARMATURE", "CAST", "CLOTH", "CORRECTIVE_SMOOTH", "CURVE", "DATA_TRANSFER", "DISPLACE"),
    *("HOOK", "LAPLACIANDEFORM", "LAPLACIANSMOOTH", "LATTICE", "MESH_CACHE", "MESH_DEFORM"),
    *("MESH_SEQUENCE_CACHE", "NORMAL_EDIT", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH", "SOFT_BODY"),
    *("SURFACE_DEFORM", "UV_PROJECT", "UV_WARP", "VERTEX_WEIGHT_EDIT", "VERTEX_WEIGHT_MIX"),
    *("VERTEX_WEIGHT_PROXIMITY", "VOLUME_DISPLACE", "WARP", "WAVE", "WEIGHTED_NORMAL"),
}

#: The types that add faces after those of the mesh, which stay as they are
APPENDING = {"ARRAY", "MIRROR", "SOLIDIFY"}

#: The types of parents that deform their children without a modifier
DEFORMING_PARENTS = {"ARMATURE", "LATTICE"}
