// SPDX-License-Identifier: Apache-2.0
//
// The derivatives at u = v = 2^-n are sums of terms n^power growth^n: one for each mode, by the
// eigenvalues and Jordan chains of the ring. The largest term that does not vanish is the limit.
#include "limitsurf/surface/vertex_approach.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "limitsurf/own_unit.h"
#include "limitsurf/surface/tile_weights.h"

namespace limitsurf {
namespace {

/// Vectors below this fraction of the largest coefficient count as zero: it is several orders of
/// magnitude above rounding, and far below any detail of a mesh.
constexpr double kVanishing = 1e-10;

/// The derivatives of a mode have rounding errors relative to its own size, about 1. Where products
/// of the derivatives of two modes differ by less than this part of the derivatives, they count as
/// equal: it is ten times that rounding. (Beside the boundary of a sector of N faces the two
/// leading modes are nearly parallel: the difference is N^-3 of the derivatives or so.)
constexpr double kEqualProducts = 1e-15;

/// Eigenvalues that differ by less than this count as equal. Equal ones that come from different
/// closed forms differ by rounding, which is three orders of magnitude less.
constexpr double kEqualGrowth = 1e-13;

/// Only the modes with the largest eigenvalues can lead, and of a large ring all others are left
/// out.
constexpr std::size_t kLeadingModes = 24;
/// They are among so many first modes, unless the ring is a dart: two or four modes follow each
/// other for each frequency of the spokes, and the larger eigenvalue of a frequency decreases as
/// that grows and is above 1/4, the smaller one below.
constexpr int kFirstModes = 256;

/// A term n^power growth^n of du and dv: derivatives of a mode, and its coefficient.
struct Term {
  double growth;
  int power;
  double du, dv;
  Vector3 coefficient;
};

/// A term n^power growth^n of du x dv: what two modes contribute to it.
struct CrossTerm {
  double growth;
  int power;
  double area;  ///< du x dv of the two modes
  Vector3 normal;
};

/// Whether a term outgrows another one as n grows. Of terms whose growth differs only in its sign
/// the positive one comes first.
template <typename A, typename B>
bool dominates(const A& a, const B& b) {
  const double size_a = std::abs(a.growth), size_b = std::abs(b.growth);
  if (std::abs(size_a - size_b) > kEqualGrowth) {
    return size_a > size_b;
  }
  if ((a.growth < 0) != (b.growth < 0)) {
    return b.growth < 0;
  }
  return a.power > b.power;
}

/// The size of the larger eigenvalue of a pair.
double largerSize(const ModePair& pair) {
  const double square = pair.forth * pair.back;
  return square < 0 ? std::sqrt(pair.mean * pair.mean - square)
                    : std::abs(pair.mean) + std::sqrt(square);
}

bool isIn(const ModePair& pair, int mode) { return mode == pair.a || mode == pair.b; }

/// The size of a mode's eigenvalue; of a pair's modes the larger one.
double sizeOf(const Eigenbasis& basis, int mode) {
  for (const ModePair& pair : basis.pairs()) {
    if (isIn(pair, mode)) {
      return largerSize(pair);
    }
  }
  return std::abs(basis.eigenvalue(mode));
}

/// The terms of the derivatives on the way to the vertex of one face.
class ApproachTerms {
 public:
  /// Coefficients are multiplied by `scale`.
  ApproachTerms(const Eigenbasis& basis, int face, const Points& coefficients, double scale)
      : basis_(basis),
        face_(face),
        coefficients_(coefficients),
        scale_(scale),
        window_(outermost(basis, face)) {}

  /// All terms, dominant ones first.
  std::vector<Term> sorted() const {
    std::vector<Term> terms;
    for (const ModePair& pair : basis_.pairs()) {
      addPair(pair, terms);
    }
    for (const int mode : leadingModes()) {
      if (!inPair(mode)) {
        addMode(mode, terms);
      }
    }
    std::stable_sort(terms.begin(), terms.end(), dominates<Term, Term>);
    return terms;
  }

