// SPDX-License-Identifier: Apache-2.0
//
// The eigenbasis of every kind of ring, against the subdivision step itself.
#include "limitsurf/eigen/eigenbasis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include "limitsurf/eigen/dart_spectrum.h"
#include "limitsurf/eigen/ring_slots.h"
#include "limitsurf/precision/complex.h"
#include "limitsurf/precision/double_double_eigen.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

using Big = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>,
                                          boost::multiprecision::et_off>;
using WideMatrix = Eigen::Matrix<DoubleDouble, Eigen::Dynamic, Eigen::Dynamic>;

constexpr RingKind kKinds[] = {RingKind::interior, RingKind::boundary, RingKind::pinned,
                               RingKind::cone,     RingKind::dart,     RingKind::tip,
                               RingKind::loop};

std::string describe(const Ring& ring) {
  const char* names[] = {"interior", "boundary", "pinned", "cone", "dart", "tip", "loop"};
  return std::string(names[static_cast<int>(ring.kind)]) + " of " + std::to_string(ring.faces);
}

bool exists(const Ring& ring) {
  return ring.faces >= (ring.closed() || ring.kind == RingKind::loop ? 2 : 1);
}

/// The matrix of a step on the coefficients of the modes.
WideMatrix jordanForm(const Eigenbasis& basis) {
  WideMatrix j = WideMatrix::Zero(basis.modeCount(), basis.modeCount());
  for (int mode = 0; mode < basis.modeCount(); ++mode) j(mode, mode) = basis.eigenvalue(mode);
  for (const auto& chain : basis.chains()) j(chain.to, chain.from) = chain.rate;
  for (const ModePair& pair : basis.pairs()) {
    j(pair.b, pair.a) = pair.forth;
    j(pair.a, pair.b) = pair.back;
  }
  return j;
}

/// Holds S R = R J and L R = 1, which together prove that the eigenvalues are those of S, each as
/// often as it occurs.
void compareWithRingMatrix(const Ring& ring) {
  const Eigenbasis basis(ring);
  const int n = ring.size();
  const WideMatrix identity = WideMatrix::Identity(n, n), j = jordanForm(basis);
  const WideMatrix s = subdivideRing<WideMatrix>(ring, identity);
  WideMatrix right(n, n);
  for (int mode = 0; mode < n; ++mode) {
    const std::vector<double> vector = basis.ringVector(mode);
    right.col(mode) = Eigen::Map<const Eigen::VectorXd>(vector.data(), n).cast<DoubleDouble>();
  }
  const Eigen::MatrixXd left = basis.projectTransposed(Eigen::MatrixXd::Identity(n, n)).transpose();
  const auto largest = [](const WideMatrix& m) { return m.cast<double>().cwiseAbs().maxCoeff(); };
  const WideMatrix wide_left = left.cast<DoubleDouble>();
  EXPECT_LE(largest(s * right - right * j), 2e-15) << describe(ring);
  // The other errors are sums of the rounding of all modes.
  const double allowed = 1e-14 * std::max(1., ring.faces / 100.);
  EXPECT_LE(largest(wide_left * right - identity), 2 * allowed) << describe(ring);
  EXPECT_LE(largest(s - right * j * wide_left), allowed) << describe(ring);

  Random random(n);
  Points points(n, 3), coefficients;
  for (int i = 0; i < n; ++i) points.row(i) = random.vector(1);
  basis.project(points, coefficients);
  EXPECT_LE((coefficients - left * points).cwiseAbs().maxCoeff(), 1e-14 * left.norm())
      << describe(ring);
}

TEST(Eigenbasis, FactorisesTheRingMatrix) {
  for (RingKind kind : kKinds) {
    for (int faces = 1; faces <= 24; ++faces) {
      if (exists({kind, faces})) compareWithRingMatrix({kind, faces});
    }
    for (int faces : {33, 48}) compareWithRingMatrix({kind, faces});
  }
}

TEST(SlowEigenbasis, FactorisesTheRingMatrix) {
  for (RingKind kind : kKinds) {
    for (int faces = 25; faces <= 102; ++faces) compareWithRingMatrix({kind, faces});
    for (int faces : {125, 150, 169, 183, 198, 200}) compareWithRingMatrix({kind, faces});
  }
}

