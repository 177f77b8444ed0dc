// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "limitsurf/mesh/interpolation.h"
#include "support/cages/cage.h"
#include "support/random.h"

namespace limitsurf::test {

constexpr std::pair<const char*, Interpolation> kInterpolations[] = {
    {"none", Interpolation::none},
    {"corners_only", Interpolation::corners_only},
    {"corners_plus1", Interpolation::corners_plus1},
    {"corners_plus2", Interpolation::corners_plus2},
    {"boundaries", Interpolation::boundaries},
    {"all", Interpolation::all}};

/// Which value each corner of a cage's faces picks.
struct Channel {
  std::vector<std::int64_t> indices;
  int value_count = 0;
};

/// One edge in `edges_per_cut` is cut; corners share a value where no cut lies between their faces
/// at the vertex. Cuts may end inside, meet, and leave corners of one face.
Channel cutChannel(const Cage& cage, int edges_per_cut, Random& random);

/// Each vertex has a few values, of which its corners take that of their face's chart, or one at
/// random.
Channel chartChannel(const Cage& cage, int charts, Random& random);
Channel scatteredChannel(const Cage& cage, int choices, Random& random);

/// Any of these, or one whose values different vertices have in common.
Channel randomChannel(const Cage& cage, Random& random);

/// Random values in [-1, 1].
DataRows randomRows(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed);

}  // namespace limitsurf::test
