// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/geodesic_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/surface/face_corner.h"

namespace limitsurf {
namespace {

/// So far beyond a patch's sides, in its own parameters, a geodesic may run: without room one that
/// runs along a side would change the patch again and again.
constexpr double kRoom = 1e-9;
/// Where a side is reached is found to this part of the patch.
constexpr double kSideReached = 1e-12;
/// The local error of a step, relative to its length.
constexpr double kStepError = 1e-8;
/// Steps that are shorter than this share of a patch are not divided further.
constexpr double kShortestStep = 1e-6;
/// The distance in (u, v) beside a border at which a patch is looked for.
constexpr double kBeside = 0x1p-40;
/// The distance in (u, v) from an extraordinary vertex at which a geodesic goes on that has come
/// closer than that: more than PatchFinder leaves of cores.
constexpr double kPass = 0x1p-14;
/// A geodesic that would have to turn by more than this at a vertex ends there (cosine).
constexpr double kStraightOn = 0.7;
constexpr std::size_t kMostFacesAround = 65536;

// The sides of a patch: 0: s = 0, 1: s = 1, 2: t = 0, 3: t = 1.
double beyond(const GeodesicState& at, int side) {
  const double x = side < 2 ? at.s : at.t;
  return (side % 2 ? x - 1 : -x) - kRoom;
}

/// The derivative along the side, and into the patch.
Vector3 alongSide(const PatchTangents& at, int side) { return side < 2 ? at.dt : at.ds; }
Vector3 intoPatch(const PatchTangents& at, int side) {
  const Vector3 across = side < 2 ? at.ds : at.dt;
  return side % 2 ? Vector3(-across) : across;
}

/// The unit vector along `vector` perpendicular to a unit vector.
Vector3 across(const Vector3& vector, const Vector3& along) {
  const Vector3 rest = vector - vector.dot(along) * along;
  const double norm = rest.norm();
  return norm > 0 ? Vector3(rest / norm) : Vector3(Vector3::Zero());
}

Vector3 inTangentPlane(const PatchTangents& at, const Vector3& direction) {
  return across(direction, at.normal());
}

double distanceToSide(const PatchPlace& at, int side) {
  const double x = side < 2 ? at.s : at.t;
  return std::abs(side % 2 ? 1 - x : x);
}

int cornerOf(const Location& at) { return at.v == 0 ? (at.u == 0 ? 0 : 1) : (at.u == 1 ? 2 : 3); }

/// The faces around a vertex, each with the corner at which the vertex is.
std::vector<std::pair<int, int>> facesAround(const FaceNeighbors& neighbors, int face, int corner) {
  std::vector<std::pair<int, int>> found = {{face, corner}};
  for (const bool forward : {true, false}) {
    std::pair<int, int> last = found.front();
    while (found.size() < kMostFacesAround) {
      const auto next = neighbors.beyond(last.first, forward ? (last.second + 3) % 4 : last.second,
                                         forward ? 1 : 0);
      if (!next.side) {
        break;
      }
      const Location at = next.side->at(next.x);
      if (!isCorner(at)) {
        break;
      }
      last = {at.face, cornerOf(at)};
      if (last == found.front()) {
        return found;
      }
      found.push_back(last);
    }
  }
  return found;
}

}  // namespace

bool GeodesicWalk::start(const Location& from, const Vector3& direction) {
  if (!finder_.find(from, on_)) {
    return false;
  }
  at_.direction = direction;
  if (on_.is_rest) {
    const Points position = ground_.positions({from});
    return pass(position.row(0));
  }
  const PatchPlace place = placeOn(on_.patch.on, from);
  at_.s = std::clamp(place.s, 0., 1.);
  at_.t = std::clamp(place.t, 0., 1.);
  at_.direction = inTangentPlane(PatchTangents(on_.patch, at_.s, at_.t), direction);
  return at_.direction.norm() > 0.5;
}

GeodesicTracer::Stop GeodesicWalk::stop() const {
  const double s = std::clamp(at_.s, 0., 1.), t = std::clamp(at_.t, 0., 1.);
  const PatchTangents here(on_.patch, s, t);
  return {on_.patch.on.at(s, t), here.position, inTangentPlane(here, at_.direction), here.normal()};
}

bool GeodesicWalk::go(double length) {
  while (length_ < length) {
    if (!step(length - length_)) {
      return false;
    }
  }
  return true;
}

/// One step of at most this length, to a side of the patch at most, and beyond it into the next
/// patch. Returns false where the walk ends.
bool GeodesicWalk::step(double most) {
  const GeodesicRate rate = geodesicRate(on_.patch, at_);
  if (!rate.exists || ++steps_ - kSpareSteps > kStepsAPatch * changes_) {
    return false;
  }
  const double across_patch = 1 / std::max(std::abs(rate.s), std::abs(rate.t));
  double h = std::min(most, across_patch);
  if (next_step_ > 0) {
    h = std::min(h, next_step_);
  }
  GeodesicStep taken;
  while (true) {
    taken = geodesicStep(on_.patch, at_, h);
    if (!taken.exists) {
      return false;
    }
    const double allowed = kStepError * h;
    if (taken.error <= allowed || h <= kShortestStep * across_patch) {
      const double factor = taken.error > 0 ? 0.9 * std::pow(allowed / taken.error, 0.2) : 5.;
      next_step_ = h * std::clamp(factor, 0.2, 5.);
      break;
    }
    h *= std::clamp(0.9 * std::pow(allowed / taken.error, 0.2), 0.1, 0.7);
  }
  // The side that is reached first: the length to each one beyond which the step leads is found by
  // regula falsi (the Illinois variant), and the step ends there.
  int side = -1;
  for (int k = 0; k < 4; ++k) {
    if (!(beyond(taken.to, k) > 0)) {
      continue;
    }
    double low = 0, high = h, at_low = beyond(at_, k), at_high = beyond(taken.to, k);
    if (!(at_low < 0)) {
      at_low = -kSideReached;
    }
    GeodesicStep there = taken;
    double length = high;
    int kept = 0;  // which end of the bracket was kept last: -1 low, 1 high
    for (int i = 0; i < 60 && std::abs(beyond(there.to, k)) > kSideReached; ++i) {
      length = (low * at_high - high * at_low) / (at_high - at_low);
      if (!(length > low && length < high)) {
        break;
      }
      there = geodesicStep(on_.patch, at_, length);
      const double value = beyond(there.to, k);
      if (value > 0) {
        high = length;
        at_high = value;
        at_low = kept == -1 ? at_low / 2 : at_low;
        kept = -1;
      } else {
        low = length;
        at_low = value;
        at_high = kept == 1 ? at_high / 2 : at_high;
        kept = 1;
      }
    }
    taken = there;
    h = length;
    side = k;
  }
  at_ = taken.to;
  length_ += h;
  changes_on_spot_ = h > kShortestStep * across_patch ? 0 : changes_on_spot_;
  return side < 0 || cross(side);
}

/// Goes on beyond a side of the patch.
bool GeodesicWalk::cross(int side) {
  if (++changes_ > kMostChanges || ++changes_on_spot_ > kMostChangesOnSpot) {
    return false;
  }
  GeodesicState on_side = at_;
  (side < 2 ? on_side.s : on_side.t) = side % 2;
  const double s = std::clamp(on_side.s, 0., 1.), t = std::clamp(on_side.t, 0., 1.);
  const FaceRectangle& on = on_.patch.on;
  const Location here = on.at(s, t);
  const Vector3 along = alongSide(PatchTangents(on_.patch, s, t), side).normalized();
  // The way out of the patch, in (u, v).
  const double sign = side % 2 ? 1 : -1;
  const double du = sign * (side < 2 ? on.us : on.ut), dv = sign * (side < 2 ? on.vs : on.vt);
  const double u = here.u + (du > 0 ? kBeside : du < 0 ? -kBeside : 0);
  const double v = here.v + (dv > 0 ? kBeside : dv < 0 ? -kBeside : 0);
  if (u >= 0 && u <= 1 && v >= 0 && v <= 1) {
    return enter(here, {here.face, u, v}, along);
  }
  const int k = v < 0 ? 0 : u > 1 ? 1 : v > 1 ? 2 : 3;
  const double x = k == 0 ? here.u : k == 1 ? here.v : k == 2 ? 1 - here.u : 1 - here.v;
  const FaceNeighbors::Beyond next = ground_.neighbors.beyond(here.face, k, x);
  if (next.edge >= 0 && targets_ && (*targets_)[static_cast<std::size_t>(next.edge)]) {
    hit_ = true;
    return false;
  }
  if (!next.side) {
    return false;
  }
  Location there = next.side->at(next.x), beside = there;
  // The inner side lies to the left of the side's direction.
  beside.u = std::clamp(there.u - kBeside * next.side->dv, 0., 1.);
  beside.v = std::clamp(there.v + kBeside * next.side->du, 0., 1.);
  return enter(there, beside, along);
}

/// Enters the patch that contains `beside`, at `at` on its side, which has the unit direction
/// `along`: the angle to the side stays the same.
bool GeodesicWalk::enter(const Location& at, const Location& beside, const Vector3& along) {
  const Vector3 from = PatchTangents(on_.patch, at_.s, at_.t).position;
  if (!finder_.find(beside, on_)) {
    return false;
  }
  if (on_.is_rest) {
    return pass(from);
  }
  const PatchPlace place = placeOn(on_.patch.on, at);
  at_.s = std::clamp(place.s, 0., 1.);
  at_.t = std::clamp(place.t, 0., 1.);
  const PatchTangents here(on_.patch, at_.s, at_.t);
  // At a corner two sides are near: the right one runs in the same direction.
  int side = -1;
  double best = -1;
  for (int k = 0; k < 4; ++k) {
    const double match = std::abs(alongSide(here, k).normalized().dot(along));
    if (distanceToSide(place, k) < 1e-4 && match > best) {
      best = match;
      side = k;
    }
  }
  if (side < 0) {
    at_.direction = inTangentPlane(here, at_.direction);
    return true;
  }
  Vector3 edge = alongSide(here, side).normalized();
  if (edge.dot(along) < 0) {
    edge = -edge;
  }
  const double parallel = std::clamp(at_.direction.dot(along), -1., 1.);
  at_.direction =
      parallel * edge + std::sqrt(1 - parallel * parallel) * across(intoPatch(here, side), edge);
  return true;
}

/// Whether a walk ends at this side of a Ptex face.
bool GeodesicWalk::isTarget(int face, int side) const {
  const int edge = ground_.neighbors.beyond(face, side, 0.5).edge;
  return edge >= 0 && targets_ && (*targets_)[static_cast<std::size_t>(edge)];
}

/// Goes on beyond an extraordinary vertex, straight on as seen in space. `on_` is what is left of
/// a core, `from` the place from which the walk comes.
bool GeodesicWalk::pass(const Vector3& from) {
  const Location vertex = on_.patch.on.at(0, 0);
  if (++changes_on_spot_ > kMostChangesOnSpot || !isCorner(vertex)) {
    return false;
  }
  std::vector<Location> around = {vertex};
  bool is_target = false;
  for (const auto& [face, corner] : facesAround(ground_.neighbors, vertex.face, cornerOf(vertex))) {
    is_target = is_target || isTarget(face, corner) || isTarget(face, (corner + 3) % 4);
    const FaceSide side = FaceSide::of(face, corner);
    for (const auto& [a, b] :
         {std::pair<double, double>{1, 0}, {1, 0.5}, {1, 1}, {0.5, 1}, {0, 1}}) {
      around.push_back({face, side.u0 + kPass * (a * side.du - b * side.dv),
                        side.v0 + kPass * (a * side.dv + b * side.du)});
    }
  }
  const Points positions = ground_.positions(around);
  const Vector3 center = positions.row(0);
  // A walk that begins beside the vertex may leave it; one that comes from afar ends there.
  if (is_target && length_ > 2 * (center - from).norm()) {
    length_ += (center - from).norm();
    hit_ = true;
    return false;
  }
  Eigen::Index best = -1;
  double straightest = kStraightOn;
  for (Eigen::Index i = 1; i < positions.rows(); ++i) {
    const Vector3 way = positions.row(i).transpose() - center;
    const double cosine = way.normalized().dot(at_.direction);
    if (cosine > straightest) {
      straightest = cosine;
      best = i;
    }
  }
  if (best < 0) {
    return false;
  }
  const Location& to = around[static_cast<std::size_t>(best)];
  if (!finder_.find(to, on_) || on_.is_rest) {
    return false;
  }
  length_ += (center - from).norm() + (positions.row(best).transpose() - center).norm();
  const PatchPlace place = placeOn(on_.patch.on, to);
  at_.s = std::clamp(place.s, 0., 1.);
  at_.t = std::clamp(place.t, 0., 1.);
  at_.direction = inTangentPlane(PatchTangents(on_.patch, at_.s, at_.t), at_.direction);
  next_step_ = 0;
  return at_.direction.norm() > 0.5;
}

}  // namespace limitsurf
