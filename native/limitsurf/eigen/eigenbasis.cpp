// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/eigenbasis.h"

#include <cmath>
#include <map>
#include <mutex>

#include "limitsurf/eigen/curve_mode.h"
#include "limitsurf/eigen/eigenbasis_builder.h"

namespace limitsurf {
namespace {

double power(double base, int exponent) {
  double result = 1;
  for (; exponent > 0; exponent >>= 1, base *= base) {
    if (exponent & 1) {
      result *= base;
    }
  }
  return result;
}

/// lambda^steps for values, first and second derivatives: times 1, 2^(steps + 1), 2^(steps + 2).
/// (2 lambda)^steps stays within the range of double where lambda^steps does not.
struct Powers {
  double by_order[3];

  Powers(double lambda, int steps) {
    const double scaled = power(2 * lambda, steps);
    by_order[0] = std::ldexp(scaled, -steps);
    by_order[1] = 2 * scaled;
    by_order[2] = 4 * scaled;
  }
  double at(int functional) const { return by_order[functional == 0 ? 0 : functional < 3 ? 1 : 2]; }
};

using Functionals = Eigen::Array<double, GridWindow::kMaxCount, 1>;

Functionals applied(const GridWindow& window, const double* grid) {
  const double* corner = grid + window.b * tile_grid::kSize + window.a;
  PatchValues<double> patch{};
  switch (window.order) {
    case 0:
      evaluateWindow<0>(corner, tile_grid::kSize, window.u, window.v, patch);
      break;
    case 1:
      evaluateWindow<1>(corner, tile_grid::kSize, window.u, window.v, patch);
      break;
    default:
      evaluateWindow<2>(corner, tile_grid::kSize, window.u, window.v, patch);
  }
  Functionals result;
  result << patch.value, patch.du, patch.dv, patch.duu, patch.duv, patch.dvv;
  return result;
}

Functionals scaled(Functionals values, const Powers& powers, int count) {
  for (int d = 0; d < count; ++d) {
    values[d] *= powers.at(d);
  }
  return values;
}

}  // namespace

std::shared_ptr<const Eigenbasis> Eigenbasis::get(const Ring& ring) {
  static std::mutex mutex;
  static std::map<Ring, std::weak_ptr<const Eigenbasis>> bases;
  const std::lock_guard<std::mutex> lock(mutex);
  std::weak_ptr<const Eigenbasis>& known = bases[ring];
  std::shared_ptr<const Eigenbasis> basis = known.lock();
  if (!basis) {
    basis = std::make_shared<const Eigenbasis>(ring);
    known = basis;
  }
  return basis;
}

Eigenbasis::Eigenbasis(const Ring& ring) : ring_(ring) { Builder(*this).build(); }

Sides Eigenbasis::sides(int face) const {
  if (ring_.interior()) {
    return Sides::inner;
  }
  const bool left = face == 0, right = face == ring_.faces - 1;
  return left && right ? Sides::both : left ? Sides::left : right ? Sides::right : Sides::inner;
}

int Eigenbasis::firstMode(int m) const { return 3 + (ring_.interior() ? 4 : 2) * (m - 1); }

int Eigenbasis::parts(int m, bool plus, int face, Part out[2]) const {
  const int first = firstMode(m);
  const long turn = 2L * m * face;
  if (ring_.interior()) {
    if (2 * m == ring_.faces) {  // spokes alternate, or faces do
      out[0] = plus ? Part{first, cosAt(turn), 0} : Part{first + 1, 0, cosAt(turn)};
      return 1;
    }
    const int mode = first + (plus ? 0 : 2);
    out[0] = {mode, cosAt(turn), -sinAt(turn)};
    out[1] = {mode + 1, sinAt(turn), cosAt(turn)};
    return 2;
  }
  if (m == ring_.faces && plus) {
    return 0;  // its spokes all vanish
  }
  const int mode = m == ring_.faces || plus ? first : first + 1;
  switch (sides(face)) {
    case Sides::inner:
      out[0] = {mode, sinAt(turn), cosAt(turn)};
      break;
    case Sides::right:
      out[0] = {mode, 0, m % 2 ? 1. : -1.};
      break;
    default:
      out[0] = {mode, 0, 1};
  }
  return 1;
}

void Eigenbasis::project(const Points& ring_points, Points& coefficients) const {
  const int faces = ring_.faces, edges = ring_.edges();
  coefficients.setZero(modeCount(), 3);
  Points rest = ring_points;
  if (ring_.interior()) {
    const Vector3 v = ring_points.row(0);
    Vector3 edge_mean = Vector3::Zero(), face_mean = Vector3::Zero();
    for (int i = 0; i < faces; ++i) {
      edge_mean += (ring_points.row(ring_.edge(i)).transpose() - v) / faces;
      face_mean += (ring_points.row(ring_.face(i)).transpose() - v) / faces;
    }
    Vector3 constant = v;
    for (int i = 0; i < 2; ++i) {
      const Vector3 coefficient =
          radial_inverse_(i, 0) * edge_mean + radial_inverse_(i, 1) * face_mean;
      coefficients.row(1 + i) = coefficient;
      constant -= radial_vertex_[i] * coefficient;
    }
    coefficients.row(0) = constant;
    rest.rowwise() -= v.transpose();
  } else {
    const Vector3 v = ring_points.row(0), e_0 = ring_points.row(ring_.edge(0)),
                  e_k = ring_points.row(ring_.edge(faces));
    const auto curve = curveCoefficients<Vector3>(ring_.kind, v, e_0, e_k);
    coefficients.row(0) = curve.constant;
    coefficients.row(1) = curve.first;
    coefficients.row(2) = curve.second;
    for (int i = 0; i < ring_.size(); ++i) {
      rest.row(i) -=
          (curve.constant + curve_ring_[0][i] * curve.first + curve_ring_[1][i] * curve.second)
              .transpose();
    }
  }

  for (int m = 1; m <= spokeCount(); ++m) {
    Vector3 edge_cos = Vector3::Zero(), edge_sin = edge_cos, face_cos = edge_cos,
            face_sin = edge_cos;
    long edge_angle = 0, face_angle = m;
    const long step = 2L * m;
    const auto advance = [&](long& angle) {
      angle += step;
      while (angle >= period_) {
        angle -= period_;
      }
    };
    while (face_angle >= period_) {
      face_angle -= period_;
    }
    for (int i = 0; i < edges; ++i, advance(edge_angle)) {
      const Vector3 e = rest.row(ring_.edge(i));
      edge_cos += cos_[edge_angle] * e;
      edge_sin += sin_[edge_angle] * e;
    }
    for (int j = 0; j < faces; ++j, advance(face_angle)) {
      const Vector3 f = rest.row(ring_.face(j));
      face_cos += cos_[face_angle] * f;
      face_sin += sin_[face_angle] * f;
    }
    // 2 / faces normalises sines and cosines, 1 / faces those that alternate.
    const bool alternating = ring_.interior() ? 2 * m == faces : m == faces;
    const double norm = (alternating ? 1. : 2.) / faces;
    for (const bool plus : {true, false}) {
      const Spoke& spoke = spokes_[pairIndex(m, plus)];
      const double e = norm * spoke.edge, f = norm * spoke.face / 4;
      const Vector3 cosine = e * edge_cos + f * face_cos, sine = e * edge_sin + f * face_sin;
      // On face 0 of a ring the parts are the cosine and the sine mode themselves.
      Part part[2];
      const int count = parts(m, plus, 0, part);
      for (int i = 0; i < count; ++i) {
        coefficients.row(part[i].mode) = part[i].cosine != 0 ? cosine : sine;
      }
    }
  }
}

Eigen::MatrixXd Eigenbasis::projectTransposed(const Eigen::MatrixXd& mode_weights) const {
  const int faces = ring_.faces, edges = ring_.edges();
  Eigen::MatrixXd ring = Eigen::MatrixXd::Zero(ring_.size(), mode_weights.cols());
  for (int m = 1; m <= spokeCount(); ++m) {
    const bool alternating = ring_.interior() ? 2 * m == faces : m == faces;
    const double norm = (alternating ? 1. : 2.) / faces;
    for (const bool plus : {true, false}) {
      const Spoke& spoke = spokes_[pairIndex(m, plus)];
      Part part[2];
      const int count = parts(m, plus, 0, part);
      for (int p = 0; p < count; ++p) {
        const std::vector<double>& wave = part[p].cosine != 0 ? cos_ : sin_;
        const auto weight = norm * mode_weights.row(part[p].mode);
        for (int i = 0; i < edges; ++i) {
          ring.row(ring_.edge(i)) += spoke.edge * wave[2L * m * i % period_] * weight;
        }
        for (int j = 0; j < faces; ++j) {
          ring.row(ring_.face(j)) += spoke.face / 4 * wave[m * (2L * j + 1) % period_] * weight;
        }
      }
    }
  }

  if (ring_.interior()) {
    // The spoke modes saw e - v and f - v, but the sum of v over each wave is 0.
    const auto constant = mode_weights.row(0);
    Eigen::MatrixXd means(2, mode_weights.cols());
    for (int i = 0; i < 2; ++i) {
      means.row(i).setZero();
      for (int mode = 0; mode < 2; ++mode) {
        means.row(i) += radial_inverse_(mode, i) *
                        (mode_weights.row(1 + mode) - radial_vertex_[mode] * constant);
      }
    }
    for (int i = 0; i < faces; ++i) {
      ring.row(ring_.edge(i)) += means.row(0) / faces;
      ring.row(ring_.face(i)) += means.row(1) / faces;
    }
    ring.row(0) += constant - means.row(0) - means.row(1);
    return ring;
  }

  // The spoke modes saw what the curve modes left over.
  Eigen::MatrixXd curve = mode_weights.topRows(3);
  for (int i = 0; i < ring_.size(); ++i) {
    curve.row(0) -= ring.row(i);
    curve.row(1) -= curve_ring_[0][i] * ring.row(i);
    curve.row(2) -= curve_ring_[1][i] * ring.row(i);
  }
  for (int i = 0; i < 3; ++i) {
    const Vector3 unit = Vector3::Unit(i);
    const auto c = curveCoefficients<double>(ring_.kind, unit[0], unit[1], unit[2]);
    ring.row(i == 0 ? 0 : ring_.edge(i == 1 ? 0 : faces)) +=
        c.constant * curve.row(0) + c.first * curve.row(1) + c.second * curve.row(2);
  }
  return ring;
}

std::vector<double> Eigenbasis::ringVector(int mode) const {
  std::vector<double> ring(ring_.size(), 1.);
  if (mode == 0) {
    return ring;
  }
  if (mode < 3 && !ring_.interior()) {
    return curve_ring_[mode - 1];
  }
  if (mode < 3) {
    const double v = radial_vertex_[mode - 1];
    ring[0] = v;
    for (int i = 0; i < ring_.faces; ++i) {
      ring[ring_.edge(i)] = v + radial_(0, mode - 1);
      ring[ring_.face(i)] = v + radial_(1, mode - 1);
    }
    return ring;
  }
  ring[0] = 0;
  const int m = 1 + (mode - 3) / (ring_.interior() ? 4 : 2);
  for (const bool plus : {true, false}) {
    Part part[2];
    const int count = parts(m, plus, 0, part);
    for (int p = 0; p < count; ++p) {
      if (part[p].mode != mode) {
        continue;
      }
      const std::vector<double>& wave = part[p].cosine != 0 ? cos_ : sin_;
      const Spoke& spoke = spokes_[pairIndex(m, plus)];
      for (int i = 0; i < ring_.edges(); ++i) {
        ring[ring_.edge(i)] = spoke.edge * wave[2L * m * i % period_];
      }
      for (int j = 0; j < ring_.faces; ++j) {
        ring[ring_.face(j)] = spoke.face * wave[m * (2L * j + 1) % period_];
      }
    }
  }
  return ring;
}

Eigenbasis::Table Eigenbasis::table(int mode, int face) const {
  Table result;
  if (mode == 0) {
    for (int c = 0; c < tile_grid::kCells; ++c) {
      result.grid[c] = tile_grid::exists(sides(face), c) ? 1 : 0;
    }
    std::fill_n(result.outer, outerModes(face).count(), 1.);
    return result;
  }
  if (mode < 3) {
    return fixed(face).tables[mode - 1];
  }
  const FaceTables& t = tables(sides(face));
  const int m = 1 + (mode - 3) / (ring_.interior() ? 4 : 2);
  for (const bool plus : {true, false}) {
    Part part[2];
    const int count = parts(m, plus, face, part);
    for (int p = 0; p < count; ++p) {
      if (part[p].mode != mode) {
        continue;
      }
      const auto add = [&](double factor, const std::vector<Table>& from) {
        if (factor == 0) {
          return;
        }
        const Table& source = from[pairIndex(m, plus)];
        for (int i = 0; i < tile_grid::kOuter; ++i) {
          result.outer[i] += factor * source.outer[i];
        }
        for (int c = 0; c < tile_grid::kCells; ++c) {
          result.grid[c] += factor * source.grid[c];
        }
      };
      add(part[p].cosine, t.cosine);
      add(part[p].sine, t.sine);
    }
  }
  return result;
}

template <typename Body>
void Eigenbasis::forEachTable(int face, const Points& coefficients, const Body& body) const {
  const auto coefficient = [&](int mode) -> Eigen::Array4d {
    return {coefficients(mode, 0), coefficients(mode, 1), coefficients(mode, 2), 0};
  };
  for (int i = 0; i < 2; ++i) {
    body(fixed(face).tables[i], lambda_[1 + i], coefficient(1 + i));
  }
  const FaceTables& t = tables(sides(face));
  for (int m = 1; m <= spokeCount(); ++m) {
    for (const bool plus : {true, false}) {
      Part part[2];
      const int count = parts(m, plus, face, part);
      if (count == 0) {
        continue;
      }
      Eigen::Array4d cosine = Eigen::Array4d::Zero(), sine = cosine;
      for (int p = 0; p < count; ++p) {
        cosine += part[p].cosine * coefficient(part[p].mode);
        sine += part[p].sine * coefficient(part[p].mode);
      }
      const double lambda = lambda_[part[0].mode];
      body(t.sine[pairIndex(m, plus)], lambda, sine);
      if (!t.cosine.empty()) {
        body(t.cosine[pairIndex(m, plus)], lambda, cosine);
      }
    }
  }
}

void Eigenbasis::controlGrid(int face, int steps, int ring_steps, const Points& coefficients,
                             const Eigen::Array4d outer_points[], Eigen::Array4d grid[]) const {
  const FaceTables& t = tables(sides(face));
  const OuterModes<double>& outer = t.outer_modes;
  const int outer_count = outer.count();
  std::fill_n(grid, tile_grid::kCells, Eigen::Array4d::Zero());
  Eigen::Array4d left_over[tile_grid::kOuter];  // of the outer points, besides the ring's modes
  std::copy_n(outer_points, outer_count, left_over);
  const auto add = [&](const Table& table, const Eigen::Array4d& in_grid,
                       const Eigen::Array4d& in_outer) {
    for (int c = 0; c < tile_grid::kCells; ++c) {
      grid[c] += table.grid[c] * in_grid;
    }
    for (int i = 0; i < outer_count; ++i) {
      left_over[i] -= table.outer[i] * in_outer;
    }
  };

  const Eigen::Array4d constant(coefficients(0, 0), coefficients(0, 1), coefficients(0, 2), 0);
  add(table(0, face), std::ldexp(1., steps - 1) * constant, constant);
  forEachTable(face, coefficients,
               [&](const Table& table, double lambda, const Eigen::Array4d& coefficient) {
                 const Eigen::Array4d before = power(lambda, ring_steps) * coefficient;
                 add(table, power(2 * lambda, steps - 1) * before, before);
               });
  for (const Chain& chain : chains_) {
    const double lambda = lambda_[chain.from];
    const Eigen::Array4d fed =
        power(lambda, ring_steps) * chain.rate / lambda *
        Eigen::Array4d(coefficients(chain.from, 0), coefficients(chain.from, 1),
                       coefficients(chain.from, 2), 0);
    add(table(chain.to, face), (steps - 1 + ring_steps) * power(2 * lambda, steps - 1) * fed,
        ring_steps * fed);
  }
  for (int q = 0; q < outer_count; ++q) {
    Eigen::Array4d coefficient = Eigen::Array4d::Zero();
    for (int i = 0; i < outer_count; ++i) {
      coefficient += outer.inverse()(q, i) * left_over[i];
    }
    if (rest_mode_ >= 0) {
      coefficient += (steps - 1) * rest_[q] / lambda_[rest_mode_] *
                     power(lambda_[rest_mode_], ring_steps) *
                     Eigen::Array4d(coefficients(rest_mode_, 0), coefficients(rest_mode_, 1),
                                    coefficients(rest_mode_, 2), 0);
    }
    coefficient *= power(2 * outer.lambda(q), steps - 1);
    for (int c = 0; c < tile_grid::kCells; ++c) {
      grid[c] += t.outer[q].grid[c] * coefficient;
    }
  }
}

void Eigenbasis::weights(int face, int steps, int ring_steps, const GridWindow& window,
                         Eigen::MatrixXd& mode_weights, Eigen::MatrixXd& outer_weights) const {
  const FaceTables& t = tables(sides(face));
  const OuterModes<double>& outer = t.outer_modes;
  const int count = window.count(), outer_count = outer.count();
  mode_weights.resize(count, modeCount());

  // Weights on the outer modes, then through W^-1 on the outer points.
  Eigen::Matrix<double, GridWindow::kMaxCount, tile_grid::kOuter> on_outer_modes;
  for (int q = 0; q < outer_count; ++q) {
    on_outer_modes.col(q) =
        scaled(applied(window, t.outer[q].grid), Powers(outer.lambda(q), steps - 1), count);
  }
  Eigen::Matrix<double, GridWindow::kMaxCount, tile_grid::kOuter> on_outer =
      Eigen::Matrix<double, GridWindow::kMaxCount, tile_grid::kOuter>::Zero();
  on_outer.leftCols(outer_count) = on_outer_modes.leftCols(outer_count) * outer.inverse();
  outer_weights = on_outer.topLeftCorner(count, outer_count);

  // A mode is seen through the grid after `steps` steps, less what the outer points hold of it
  // already. Both parts apart, since a Jordan chain counts their steps differently.
  struct Seen {
    Functionals grid, outer;
  };
  const auto see = [&](const Table& table, double lambda) {
    const double before = power(lambda, ring_steps);
    Seen seen;
    seen.grid = before * scaled(applied(window, table.grid), Powers(lambda, steps - 1), count);
    seen.outer.setZero();
    for (int i = 0; i < outer_count; ++i) {
      seen.outer += before * table.outer[i] * on_outer.col(i).array();
    }
    return seen;
  };

  // Of the constant mode, position has weight 1 and derivatives 0, less the outer points' share.
  mode_weights.col(0) = -outer_weights.rowwise().sum();
  mode_weights(0, 0) += 1;

  for (int i = 0; i < 2; ++i) {
    const Seen seen = see(fixed(face).tables[i], lambda_[1 + i]);
    mode_weights.col(1 + i) = (seen.grid - seen.outer).head(count);
  }
  for (int m = 1; m <= spokeCount(); ++m) {
    for (const bool plus : {true, false}) {
      Part part[2];
      const int parts_count = parts(m, plus, face, part);
      if (parts_count == 0) {
        continue;
      }
      const double lambda = lambda_[part[0].mode];
      const int pair = pairIndex(m, plus);
      Functionals sine = Functionals::Zero(), cosine = Functionals::Zero();
      const Seen s = see(t.sine[pair], lambda);
      sine = s.grid - s.outer;
      if (!t.cosine.empty()) {
        const Seen c = see(t.cosine[pair], lambda);
        cosine = c.grid - c.outer;
      }
      for (int p = 0; p < parts_count; ++p) {
        mode_weights.col(part[p].mode) =
            (part[p].cosine * cosine + part[p].sine * sine).head(count);
      }
    }
  }

  // (lambda + nilpotent)^n = lambda^n + n lambda^(n - 1) (nilpotent)
  for (const Chain& chain : chains_) {
    const double lambda = lambda_[chain.from];
    const Seen seen = see(table(chain.to, face), lambda);
    const int all_steps = steps - 1 + ring_steps;
    mode_weights.col(chain.from) +=
        (chain.rate / lambda * (all_steps * seen.grid - ring_steps * seen.outer))
            .head(count)
            .matrix();
  }
  if (rest_mode_ >= 0 && steps > 1) {
    const double lambda = lambda_[rest_mode_];
    for (int q = 0; q < outer_count; ++q) {
      mode_weights.col(rest_mode_) += power(lambda, ring_steps) * (steps - 1) / lambda * rest_[q] *
                                      on_outer_modes.col(q).head(count);
    }
  }
}

}  // namespace limitsurf
