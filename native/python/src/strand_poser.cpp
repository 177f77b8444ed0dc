// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/strand_poser.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "arrays.h"
#include "batches.h"
#include "bound_class.h"
#include "limitsurf/number_text.h"
#include "matrices.h"
#include "strand_poser.h"

namespace limitsurf::python {
namespace {

constexpr char kMakerDoc[] =
    R"(strand_poser(face, uv, rest_roots, rest_rotations, offsets=None, *, threads=0)

Binds strands to this surface, so that they move with it when it is posed: StrandPoser.

Each strand was bound at a location at which the surface had the position r and the frame R of frames().
If the surface now has the position P and the frame F there, a point p of the rest shape moves to
P + F R^-1 (p - r): the strand moves as a rigid body with its root.

Parameters
    face, uv: (n,) Ptex faces and (n, 2), as in evaluate().
    rest_roots: (n, 3) float32, r in the space of the strands.
    rest_rotations: (n, 4) float32, quaternions w, x, y, z of any length, or (n, 3, 3) matrices as those
        of frames(): R in that space. A strand with zeros is not bound: it stays where it is, and its
        face, uv and rest root are not looked at.
    offsets: (n + 1,) integers: strand i has the points offsets[i] to offsets[i + 1] - 1. None: each
        strand has one point, as scattered points have.
    threads: 0 uses all cores.

Make it once and use it for all frames of an animation. It stays valid when set_positions() gives the
surface another pose. All arrays are copied.

Raises LocationError and MeshError as evaluate() does, for bound strands, and ValueError for arrays of
other shapes, for offsets that do not begin with 0 or that decrease, and for a rest root or a rest
rotation of a bound strand that is not finite, naming its row. Cost: O(n). Memory: 64 bytes a
strand.)";

constexpr char kClassDoc[] =
    R"(Strands that are bound to a limit surface (LimitSurface.strand_poser()).

They cannot be copied or pickled.

All arrays of points are float32, as Blender's attributes are; others are converted. `out` receives the
result: a contiguous float32 array, which may be the input itself, but not overlap it in part; without it
a new array is returned. If a call is interrupted, some rows of `out` are written and others are not.

`matrix` (4, 4) transforms from the surface's space to that of the strands; its last row is (0, 0, 0, 1).
None: they are the same. P is transformed as a point. F consists of the direction of the transformed du,
the normal of the transformed surface (on the side to which the surface's normal is transformed) and
normal x tangent. So F is a rotation whatever the matrix is, and strands stay on the outside if the
matrix mirrors. Where du or the normal has no limit (as at the vertex where a crease ends, at which
evaluate() gives the du of one side) or vanishes, F is made in the same way from the columns of frames().

`positions` (vertices, 3): the control points of a pose that the surface need not have, instead of
set_positions() before the call. The surface's own pose is not looked at, and may be changed meanwhile.
Where irregular_count is more than a tenth of all strands, such calls take less time than set_positions()
and a call without `positions`: on triangles, a tenth to a fifth. Results may differ in their last bits.
The first such call prepares the roots as fixed_samples() does. On triangles that takes about 10
microseconds of one core for each strand, and 320 bytes, which are kept: it pays if 10 to 20 frames
follow. Such calls raise MeshError as set_positions() does.

All methods raise ValueError for arrays of other shapes, for such an overlap and for matrices that are
not finite, and TypeError for an `out` of another kind.
)";

constexpr char kPoseDoc[] =
    R"((points, 3) float32: the rest shape, moved with the surface to its present pose, or to `positions`.

Error: 4e-11 times (the diagonal of the transformed control mesh + the distance of the point from its
root) times the condition number of the matrix, and the rounding to float32. Cost: an evaluation with
derivatives=1 for each strand, and some nanoseconds for each point. The result has the same bits for any
number of threads.
)";

constexpr char kReposeDoc[] =
    R"((bool, (n,) int32): does the same as pose(), in place: `points` hold an earlier pose.

Returns whether a bit of any point changed, and fingerprints() of the new points. `points` is a
contiguous float32 array, (points, 3). One pass over the points does what would need three with pose(), a
comparison and fingerprints(). Error and cost: as pose().
)";

constexpr char kUnposeDoc[] =
    R"((points, 3) float32: the rest shape of points that pose() has moved: the inverse.

With `only`, (n,) bool, the points of the other strands are left as they are in `out`, which must be
given.
)";

constexpr char kPoseVectorsDoc[] =
    R"((points, 3) float32: vectors (tangents, normals), one for each point, turned as pose() turns strands.)";

