// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/path/bezier_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/path/space_curves.h"

namespace limitsurf {
namespace {

constexpr int kReparametrizations = 4;
/// Handles shorter than this share of the chord come from an equation without a useful solution.
constexpr double kShortestHandle = 1e-3, kLongestHandle = 3;

Vector3 unit(const Vector3& v) {
  const double length = v.norm();
  return length > 0 ? Vector3(v / length) : Vector3(Vector3::Zero());
}

/// The derivatives of a cubic Bezier segment.
Vector3 firstDerivative(const Vector3 (&p)[4], double t) {
  const double s = 1 - t;
  return 3 * (s * s * (p[1] - p[0]) + 2 * s * t * (p[2] - p[1]) + t * t * (p[3] - p[2]));
}
Vector3 secondDerivative(const Vector3 (&p)[4], double t) {
  return 6 * ((1 - t) * (p[2] - 2 * p[1] + p[0]) + t * (p[3] - 2 * p[2] + p[1]));
}

Eigen::VectorXd chordLengths(const Points& path, int first, int last) {
  Eigen::VectorXd at(last - first + 1);
  at[0] = 0;
  for (int i = first + 1; i <= last; ++i) {
    at[i - first] = at[i - first - 1] + (path.row(i) - path.row(i - 1)).norm();
  }
  const double length = at[last - first];
  return length > 0 ? Eigen::VectorXd(at / length)
                    : Eigen::VectorXd(Eigen::VectorXd::LinSpaced(last - first + 1, 0, 1));
}

/// The handles by least squares for given parameters.
void solveHandles(const Points& path, int first, const Vector3& leaving, const Vector3& arriving,
                  BezierFit& fit) {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < fit.parameters.size(); ++i) {
    const double t = fit.parameters[i], s = 1 - t;
    const double b1 = 3 * s * s * t, b2 = 3 * s * t * t;
    const Vector3 a1 = b1 * leaving, a2 = b2 * arriving;
    const Vector3 rest = path.row(first + i).transpose() - (s * s * s + b1) * fit.points[0] -
                         (b2 + t * t * t) * fit.points[3];
    matrix(0, 0) += a1.dot(a1);
    matrix(0, 1) += a1.dot(a2);
    matrix(1, 1) += a2.dot(a2);
    right += Eigen::Vector2d(a1.dot(rest), a2.dot(rest));
  }
  matrix(1, 0) = matrix(0, 1);
  const double chord = (fit.points[3] - fit.points[0]).norm();
  const double determinant = matrix.determinant();
  Eigen::Vector2d length = Eigen::Vector2d::Constant(chord / 3);
  if (determinant > 1e-12 * matrix(0, 0) * matrix(1, 1)) {
    const Eigen::Vector2d solved = matrix.inverse() * right;
    if (solved.minCoeff() > kShortestHandle * chord && solved.maxCoeff() < kLongestHandle * chord) {
      length = solved;
    }
  }
  fit.points[1] = fit.points[0] + length[0] * leaving;
  fit.points[2] = fit.points[3] + length[1] * arriving;
}

void measure(const Points& path, int first, BezierFit& fit) {
  fit.error = 0;
  fit.farthest = first + static_cast<int>(fit.parameters.size()) / 2;
  for (Eigen::Index i = 1; i + 1 < fit.parameters.size(); ++i) {
    const Vector3 point = path.row(first + i);
    const double distance = (bezierPoint(fit.points, fit.parameters[i]) - point).norm();
    if (distance > fit.error) {
      fit.error = distance;
      fit.farthest = first + static_cast<int>(i);
    }
  }
}

/// One step of Newton's iteration towards the parameter of the closest point, for each row.
void reparametrize(const Points& path, int first, BezierFit& fit) {
  double least = 0;
  for (Eigen::Index i = 1; i + 1 < fit.parameters.size(); ++i) {
    double& t = fit.parameters[i];
    const Vector3 point = path.row(first + i);
    const Vector3 off = bezierPoint(fit.points, t) - point;
    const Vector3 d1 = firstDerivative(fit.points, t), d2 = secondDerivative(fit.points, t);
    const double slope = d1.squaredNorm() + off.dot(d2);
    if (slope > 0) {
      t -= off.dot(d1) / slope;
    }
    t = least = std::clamp(t, least, 1.);  // the order of the points stays
  }
}

BezierFit begun(const Points& path, int first, int last) {
  BezierFit fit;
  fit.points[0] = path.row(first);
  fit.points[3] = path.row(last);
  fit.parameters = chordLengths(path, first, last);
  return fit;
}

}  // namespace

