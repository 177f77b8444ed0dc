// SPDX-License-Identifier: Apache-2.0

#include <limits>
#include <stdexcept>

#include "batches.h"
#include "docstrings.h"
#include "limitsurf/row_check.h"
#include "limitsurf/search/checks.h"
#include "numbers.h"
#include "progress.h"
#include "result_memory.h"
#include "shared_surface.h"

namespace limitsurf::python {
namespace {

/// The number of rows searched between two reports of the progress; Ctrl-C takes effect there.
constexpr Eigen::Index kRowsPerSearch = Eigen::Index{1} << 15;

/// Rows of three numbers, read in place where they are an array of float64. They are checked
/// all together before searches, so that errors name rows of the call, and in parts again, since
/// other threads of Python may write to the array meanwhile.
class SearchRows {
 public:
  SearchRows(const py::handle& object, const char* name) : array_(doubles(object, name)) {
    requireRows<std::invalid_argument>(array_, name, 3);
    data_ = array_.data();
    count_ = array_.shape(0);
  }
  Eigen::Index count() const { return count_; }
  Eigen::Map<const Points> all() const { return {data_, count_, 3}; }
  /// Copies some rows into `part`. It may be called without the GIL.
  void copy(Eigen::Index begin, Eigen::Index count, Points& part) const {
    part = all().middleRows(begin, count);
  }

 private:
  Doubles array_;
  const double* data_;
  Eigen::Index count_;
};

/// A direction for each point, from one for each, one for all, or none.
Points facingOf(const py::object& facing, Eigen::Index points) {
  if (facing.is_none()) {
    return Points(0, 3);
  }
  const Doubles array = doubles(facing, "facing");
  if (array.ndim() == 1 && array.shape(0) == 3) {
    return Eigen::Map<const Eigen::RowVector3d>(array.data()).replicate(points, 1);
  }
  const Points rows = rowsOfThree(facing, "facing");
  checkRows("facing", rows.rows(), points, "points");
  return rows;
}

/// The numpy arrays of hits.
class HitArrays {
 public:
  HitArrays() = default;
  HitArrays(py::ssize_t rows, const py::dtype& type)
      : face_(newArray<int>({rows})),
        uv_(type, {rows, 2}),
        position_(type, {rows, 3}),
        distance_(type, {rows}),
        normal_(type, {rows, 3}),
        faces_(face_.mutable_data()) {}

  /// Sets rows from `begin` on. It may be called without the GIL.
  void put(std::size_t begin, const Hits& hits) {
    for (std::size_t i = 0; i < hits.at.size(); ++i) {
      faces_[begin + i] = hits.at[i].face;
      uv_.put(2 * (begin + i), &hits.at[i].u, 1);
      uv_.put(2 * (begin + i) + 1, &hits.at[i].v, 1);
    }
    position_.put(3 * begin, hits.position.data(), 3 * hits.at.size());
    distance_.put(begin, hits.distance.data(), hits.at.size());
    normal_.put(3 * begin, hits.normal.data(), 3 * hits.at.size());
  }

  template <typename... More>
  py::object object(const char* type, const More&... more) const {
    return result(type)(face_, uv_.object(), position_.object(), distance_.object(),
                        normal_.object(), more...);
  }