/// Whether a dart has a real eigenvalue, to the last bit of a double.
bool hasEigenvalue(int faces, double eigenvalue) {
  const DartSpectrum spectrum(faces);
  const auto is_equal = [&](const auto& wave) {
    return static_cast<double>(abs(wave.lambda())) == eigenvalue;
  };
  return std::any_of(spectrum.waves.begin(), spectrum.waves.end(), is_equal) ||
         std::any_of(spectrum.pair.begin(), spectrum.pair.end(), is_equal);
}

TEST(Eigenbasis, OfDartsHasTheEigenvaluesMidwayBetweenPoles) {
  for (int faces = 4; faces <= 100; faces += 4) EXPECT_TRUE(hasEigenvalue(faces, 0.5)) << faces;
  EXPECT_TRUE(hasEigenvalue(4, 0.25));
  for (int faces : {2, 3, 5, 6, 7, 9, 10}) EXPECT_FALSE(hasEigenvalue(faces, 0.5)) << faces;
}

void openDart(int faces) { EXPECT_NO_THROW(DartSpectrum{faces}) << faces << " faces"; }

TEST(Eigenbasis, OfDartsOpens) {
  for (int faces = 2; faces <= 200; ++faces) openDart(faces);
  for (int faces = 201; faces <= 1000; faces += 47) openDart(faces);
}

TEST(SlowEigenbasis, OfDartsOpens) {
  for (int faces = 201; faces <= 1000; ++faces) openDart(faces);
}

TEST(Eigenbasis, OfDartsHasComplexPairs) {
  for (int faces = 2; faces <= 102; ++faces) {
    const Eigenbasis basis({RingKind::dart, faces});
    ASSERT_EQ(basis.pairs().size(), 1u);
    const bool complex = basis.pairs()[0].forth * basis.pairs()[0].back < 0;
    if (faces < 6 || (faces % 4 == 0 && faces >= 20)) {
      EXPECT_FALSE(complex) << faces;
    } else if (faces <= 33 || faces % 4 == 2) {
      EXPECT_TRUE(complex) << faces;
    }
  }
}

// One coordinate on one face, subdivided.

struct Tile {
  Ring ring;
  int face;
  int ring_steps;
  std::vector<double> ring_points, outer_points;
};

Tile randomTile(const Eigenbasis& basis, int face, int ring_steps, Random& random) {
  Tile tile{basis.ring(), face, ring_steps, {}, {}};
  for (int i = 0; i < basis.ring().size(); ++i) {
    tile.ring_points.push_back(random.uniform(-1, 1));
  }
  for (int i = 0; i < basis.outerModes(face).count(); ++i) {
    tile.outer_points.push_back(random.uniform(-1, 1));
  }
  return tile;
}

using BigGrid = std::array<Big, tile_grid::kSlots>;

class SubdividedTile {
 public:
  explicit SubdividedTile(const Tile& tile)
      : tile_(tile),
        ring_step_(tile.ring),
        tile_step_(tile.ring.sides(tile.face)),
        ring_(tile.ring_points.begin(), tile.ring_points.end()) {
    for (int i = 0; i < tile.ring_steps; ++i) stepRing();
    grid_.fill(0);
    std::size_t next = 0;
    for (const int c : tile_grid::kOuterSlots) {
      if (tile_grid::exists(tile.ring.sides(tile.face), c)) grid_[c] = tile.outer_points[next++];
    }
    takeRing();
  }

  void step() {
    BigGrid next;
    next.fill(0);
    tile_step_.apply(grid_, next);
    grid_ = next;
    stepRing();
    takeRing();
  }

  const BigGrid& grid() const { return grid_; }

  /// The limit position of the vertex.
  Big limit() const {
    SubdividedTile copy(*this);
    for (int i = 0; i < 600; ++i) copy.stepRing();
    return copy.ring_[0];
  }

  /// The largest distance of the ring's points from that limit.
  Big size(const Big& limit) const {
    Big result = 0;
    for (const Big& point : ring_) result = std::max<Big>(result, abs(point - limit));
    return result;
  }

