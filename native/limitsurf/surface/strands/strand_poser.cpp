// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/strand_poser.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "limitsurf/first_made.h"
#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"
#include "limitsurf/prefetch.h"
#include "limitsurf/row_check.h"
#include "limitsurf/surface/limit_surface_data.h"
#include "limitsurf/surface/strands/fingerprint.h"
#include "limitsurf/surface/strands/fixed_roots.h"
#include "limitsurf/surface/strands/root_pose.h"
#include "limitsurf/surface/strands/strand_motion.h"
#include "limitsurf/surface/strands/strand_offsets.h"

namespace limitsurf {
namespace {

/// Strands that make one task where their points are only read.
constexpr std::size_t kStrandsPerTask = 4096;

/// The tiles of strands in random order are spread over the memory: each is fetched while so many
/// strands before it are posed, which takes as long as the memory needs to answer.
constexpr std::size_t kPrefetched = 6;

void prefetchTile(const TileTable& table, TileRef tile) {
  if (tile.kind == TileRef::kBSpline) {
    prefetch(table.bsplines[tile.index]);
  } else if (tile.kind == TileRef::kRing) {
    prefetch(table.ring_tiles[tile.index]);
  }
}

std::string rowText(const float* row, int count) {
  std::ostringstream text;
  for (int i = 0; i < count; ++i) {
    text << (i == 0 ? "(" : ", ") << numberText(row[i]);
  }
  text << ")";
  return text.str();
}

void checkFinite(const char* name, std::size_t row, const float* values, int count) {
  if (!std::all_of(values, values + count, [](float x) { return std::isfinite(x); })) {
    throw std::invalid_argument("row " + std::to_string(row) + ": " + name + " is " +
                                rowText(values, count) + ", which is not finite");
  }
}

void checkMap(const Eigen::Matrix4d& map) {
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const double value = map(row, column);
      const bool is_right = row < 3 ? std::isfinite(value) : value == (column == 3 ? 1 : 0);
      if (!is_right) {
        std::ostringstream message;
        message << "matrix has " << numberText(value) << " in row " << row << ", column " << column
                << (row < 3 ? "; expected a finite number" : "; expected (0, 0, 0, 1) in row 3");
        throw std::invalid_argument(message.str());
      }
    }
  }
}

template <typename Rows>
const float* rowOf(const Rows& rows, std::int64_t row) {
  return rows.data() + rows.cols() * row;
}
template <typename Rows>
float* rowOf(RowsOut<Rows>& rows, std::int64_t row) {
  return rows.data() + rows.cols() * row;
}