constexpr char kPoseRotationsDoc[] =
    R"((points, 4) float32: quaternions w, x, y, z, one for each point, turned as pose() turns strands.

Results have the length 1 and w >= 0; where the given quaternion is 0 they are 0. Those of strands
that are not bound stay as they are given.
)";

constexpr char kFingerprintsDoc[] =
    R"((n,) int32, never 0: a checksum of the points of each strand.

Keep the checksums of points that you write; strands whose checksums differ later have been edited. Two
different strands have the same checksum only in one case in 2^32.
)";

/// The surface lives as long as this.
struct BoundStrandPoser {
  BoundStrandPoser(const SharedSurface& of, StrandPoser made)
      : surface_(of.shared_from_this()), poser_(std::move(made)) {}

  const SharedSurface& surface() const { return *surface_; }
  const StrandPoser& poser() const { return poser_; }

 private:
  std::shared_ptr<const SharedSurface> surface_;
  StrandPoser poser_;
};

/// The rows of an (n, Columns) array of float32.
template <int Columns>
using Rows = Eigen::Matrix<float, Eigen::Dynamic, Columns, Eigen::RowMajor>;
template <int Columns>
using RowsMap = Eigen::Map<Rows<Columns>>;

template <int Columns>
Floats floatRows(const py::object& object, const char* name) {
  Floats array = floats(object, name);
  shapeEmpty(array, {0, Columns});
  if (array.ndim() != 2 || array.shape(1) != Columns) {
    throw py::value_error(std::string(name) + " has shape " + shapeText(array) + "; expected (n, " +
                          std::to_string(Columns) + ")");
  }
  return array;
}

template <int Columns>
Eigen::Map<const Rows<Columns>> viewOf(const Floats& array) {
  return {array.data(), array.shape(0), Columns};
}

/// Throws ValueError for the first number that float32 cannot hold, in the row of a bound strand.
/// What is not finite in the first place is left to StrandPoser.
void refuseBeyondFloat(const py::object& object, const char* name,
                       const FloatRotations& rotations) {
  if (isPlain<float>(object)) {
    return;
  }
  const Doubles array = doubles(object, name);
  const py::ssize_t rows = std::min<py::ssize_t>(array.shape(0), rotations.rows());
  const py::ssize_t columns = array.size() / std::max<py::ssize_t>(array.shape(0), 1);
  for (py::ssize_t i = 0; i < rows * columns; ++i) {
    const double number = array.data()[i];
    if (std::isfinite(number) && !std::isfinite(static_cast<float>(number)) &&
        !rotations.row(i / columns).isZero(0)) {
      throw py::value_error("row " + std::to_string(i / columns) + ": " + name + " has " +
                            numberText(number) + ", which float32 cannot hold");
    }
  }
}

/// Rest rotations: quaternions (n, 4), or matrices (n, 3, 3), which are converted. A matrix of
/// zeros becomes the quaternion of zeros.
FloatRotations floatRotations(const py::object& object) {
  const Doubles array = doubles(object, "rest_rotations");
  if (array.ndim() != 3) {
    return viewOf<4>(floatRows<4>(object, "rest_rotations"));
  }
  if (array.shape(1) != 3 || array.shape(2) != 3) {
    throw py::value_error("rest_rotations has shape " + shapeText(array) +
                          "; expected (n, 4) or (n, 3, 3)");
  }
  FloatRotations result(array.shape(0), 4);
  for (Eigen::Index row = 0; row < result.rows(); ++row) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> matrix(array.data() +
                                                                                9 * row);
    if (matrix.isZero(0)) {
      result.row(row).setZero();
    } else {
      for (Eigen::Index i = 0; i < 9; ++i) {
        if (!std::isfinite(matrix.data()[i])) {
          throw py::value_error("row " + std::to_string(row) + ": rest_rotations has " +
                                numberText(matrix.data()[i]) + ", which is not finite");
        }
      }
      const Eigen::Quaterniond q{Eigen::Matrix3d(matrix)};
      result.row(row) = Eigen::RowVector4d(q.w(), q.x(), q.y(), q.z()).cast<float>();
    }
  }
  return result;
}

/// Whether one of two arrays begins within the other.
bool overlapInPart(const Floats& a, const Floats& b) {
  const std::less<> before;
  return a.data() != b.data() && before(a.data(), b.data() + b.size()) &&
         before(b.data(), a.data() + a.size());
}

/// What carries the strands, as callers give it.
struct CarrierArguments {
  const py::object& matrix;
  const py::object& positions;
  int threads;
};