 private:
  void stepRing() {
    std::vector<Big> next(ring_.size());
    ring_step_.apply([&](int i) -> const Big& { return ring_[i]; },
                     [&](int i) -> Big& { return next[i]; });
    ring_ = next;
  }
  void takeRing() {
    forEachRingSlot(tile_.ring, tile_.face,
                    [&](int slot, int point) { grid_[slot] = ring_[point]; });
  }

  Tile tile_;
  RingStep<Big> ring_step_;
  TileStep<Big> tile_step_;
  std::vector<Big> ring_;
  BigGrid grid_;
};

/// A uniform cubic B-spline of four points, or its derivative; a missing first point is the linear
/// continuation.
Big spline(std::array<Big, 4> p, bool low, double parameter, int derivative) {
  if (low) p[0] = 2 * p[1] - p[2];
  const Big t = parameter, s = 1 - t;
  switch (derivative) {
    case 0:
      return (s * s * s * p[0] + (3 * t * t * t - 6 * t * t + 4) * p[1] +
              (3 * s * s * s - 6 * s * s + 4) * p[2] + t * t * t * p[3]) /
             6;
    case 1:
      return (s * s * (p[1] - p[0]) + (1 + 2 * s * t) * (p[2] - p[1]) + t * t * (p[3] - p[2])) / 2;
    default:
      return s * (p[2] - 2 * p[1] + p[0]) + t * (p[3] - 2 * p[2] + p[1]);
  }
}

struct Place {
  int a, b;  // the quarter
  double u, v;
};

Big patch(const BigGrid& grid, Sides sides, const Place& at, int du, int dv) {
  std::array<Big, 4> rows;
  for (int y = 0; y < 4; ++y) {
    std::array<Big, 4> row;
    for (int x = 0; x < 4; ++x) row[x] = grid[(at.b + y) * tile_grid::kSize + at.a + x];
    rows[y] = spline(row, onRight(sides) && at.a == 0, at.u, du);
  }
  return spline(rows, onLeft(sides) && at.b == 0, at.v, dv);
}

