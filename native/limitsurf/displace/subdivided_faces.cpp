// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/displace/subdivided_faces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "limitsurf/displace/face_grid.h"
#include "limitsurf/displace/subdivided_vertices.h"
#include "limitsurf/interruptible_vector.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr std::size_t kLocationsPerTask = 8192;
constexpr std::size_t kNone = SIZE_MAX;

[[noreturn]] void refuse(const std::string& why) {
  throw MeshError("structures do not match: " + why);
}

std::string number(std::int64_t value) { return std::to_string(value); }

std::string times(int levels) {
  return number(levels) + (levels == 1 ? " subdivision" : " subdivisions");
}

int findLevels(const ControlMesh& base, const ControlMesh& subdivided) {
  std::int64_t at_one = 0;
  for (int face = 0; face < base.faceCount(); ++face) {
    at_one += base.faceSize(face);
  }
  std::int64_t faces = base.faceCount();
  for (int levels = 0; levels <= kMostSubdivisions; ++levels) {
    if (faces == subdivided.faceCount()) {
      return levels;
    }
    faces = levels == 0 ? at_one : 4 * faces;
  }
  refuse("the target has " + number(subdivided.faceCount()) + " faces; the base's " +
         number(base.faceCount()) + " become " + number(at_one) + ", " + number(4 * at_one) + ", " +
         number(16 * at_one) + ", ... when they are subdivided");
}

/// Checks the sizes of all faces; the other checks rely on them.
void checkSizes(const ControlMesh& base, const ControlMesh& subdivided, int levels) {
  for (int face = 0; face < subdivided.faceCount(); ++face) {
    const int expected = levels == 0 ? base.faceSize(face) : 4;
    if (subdivided.faceSize(face) != expected) {
      refuse("face " + number(face) + " of the target has " + number(subdivided.faceSize(face)) +
             " corners; after " + times(levels) + " of the base it has " + number(expected));
    }
  }
}

/// The vertex of each corner of the faces that subdividing the base produces in this order.
std::vector<int> expectedVertices(const ControlMesh& base, int levels, FaceOrder order) {
  if (levels == 0) {
    return base.faceVertices();
  }
  const SubdividedVertices vertices(base, levels);
  std::vector<int> result;
  std::size_t first = 0;
  for (int face = 0; face < base.faceCount(); ++face) {
    const FaceGrid grid(base.faceSize(face), levels);
    result.resize(result.size() + 4 * static_cast<std::size_t>(grid.count()));
    for (int part = 0; part < grid.parts(); ++part) {
      for (int j = 0; j < grid.side(); ++j) {
        for (int i = 0; i < grid.side(); ++i) {
          int* corners = &result[4 * (first + grid.index(order, part, i, j))];
          corners[0] = vertices.at(face, part, i, j);
          corners[1] = vertices.at(face, part, i + 1, j);
          corners[2] = vertices.at(face, part, i + 1, j + 1);
          corners[3] = vertices.at(face, part, i, j + 1);
        }
      }
    }
    first += static_cast<std::size_t>(grid.count());
    InterruptionPoint::pass();
  }
  return result;
}

/// A corner at which two lists of vertices share them differently.
struct Difference {
  std::size_t corner;
  std::size_t other;  ///< the corner whose vertex it should have, or should not have
  bool shares;        ///< it has the same vertex though it should not
};

/// Vertices may be numbered differently, but there must be a one-to-one correspondence between
/// them.
std::optional<Difference> findDifference(const std::vector<int>& expected,
                                         const std::vector<int>& found) {
  const auto firstUses = [](const std::vector<int>& numbers) {
    const int largest = *std::max_element(numbers.begin(), numbers.end());
    return std::vector<std::size_t>(static_cast<std::size_t>(largest) + 1, kNone);
  };
  std::vector<std::size_t> of_expected = firstUses(expected), of_found = firstUses(found);
  for (std::size_t corner = 0; corner < expected.size(); ++corner) {
    std::size_t& ours = of_expected[static_cast<std::size_t>(expected[corner])];
    std::size_t& theirs = of_found[static_cast<std::size_t>(found[corner])];
    if (ours == theirs) {
      ours = theirs = std::min(ours, corner);
    } else if (ours != kNone) {
      return Difference{corner, ours, false};
    } else {
      return Difference{corner, theirs, true};
    }
  }
  return std::nullopt;
}

