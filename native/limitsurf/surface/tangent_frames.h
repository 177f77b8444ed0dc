// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/surface_data.h"

namespace limitsurf {

/// Bound on the error of a tangent's direction, in radians, relative to its condition
/// (|du| |dV/dv| + |dv| |dV/du|) / |du dV/dv - dv dV/du|. Here each derivative counts as at least
/// as large as the face's largest one 1/16 away from its corners. Within 1/16 of an irregular
/// vertex, where derivatives vanish or diverge, the same holds for their ratios. Derivation:
/// docs/accuracy.md.
constexpr double kTangentError = 1e-11;

/// The frames in which tangent-space normals and displacements are expressed, for a map (U, V) on
/// the surface: row-major 3x3 matrices, nine numbers a row, with columns
///   tangent    dP/dU made perpendicular to the normal, unit;
///   bitangent  sign * normal x tangent, where the sign is -1 if the map is mirrored (its Jacobian
///              is negative), else 1;
///   normal     the limit surface's.
/// This is what MikkTSpace's frames, which Blender and others interpolate from the corners of
/// polygons, converge to as a mesh on the limit is tessellated ever more finely.
///
/// Orthonormal and finite everywhere:
///   - at a vertex where the surface or the map is irregular, the tangent is that at the distance
///     kSeenFrom inside the face, and the normal is that of LimitSurface::frames() at the vertex;
///   - where the map or the surface is singular (dP/dU vanishes or has the normal's direction), the
///     frame is that of LimitSurface::frames(), with sign 1.
///
/// Throws what LimitSurface::evaluate() throws, and std::invalid_argument for a map that does not
/// have two columns or belongs to a surface with another number of faces. Cost: two evaluations for
/// each location. Any number of threads gives the same bits.
using TangentFrames = Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>;
TangentFrames tangentFrames(const LimitSurface& surface, const SurfaceData& uv_map,
                            const LocationBatch& at, int threads = 0);

}  // namespace limitsurf
