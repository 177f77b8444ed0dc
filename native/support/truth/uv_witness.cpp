// SPDX-License-Identifier: Apache-2.0
#include "support/truth/uv_witness.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "support/cages/meshes.h"

namespace limitsurf::test {
namespace {

std::vector<Location> spread(int face, int per_side, double shift) {
  std::vector<Location> at;
  const int points = shift == 0 ? per_side + 1 : per_side;
  for (int j = 0; j < points; ++j) {
    for (int i = 0; i < points; ++i) {
      at.push_back({face, (i + shift) / per_side, (j + shift) / per_side});
    }
  }
  return at;
}

/// Corners' values from the positions of their vertices seen from above, within [0.1, 0.9]^2.
DataRows fromAbove(const Cage& cage, const Channel& channel) {
  DataRows rows = DataRows::Zero(channel.value_count, 2);
  std::size_t corner = 0;
  for (const std::vector<int>& face : cage.faces) {
    for (const int vertex : face) {
      const Eigen::RowVector3d p = cage.positions.row(vertex);
      rows.row(channel.indices[corner++]) << p[0] + 0.31 * p[2], p[1] + 0.43 * p[2];
    }
  }
  const Eigen::RowVector2d low = rows.colwise().minCoeff(), high = rows.colwise().maxCoeff();
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    rows.row(row) = 0.1 + 0.8 * (rows.row(row) - low).array() / (high - low).array();
  }
  return rows;
}

Cage creased() {
  Cage cage = perturbed(grid(4, 4), 0.2, 5);
  cage.options.edge_sharpness = {{{2, 5}, {5, 7}, {12, 17}, {12, 10}}, {2.5, 2.5, 10, 0.7}};
  return cage;
}

}  // namespace

std::vector<NamedMap> uvMaps() {
  const NamedCages cages = {{"one quad", perturbed(grid(1, 1), 0.2, 9)},
                            {"grid", perturbed(grid(4, 3), 0.25, 1)},
                            {"holes", perturbed(gridWithHoles(5, 5, {7, 13}), 0.2, 2)},
                            {"cross", cross()},
                            {"cube", perturbed(cube(), 0.2, 3)},
                            {"fan 3", fan(3, true, 1)},
                            {"fan 7", fan(7, true, 1)},
                            {"open fan 5", fan(5, false, 2)},
                            {"pole", pole(9)},
                            {"hexagon", ngon(6, 1)},
                            {"mixture", mixture(1)},
                            {"valence 2", valenceTwo()},
                            {"creases", creased()}};
  std::vector<NamedMap> maps;
  Random random(77);
  std::size_t turn = 0;
  for (const auto& [name, cage] : cages) {
    for (const auto& [rule, interpolation] : kInterpolations) {
      const int kind = static_cast<int>(turn++ % 3);
      const Channel channel = kind == 0   ? cutChannel(cage, 1 << 20, random)
                              : kind == 1 ? cutChannel(cage, 3, random)
                                          : randomChannel(cage, random);
      DataRows rows = fromAbove(cage, channel);
      if (kind == 1) {  // islands overlap here and there
        rows += 0.1 * randomRows(rows.rows(), 2, turn);
      } else if (kind == 2) {
        rows = 0.5 + 0.5 * randomRows(rows.rows(), 2, turn).array();
      }
      LimitSurface surface = limitSurface(cage);
      SurfaceData map = surface.faceVarying(rows, channel.indices, interpolation);
      static const char* const kKinds[] = {", whole", ", cut", ", random"};
      maps.push_back({name + ", " + rule + kKinds[kind], std::move(surface), std::move(map)});
    }
  }
  return maps;
}

UvWitness::UvWitness(const LimitSurface& surface, const SurfaceData& map, int per_side)
    : per_side_(per_side) {
  std::vector<Location> corners, middles;
  for (int face = 0; face < surface.faceCount(); ++face) {
    if (surface.refused().count(surface.baseFace()[face]) == 0) {
      faces_.push_back(face);
      for (const Location& at : spread(face, per_side, 0)) corners.push_back(at);
      for (const Location& at : spread(face, per_side, 0.5)) middles.push_back(at);
    }
  }
  values_ = map.evaluate(corners).value;
  const DataRows truth = map.evaluate(middles).value;
  // A square's middle against the means of both of its diagonals.
  const int side = per_side + 1;
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    for (int j = 0; j < per_side; ++j) {
      for (int i = 0; i < per_side; ++i) {
        const auto corner = static_cast<Eigen::Index>(face * side * side + j * side + i);
        const auto middle =
            static_cast<Eigen::Index>(face * per_side * per_side + j * per_side + i);
        const auto off = [&](Eigen::Index a, Eigen::Index b) {
          return (0.5 * (values_.row(a) + values_.row(b)) - truth.row(middle)).norm();
        };
        deviation_ =
            std::max({deviation_, off(corner, corner + side + 1), off(corner + 1, corner + side)});
      }
    }
  }
  deviation_ *= 2;
}

