// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "limitsurf/sample/blue_noise/trial_cell.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Lists of cells one after the other, without a copy of them. The lists must not change meanwhile.
class CellList {
 public:
  void add(Span<TrialCell> cells) {
    if (!cells.empty()) {
      lists_.push_back(cells);
      ends_.push_back(size() + cells.size());
    }
  }
  void clear() {
    lists_.clear();
    ends_.clear();
  }
  std::size_t size() const { return ends_.empty() ? 0 : ends_.back(); }

  /// Calls visit(cells) for the parts of lists that make up the cells from `begin` to `end`.
  template <typename Visit>
  void visit(std::size_t begin, std::size_t end, const Visit& visit) const {
    std::size_t list = static_cast<std::size_t>(
        std::upper_bound(ends_.begin(), ends_.end(), begin) - ends_.begin());
    for (; begin < end; ++list) {
      const std::size_t first = ends_[list] - lists_[list].size();
      const std::size_t last = std::min(end, ends_[list]);
      visit(lists_[list].subspan(begin - first, last - begin));
      begin = last;
    }
  }

 private:
  std::vector<Span<TrialCell>> lists_;
  std::vector<std::size_t> ends_;
};

}  // namespace limitsurf
