// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/batch/row_parts.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <tuple>
#include <vector>

#include "limitsurf/surface/batch/instruction_sets.h"
#include "limitsurf/surface/batch/patch_run.h"
#include "support/random.h"

namespace limitsurf {
namespace {

using Row = std::tuple<double, double, std::size_t>;
using Parts = std::map<unsigned, std::vector<Row>>;

/// Rows, with numbers behind them that are not to be read as rows.
struct Rows {
  explicit Rows(unsigned count) : rows(count) {
    test::Random random(count);
    constexpr double kEdges[] = {0, 0.125, 0.25, 0.5, 1};
    const auto number = [&] {
      return random.below(3) > 0 ? random.uniform() : kEdges[random.below(5)];
    };
    for (unsigned i = 0; i < count + PatchRun::kReadBeyond; ++i) {
      u.push_back(i < count ? number() : 0.75);
      v.push_back(i < count ? number() : 0.75);
    }
    std::iota(rows.begin(), rows.end(), 7);
  }
  TileRows all() { return {u.data(), v.data(), rows.data(), static_cast<unsigned>(rows.size())}; }

  std::vector<double> u, v;
  std::vector<std::size_t> rows;
};

Parts partsOf(RowParts& sorted) {
  Parts parts;
  sorted.forEachPart([&](unsigned part, const TileRows& some) {
    for (unsigned i = 0; i < some.count; ++i) {
      parts[part].emplace_back(some.u[i], some.v[i], some.rows[i]);
    }
  });
  return parts;
}

template <typename Body>
void withEachSet(const Body& body) {
  const InstructionSet before = instructionSet();
  for (const InstructionSet set :
       {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (isAvailable(set)) {
      useInstructionSet(set);
      body();
    }
  }
  useInstructionSet(before);
}

TEST(RowParts, ChildrenHaveTheirRowsInOrderAndTheirOwnParameters) {
  withEachSet([] {
    for (unsigned count = 1; count < 70; ++count) {
      Rows rows(count);
      Parts expected;
      for (unsigned i = 0; i < count; ++i) {
        const double u = rows.u[i], v = rows.v[i];
        const bool right = u >= 0.5, top = v >= 0.5;
        const double from_side = right ? 2 * (1 - u) : 2 * u;
        const double from_bottom = top ? 2 * (1 - v) : 2 * v;
        const unsigned child = right ? (top ? 2 : 1) : (top ? 3 : 0);
        expected[child].emplace_back(child % 2 == 0 ? from_side : from_bottom,
                                     child % 2 == 0 ? from_bottom : from_side, rows.rows[i]);
      }
      RowParts parts;
      parts.sortByChild(rows.all());
      ASSERT_EQ(partsOf(parts), expected) << count;
    }
  });
}

TEST(RowParts, QuartersAfterSomeStepsHaveTheirRowsInOrder) {
  withEachSet([] {
    RowParts parts;
    if (!parts.sortsFast()) {
      return;
    }
    for (unsigned count = 1; count < 70; ++count) {
      for (const int steps : {1, 2, 3}) {
        Rows rows(count);
        const double bound = 1. / (1 << steps);
        Parts expected;
        for (unsigned i = 0; i < count; ++i) {
          const double u = rows.u[i], v = rows.v[i];
          expected[(u >= bound ? 1 : 0) + (v >= bound ? 2 : 0)].emplace_back(u, v, rows.rows[i]);
        }
        parts.sortByQuarterAfter(steps, rows.all());
        ASSERT_EQ(partsOf(parts), expected) << count;
      }
    }
  });
}

}  // namespace
}  // namespace limitsurf
