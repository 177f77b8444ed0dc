// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace limitsurf {

/// An invalid control mesh, or a request for a face that has no limit surface. The message names
/// the face, vertex, edge or row and the invalid value.
class MeshError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A location outside the surface's domain: a face id that does not exist, or a (u, v) that is NaN
/// or outside [0, 1]. The message names the row of the batch and the invalid value.
class LocationError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace limitsurf