 private:
  py::array_t<int> face_;
  Output uv_, position_, distance_, normal_;
  int* faces_ = nullptr;
};

/// Calls body(search, first row, number of rows) for one part of the rows after the other, without
/// the GIL.
template <typename Body>
void searchInParts(const SharedSurface& shared, Eigen::Index rows, int threads,
                   const py::object& progress, const Body& body) {
  const ProgressReport report(progress);
  const LongCall call(shared.lock);
  const SurfaceSearch& search = shared.search.get(shared.surface(), threads);
  for (Eigen::Index begin = 0; begin < rows; begin += kRowsPerSearch) {
    const Eigen::Index count = std::min(kRowsPerSearch, rows - begin);
    body(search, begin, count);
    report(static_cast<double>(begin + count) / static_cast<double>(rows));
  }
}

py::object closest(const SharedSurface& shared, const py::object& points, double max_distance,
                   const py::object& facing, double max_angle, int threads, const py::object& dtype,
                   const py::object& progress) {
  checkThreads(threads);
  const SearchRows all(points, "points");
  const Points directions = facingOf(facing, all.count());
  HitArrays arrays(all.count(), floatType(dtype));
  checkFinite(all.all(), "points");
  checkDirections(directions, "facing");
  checkDistance(max_distance);
  checkAngle(max_angle);
  ClosestOptions options;
  options.max_distance = max_distance;
  options.max_angle = max_angle;
  Points part;  // one after the other in the same memory, and their hits
  Hits hits;
  searchInParts(shared, all.count(), threads, progress,
                [&](const SurfaceSearch& search, Eigen::Index begin, Eigen::Index count) {
                  if (directions.rows() > 0) {
                    options.facing = directions.middleRows(begin, count);
                  }
                  all.copy(begin, count, part);
                  search.closest(part, options, hits, threads);
                  arrays.put(static_cast<std::size_t>(begin), hits);
                });
  return arrays.object("Hits");
}

/// The rays of a call. They are checked all together, so that errors name rows of the call.
struct Rays {
  Rays(const py::object& from, const py::object& along, double max_distance)
      : origins(from, "origins"), directions(along, "directions") {
    checkRows("directions", directions.count(), origins.count(), "origins");
    checkFinite(origins.all(), "origins");
    checkDirections(directions.all(), "directions");
    checkDistance(max_distance);
  }
  SearchRows origins, directions;
};

py::object rayCast(const SharedSurface& shared, const py::object& origins,
                   const py::object& directions, double max_distance, int threads,
                   const py::object& dtype, const py::object& progress) {
  checkThreads(threads);
  const Rays rays(origins, directions, max_distance);
  HitArrays arrays(rays.origins.count(), floatType(dtype));
  Points from, along;  // of one part after the other in the same memory, and their hits
  Hits hits;
  searchInParts(shared, rays.origins.count(), threads, progress,
                [&](const SurfaceSearch& search, Eigen::Index begin, Eigen::Index count) {
                  rays.origins.copy(begin, count, from);
                  rays.directions.copy(begin, count, along);
                  search.rayCast(from, along, max_distance, hits, threads);
                  arrays.put(static_cast<std::size_t>(begin), hits);
                });
  return arrays.object("Hits");
}

py::object rayCastAll(const SharedSurface& shared, const py::object& origins,
                      const py::object& directions, double max_distance, int threads,
                      const py::object& dtype, const py::object& progress) {
  checkThreads(threads);
  const py::dtype type = floatType(dtype);
  const Rays rays(origins, directions, max_distance);
  Points from, along;  // of one part after the other in the same memory
  std::vector<RayHits> parts;
  std::vector<std::int64_t> offsets{0};
  searchInParts(shared, rays.origins.count(), threads, progress,
                [&](const SurfaceSearch& search, Eigen::Index begin, Eigen::Index count) {
                  rays.origins.copy(begin, count, from);
                  rays.directions.copy(begin, count, along);
                  parts.push_back(search.rayCastAll(from, along, max_distance, threads));
                  const std::int64_t before = offsets.back();
                  const std::vector<std::int64_t>& own = parts.back().offsets;
                  for (std::size_t ray = 1; ray < own.size(); ++ray) {
                    offsets.push_back(before + own[ray]);
                  }
                });
  HitArrays arrays(offsets.back(), type);
  std::size_t begin = 0;
  for (const RayHits& part : parts) {
    arrays.put(begin, part);
    begin += part.at.size();
  }
  return arrays.object("RayHits", arrayOf(offsets));
}

}  // namespace

void bindSearch(SurfaceClass& type) {
  using namespace py::literals;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const py::object float64 = py::dtype("float64");
  type.def("closest", &closest, "points"_a, "max_distance"_a = kInfinity, py::kw_only(),
           "facing"_a = py::none(), "max_angle"_a = ClosestOptions().max_angle, "threads"_a = 0,
           "dtype"_a = float64, "progress"_a = py::none(), kClosestDoc)
      .def("ray_cast", &rayCast, "origins"_a, "directions"_a, "max_distance"_a = kInfinity,
           py::kw_only(), "threads"_a = 0, "dtype"_a = float64, "progress"_a = py::none(),
           kRayCastDoc)
      .def("ray_cast_all", &rayCastAll, "origins"_a, "directions"_a, "max_distance"_a = kInfinity,
           py::kw_only(), "threads"_a = 0, "dtype"_a = float64, "progress"_a = py::none(),
           kRayCastAllDoc);
}

}  // namespace limitsurf::python
