// SPDX-License-Identifier: Apache-2.0
#include "batches.h"

#include <limits>
#include <sstream>

#include "limitsurf/error.h"
#include "result_memory.h"

namespace limitsurf::python {
namespace {

/// Throws LocationError unless there is one face, or one for each row of uv.
void checkShapes(const py::array& faces, const char* face_name, Doubles& uvs, const char* uv_name) {
  requireRows<LocationError>(uvs, uv_name, 2);
  if (faces.ndim() > 1 || (faces.ndim() == 1 && faces.shape(0) != uvs.shape(0))) {
    throw LocationError(std::string(face_name) + " has shape " + shapeText(faces) + " and " +
                        uv_name + " " + shapeText(uvs) + "; expected one face, or (n,) and (n, 2)");
  }
}

}  // namespace

LocationArrays::LocationArrays(const py::object& face, const py::object& uv)
    : uv_(doubles(uv, "uv")) {
  const bool is_narrow = isPlain<std::int32_t>(face);
  face_ = is_narrow ? py::reinterpret_borrow<py::array>(face)
                    : py::array(integers<LocationError>(face, "face"));
  checkShapes(face_, "face", uv_, "uv");
  const auto count = static_cast<std::size_t>(face_.size());
  const Span<double> parameters(uv_.data(), static_cast<std::size_t>(uv_.size()));
  batch_ = is_narrow
               ? LocationBatch({static_cast<const std::int32_t*>(face_.data()), count}, parameters)
               : LocationBatch({static_cast<const std::int64_t*>(face_.data()), count}, parameters);
}

Locations locationsOf(int face_count, const py::object& face, const py::object& uv, FaceCheck check,
                      const char* face_name, const char* uv_name) {
  Doubles uvs = doubles(uv, uv_name);
  const Integers faces = integers<LocationError>(face, face_name);
  checkShapes(faces, face_name, uvs, uv_name);
  const std::size_t rows = static_cast<std::size_t>(uvs.shape(0));
  const std::int64_t* ids = faces.data();
  const double* parameters = uvs.data();
  const bool one = faces.ndim() == 0;
  using Int = std::numeric_limits<int>;
  const std::int64_t lowest = check == FaceCheck::range ? 0 : Int::min();
  const std::int64_t highest = check == FaceCheck::range ? face_count - 1 : Int::max();
  Locations result;
  result.reserve(rows);
  forEachRow(rows, [&](std::size_t row) {
    const std::int64_t id = ids[one ? 0 : row];
    if (id < lowest || id > highest) {
      std::ostringstream message;
      message << "row " << row << ": " << face_name << " " << id << " is not among the "
              << face_count << " Ptex faces";
      throw LocationError(message.str());
    }
    result.push_back({static_cast<int>(id), parameters[2 * row], parameters[2 * row + 1]});
  });
  return result;
}

void checkDerivatives(int derivatives, int highest) {
  if (derivatives < 0 || derivatives > highest) {
    throw py::value_error("derivatives is " + std::to_string(derivatives) + "; expected " +
                          (highest == 2 ? "0, 1 or 2" : "0 or 1"));
  }
}

py::object locations(const Locations& at) {
  const auto rows = static_cast<py::ssize_t>(at.size());
  auto face = newArray<int>({rows});
  auto uv = newArray<double>({rows, 2});
  int* faces = face.mutable_data();
  double* uvs = uv.mutable_data();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  forEachRow(at.size(), [&](std::size_t i) {
    faces[i] = at[i].face;
    uvs[2 * i] = at[i].face < 0 ? kNaN : at[i].u;
    uvs[2 * i + 1] = at[i].face < 0 ? kNaN : at[i].v;
  });
  return result("Locations")(face, uv);
}

py::object result(const char* name) {
  static const py::handle results =
      py::module_::import("limitsurf._results").release();  // for good
  return results.attr(name);
}

}  // namespace limitsurf::python
