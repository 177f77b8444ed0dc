// SPDX-License-Identifier: Apache-2.0
#include "support/cages/poles.h"

#include <cmath>

#include "limitsurf/pi.h"
#include "support/cages/meshes.h"

namespace limitsurf::test {

Cage openFan(int triangles) {
  Cage cage;
  cage.positions.resize(triangles + 2, 3);
  cage.positions.row(0) << 0, 0, 0.5;
  for (int i = 0; i <= triangles; ++i) {
    const double angle = kPi<double> * i / triangles;
    cage.positions.row(i + 1) << std::cos(angle), std::sin(angle), 0;
    if (i < triangles) cage.faces.push_back({0, i + 1, i + 2});
  }
  return cage;
}

Cage flattened(Cage cage) {
  cage.positions.col(2).setZero();
  return cage;
}

NamedCages poles() {
  return {{"pole of 5", pole(5)},
          {"pole of 6", pole(6)},
          {"pole of 17", pole(17)},
          {"pole of 100", pole(100)},
          {"crooked pole", perturbed(pole(24), 0.1, 1)},
          {"nearly regular pole", perturbed(pole(40), 1e-9, 2)},
          {"flat pole", flattened(pole(30))},
          {"open fan", openFan(20)},
          {"crooked open fan", perturbed(openFan(25), 0.03, 3)}};
}

}  // namespace limitsurf::test