  /// The first of them: those of the two modes with the largest eigenvalues, and of all whose
  /// eigenvalues have the size of the second one's. Empty where pairs have terms.
  std::vector<Term> first() const {
    std::vector<Term> terms;
    if (!basis_.pairs().empty()) {
      return terms;
    }
    const int count = firstModes();
    double largest = 0, second = 0;
    for (int mode = 1; mode < count; ++mode) {
      const double size = std::abs(basis_.eigenvalue(mode));
      second = std::max(second, std::min(size, largest));
      largest = std::max(largest, size);
    }
    for (int mode = 1; mode < count; ++mode) {
      if (std::abs(basis_.eigenvalue(mode)) >= second - kEqualGrowth) {
        addMode(mode, terms);
      }
    }
    std::stable_sort(terms.begin(), terms.end(), dominates<Term, Term>);
    return terms;
  }

 private:
  /// The window at the outermost point of the way, where it enters quarter (1, 1).
  static GridWindow outermost(const Eigenbasis& basis, int face) {
    Quarter corner(1, 1);
    corner.u = corner.v = 0;
    return gridWindow(corner, basis.sides(face), 1);
  }

  /// The modes with the largest eigenvalues but the constant one. (The factor 2^n that both
  /// derivatives have in common does not change the order.)
  std::vector<int> leadingModes() const {
    std::vector<int> modes(static_cast<std::size_t>(firstModes()) - 1);
    std::iota(modes.begin(), modes.end(), 1);
    const std::size_t kept = std::min(kLeadingModes, modes.size());
    std::partial_sort(modes.begin(), modes.begin() + static_cast<std::ptrdiff_t>(kept), modes.end(),
                      [&](int a, int b) {
                        const double size_a = sizeOf(basis_, a), size_b = sizeOf(basis_, b);
                        return size_a != size_b ? size_a > size_b : a < b;
                      });
    modes.resize(kept);
    return modes;
  }

  /// The leading modes are among so many first ones.
  int firstModes() const {
    return basis_.ring().kind == RingKind::dart ? basis_.modeCount()
                                                : std::min(basis_.modeCount(), kFirstModes);
  }

  Vector3 coefficientOf(int mode) const { return scale_ * coefficients_.row(mode).transpose(); }

  bool inPair(int mode) const {
    return std::any_of(basis_.pairs().begin(), basis_.pairs().end(),
                       [&](const ModePair& pair) { return isIn(pair, mode); });
  }

  /// The derivatives of mode `shape` times a coefficient.
  void add(int shape, double growth, int power, const Vector3& coefficient,
           std::vector<Term>& terms) const {
    const Eigenbasis::Table table = basis_.table(shape, face_);
    PatchValues<double> patch;
    evaluateWindow<1>(table.grid + window_.b * tile_grid::kSize + window_.a, tile_grid::kSize,
                      window_.u, window_.v, patch);
    terms.push_back({growth, power, patch.du, patch.dv, coefficient});
  }

  void addMode(int mode, std::vector<Term>& terms) const {
    const Vector3 coefficient = coefficientOf(mode);
    add(mode, basis_.eigenvalue(mode), 0, coefficient, terms);
    for (const Eigenbasis::Chain& chain : basis_.chains()) {
      if (chain.from == mode) {
        add(chain.to, basis_.eigenvalue(mode), 1,
            chain.rate / basis_.eigenvalue(mode) * coefficient, terms);
      }
    }
  }

  void addPair(const ModePair& pair, std::vector<Term>& terms) const {
    const Vector3 a = coefficientOf(pair.a), b = coefficientOf(pair.b);
    const double square = pair.forth * pair.back;
    if (square < 0) {  // a complex pair, turned by whole circles: both modes as they are
      add(pair.a, largerSize(pair), 0, a, terms);
      add(pair.b, largerSize(pair), 0, b, terms);
      return;
    }
    for (const double root : {std::sqrt(square), -std::sqrt(square)}) {
      // The eigenvector to mean + root is a + (root / back) b.
      const Vector3 share = (a + (pair.back / root) * b) / 2;
      add(pair.a, pair.mean + root, 0, share, terms);
      add(pair.b, pair.mean + root, 0, (root / pair.back) * share, terms);
    }
  }