const char* nameOf(FaceOrder order) {
  return order == FaceOrder::blender ? "Blender's" : "OpenSubdiv's";
}

std::string describe(const Difference& difference, const ControlMesh& subdivided, int levels,
                     FaceOrder order) {
  const auto corner = [&](std::size_t index) {
    int face = static_cast<int>(index / 4);
    if (levels == 0) {
      face = 0;
      while (static_cast<std::size_t>(subdivided.firstCorner(face) + subdivided.faceSize(face)) <=
             index) {
        ++face;
      }
    }
    return std::pair(face, static_cast<int>(index) - subdivided.firstCorner(face));
  };
  const auto [face, at] = corner(difference.corner);
  const auto [other, other_at] = corner(difference.other);
  const std::string vertex = number(subdivided.faceVertices()[difference.corner]);
  std::string text = "face " + number(face) + " of the target has vertex " + vertex +
                     " at its corner " + number(at) + ", which it ";
  text += difference.shares ? "shares with corner " : "does not share with corner ";
  text += number(other_at) + " of face " + number(other) + ", as after " + times(levels) +
          " of the base it should";
  text += difference.shares ? " not" : "";
  return text + (levels > 1 ? std::string(" (") + nameOf(order) + " order of faces)" : "");
}

}  // namespace

SubdividedFaces::SubdividedFaces(const ControlMesh& base, const ControlMesh& subdivided)
    : levels_(findLevels(base, subdivided)) {
  checkSizes(base, subdivided, levels_);
  std::optional<Difference> farthest;
  for (const FaceOrder order : {FaceOrder::blender, FaceOrder::opensubdiv}) {
    const auto difference =
        findDifference(expectedVertices(base, levels_, order), subdivided.faceVertices());
    if (!difference) {
      order_ = order;
      farthest.reset();
      break;
    }
    if (!farthest || difference->corner > farthest->corner) {
      farthest = difference;
      order_ = order;
    }
  }
  if (farthest) {
    refuse(describe(*farthest, subdivided, levels_, order_));
  }
  int first = 0;
  for (int face = 0; face < base.faceCount(); ++face) {
    const int size = base.faceSize(face), parts = size == 4 ? 1 : size;
    for (int corner = 0; corner < parts; ++corner) {
      parts_.push_back({first, size, corner});
    }
    first += levels_ == 0 ? parts : FaceGrid(size, levels_).count();
  }
}

Location SubdividedFaces::locate(const Location& at) const {
  const Part& part = parts_[static_cast<std::size_t>(at.face)];
  if (levels_ == 0) {
    return at;
  }
  const FaceGrid grid(part.size, levels_);
  const double u = std::ldexp(at.u, grid.sideLog2()), v = std::ldexp(at.v, grid.sideLog2());
  const int i = std::min(static_cast<int>(u), grid.side() - 1);
  const int j = std::min(static_cast<int>(v), grid.side() - 1);
  return {part.first + grid.index(order_, part.corner, i, j), u - i, v - j};
}

std::vector<Location> SubdividedFaces::locate(const LocationBatch& at, int threads) const {
  checkThreads(threads);
  for (std::size_t row = 0; row < at.size(); ++row) {
    checkParameters(at[row], row);
  }
  std::vector<Location> result;
  resizeInParts(result, at.size());
  parallelFor(at.size(), kLocationsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      result[row] = locate(at[row]);
    }
  });
  return result;
}

}  // namespace limitsurf