/// Calls body(input, output, matrix, control_points) without the GIL. Without control points the
/// surface carries the strands, and keeps its pose meanwhile.
template <int Columns, typename Body>
py::object posed(const BoundStrandPoser& self, const py::object& object, const char* name,
                 const CarrierArguments& by, const py::object& out, const char* out_name,
                 const Body& body) {
  checkThreads(by.threads);
  const Floats from = floatRows<Columns>(object, name);
  const Eigen::Matrix4d map = matrixOrNone(by.matrix, "matrix");
  Doubles positions;
  if (!by.positions.is_none()) {
    positions = positionRows(by.positions, self.surface().mesh->vertexCount());
  }
  Floats to = resultArray(out, out_name, {self.poser().pointCount(), Columns});
  if (overlapInPart(from, to)) {
    throw py::value_error(std::string(out_name) + " overlaps " + name +
                          " in part; expected the same array, or another one");
  }
  const Eigen::Map<const Rows<Columns>> input = viewOf<Columns>(from);
  RowsMap<Columns> output(to.mutable_data(), to.shape(0), Columns);
  if (by.positions.is_none()) {
    const LongCall call(self.surface().lock);
    body(input, output, map, nullptr);
  } else {
    const GilRelease release;
    const InterruptionPoint point = interruptible();
    const RowsIn<Points> rows = Eigen::Map<const Points>(positions.data(), positions.shape(0), 3);
    body(input, output, map, &rows);
  }
  return std::move(to);
}

py::object pose(const BoundStrandPoser& self, const py::object& rest_points,
                const py::object& matrix, const py::object& out, const py::object& positions,
                int threads) {
  return posed<3>(self, rest_points, "rest_points", {matrix, positions, threads}, out, "out",
                  [&](const auto& from, auto& to, const Eigen::Matrix4d& map,
                      const RowsIn<Points>* control_points) {
                    self.poser().pose(from, to, map, threads, control_points);
                  });
}

py::tuple repose(const BoundStrandPoser& self, const py::object& rest_points,
                 const py::object& points, const py::object& matrix, const py::object& positions,
                 int threads) {
  if (points.is_none()) {
    throw py::type_error("points is no contiguous array of float32");
  }
  StrandPoser::Reposed result;
  posed<3>(self, rest_points, "rest_points", {matrix, positions, threads}, points, "points",
           [&](const auto& from, auto& to, const Eigen::Matrix4d& map,
               const RowsIn<Points>* control_points) {
             result = self.poser().repose(from, to, map, threads, control_points);
           });
  return py::make_tuple(result.has_changed, arrayOf(result.fingerprints));
}

py::object unpose(const BoundStrandPoser& self, const py::object& points, const py::object& matrix,
                  const py::object& out, const py::object& only, const py::object& positions,
                  int threads) {
  std::vector<char> flags;
  if (!only.is_none()) {
    const py::array_t<bool> array = booleans(only, "only");
    if (array.ndim() != 1 || array.shape(0) != static_cast<py::ssize_t>(self.poser().size())) {
      throw py::value_error("the argument only has shape " + shapeText(array) + "; expected (" +
                            std::to_string(self.poser().size()) + ",)");
    }
    if (out.is_none()) {
      throw py::value_error(
          "the argument only needs out, in which the other strands are left as they are");
    }
    flags.assign(array.data(), array.data() + array.size());
  }
  return posed<3>(self, points, "points", {matrix, positions, threads}, out, "out",
                  [&](const auto& from, auto& to, const Eigen::Matrix4d& map,
                      const RowsIn<Points>* control_points) {
                    self.poser().unpose(from, to, map, flags, threads, control_points);
                  });
}

py::object poseVectors(const BoundStrandPoser& self, const py::object& rest_vectors,
                       const py::object& matrix, const py::object& out, const py::object& positions,
                       int threads) {
  return posed<3>(self, rest_vectors, "rest_vectors", {matrix, positions, threads}, out, "out",
                  [&](const auto& from, auto& to, const Eigen::Matrix4d& map,
                      const RowsIn<Points>* control_points) {
                    self.poser().poseVectors(from, to, map, threads, control_points);
                  });
}

py::object poseRotations(const BoundStrandPoser& self, const py::object& rest_rotations,
                         const py::object& matrix, const py::object& out,
                         const py::object& positions, int threads) {
  return posed<4>(self, rest_rotations, "rest_rotations", {matrix, positions, threads}, out, "out",
                  [&](const auto& from, auto& to, const Eigen::Matrix4d& map,
                      const RowsIn<Points>* control_points) {
                    self.poser().poseRotations(from, to, map, threads, control_points);
                  });
}