  const Eigenbasis& basis_;
  const int face_;
  const Points& coefficients_;
  const double scale_;
  const GridWindow window_;
};

/// To the frame that is turned back by so many corners.
void turnBack(std::vector<Term>& terms, int turns) {
  for (Term& term : terms) {
    for (int i = 0; i < turns; ++i) {
      const double du = term.du;
      term.du = -term.dv;
      term.dv = du;
    }
  }
}

/// What a term contributes to a vector, and the size with which the length of a sum is compared.
struct Part {
  Vector3 value;
  double size;
};

/// The leading sum of terms that is not zero, of terms in the order of dominance. Those that grow
/// alike are added up. A sum counts as zero if it is at most `least` times the largest size in it.
template <typename Terms, typename PartOf>
Vector3 leadingSum(const Terms& terms, double least, const PartOf& partOf) {
  for (std::size_t i = 0; i < terms.size();) {
    Vector3 sum = Vector3::Zero();
    double largest = 0;
    const auto& leading = terms[i];
    for (; i < terms.size() && !dominates(leading, terms[i]); ++i) {
      const Part part = partOf(terms[i]);
      sum += part.value;
      largest = std::max(largest, part.size);
    }
    if (sum.norm() > least * largest) {
      return sum;
    }
  }
  return Vector3::Zero();
}

/// The leading term of a derivative. It counts as zero if it is at most `least`.
Vector3 leadingDerivative(const std::vector<Term>& terms, double Term::* derivative, double least) {
  return leadingSum(terms, least, [&](const Term& term) -> Part {
    return {term.*derivative * term.coefficient, 1};
  });
}

/// What two terms contribute to du x dv.
CrossTerm crossTerm(const Term& a, const Term& b) {
  const double area = a.du * b.dv - b.du * a.dv;
  const double sides = std::abs(a.du) + std::abs(a.dv) + std::abs(b.du) + std::abs(b.dv);
  if (!(std::abs(area) > kEqualProducts * sides)) {
    return {a.growth * b.growth, a.power + b.power, 0, Vector3::Zero()};
  }
  return {a.growth * b.growth, a.power + b.power, std::abs(area),
          area * a.coefficient.cross(b.coefficient)};
}

/// The products of all terms, dominant ones first.
std::vector<CrossTerm> crossTerms(const std::vector<Term>& terms) {
  std::vector<CrossTerm> crosses;
  for (auto a = terms.begin(); a != terms.end(); ++a) {
    for (auto b = a + 1; b != terms.end(); ++b) {
      crosses.push_back(crossTerm(*a, *b));
    }
  }
  std::stable_sort(crosses.begin(), crosses.end(), dominates<CrossTerm, CrossTerm>);
  return crosses;
}

/// Only those that grow like the first one.
void keepLeading(std::vector<CrossTerm>& crosses) {
  const auto end = std::find_if(crosses.begin(), crosses.end(), [&](const CrossTerm& cross) {
    return dominates(crosses.front(), cross);
  });
  crosses.erase(end, crosses.end());
}

/// The leading term of the cross product. Products of coefficients count as zero if they are at
/// most `least`.
Vector3 leadingNormal(const std::vector<CrossTerm>& crosses, double least) {
  return leadingSum(crosses, least,
                    [](const CrossTerm& cross) -> Part { return {cross.normal, cross.area}; });
}

}  // namespace

VertexApproach vertexApproach(const TileTable& table, const Pose& pose, int ring_tile, int turns) {
  const RingTile& tile = table.ring_tiles[ring_tile];
  const Pose::RingPose& ring = pose.ring(tile.ring);
  // Only directions are wanted. In a unit near their own size, products of lengths can be formed.
  const double scale = scaleToOwnUnit(ring.largest), size = scale * ring.largest;
  const ApproachTerms approach(*table.rings[tile.ring].basis, tile.face, ring.coefficients, scale);
  const auto leading = [&](std::vector<Term> terms, bool are_all) -> VertexApproach {
    turnBack(terms, turns);
    std::vector<CrossTerm> crosses = crossTerms(terms);
    if (!are_all) {
      keepLeading(crosses);  // products with other terms may come between the others
    }
    return {leadingDerivative(terms, &Term::du, kVanishing * size),
            leadingDerivative(terms, &Term::dv, kVanishing * size),
            leadingNormal(crosses, kVanishing * size * size)};
  };
  // On most meshes the first sums do not vanish, and no others are needed.
  const VertexApproach first = leading(approach.first(), false);
  if (!first.du.isZero(0) && !first.dv.isZero(0) && !first.normal.isZero(0)) {
    return first;
  }
  return leading(approach.sorted(), true);
}

}  // namespace limitsurf