PathTangents::PathTangents(const Points& path, const Points& normals, double apart, bool closed)
    : path_(path),
      normals_(normals),
      apart_(apart),
      closed_(closed),
      is_corner_(static_cast<std::size_t>(path.rows()), false) {}

int PathTangents::neighbour(int row, int step) const {
  const int count = static_cast<int>(path_.rows());
  int far = -1;
  for (int i = 1; i < count; ++i) {
    int at = row + step * i;
    if (closed_) {
      at = (at % (count - 1) + count - 1) % (count - 1);  // the last row repeats the first
    } else if (at < 0 || at >= count) {
      break;
    }
    const double distance = (path_.row(at) - path_.row(row)).norm();
    if (distance > 0) {
      far = at;
    }
    if (distance > 0 && (distance >= apart_ || is_corner_[at])) {
      return at;
    }
  }
  return far;
}

Vector3 PathTangents::oneSided(int row, int step) const {
  const int near = neighbour(row, step);
  if (near < 0) {
    return Vector3::Zero();
  }
  const Vector3 here = path_.row(row), first = path_.row(near);
  const double h1 = (first - here).norm();
  Vector3 slope1 = (first - here) / h1;
  const int far = is_corner_[near] ? -1 : neighbour(near, step);
  if (far < 0 || far == row) {
    return slope1;
  }
  const Vector3 second = path_.row(far);
  const double h2 = (second - first).norm();
  const Vector3 slope2 = (second - first) / h2;
  return unit(slope1 + (slope1 - slope2) * (h1 / (h1 + h2)));
}

Vector3 PathTangents::inPlane(const Vector3& direction, int row) const {
  const Vector3 normal = normals_.row(row);
  if (!normal.allFinite()) {
    return unit(direction);
  }
  const Vector3 within = direction - direction.dot(normal) * normal;
  return within.norm() > 0.1 * direction.norm() ? unit(within) : unit(direction);
}

Vector3 PathTangents::leaving(int row) const { return inPlane(oneSided(row, 1), row); }

Vector3 PathTangents::arriving(int row) const { return inPlane(-oneSided(row, -1), row); }

Vector3 PathTangents::passing(int row) const {
  const int before = neighbour(row, -1), after = neighbour(row, 1);
  if (before < 0) {
    return leaving(row);
  }
  if (after < 0) {
    return arriving(row);
  }
  const Vector3 back = path_.row(row) - path_.row(before),
                ahead = path_.row(after) - path_.row(row);
  const double h1 = back.norm(), h2 = ahead.norm();
  const Vector3 slope = back * (h2 / h1) + ahead * (h1 / h2);
  return inPlane(slope.norm() > 0 ? slope : ahead, row);
}

double PathTangents::turn(int row) const {
  const int before = neighbour(row, -1), after = neighbour(row, 1);
  if (before < 0 || after < 0) {
    return 0;
  }
  const Vector3 back = path_.row(row) - path_.row(before),
                ahead = path_.row(after) - path_.row(row);
  return std::atan2(back.cross(ahead).norm(), back.dot(ahead));
}

BezierFit fitBezier(const Points& path, int first, int last, const Vector3& leaving,
                    const Vector3& arriving) {
  BezierFit best = begun(path, first, last);
  solveHandles(path, first, leaving, arriving, best);
  measure(path, first, best);
  BezierFit next = best;
  for (int i = 0; i < kReparametrizations && last > first + 1; ++i) {
    reparametrize(path, first, next);
    solveHandles(path, first, leaving, arriving, next);
    measure(path, first, next);
    if (next.error < best.error) {
      best = next;
    }
  }
  return best;
}

BezierFit straightBezier(const Points& path, int first, int last) {
  BezierFit fit = begun(path, first, last);
  fit.points[1] = (2 * fit.points[0] + fit.points[3]) / 3;
  fit.points[2] = (fit.points[0] + 2 * fit.points[3]) / 3;
  measure(path, first, fit);
  return fit;
}

int chordsWithin(const Vector3 (&points)[4], double tolerance) {
  const double bend =
      std::max(secondDerivative(points, 0).norm(), secondDerivative(points, 1).norm());
  const double chords = std::ceil(std::sqrt(bend / (8 * tolerance)));
  return static_cast<int>(std::clamp(chords, 1., 1e6));
}

}  // namespace limitsurf