std::vector<Sheets> UvWitness::sheetsAt(const DataRows& points) const {
  std::vector<Sheets> sheets(static_cast<std::size_t>(points.rows()));
  std::multimap<double, std::size_t> by_x;
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    by_x.emplace(points(static_cast<Eigen::Index>(i), 0), i);
  }
  const auto addTriangle = [&](int face, Eigen::Index a, Eigen::Index b, Eigen::Index c) {
    const Eigen::RowVector2d p[3] = {values_.row(a), values_.row(b), values_.row(c)};
    const auto area = [](const Eigen::RowVector2d& x, const Eigen::RowVector2d& y,
                         const Eigen::RowVector2d& z) {
      return (y[0] - x[0]) * (z[1] - x[1]) - (y[1] - x[1]) * (z[0] - x[0]);
    };
    const double whole = area(p[0], p[1], p[2]);
    const auto first = by_x.lower_bound(std::min({p[0][0], p[1][0], p[2][0]}));
    const auto last = by_x.upper_bound(std::max({p[0][0], p[1][0], p[2][0]}));
    for (auto at = first; at != last; ++at) {
      const Eigen::RowVector2d point = points.row(static_cast<Eigen::Index>(at->second));
      const double parts[3] = {area(point, p[1], p[2]), area(p[0], point, p[2]),
                               area(p[0], p[1], point)};
      if (whole != 0 && parts[0] / whole > 0 && parts[1] / whole > 0 && parts[2] / whole > 0) {
        Sheets& over = sheets[at->second];
        ++over.count;
        if (over.lowest_face < 0 || face == over.lowest_face) {
          over.flipped |= whole < 0;
          over.lowest_face = face;
          ++over.of_lowest_face;
        }
      }
    }
  };
  const int side = per_side_ + 1;
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    for (int j = 0; j < per_side_; ++j) {
      for (int i = 0; i < per_side_; ++i) {
        const auto corner = static_cast<Eigen::Index>(face * side * side + j * side + i);
        addTriangle(faces_[face], corner, corner + 1, corner + side + 1);
        addTriangle(faces_[face], corner, corner + side + 1, corner + side);
      }
    }
  }
  return sheets;
}

std::vector<UvWitness::Answer> UvWitness::at(const DataRows& points) const {
  std::vector<Answer> answers(static_cast<std::size_t>(points.rows()));
  for (int around = 0; around < 9; ++around) {
    DataRows moved = points;
    // Off the middle as well: triangles' own sides have no inside.
    const double unit = deviation_ + 1e-7;
    moved.col(0).array() += unit * (around % 3 - 1 + 0.013);
    moved.col(1).array() += unit * (around / 3 - 1 + 0.017);
    const std::vector<Sheets> sheets = sheetsAt(moved);
    for (std::size_t i = 0; i < sheets.size(); ++i) {
      if (around == 0) {
        answers[i] = {true, sheets[i]};
      }
      answers[i].known &= sheets[i].count == answers[i].sheets.count &&
                          sheets[i].lowest_face == answers[i].sheets.lowest_face &&
                          sheets[i].of_lowest_face == answers[i].sheets.of_lowest_face &&
                          sheets[i].flipped == answers[i].sheets.flipped;
    }
  }
  return answers;
}

double UvWitness::distance(const Eigen::RowVector2d& point, const Eigen::RowVector2d& scale) const {
  double squared = std::numeric_limits<double>::infinity();
  for (Eigen::Index row = 0; row < values_.rows(); ++row) {
    squared =
        std::min(squared, ((values_.row(row) - point).array() * scale.array()).square().sum());
  }
  return std::sqrt(squared);
}

}  // namespace limitsurf::test
