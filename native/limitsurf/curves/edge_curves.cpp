// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/edge_curves.h"

#include <algorithm>
#include <cmath>

#include "limitsurf/curves/edge_curves_data.h"
#include "limitsurf/curves/face_neighbors.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// The quadrature of a part has converged when halving it changes it by at most this share.
constexpr double kConverged = kCurveLengthError / 100;
/// Parts that are shorter than this share of their cubic are not halved further.
constexpr double kNegligible = 1e-13;
constexpr int kMostHalvings = 40;
/// The number of edges that one task measures.
constexpr std::size_t kEdgesPerTask = 16;

/// Halves parts of a cubic until quadrature has converged, and lists them. They end at cusps: one
/// closer to an end of a part than all points of the quadrature would be seen neither by it nor by
/// that of the halves.
class Measure {
 public:
  Measure(const CurveCubic& cubic, int number, double& arc, std::vector<CurveLeaf>& leaves)
      : cubic_(cubic), number_(number), arc_(arc), leaves_(leaves) {
    std::vector<double> ends = cubic.turns();
    ends.push_back(1);
    negligible_ = kNegligible * cubic.quadrature(0, 1);
    double from = 0;
    for (const double to : ends) {
      add(from, to, cubic.quadrature(from, to), kMostHalvings);
      from = to;
    }
  }

 private:
  void add(double from, double to, double whole, int halvings) {
    const double middle = 0.5 * (from + to);
    const double low = cubic_.quadrature(from, middle), high = cubic_.quadrature(middle, to);
    const double sum = low + high, change = std::abs(sum - whole);
    if (change <= kConverged * sum || sum <= negligible_ || halvings == 0) {
      leaves_.push_back({number_, from, to, arc_});
      arc_ += sum;
      return;
    }
    add(from, middle, low, halvings - 1);
    add(middle, to, high, halvings - 1);
  }

  const CurveCubic& cubic_;
  int number_;
  double& arc_;
  std::vector<CurveLeaf>& leaves_;
  double negligible_;
};

/// The direction of a cubic at a parameter: that of its derivative or, where this vanishes, of the
/// way from or to a place beside it.
Vector3 direction(const CurveCubic& cubic, double t) {
  const Vector3 whole = (cubic.points[3] - cubic.points[0]).head<3>().matrix();
  double size = 0;
  for (int i = 1; i < 4; ++i) {
    size = std::max(size, (cubic.points[i] - cubic.points[0]).matrix().norm());
  }
  constexpr double kVanishes = 1e-10, kBeside = 1e-4;
  Vector3 along = cubic.derivative(t).head<3>().matrix();
  if (along.norm() <= kVanishes * size) {
    along = cubic.derivative(t < 0.5 ? t + kBeside : t - kBeside).head<3>().matrix();
  }
  if (!(along.norm() > 0)) {
    along = whole;
  }
  const double norm = along.norm();
  return norm > 0 ? Vector3(along / norm) : Vector3(Vector3::Zero());
}

}  // namespace

EdgeCurves::Data::Data(const LimitSurface& surface, EdgeChains found, int threads)
    : chains(std::move(found)) {
  checkThreads(threads);
  const std::size_t edge_count = chains.edges.size();
  first_leaf.push_back(0);
  if (edge_count == 0) {
    return;
  }
  const SurfacePatches patches(surface, threads);
  const FaceTiles tiles(patches, surface.faceCount());
  const std::vector<int> first_ptex = firstPtexFaces(surface);
  std::vector<EdgeParts> edge_parts(edge_count);
  parallelFor(edge_count, kEdgesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      edge_parts[i] = parts(surface, patches, tiles, first_ptex, chains.edges[i]);
    }
  });
  const ControlMesh& mesh = surface.mesh();
  for (std::size_t chain = 0; chain + 1 < chains.offsets.size(); ++chain) {
    double arc = 0;
    for (std::int64_t edge = chains.offsets[chain]; edge < chains.offsets[chain + 1]; ++edge) {
      const EdgeParts& of = edge_parts[static_cast<std::size_t>(edge)];
      const int first_cubic = static_cast<int>(cubics.size());
      cubics.insert(cubics.end(), of.cubics.begin(), of.cubics.end());
      cubic_edge.insert(cubic_edge.end(), of.cubics.size(), edge);
      for (CurveLeaf leaf : of.leaves) {
        leaf.cubic += first_cubic;
        leaf.arc += arc;
        leaves.push_back(leaf);
      }
      arc += of.length;
      edge_lengths.push_back(of.length);
    }
    lengths.push_back(arc);
    first_leaf.push_back(leaves.size());
  }
  for (const EdgeChains::Edge& edge : chains.edges) {
    for (const CurveSide side : {CurveSide::left, CurveSide::right}) {
      const MeshEdges::Use& use = side == CurveSide::left ? edge.left : edge.right;
      // Where no face is on a side, any face stands for it: it is not asked for.
      const MeshEdges::Use& some = use.face >= 0         ? use
                                   : edge.left.face >= 0 ? edge.left
                                                         : edge.right;
      (side == CurveSide::left ? left : right)
          .emplace_back(mesh, first_ptex[static_cast<std::size_t>(some.face)], some);
    }
  }
}

