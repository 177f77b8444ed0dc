// SPDX-License-Identifier: Apache-2.0
#include "bench/support/embree_peer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace limitsurf::bench {
namespace {

using Vector = Eigen::Vector3f;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The closest point of a triangle, by the region of its plane (corners, edges, inside) that holds
/// p.
Vector closestOnTriangle(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const Vector ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float ap_ab = ab.dot(ap), ap_ac = ac.dot(ap);
  if (ap_ab <= 0 && ap_ac <= 0) return a;
  const float bp_ab = ab.dot(bp), bp_ac = ac.dot(bp);
  if (bp_ab >= 0 && bp_ac <= bp_ab) return b;
  const float cp_ab = ab.dot(cp), cp_ac = ac.dot(cp);
  if (cp_ac >= 0 && cp_ab <= cp_ac) return c;
  const float of_c = ap_ab * bp_ac - bp_ab * ap_ac;
  if (of_c <= 0 && ap_ab >= 0 && bp_ab <= 0) return a + ap_ab / (ap_ab - bp_ab) * ab;
  const float of_b = cp_ab * ap_ac - ap_ab * cp_ac;
  if (of_b <= 0 && ap_ac >= 0 && cp_ac <= 0) return a + ap_ac / (ap_ac - cp_ac) * ac;
  const float of_a = bp_ab * cp_ac - cp_ab * bp_ac;
  const float from_b = bp_ac - bp_ab, from_c = cp_ab - cp_ac;
  if (of_a <= 0 && from_b >= 0 && from_c >= 0) return b + from_b / (from_b + from_c) * (c - b);
  return a + (of_b * ab + of_c * ac) / (of_a + of_b + of_c);
}

struct Search {
  const float* vertices;
  const unsigned* triangles;
  Vector point;
  Vector closest;
};

bool visitTriangle(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  const unsigned* triangle = search.triangles + 3 * std::size_t{arguments->primID};
  const auto corner = [&](int i) {
    return Eigen::Map<const Vector>(search.vertices + 3 * std::size_t{triangle[i]});
  };
  const Vector on_triangle = closestOnTriangle(search.point, corner(0), corner(1), corner(2));
  const float distance = (on_triangle - search.point).norm();
  if (!(distance < arguments->query->radius)) return false;
  arguments->query->radius = distance;
  search.closest = on_triangle;
  return true;
}

/// Calls body(row) on all cores.
template <typename Body>
void forRows(Eigen::Index count, const Body& body) {
  constexpr Eigen::Index kGrain = 512;
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, count, kGrain), [&](const auto& range) {
    for (Eigen::Index row = range.begin(); row != range.end(); ++row) body(row);
  });
}

}  // namespace

EmbreePeer::EmbreePeer(const Tessellation& mesh) : device_(rtcNewDevice(nullptr)) {
  if (!device_) throw std::runtime_error("Embree does not start");
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);  // otherwise rays pass between triangles
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  vertices_ = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              3 * sizeof(float), static_cast<std::size_t>(mesh.positions.rows())));
  Eigen::Map<Eigen::VectorXf>(vertices_, mesh.positions.size()) =
      Eigen::Map<const Eigen::VectorXd>(mesh.positions.data(), mesh.positions.size()).cast<float>();
  const std::size_t quads = mesh.face_vertices.size() / 4;
  triangles_ = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), 2 * quads));
  unsigned* next = triangles_;
  for (std::size_t quad = 0; quad < quads; ++quad) {
    for (const int corner : {0, 1, 2, 0, 2, 3}) {
      *next++ = static_cast<unsigned>(mesh.face_vertices[4 * quad + static_cast<unsigned>(corner)]);
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
}

EmbreePeer::~EmbreePeer() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

EmbreePeer::Found EmbreePeer::closest(const Points& points) const {
  Found found{Points(points.rows(), 3), Eigen::VectorXd(points.rows())};
  forRows(points.rows(), [&](Eigen::Index row) {
    Search search{vertices_, triangles_, points.row(row).transpose().cast<float>(), {}};
    RTCPointQuery query{search.point.x(), search.point.y(), search.point.z(), 0, kInfinity};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, visitTriangle, &search);
    found.position.row(row) = search.closest.transpose().cast<double>();
    found.distance[row] = static_cast<double>(query.radius);
  });
  return found;
}

EmbreePeer::Found EmbreePeer::rayCast(const Points& origins, const Points& directions) const {
  Found found{Points(origins.rows(), 3), Eigen::VectorXd(origins.rows())};
  forRows(origins.rows(), [&](Eigen::Index row) {
    const Vector origin = origins.row(row).transpose().cast<float>();
    const Vector direction = directions.row(row).transpose().cast<float>();
    RTCRayHit ray{};
    ray.ray.org_x = origin.x(), ray.ray.org_y = origin.y(), ray.ray.org_z = origin.z();
    ray.ray.dir_x = direction.x(), ray.ray.dir_y = direction.y(), ray.ray.dir_z = direction.z();
    ray.ray.tfar = kInfinity;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &ray);
    const bool is_hit = ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    found.distance[row] = is_hit ? static_cast<double>(ray.ray.tfar) : kNaN;
    found.position.row(row) = origins.row(row) + found.distance[row] * directions.row(row);
  });
  return found;
}

}  // namespace limitsurf::bench