std::uint32_t bitsOf(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

/// What carries strands.
struct StrandPoser::Carrier {
  const Eigen::Matrix4d& to_strands;
  int threads;
  const RowsIn<Points>* control_points;  // none: the surface in its pose
};

struct StrandPoser::Data {
  struct Strand {
    TileLocation place;
    float root[3], rotation[4];
    int row;
  };

  Data(const LimitSurface::Data& of_surface, std::size_t strand_count,
       const std::vector<std::int64_t>& point_offsets)
      : surface(of_surface), count(strand_count), offsets(point_offsets) {}

  void bind(Span<Location> at, const RowsIn<FloatPoints>& rest_roots,
            const RowsIn<FloatRotations>& rest_rotations, int threads);

  /// Throws what the calls throw for what carries the strands.
  void check(const Carrier& by) const {
    checkThreads(by.threads);
    checkMap(by.to_strands);
    if (by.control_points) {
      checkPositions(*by.control_points, surface.table.points.cagePoints(), by.threads);
    }
  }

  std::int64_t pointCount() const {
    return offsets.empty() ? static_cast<std::int64_t>(count) : offsets.back();
  }
  std::int64_t begin(std::size_t row) const {
    return offsets.empty() ? static_cast<std::int64_t>(row) : offsets[row];
  }

  /// Calls body(row, motion) for each bound strand, in parallel, and then after(row) when some
  /// strands are done. (What was written a moment ago is read slowly in other pieces than it was
  /// written in.)
  template <typename Body, typename After>
  void forEachBound(const Carrier& by, const Body& body, const After& after) const;
  template <typename Body>
  void forEachBound(const Carrier& by, const Body& body) const {
    forEachBound(by, body, [](std::size_t) {});
  }

  /// Calls body(point, motion) for each point of bound strands, and leave(point) for all others.
  template <typename Body, typename Leave>
  void forEachPoint(const Carrier& by, const Body& body, const Leave& leave) const {
    check(by);
    forEachBound(by, [&](std::size_t row, const Motion& motion) {
      for (std::int64_t point = begin(row), end = begin(row + 1); point < end; ++point) {
        body(point, motion);
      }
    });
    for (const int row : unbound) {
      for (std::int64_t point = begin(row), end = begin(row + 1); point < end; ++point) {
        leave(point);
      }
    }
  }

  const LimitSurface::Data& surface;
  std::size_t count;
  std::vector<std::int64_t> offsets;
  std::vector<Strand> bound;
  std::vector<int> unbound;
  FirstMade<FixedRoots> fixed;  // of the bound strands, for control points
};

template <typename Body, typename After>
void StrandPoser::Data::forEachBound(const Carrier& by, const Body& body,
                                     const After& after) const {
  const RootMap map(by.to_strands);
  const auto move = [&](const Strand& strand, const RootPose& root) {
    body(static_cast<std::size_t>(strand.row), motionOf(strand.root, strand.rotation, root));
  };
  if (by.control_points) {
    const FixedRoots& roots = fixed.get([&] {
      std::vector<TileLocation> places(bound.size());
      std::transform(bound.begin(), bound.end(), places.begin(),
                     [](const Strand& strand) { return strand.place; });
      return std::make_unique<const FixedRoots>(surface.tiles, std::move(places), by.threads);
    });
    roots.forEach(
        *by.control_points, map, by.threads,
        [&](std::size_t i, const RootPose& root) { move(bound[i], root); },
        [&](std::size_t i) { after(static_cast<std::size_t>(bound[i].row)); });
    return;
  }
  parallelFor(bound.size(), kRowsPerTask, by.threads, [&](std::size_t first, std::size_t last) {
    RootFinder root(surface.table, surface.pose, map);
    for (std::size_t i = first; i < last; ++i) {
      if (i + kPrefetched < last) {
        prefetchTile(surface.table, bound[i + kPrefetched].place.tile);
      }
      move(bound[i], root(bound[i].place));
    }
    for (std::size_t i = first; i < last; ++i) {
      after(static_cast<std::size_t>(bound[i].row));
    }
  });
}

void StrandPoser::Data::bind(Span<Location> at, const RowsIn<FloatPoints>& rest_roots,
                             const RowsIn<FloatRotations>& rest_rotations, int threads) {
  const auto isBound = [&](std::size_t row) {
    return !(rest_rotations.row(static_cast<Eigen::Index>(row)).array() == 0).all();
  };
  std::vector<int> rows;
  for (std::size_t row = 0; row < count; ++row) {
    (isBound(row) ? rows : unbound).push_back(static_cast<int>(row));
  }
  for (const int row : rows) {
    surface.tiles->check(at, static_cast<std::size_t>(row));
  }
  for (const int row : rows) {
    checkFinite("rest_roots", static_cast<std::size_t>(row), rowOf(rest_roots, row), 3);
    checkFinite("rest_rotations", static_cast<std::size_t>(row), rowOf(rest_rotations, row), 4);
  }

  bound.resize(rows.size());
  parallelFor(rows.size(), kStrandsPerTask, threads, [&](std::size_t first, std::size_t last) {
    const TileEvaluator evaluator(surface.table, surface.pose);
    for (std::size_t i = first; i < last; ++i) {
      Strand& strand = bound[i];
      strand.row = rows[i];
      strand.place = evaluator.locate(at[static_cast<std::size_t>(rows[i])]);
      std::copy_n(rowOf(rest_roots, rows[i]), 3, strand.root);
      std::copy_n(rowOf(rest_rotations, rows[i]), 4, strand.rotation);
    }
  });
}

StrandPoser::StrandPoser(const LimitSurface& surface, Span<Location> at,
                         const RowsIn<FloatPoints>& rest_roots,
                         const RowsIn<FloatRotations>& rest_rotations,
                         const std::vector<std::int64_t>& offsets, int threads)
    : data_(std::make_unique<Data>(*surface.data_, at.size(), offsets)) {
  checkThreads(threads);
  const auto count = static_cast<std::int64_t>(at.size());
  checkRows("rest_roots", rest_roots.rows(), count, "face");
  checkRows("rest_rotations", rest_rotations.rows(), count, "face");
  if (!offsets.empty()) {
    checkOffsets(offsets, at.size());
  }
  data_->bind(at, rest_roots, rest_rotations, threads);
}

StrandPoser::~StrandPoser() = default;
StrandPoser::StrandPoser(StrandPoser&&) noexcept = default;
StrandPoser& StrandPoser::operator=(StrandPoser&&) noexcept = default;

std::size_t StrandPoser::size() const { return data_->count; }
std::size_t StrandPoser::boundCount() const { return data_->bound.size(); }
std::size_t StrandPoser::irregularCount() const {
  return static_cast<std::size_t>(
      std::count_if(data_->bound.begin(), data_->bound.end(), [this](const Data::Strand& strand) {
        return FixedRoots::isFaster(data_->surface.table, strand.place);
      }));
}
std::int64_t StrandPoser::pointCount() const { return data_->pointCount(); }

void StrandPoser::pose(const RowsIn<FloatPoints>& rest_points, RowsOut<FloatPoints> posed,
                       const Eigen::Matrix4d& to_strands, int threads,
                       const RowsIn<Points>* control_points) const {
  checkRows("rest_points", rest_points.rows(), pointCount());
  checkRows("posed", posed.rows(), pointCount());
  data_->forEachPoint(
      {to_strands, threads, control_points},
      [&](std::int64_t i, const Motion& motion) {
        motion.move(rowOf(rest_points, i), rowOf(posed, i));
      },
      [&](std::int64_t i) { posed.row(i) = rest_points.row(i); });
}

StrandPoser::Reposed StrandPoser::repose(const RowsIn<FloatPoints>& rest_points,
                                         RowsOut<FloatPoints> points,
                                         const Eigen::Matrix4d& to_strands, int threads,
                                         const RowsIn<Points>* control_points) const {
  const Carrier by{to_strands, threads, control_points};
  data_->check(by);
  checkRows("rest_points", rest_points.rows(), pointCount());
  checkRows("points", points.rows(), pointCount());
  const Data& data = *data_;
  std::atomic<bool> has_changed{false};
  Reposed result;
  result.fingerprints.resize(data.count);
  // Bits of the strand's points that change.
  const auto renew = [&](std::size_t row, const auto& move) {
    std::uint32_t changes = 0;
    for (std::int64_t i = data.begin(row), end = data.begin(row + 1); i < end; ++i) {
      float moved[3], *point = rowOf(points, i);
      move(rowOf(rest_points, i), moved);
      for (int axis = 0; axis < 3; ++axis) {
        changes |= bitsOf(point[axis]) ^ bitsOf(moved[axis]);
        point[axis] = moved[axis];
      }
    }
    if (changes != 0) {
      has_changed.store(true, std::memory_order_relaxed);
    }
  };
  const auto print = [&](std::size_t row) {
    const std::int64_t begin = data.begin(row), end = data.begin(row + 1);
    result.fingerprints[row] =
        fingerprint(points.data() + 3 * begin, static_cast<std::size_t>(end - begin));
  };
  data.forEachBound(
      by,
      [&](std::size_t row, const Motion& motion) {
        renew(row, [&](const float* rest, float* out) { motion.move(rest, out); });
      },
      print);
  for (const int unbound_row : data.unbound) {
    const auto row = static_cast<std::size_t>(unbound_row);
    renew(row, [](const float* rest, float* out) { std::copy_n(rest, 3, out); });
    print(row);
  }
  result.has_changed = has_changed;
  return result;
}

void StrandPoser::unpose(const RowsIn<FloatPoints>& points, RowsOut<FloatPoints> rest_points,
                         const Eigen::Matrix4d& to_strands, const std::vector<char>& only,
                         int threads, const RowsIn<Points>* control_points) const {
  const Carrier by{to_strands, threads, control_points};
  data_->check(by);
  checkRows("points", points.rows(), pointCount());
  checkRows("rest_points", rest_points.rows(), pointCount());
  if (!only.empty()) {
    checkRows("only", static_cast<Eigen::Index>(only.size()),
              static_cast<std::int64_t>(data_->count));
  }
  const Data& data = *data_;
  const auto isWanted = [&](std::size_t row) { return only.empty() || only[row]; };
  data.forEachBound(by, [&](std::size_t row, const Motion& motion) {
    if (isWanted(row)) {
      const Motion back = motion.inverse();
      for (std::int64_t i = data.begin(row), end = data.begin(row + 1); i < end; ++i) {
        back.move(rowOf(points, i), rowOf(rest_points, i));
      }
    }
  });
  for (const int unbound_row : data.unbound) {
    const auto row = static_cast<std::size_t>(unbound_row);
    if (isWanted(row)) {
      const std::int64_t first = data.begin(row), count = data.begin(row + 1) - first;
      rest_points.middleRows(first, count) = points.middleRows(first, count);
    }
  }
}

void StrandPoser::poseVectors(const RowsIn<FloatPoints>& rest_vectors, RowsOut<FloatPoints> posed,
                              const Eigen::Matrix4d& to_strands, int threads,
                              const RowsIn<Points>* control_points) const {
  checkRows("rest_vectors", rest_vectors.rows(), pointCount());
  checkRows("posed", posed.rows(), pointCount());
  data_->forEachPoint(
      {to_strands, threads, control_points},
      [&](std::int64_t i, const Motion& motion) {
        motion.turned(Triple(rowOf(rest_vectors, i))).store(rowOf(posed, i));
      },
      [&](std::int64_t i) { posed.row(i) = rest_vectors.row(i); });
}

void StrandPoser::poseRotations(const RowsIn<FloatRotations>& rest_rotations,
                                RowsOut<FloatRotations> posed, const Eigen::Matrix4d& to_strands,
                                int threads, const RowsIn<Points>* control_points) const {
  checkRows("rest_rotations", rest_rotations.rows(), pointCount());
  checkRows("posed", posed.rows(), pointCount());
  data_->forEachPoint(
      {to_strands, threads, control_points},
      [&](std::int64_t i, const Motion& motion) {
        const Eigen::Vector4d q = rest_rotations.row(i).cast<double>().transpose();
        if (q.isZero(0)) {
          posed.row(i).setZero();
          return;
        }
        Eigen::Matrix3d turn;
        for (int column = 0; column < 3; ++column) {
          const Triple& v = motion.turn[column];
          turn.col(column) = Vector3(v.x, v.y, v.z);
        }
        Eigen::Quaterniond result =
            Eigen::Quaterniond(turn) * Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
        result.normalize();
        const double sign = result.w() < 0 ? -1 : 1;
        posed.row(i) = (sign * Eigen::RowVector4d(result.w(), result.x(), result.y(), result.z()))
                           .cast<float>();
      },
      [&](std::int64_t i) { posed.row(i) = rest_rotations.row(i); });
}

std::vector<std::int32_t> StrandPoser::fingerprints(const RowsIn<FloatPoints>& points,
                                                    int threads) const {
  checkThreads(threads);
  checkRows("points", points.rows(), pointCount());
  std::vector<std::int32_t> result(data_->count);
  parallelFor(result.size(), kStrandsPerTask, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
      const std::int64_t begin = data_->begin(row), end = data_->begin(row + 1);
      result[row] = fingerprint(points.data() + 3 * begin, static_cast<std::size_t>(end - begin));
    }
  });
  return result;
}

}  // namespace limitsurf
