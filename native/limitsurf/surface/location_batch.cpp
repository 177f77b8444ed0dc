// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/location_batch.h"

#include <stdexcept>
#include <string>
#include <type_traits>

#include "limitsurf/error.h"
#include "limitsurf/number_text.h"

namespace limitsurf {

void checkParameters(const Location& at, std::size_t row, const char* uv_word) {
  if (!(at.u >= 0 && at.u <= 1 && at.v >= 0 && at.v <= 1)) {
    throw LocationError("row " + std::to_string(row) + ": " + uv_word + " is (" + numberText(at.u) +
                        ", " + numberText(at.v) + "), which is outside [0, 1]");
  }
}

LocationBatch::LocationBatch(const Location* locations, std::size_t count)
    : face_step_(sizeof(Location)), uv_step_(sizeof(Location)), size_(count) {
  static_assert(std::is_same_v<decltype(Location::face), std::int32_t>);
  static_assert(offsetof(Location, v) == offsetof(Location, u) + sizeof(double));
  if (count > 0) {
    faces_ = reinterpret_cast<const char*>(&locations->face);
    uv_ = reinterpret_cast<const char*>(&locations->u);
  }
}

LocationBatch::LocationBatch(const void* faces, std::size_t face_size, std::size_t face_count,
                             Span<double> uv)
    : faces_(static_cast<const char*>(faces)),
      uv_(reinterpret_cast<const char*>(uv.data())),
      face_step_(face_count == 1 ? 0 : face_size),
      uv_step_(2 * sizeof(double)),
      size_(uv.size() / 2),
      is_wide_(face_size == sizeof(std::int64_t)) {
  if (uv.size() % 2 != 0 || (face_count != 1 && face_count != size_)) {
    throw std::invalid_argument("there are " + std::to_string(face_count) + " faces and " +
                                std::to_string(uv.size()) +
                                " numbers of (u, v); expected two numbers for each face, or one "
                                "face for all");
  }
}

LocationBatch LocationBatch::called(const char* face_word, const char* uv_word) const {
  LocationBatch renamed(*this);
  renamed.face_word_ = face_word;
  renamed.uv_word_ = uv_word;
  return renamed;
}

LocationBatch LocationBatch::rows(std::size_t begin, std::size_t count) const {
  LocationBatch some(*this);
  some.size_ = count;
  if (count > 0) {
    some.faces_ += begin * face_step_;
    some.uv_ += begin * uv_step_;
  }
  return some;
}

}  // namespace limitsurf