py::object fingerprints(const BoundStrandPoser& self, const py::object& points, int threads) {
  checkThreads(threads);
  const Floats from = floatRows<3>(points, "points");
  const Eigen::Map<const Rows<3>> input = viewOf<3>(from);
  std::vector<std::int32_t> numbers;
  {
    const GilRelease release;
    const InterruptionPoint point = interruptible();
    numbers = self.poser().fingerprints(input, threads);
  }
  return arrayOf(numbers);
}

std::unique_ptr<BoundStrandPoser> makePoser(const SharedSurface& shared, const py::object& face,
                                            const py::object& uv, const py::object& rest_roots,
                                            const py::object& rest_rotations,
                                            const py::object& offsets, int threads) {
  checkThreads(threads);
  const LimitSurface& surface = shared.surface();
  const Locations at = locationsOf(surface.faceCount(), face, uv, FaceCheck::size);
  const Floats roots = floatRows<3>(rest_roots, "rest_roots");
  const FloatRotations rotations = floatRotations(rest_rotations);
  const std::vector<std::int64_t> starts = strandOffsets(offsets);
  refuseBeyondFloat(rest_roots, "rest_roots", rotations);
  refuseBeyondFloat(rest_rotations, "rest_rotations", rotations);
  const Eigen::Map<const Rows<3>> root_rows = viewOf<3>(roots);
  const LongCall call(shared.lock);
  return std::make_unique<BoundStrandPoser>(
      shared, StrandPoser(surface, at, root_rows, rotations, starts, threads));
}

}  // namespace

std::vector<std::int64_t> strandOffsets(const py::object& offsets) {
  if (offsets.is_none()) {
    return {};
  }
  const Integers array = integers<std::invalid_argument>(offsets, "offsets");
  requireVector<std::invalid_argument>(array, "offsets");
  if (array.size() == 0) {
    throw py::value_error("offsets is empty; expected n + 1 numbers for n strands");
  }
  return {array.data(), array.data() + array.size()};
}

void bindStrandPoser(py::module_& module) {
  using namespace py::literals;
  const auto none = py::none();
  boundClass<py::class_<BoundStrandPoser>>(module, "StrandPoser", kClassDoc)
      .def("__len__", [](const BoundStrandPoser& self) { return self.poser().size(); })
      .def_property_readonly(
          "bound_count", [](const BoundStrandPoser& self) { return self.poser().boundCount(); },
          "The number of strands that are bound.")
      .def_property_readonly(
          "irregular_count",
          [](const BoundStrandPoser& self) { return self.poser().irregularCount(); },
          "The number of bound strands that calls with `positions` move faster: beside irregular "
          "vertices, on faces other than quads, at boundaries and creases. Strands nearer to an "
          "irregular vertex than 2^-8 of a face, or beside one of more than 30 faces, do not "
          "count. Cost: O(n).")
      .def_property_readonly(
          "point_count", [](const BoundStrandPoser& self) { return self.poser().pointCount(); },
          "The number of points of all strands.")
      .def("pose", &pose, "rest_points"_a, "matrix"_a = none, "out"_a = none, py::kw_only(),
           "positions"_a = none, "threads"_a = 0, kPoseDoc)
      .def("repose", &repose, "rest_points"_a, "points"_a, "matrix"_a = none, py::kw_only(),
           "positions"_a = none, "threads"_a = 0, kReposeDoc)
      .def("unpose", &unpose, "points"_a, "matrix"_a = none, "out"_a = none, py::kw_only(),
           "only"_a = none, "positions"_a = none, "threads"_a = 0, kUnposeDoc)
      .def("pose_vectors", &poseVectors, "rest_vectors"_a, "matrix"_a = none, "out"_a = none,
           py::kw_only(), "positions"_a = none, "threads"_a = 0, kPoseVectorsDoc)
      .def("pose_rotations", &poseRotations, "rest_rotations"_a, "matrix"_a = none, "out"_a = none,
           py::kw_only(), "positions"_a = none, "threads"_a = 0, kPoseRotationsDoc)
      .def("fingerprints", &fingerprints, "points"_a, py::kw_only(), "threads"_a = 0,
           kFingerprintsDoc);
}

void bindStrandPoserMaker(SurfaceClass& type) {
  using namespace py::literals;
  type.def("strand_poser", &makePoser, "face"_a, "uv"_a, "rest_roots"_a, "rest_rotations"_a,
           "offsets"_a = py::none(), py::kw_only(), "threads"_a = 0, kMakerDoc);
}

}  // namespace limitsurf::python