constexpr std::array<std::array<int, 2>, 6> kDerivatives = {
    {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};

double asDouble(const Big& value) { return static_cast<double>(value); }

/// The worst errors of values, first and second derivatives.
using Errors = std::array<double, 3>;

/// Compares weights() and controlGrid() of a random tile after some steps. Derivatives are with
/// respect to the face's own parameters. Errors are relative to the largest value after the same
/// number of steps, or after the first step; those of first derivatives also to the size of the
/// ring after these steps.
void compareTile(const Eigenbasis& basis, int face, int ring_steps, Random& random,
                 Errors& errors) {
  const Tile tile = randomTile(basis, face, ring_steps, random);
  const Sides sides = basis.sides(face);
  Points ring_points = Points::Zero(basis.ring().size(), 3), coefficients;
  for (int i = 0; i < basis.ring().size(); ++i) ring_points(i, 0) = tile.ring_points[i];
  basis.project(ring_points, coefficients);

  SubdividedTile truth(tile);
  const Big limit = truth.limit();
  errors[0] = std::max(errors[0], std::abs(coefficients(0, 0) - asDouble(limit)));
  Points relative = coefficients;
  relative(0, 0) = 0;
  Eigen::Array4d outer[tile_grid::kOuter];
  for (std::size_t i = 0; i < tile.outer_points.size(); ++i) {
    outer[i] = Eigen::Array4d::Zero();
    outer[i][0] = asDouble(tile.outer_points[i] - limit);
  }

  Errors first_scale = {};
  int done = 0;
  for (const int steps : {1, 2, 3, 5, 10, 20, 40, 70}) {
    for (; done < steps; ++done) truth.step();
    const Place places[] = {{1, 0, random.uniform(), random.uniform()},
                            {1, 1, random.uniform(), random.uniform()},
                            {0, 1, random.uniform(), random.uniform()},
                            {1, 0, 0, 0},
                            {1, 1, 0, 0}};
    Errors differences = {}, scale = {1, first_scale[1], std::ldexp(first_scale[2], 1 - steps)};
    for (const Place& at : places) {
      GridWindow window{at.a, at.b, CubicWeights(at.u, onRight(sides) && at.a == 0, false),
                        CubicWeights(at.v, onLeft(sides) && at.b == 0, false), 2};
      Eigen::MatrixXd on_modes, on_outer;
      basis.weights(face, steps, ring_steps, window, on_modes, on_outer);
      for (std::size_t functional = 0; functional < kDerivatives.size(); ++functional) {
        const auto [du, dv] = kDerivatives[functional];
        const int order = du + dv;
        // For second derivatives the caller has to multiply by 2^(steps - 1).
        const double exact = asDouble(boost::multiprecision::ldexp(
            patch(truth.grid(), sides, at, du, dv), order == 2 ? steps + 1 : order * steps));
        const Eigen::Index row = static_cast<Eigen::Index>(functional);
        double got = on_modes.row(row).dot(coefficients.col(0));
        for (std::size_t i = 0; i < tile.outer_points.size(); ++i) {
          got += on_outer(row, static_cast<Eigen::Index>(i)) * tile.outer_points[i];
        }
        scale[order] = std::max(scale[order], std::abs(exact));
        differences[order] = std::max(differences[order], std::abs(got - exact));
      }
    }

    Eigen::Array4d grid[tile_grid::kSlots];
    basis.controlGrid(face, steps, ring_steps, relative, outer, grid);
    for (int c = 0; c < tile_grid::kSlots; ++c) {
      if (!tile_grid::exists(sides, c)) continue;
      const double exact =
          asDouble(boost::multiprecision::ldexp(truth.grid()[c] - limit, steps - 1));
      scale[1] = std::max(scale[1], std::abs(exact));
      differences[1] = std::max(differences[1], std::abs(grid[c][0] - exact));
    }
    scale[1] =
        std::max(scale[1], asDouble(boost::multiprecision::ldexp(truth.size(limit), steps - 1)));
    if (steps == 1) first_scale = scale;
    for (int order = 0; order < 3; ++order) {
      errors[order] = std::max(errors[order], differences[order] / scale[order]);
    }
  }
}

void compareTiles(RingKind kind, const std::vector<int>& face_counts) {
  for (const int faces : face_counts) {
    const Ring ring{kind, faces};
    if (!exists(ring)) continue;
    const Eigenbasis basis(ring);
    Random random(faces);
    Errors errors = {};
    std::vector<int> some = {0, 1, faces / 2, faces - 1};
    std::sort(some.begin(), some.end());
    some.erase(std::unique(some.begin(), some.end()), some.end());
    for (const int face : some) {
      if (face >= faces) continue;
      for (const int ring_steps : {0, 1, 2}) compareTile(basis, face, ring_steps, random, errors);
    }
    std::printf("%-18s position %.1e  first derivatives %.1e  second %.1e\n",
                describe(ring).c_str(), errors[0], errors[1], errors[2]);
    // The largest errors are those of darts of valence 16, which almost have a triple eigenvalue.
    EXPECT_LE(errors[0], 4e-15) << describe(ring);
    EXPECT_LE(errors[1], 1e-13) << describe(ring);
    EXPECT_LE(errors[2], 1e-12) << describe(ring);
  }
}

TEST(Eigenbasis, ReachesSubdividedTiles) {
  for (RingKind kind : kKinds) compareTiles(kind, {1, 2, 3, 4, 5, 6, 8, 17});
}

TEST(SlowEigenbasis, ReachesSubdividedTiles) {
  std::vector<int> all(100);
  std::iota(all.begin(), all.end(), 1);
  for (RingKind kind : kKinds) compareTiles(kind, all);
}

TEST(Eigenbasis, OfLargeDartsReachesAStep) {
  for (const int faces : {999, 1000, 1002}) {
    const Ring ring{RingKind::dart, faces};
    const Eigenbasis basis(ring);
    Random random(faces);
    Points points(ring.size(), 3), before, after;
    for (int i = 0; i < ring.size(); ++i) points.row(i) = random.vector(1);
    basis.project(points, before);
    basis.project(subdivideRing<Points>(ring, points), after);
    Points expected = before, sum = Points::Zero(ring.size(), 3);
    for (int mode = 0; mode < basis.modeCount(); ++mode) {
      expected.row(mode) = basis.eigenvalue(mode) * before.row(mode);
      const std::vector<double> vector = basis.ringVector(mode);
      sum += Eigen::Map<const Eigen::VectorXd>(vector.data(), ring.size()) * before.row(mode);
    }
    const ModePair& pair = basis.pairs()[0];
    expected.row(pair.a) += pair.back * before.row(pair.b);
    expected.row(pair.b) += pair.forth * before.row(pair.a);
    EXPECT_LE((after - expected).cwiseAbs().maxCoeff(), 1e-14) << faces;
    EXPECT_LE((sum - points).cwiseAbs().maxCoeff(), 3e-14) << faces;
  }
}

// Twice the product of two numbers up to these valences exceeds 2^31.
constexpr Ring kRingsBeyond32Bits[] = {{RingKind::interior, 50000}, {RingKind::pinned, 33000}};

TEST(Eigenbasis, OfLargeValencesHasItsModesOnEveryFace) {
  for (const Ring& ring : kRingsBeyond32Bits) {
    const Eigenbasis basis(ring);
    for (const int mode : {3, basis.modeCount() / 2, basis.modeCount() - 2}) {
      const double lambda = basis.eigenvalue(mode);
      const std::vector<double> vector = basis.ringVector(mode);
      const Eigen::Map<const Eigen::VectorXd> before(vector.data(), ring.size());
      const auto after = subdivideRing<Eigen::MatrixXd>(ring, before);
      EXPECT_GE(before.cwiseAbs().maxCoeff(), 0.5) << describe(ring) << ", mode " << mode;
      EXPECT_LE((after - lambda * before).cwiseAbs().maxCoeff(), 1e-15)
          << describe(ring) << ", mode " << mode;
      for (const int face : {0, ring.faces / 2, ring.faces - 1}) {
        const Eigenbasis::Table table = basis.table(mode, face);
        forEachRingSlot(ring, face, [&](int slot, int point) {
          EXPECT_NEAR(table.grid[slot], lambda * vector[point], 1e-15)
              << describe(ring) << ", mode " << mode << ", face " << face << ", slot " << slot;
        });
      }
    }
  }
}

TEST(SlowEigenbasis, OfLargeValencesHasItsDualVectors) {
  const Ring ring = kRingsBeyond32Bits[1];
  const Eigenbasis basis(ring);
  const int mode = basis.modeCount() - 2;
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(basis.modeCount(), 1);
  weights(mode, 0) = 1;
  const Eigen::MatrixXd left = basis.projectTransposed(weights);
  for (const int other : {3, basis.modeCount() / 2, mode - 1, mode, mode + 1}) {
    const std::vector<double> vector = basis.ringVector(other);
    const double product =
        left.col(0).dot(Eigen::Map<const Eigen::VectorXd>(vector.data(), ring.size()));
    EXPECT_NEAR(product, other == mode ? 1 : 0, 1e-13) << "mode " << other;
  }
}

/// The eigenvalues of the basis.
std::vector<Complex> knownSpectrum(const Eigenbasis& basis) {
  std::vector<Complex> result;
  for (int mode = 0; mode < basis.modeCount(); ++mode) result.push_back(basis.eigenvalue(mode));
  for (const ModePair& pair : basis.pairs()) {
    const Complex root = sqrt(Complex(DoubleDouble(pair.forth).times(pair.back)));
    result[pair.a] += root;
    result[pair.b] -= root;
  }
  return result;
}

/// How much a control point of a face may move, relative to the ring's size, if the coefficient of
/// each mode moves as far as rounding may move it (docs/accuracy.md): the sum over modes of
/// lambda^(steps - 1), the size of the mode, and the size of its left eigenvector.
double amplification(const Eigenbasis& basis, int face, int steps) {
  const int n = basis.modeCount();
  const Eigen::MatrixXd left = basis.projectTransposed(Eigen::MatrixXd::Identity(n, n));
  const Eigen::VectorXd left_size = left.bottomRows(n - 1).cwiseAbs().colwise().sum().transpose();
  const std::vector<Complex> spectrum = knownSpectrum(basis);
  const auto growth = [&](int mode) {
    double size = static_cast<double>(abs(spectrum[mode]));
    for (const ModePair& pair : basis.pairs()) {
      if (mode == pair.b) size = std::max(size, static_cast<double>(abs(spectrum[pair.a])));
    }
    return size;
  };
  std::array<double, tile_grid::kSlots> moved = {};
  const auto add = [&](const Eigenbasis::Table& table, double factor) {
    for (int slot = 0; slot < tile_grid::kSlots; ++slot) {
      moved[slot] += factor * std::abs(table.grid[slot]);
    }
  };
  for (int mode = 1; mode < n; ++mode) {
    const double power = std::pow(growth(mode), steps - 1) * left_size[mode];
    add(basis.table(mode, face), power);
    for (const Eigenbasis::Chain& chain : basis.chains()) {
      if (chain.from == mode) {
        add(basis.table(chain.to, face), (steps - 1) * power / growth(mode) * std::abs(chain.rate));
      }
    }
  }
  return *std::max_element(moved.begin(), moved.end());
}

TEST(Eigenbasis, AmplifiesRoundingLittle) {
  for (RingKind kind : kKinds) {
    for (int faces : {1, 2, 3, 4, 5, 6, 7, 8, 16, 20, 40, 100}) {
      if (!exists({kind, faces})) continue;
      const Eigenbasis basis({kind, faces});
      const double most = faces <= 8 ? 1.3 : faces <= 40 ? 5.2 : 12.2;
      for (int face : {0, faces / 2, faces - 1}) {
        for (int steps : {5, 6, 8}) {
          EXPECT_LE(amplification(basis, face, steps), most)
              << describe(basis.ring()) << ", " << steps << " steps";
        }
      }
    }
  }
}

// Darts and cones on a surface, at the vertex and as close to it as doubles can be.

Cage dartFan(int faces) {
  Cage cage = fan(faces, true, 31 * faces);
  const int middle = cage.faces[0][1];
  sharpenEdge(cage, cage.faces[0][0], middle, INFINITY);
  sharpenEdge(cage, middle, cage.faces[1][1], INFINITY);
  return cage;
}

TEST(Darts, HaveANormalThatAllFacesApproach) {
  for (int faces = 3; faces <= 12; ++faces) {
    const LimitSurface surface = limitSurface(dartFan(faces));
    const double near = std::ldexp(1., -400);
    for (int face = 0; face < faces; ++face) {
      const std::vector<Location> at = {{4 * face, 0, 0},
                                        {4 * face, near, 0},
                                        {4 * face, near, near},
                                        {4 * face, 0.3 * near, near}};
      const Evaluation e = surface.evaluate(at, Derivatives::first, true);
      EXPECT_TRUE(e.du.row(0).array().isNaN().all() && e.dv.row(0).array().isNaN().all());
      for (int i = 0; i < 4; ++i) {
        EXPECT_LE((e.normal.row(i) - e.normal.row(0)).norm(), 1e-6) << faces << ", face " << face;
      }
    }
  }
  const LimitSurface two = limitSurface(dartFan(2));
  const Evaluation e = two.evaluate(std::vector<Location>{{0, 0, 0}}, Derivatives::first, true);
  EXPECT_TRUE(e.normal.array().isNaN().all());
}

TEST(Darts, HaveTheFramesThatTheDiagonalApproaches) {
  for (int faces = 3; faces <= 8; ++faces) {
    const LimitSurface surface = limitSurface(dartFan(faces));
    const double near = std::ldexp(1., -400);
    for (int face = 0; face < faces; ++face) {
      const std::vector<Location> at = {{4 * face, 0, 0}, {4 * face, near, near}};
      const auto frames = surface.frames(at);
      EXPECT_LE((frames.row(0) - frames.row(1)).norm(), 1e-6) << faces << ", face " << face;
    }
  }
}

TEST(Cones, HaveNoNormal) {
  for (int faces = 2; faces <= 9; ++faces) {
    Cage cage = fan(faces, true, faces);
    sharpenVertex(cage, cage.faces[0][0], INFINITY);
    const LimitSurface surface = limitSurface(cage);
    const Evaluation e =
        surface.evaluate(std::vector<Location>{{0, 0, 0}}, Derivatives::second, true);
    EXPECT_EQ(Vector3(e.position.row(0)), Vector3(cage.positions.row(cage.faces[0][0])));
    for (const Points* missing : {&e.du, &e.dv, &e.duu, &e.duv, &e.dvv, &e.normal}) {
      EXPECT_TRUE(missing->array().isNaN().all()) << faces;
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
