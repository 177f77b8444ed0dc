// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <vector>

#include "bench/support/mesh_arrays.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf::bench {

using TopologyPointer = std::unique_ptr<OpenSubdiv::Far::TopologyRefiner>;

/// OpenSubdiv's topology of a cage, boundaries and corners smooth.
TopologyPointer farTopology(const MeshArrays& cage);

/// Approximation levels of Bfr: its default, and one that comes close to limitsurf's accuracy.
constexpr int kBfrLevels[] = {2, 10};

/// OpenSubdiv's Bfr in double precision. The surface of every face, with its patch points, is kept.
class BfrPeer {
 public:
  using Surface = OpenSubdiv::Bfr::Surface<double>;
  using Cache = OpenSubdiv::Bfr::SurfaceFactoryCache;
  using Factory = OpenSubdiv::Bfr::RefinerSurfaceFactory<>;

  /// A location in Bfr's parameters.
  struct Coordinate {
    int base_face;
    double uv[2];
  };

  /// `cache`, if given, keeps Bfr's results for topologies from one instance to the next.
  BfrPeer(const MeshArrays& cage, const OpenSubdiv::Far::TopologyRefiner& topology, int level,
          Cache* cache = nullptr);

  /// Recomputes the patch points of these faces of the cage.
  void prepare(const Points& positions, const std::vector<int>& base_faces);

  /// Converts Ptex locations to Bfr's, in which the sub-faces of n-gons are half as wide.
  std::vector<Coordinate> coordinates(Span<Location> at) const;

  /// Writes the rows of `out`, whose members must already have their sizes.
  template <Derivatives kDerivatives>
  void evaluate(const std::vector<Coordinate>& at, Evaluation& out) const;

  int level() const { return level_; }

 private:
  int level_;
  std::vector<int> base_face_;  ///< for each Ptex face
  std::vector<int> corner_;
  std::vector<Surface> surfaces_;  ///< for each face of the cage
  std::vector<std::size_t> point_offsets_;
  std::vector<double> points_;
};

template <Derivatives kDerivatives>
void BfrPeer::evaluate(const std::vector<Coordinate>& at, Evaluation& out) const {
  const Surface::PointDescriptor packed(3);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Surface& surface = surfaces_[at[i].base_face];
    const double* points = points_.data() + point_offsets_[at[i].base_face];
    const auto row = [i](Points& p) { return p.data() + 3 * i; };
    if constexpr (kDerivatives == Derivatives::none) {
      surface.Evaluate(at[i].uv, points, packed, row(out.position));
    } else if constexpr (kDerivatives == Derivatives::first) {
      surface.Evaluate(at[i].uv, points, packed, row(out.position), row(out.du), row(out.dv));
    } else {
      surface.Evaluate(at[i].uv, points, packed, row(out.position), row(out.du), row(out.dv),
                       row(out.duu), row(out.duv), row(out.dvv));
    }
  }
}

}  // namespace limitsurf::bench
