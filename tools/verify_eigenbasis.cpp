// SPDX-License-Identifier: Apache-2.0
//
// Prints, for each valence, how exact the eigenbasis of its vertices is:
//   - the defective eigenvalue of the ring matrix S and its zero-based index among the eigenvalues
//     in decreasing order (Lacewell & Burley 2007, figure 4), found by ranks of S - lambda, where S
//     is made from OpenSubdiv's masks;
//   - max |A - T J T^-1|, A being the whole face's subdivision matrix;
//   - the evaluator's error against explicit recursive subdivision in 50 decimal digits.
//
//   verify_eigenbasis [boundary|interior|pinned|cone|dart] [--valences FIRST LAST] [--csv FILE]
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/eigen/ring_slots.h"
#include "limitsurf/precision/double_double_eigen.h"
#include "limitsurf/surface/limit_surface.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/random.h"
#include "support/truth/deep_subdivision.h"

namespace limitsurf {
namespace {

using WideMatrix = Eigen::Matrix<DoubleDouble, Eigen::Dynamic, Eigen::Dynamic>;

struct Line {
  int valence = 0;
  int index = -1;  // of the defective eigenvalue; -1: none
  double value = 0;
  double factorisation = 0;  // max |A - T J T^-1|
  double position = 0;       // errors of the evaluator, as limit_surface.h measures them
  double derivative = 0;
};

/// The first, second, middle and last face: by symmetry these represent all faces.
std::vector<int> someFaces(int faces) {
  const std::set<int> some = {0, std::min(1, faces - 1), faces / 2, faces - 1};
  return {some.begin(), some.end()};
}

WideMatrix ringMatrix(const Ring& ring) {
  return subdivideRing<WideMatrix>(ring, WideMatrix::Identity(ring.size(), ring.size()));
}

/// The eigenvalue that occurs more often than it has eigenvectors.
void findDefect(const Eigenbasis& basis, Line& line) {
  std::vector<double> lambda;
  for (int mode = 0; mode < basis.modeCount(); ++mode) {
    lambda.push_back(basis.eigenvalue(mode));
  }
  for (const ModePair& pair : basis.pairs()) {  // their size, where they are conjugate
    const double square = pair.forth * pair.back;
    lambda[pair.a] =
        square < 0 ? std::sqrt(pair.mean * pair.mean - square) : pair.mean + std::sqrt(square);
    lambda[pair.b] = square < 0 ? lambda[pair.a] : pair.mean - std::sqrt(square);
  }
  std::sort(lambda.rbegin(), lambda.rend());
  const WideMatrix s = ringMatrix(basis.ring());
  for (std::size_t i = 0; i < lambda.size();) {
    std::size_t end = i;
    while (end < lambda.size() && lambda[i] - lambda[end] < 1e-14) {
      ++end;
    }
    if (end - i > 1) {
      Eigen::FullPivLU<WideMatrix> lu(s - lambda[i] * WideMatrix::Identity(s.rows(), s.cols()));
      lu.setThreshold(1e-13);
      if (lu.dimensionOfKernel() < static_cast<Eigen::Index>(end - i)) {
        line.index = static_cast<int>(i);
        line.value = lambda[i];
      }
    }
    i = end;
  }
}

/// max |A - T J T^-1| for one face, with T and its inverse as evaluation uses them.
double factorisationError(const Eigenbasis& basis, int face) {
  const Ring& ring = basis.ring();
  const OuterModes<double>& outer = basis.outerModes(face);
  const int n = ring.size(), k = n + outer.count();
  Eigen::MatrixXd u0(n, n), u1(outer.count(), n);
  for (int mode = 0; mode < n; ++mode) {
    const std::vector<double> vector = basis.ringVector(mode);
    u0.col(mode) = Eigen::Map<const Eigen::VectorXd>(vector.data(), n);
    u1.col(mode) = Eigen::Map<const Eigen::VectorXd>(basis.table(mode, face).outer, outer.count());
  }
  const Eigen::MatrixXd u0_inverse =
      basis.projectTransposed(Eigen::MatrixXd::Identity(n, n)).transpose();
  Eigen::MatrixXd t = Eigen::MatrixXd::Zero(k, k), t_inverse = t, j = t, a = t;
  t.topLeftCorner(n, n) = u0;
  t.bottomLeftCorner(outer.count(), n) = u1;
  t.bottomRightCorner(outer.count(), outer.count()) = outer.vectors();
  t_inverse.topLeftCorner(n, n) = u0_inverse;
  t_inverse.bottomLeftCorner(outer.count(), n) = -outer.inverse() * u1 * u0_inverse;
  t_inverse.bottomRightCorner(outer.count(), outer.count()) = outer.inverse();
  for (int mode = 0; mode < n; ++mode) {
    j(mode, mode) = basis.eigenvalue(mode);
  }
  for (const Eigenbasis::Chain& chain : basis.chains()) {
    j(chain.to, chain.from) = chain.rate;
  }
  for (const ModePair& pair : basis.pairs()) {
    j(pair.b, pair.a) = pair.forth;
    j(pair.a, pair.b) = pair.back;
  }
  for (int q = 0; q < outer.count(); ++q) {
    j(n + q, n + q) = outer.lambda(q);
    j.block(n, 0, outer.count(), n).row(q) = basis.chainsToOuter(face, q).transpose();
  }

  a.topLeftCorner(n, n) = ringMatrix(ring).cast<double>();
  a.bottomRightCorner(outer.count(), outer.count()) = outer.s12();
  forEachRingSlot(ring, face, [&](int slot, int point) {
    a.block(n, point, outer.count(), 1) += outer.s11().col(slot);
  });
  return (a - t * j * t_inverse).cwiseAbs().maxCoeff();
}

/// A fan of perturbed quads around a vertex of that kind.
test::Cage fanAround(const Ring& ring) {
  test::Cage cage = test::fan(ring.faces, ring.closed(), 7 * ring.faces + 1);
  const int vertex = cage.faces[0][0];
  if (ring.rule() == VertexRule::corner) {
    test::sharpenVertex(cage, vertex, INFINITY);
  } else if (ring.kind ==
             RingKind::dart) {  // sharp up to the boundary, so that only its inner end is a dart
    const int middle = cage.faces[0][1];
    test::sharpenEdge(cage, vertex, middle, INFINITY);
    test::sharpenEdge(cage, middle, cage.faces[1][1], INFINITY);
  }
  return cage;
}

/// The evaluator's errors at random places and on shells at distances down to 2^-40.
void measureEvaluator(const Ring& ring, Line& line) {
  const int faces = ring.faces;
  const test::Cage cage = fanAround(ring);
  const LimitSurface surface = test::limitSurface(cage);
  test::DeepSubdivision truth(cage);
  test::Random random(faces);
  for (const int sector : someFaces(faces)) {
    const int face = 4 * sector;  // four quads a sector, the first at the vertex
    std::vector<Location> at;
    for (const int shell : {1, 2, 3, 4, 5, 8, 13, 21, 30, 40}) {
      const double size = std::ldexp(1., -shell);
      at.push_back({face, size, size * random.uniform()});
      at.push_back({face, size * random.uniform(), size});
    }
    for (int i = 0; i < 6; ++i) {
      at.push_back({face, random.uniform(), random.uniform()});
    }
    const Evaluation got = surface.evaluate(at, Derivatives::first);
    double scale = 0;
    std::vector<test::Truth> truths;
    for (const Location& location : at) {
      truths.push_back(truth.evaluate(location));
      if (std::max(location.u, location.v) >= 1. / 16) {
        scale = std::max({scale, truths.back()[test::kDu].norm(), truths.back()[test::kDv].norm()});
      }
    }
    for (std::size_t i = 0; i < at.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const test::Truth& t = truths[i];
      line.position =
          std::max(line.position, (got.position.row(row).transpose() - t[test::kPosition]).norm() /
                                      test::diagonal(cage.positions));
      for (const auto& [quantity, value] :
           {std::pair{test::kDu, &got.du}, std::pair{test::kDv, &got.dv}}) {
        line.derivative =
            std::max(line.derivative, (value->row(row).transpose() - t[quantity]).norm() /
                                          std::max(scale, t[quantity].norm()));
      }
    }
    const Vector3 vertex = surface.evaluate(std::vector<Location>{{face, 0, 0}}).position.row(0);
    line.position = std::max(line.position, (vertex - truth.cornerPosition(face, 0)).norm() /
                                                test::diagonal(cage.positions));
  }
}

Line verified(RingKind kind, int valence) {
  Line line;
  line.valence = valence;
  const bool closed = Ring{kind, valence}.closed();
  const Ring ring{kind, closed ? valence : valence - 1};
  const auto basis = Eigenbasis::get(ring);
  findDefect(*basis, line);
  for (const int face : someFaces(ring.faces)) {
    line.factorisation = std::max(line.factorisation, factorisationError(*basis, face));
  }
  measureEvaluator(ring, line);
  return line;
}

const std::map<std::string, RingKind> kKinds = {{"boundary", RingKind::boundary},
                                                {"interior", RingKind::interior},
                                                {"pinned", RingKind::pinned},
                                                {"cone", RingKind::cone},
                                                {"dart", RingKind::dart}};

int run(int argc, char** argv) {
  RingKind kind = RingKind::boundary;
  int first = 2, last = 100;
  std::string csv;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto named = kKinds.find(argument);
    if (named != kKinds.end()) {
      kind = named->second;
    } else if (argument == "--valences" && i + 2 < argc) {
      first = std::stoi(argv[++i]);
      last = std::stoi(argv[++i]);
    } else if (argument == "--csv" && i + 1 < argc) {
      csv = argv[++i];
    } else {
      std::fprintf(stderr,
                   "usage: verify_eigenbasis [boundary|interior|pinned|cone|dart] "
                   "[--valences FIRST LAST] [--csv FILE]\n");
      return 2;
    }
  }
  if (first < 2 || last < first) {
    std::fprintf(stderr, "valences %d to %d: expected 2 <= FIRST <= LAST\n", first, last);
    return 2;
  }

  std::ofstream table;
  if (!csv.empty()) {
    table.open(csv);
    table << "valence,index,value,factorisation,position,derivative\n";
  }
  std::printf(
      "valence  defective eigenvalue   max |A - T J T^-1|   error in position   in du, dv\n");
  for (int valence = first; valence <= last; ++valence) {
    const Line line = verified(kind, valence);
    char defect[40] = "none";
    if (line.index >= 0) {
      std::snprintf(defect, sizeof defect, "index %3d: %g", line.index, line.value);
    }
    std::printf("%7d  %-20s   %18.1e   %17.1e   %9.1e\n", valence, defect, line.factorisation,
                line.position, line.derivative);
    std::fflush(stdout);
    if (table.is_open()) {
      table << valence << ',' << line.index << ',' << line.value << ',' << line.factorisation << ','
            << line.position << ',' << line.derivative << '\n';
    }
  }
  return 0;
}

}  // namespace
}  // namespace limitsurf

int main(int argc, char** argv) { return limitsurf::run(argc, argv); }