EdgeCurves::Data::EdgeParts EdgeCurves::Data::parts(const LimitSurface& surface,
                                                    const SurfacePatches& patches,
                                                    const FaceTiles& tiles,
                                                    const std::vector<int>& first_ptex,
                                                    const EdgeChains::Edge& edge) const {
  const bool on_left = edge.left.face >= 0;
  const MeshEdges::Use& use = on_left ? edge.left : edge.right;
  const EdgeSides sides(surface.mesh(), first_ptex[static_cast<std::size_t>(use.face)], use);
  EdgeParts result;
  for (int i = 0; i < sides.count; ++i) {
    for (CurveCubic cubic : sideCubics(patches, tiles, sides.sides[i])) {
      cubic.begin = (i + cubic.begin) / sides.count;
      cubic.end = (i + cubic.end) / sides.count;
      result.cubics.push_back(on_left ? cubic : cubic.reversed());
    }
  }
  if (!on_left) {
    std::reverse(result.cubics.begin(), result.cubics.end());
  }
  for (std::size_t i = 0; i < result.cubics.size(); ++i) {
    Measure(result.cubics[i], static_cast<int>(i), result.length, result.leaves);
  }
  return result;
}

EdgeCurves::EdgeCurves(const LimitSurface& surface, EdgeChoice choice, int threads)
    : data_(std::make_unique<Data>(surface, edgeChains(surface, MeshEdges(surface.mesh()), choice),
                                   threads)) {}

EdgeCurves::EdgeCurves(const LimitSurface& surface,
                       const std::vector<std::pair<std::int64_t, std::int64_t>>& edges, int threads)
    : data_(std::make_unique<Data>(surface, edgeChains(surface, MeshEdges(surface.mesh()), edges),
                                   threads)) {}

EdgeCurves::~EdgeCurves() = default;
EdgeCurves::EdgeCurves(EdgeCurves&&) noexcept = default;
EdgeCurves& EdgeCurves::operator=(EdgeCurves&&) noexcept = default;

int EdgeCurves::count() const { return data_->chains.count(); }
const std::vector<std::int64_t>& EdgeCurves::offsets() const { return data_->chains.offsets; }
bool EdgeCurves::closed(int curve) const {
  return data_->chains.closed[static_cast<std::size_t>(curve)];
}
double EdgeCurves::length(int curve) const {
  return data_->lengths[static_cast<std::size_t>(curve)];
}
std::int64_t EdgeCurves::leftOut() const { return data_->chains.left_out; }

std::pair<int, int> EdgeCurves::edgeVertices(std::int64_t edge) const {
  const auto& ends = data_->chains.edges[static_cast<std::size_t>(edge)].vertices;
  return {ends[0], ends[1]};
}
int EdgeCurves::edgeFace(std::int64_t edge, CurveSide side) const {
  const EdgeChains::Edge& of = data_->chains.edges[static_cast<std::size_t>(edge)];
  return side == CurveSide::left ? of.left.face : of.right.face;
}
double EdgeCurves::edgeLength(std::int64_t edge) const {
  return data_->edge_lengths[static_cast<std::size_t>(edge)];
}

EdgeCurves::Point EdgeCurves::at(int curve, double arc, CurveSide side) const {
  const auto first =
      data_->leaves.begin() +
      static_cast<std::ptrdiff_t>(data_->first_leaf[static_cast<std::size_t>(curve)]);
  const auto last =
      data_->leaves.begin() +
      static_cast<std::ptrdiff_t>(data_->first_leaf[static_cast<std::size_t>(curve) + 1]);
  const auto after = std::upper_bound(
      first + 1, last, arc, [](double value, const CurveLeaf& leaf) { return value < leaf.arc; });
  const CurveLeaf& leaf = *(after - 1);
  const CurveCubic& cubic = data_->cubics[static_cast<std::size_t>(leaf.cubic)];

  // Newton's iteration for the parameter, within a bracket that shrinks.
  const double wanted = arc - leaf.arc, enough = 0.1 * kArcInverseError * length(curve);
  const double end = after == last ? length(curve) : after->arc;
  const double share = end > leaf.arc ? std::clamp(wanted / (end - leaf.arc), 0., 1.) : 0;
  double low = leaf.from, high = leaf.to, t = low + share * (high - low);
  for (int i = 0; i < 100 && low < high; ++i) {
    const double error = cubic.quadrature(leaf.from, t) - wanted;
    if (std::abs(error) <= enough) {
      break;
    }
    (error > 0 ? high : low) = t;
    const double speed = cubic.speed(t), next = speed > 0 ? t - error / speed : low;
    t = next > low && next < high ? next : 0.5 * (low + high);
    if (t == low || t == high) {
      break;
    }
  }

  Point result;
  result.edge = data_->cubic_edge[static_cast<std::size_t>(leaf.cubic)];
  const EdgeChains::Edge& of = data_->chains.edges[static_cast<std::size_t>(result.edge)];
  result.fraction = std::clamp(cubic.begin + (cubic.end - cubic.begin) * t, 0., 1.);
  const bool has_left = of.left.face >= 0, has_right = of.right.face >= 0;
  const bool on_left = side == CurveSide::left ? has_left : !has_right;
  result.side = on_left ? CurveSide::left : CurveSide::right;
  const auto edge = static_cast<std::size_t>(result.edge);
  result.at =
      on_left ? data_->left[edge].at(result.fraction) : data_->right[edge].at(1 - result.fraction);
  result.position = cubic.position(t);
  result.tangent = direction(cubic, t);
  return result;
}

}  // namespace limitsurf
