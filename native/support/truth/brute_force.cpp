// SPDX-License-Identifier: Apache-2.0
#include "support/truth/brute_force.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace limitsurf::test {
namespace {

using Wide = WideRay::Vector;

/// The last step of a refinement whose result only has to be recognised.
constexpr double kFewDigits = 0x1p-26;

Wide toWide(const Vector3& v) { return v.cast<DoubleDouble>(); }

/// Newton's step towards the least distance, or Gauss and Newton's; {0, 0} where there is none.
Eigen::Vector2d newtonStep(const Vector3& offset, const Evaluation& e, bool gauss) {
  const Vector3 du = e.du.row(0), dv = e.dv.row(0);
  if (!du.allFinite() || !dv.allFinite()) return {0, 0};
  Eigen::Matrix2d hessian;
  hessian << du.dot(du), du.dot(dv), du.dot(dv), dv.dot(dv);
  if (!gauss) {
    const double mixed = offset.dot(e.duv.row(0));
    hessian(0, 0) += offset.dot(e.duu.row(0));
    hessian(0, 1) += mixed;
    hessian(1, 0) += mixed;
    hessian(1, 1) += offset.dot(e.dvv.row(0));
  }
  const Eigen::Vector2d gradient(offset.dot(du), offset.dot(dv));
  const Eigen::Vector2d step = -hessian.inverse() * gradient;
  return step.allFinite() ? step : Eigen::Vector2d(0, 0);
}

bool onSide(const Location& at) {
  const auto atEnd = [](double x) { return x < 1e-9 || x > 1 - 1e-9; };
  return atEnd(at.u) || atEnd(at.v);
}

}  // namespace

WideRay::WideRay(const Vector3& from, const Vector3& to)
    : origin(toWide(from)), direction(toWide(to)) {
  direction /= direction.cwiseAbs().maxCoeff();
  direction.normalize();
}

std::pair<DoubleDouble, DoubleDouble> WideRay::alongAndAside(const Vector3& point) const {
  const Wide offset = toWide(point) - origin;
  const DoubleDouble along = offset.dot(direction);
  return {along, (offset - along * direction).norm()};
}

DoubleDouble distanceBetween(const Vector3& a, const Vector3& b) {
  const Wide offset = toWide(a) - toWide(b);
  const DoubleDouble scale = offset.cwiseAbs().maxCoeff();
  return scale > 0 ? scale * (offset / scale).norm() : 0;
}

BruteForce::BruteForce(const LimitSurface& surface, int per_side)
    : surface_(surface), per_side_(per_side), diagonal_(test::diagonal(surface.positions())) {
  for (int face = 0; face < surface.faceCount(); ++face) {
    if (surface.refused().count(surface.baseFace()[face]) == 0) faces_.push_back(face);
  }
  std::vector<Location> locations;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    for (int j = 0; j <= per_side; ++j) {
      for (int i = 0; i <= per_side; ++i) locations.push_back(at(f, i, j));
    }
  }
  samples_ = surface.evaluate(locations).position;
}

Location BruteForce::at(std::size_t face, int i, int j) const {
  return {faces_[face], static_cast<double>(i) / per_side_, static_cast<double>(j) / per_side_};
}

std::size_t BruteForce::index(std::size_t face, int i, int j) const {
  const std::size_t side = static_cast<std::size_t>(per_side_) + 1;
  return (face * side + static_cast<std::size_t>(j)) * side + static_cast<std::size_t>(i);
}

BruteForce::Foot BruteForce::nearest(const Vector3& point, int most_starts,
                                     const std::function<bool(const Location&)>& accepts) const {
  const Eigen::VectorXd distances = (samples_.rowwise() - point.transpose()).rowwise().norm();
  struct Start {
    double distance;
    Location at;
  };
  std::vector<Start> starts;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    for (int j = 0; j <= per_side_; ++j) {
      for (int i = 0; i <= per_side_; ++i) {
        const double own = distances[static_cast<Eigen::Index>(index(f, i, j))];
        bool least = true;
        for (int y = std::max(0, j - 1); least && y <= std::min(per_side_, j + 1); ++y) {
          for (int x = std::max(0, i - 1); least && x <= std::min(per_side_, i + 1); ++x) {
            least = own <= distances[static_cast<Eigen::Index>(index(f, x, y))];
          }
        }
        if (least) starts.push_back({own, at(f, i, j)});
      }
    }
  }
  std::sort(starts.begin(), starts.end(),
            [](const Start& a, const Start& b) { return a.distance < b.distance; });
  if (starts.size() > static_cast<std::size_t>(most_starts)) starts.resize(most_starts);
  Foot best{std::numeric_limits<double>::infinity(), {}};
  for (const Start& start : starts) {
    Foot foot{start.distance, start.at};
    if (accepts) {
      // Most starts lead to feet that are not accepted, and few digits tell so.
      foot = refined(point, foot.at, 0.5 / per_side_, kFewDigits);
      if (!accepts(foot.at)) continue;
    }
    foot = refined(point, foot.at, 0.5 / per_side_, 0x1p-53);
    if (foot.distance < best.distance && (!accepts || accepts(foot.at))) best = foot;
  }
  return best;
}

