// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "support/random.h"
#include "support/truth/accuracy.h"
#include "support/truth/deep_subdivision.h"

namespace limitsurf::test {

/// Holds LimitSurface and FixedSamples to the promised accuracy against DeepSubdivision at all the
/// locations; at irregular vertices themselves also to what must be missing there. Adds the worst
/// figures to `all`.
void compareWithSubdivision(const std::string& name, const Cage& cage,
                            const std::vector<Location>& at, Accuracy& all);

/// Locations on square rings at the distances 2^-n of a face's corner, n up to 40: in several
/// directions, on the diagonal and on both edges. 1 - u and 1 - v are exact.
std::vector<Location> shells(int face, int corner, const std::vector<int>& n);

/// `count` locations anywhere on the face.
std::vector<Location> anywhere(int face, int count, Random& random);

/// On every Ptex face: near and at each corner, and anywhere.
std::vector<Location> everywhere(const Cage& cage, const std::vector<int>& levels, int random_count,
                                 Random& random);

/// On every Ptex face: at one of the corners, and `count` each near one of them (on shells of the
/// given levels), on the sides and anywhere.
std::vector<Location> hereAndThere(const Cage& cage, const std::vector<int>& levels, int count,
                                   Random& random);

/// Around the vertex 0 of a fan() of so many faces, on the first, second, middle and last of them:
/// at the vertex, on shells around it, and `count` anywhere; one anywhere on each face beyond.
std::vector<Location> aroundFan(int faces, const std::vector<int>& levels, int count,
                                Random& random);

/// Appends.
void operator+=(std::vector<Location>& locations, const std::vector<Location>& more);

}  // namespace limitsurf::test