BruteForce::Foot BruteForce::refined(const Vector3& point, Location at, double step,
                                     double smallest) const {
  // The best of the eight neighbours and of two steps of Newton's, as long as that leads down.
  Foot best{distanceBetween(
                surface_.evaluate({&at, 1}, Derivatives::none, false, 1).position.row(0), point),
            at};
  for (int round = 0; round < 400 && step > smallest; ++round) {
    const Evaluation here = surface_.evaluate({&best.at, 1}, Derivatives::second, false, 1);
    const Vector3 offset = Vector3(here.position.row(0)) - point;
    std::vector<Location> next;
    const auto add = [&](double u, double v) {
      next.push_back(
          {at.face, std::clamp(best.at.u + u, 0., 1.), std::clamp(best.at.v + v, 0., 1.)});
    };
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        if (i != 0 || j != 0) add(i * step, j * step);
      }
    }
    for (const bool gauss : {false, true}) {
      const Eigen::Vector2d newton = newtonStep(offset, here, gauss);
      add(newton[0], newton[1]);
      add(newton[0], 0);
      add(0, newton[1]);
    }
    const Points positions = surface_.evaluate(next, Derivatives::none, false, 1).position;
    bool lower = false;
    for (std::size_t i = 0; i < next.size(); ++i) {
      const DoubleDouble distance =
          distanceBetween(positions.row(static_cast<Eigen::Index>(i)), point);
      if (distance < best.distance) {
        best = {distance, next[i]};
        lower = true;
      }
    }
    if (!lower) step /= 4;
  }
  return best;
}

std::vector<BruteForce::Root> BruteForce::roots(const WideRay& ray) const {
  const Vector3 direction = ray.direction.cast<double>();
  int least;
  direction.cwiseAbs().minCoeff(&least);
  const Wide across0 = ray.direction.cross(Wide::Unit(least)).normalized();
  const Wide across1 = ray.direction.cross(across0);
  Eigen::Matrix<double, 3, 2> across;
  across << across0.cast<double>(), across1.cast<double>();
  const Eigen::Matrix<double, Eigen::Dynamic, 2> seen =
      (samples_.rowwise() - ray.origin.cast<double>().transpose()) * across;
  std::vector<Root> found;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    for (int j = 0; j < per_side_; ++j) {
      for (int i = 0; i < per_side_; ++i) {
        const auto corner = [&](int x, int y) -> Eigen::RowVector2d {
          return seen.row(static_cast<Eigen::Index>(index(f, i + x, j + y)));
        };
        const Eigen::RowVector2d low =
            corner(0, 0).cwiseMin(corner(1, 0)).cwiseMin(corner(0, 1)).cwiseMin(corner(1, 1));
        const Eigen::RowVector2d high =
            corner(0, 0).cwiseMax(corner(1, 0)).cwiseMax(corner(0, 1)).cwiseMax(corner(1, 1));
        const double margin = 0.5 * (high - low).norm();
        if (low.maxCoeff() > margin || high.minCoeff() < -margin) continue;
        Location at{faces_[f], (i + 0.5) / per_side_, (j + 0.5) / per_side_};
        Evaluation e;
        std::pair<DoubleDouble, DoubleDouble> place;
        bool arrived = false;
        for (int round = 0; round < 30 && !arrived; ++round) {
          e = surface_.evaluate({&at, 1}, Derivatives::first, false, 1);
          const Vector3 position = e.position.row(0);
          place = ray.alongAndAside(position);
          const Wide offset = toWide(position) - ray.origin;
          const Eigen::Vector2d f_here(static_cast<double>(offset.dot(across0)),
                                       static_cast<double>(offset.dot(across1)));
          Eigen::Matrix2d jacobian;
          jacobian.row(0) << e.du.row(0) * across.col(0), e.dv.row(0) * across.col(0);
          jacobian.row(1) << e.du.row(0) * across.col(1), e.dv.row(0) * across.col(1);
          const Eigen::Vector2d step = -jacobian.inverse() * f_here;
          if (!step.allFinite()) break;
          arrived = round > 0 && place.second <= 2e-14 * diagonal_;
          at.u = std::clamp(at.u + step[0], 0., 1.);
          at.v = std::clamp(at.v + step[1], 0., 1.);
        }
        if (!arrived) continue;
        e = surface_.evaluate({&at, 1}, Derivatives::first, true, 1);
        place = ray.alongAndAside(e.position.row(0));
        const double sine = std::abs(direction.dot(e.normal.row(0)));
        if (place.second <= 3e-14 * diagonal_ && sine > 0) {
          found.push_back({at, e.position.row(0), place.first, sine});
        }
      }
    }
  }
  std::sort(found.begin(), found.end(),
            [](const Root& a, const Root& b) { return a.distance < b.distance; });
  std::vector<Root> once;
  for (const Root& root : found) {
    const auto same = [&](const Root& other) {
      const bool one_place =
          root.at.face == other.at.face
              ? std::abs(root.at.u - other.at.u) + std::abs(root.at.v - other.at.v) < 1e-6
              : onSide(root.at) && onSide(other.at);
      return one_place && (root.position - other.position).norm() <= 1e-12 * diagonal_ / root.sine;
    };
    if (std::none_of(once.begin(), once.end(), same)) once.push_back(root);
  }
  return once;
}

}  // namespace limitsurf::test
