// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/stencilTable.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "bench/support/bfr_peer.h"

namespace limitsurf::bench {

/// OpenSubdiv's table of weights of fixed locations on the control points, in double precision: its
/// means for samples that stay while a mesh deforms.
class LimitStencilPeer {
 public:
  /// Patches around extraordinary vertices end after so many subdivisions.
  static constexpr int kLevel = 5;

  /// The locations must be sorted by face. The table has weights of du and dv if
  /// `with_derivatives`.
  LimitStencilPeer(const MeshArrays& cage, const std::vector<Location>& at, bool with_derivatives);

  /// Writes the rows of `out`, whose members must already have their sizes.
  void evaluate(const Points& positions, Evaluation& out) const;
  /// The bytes of the table.
  std::size_t bytes() const;

 private:
  using Table = OpenSubdiv::Far::LimitStencilTableReal<double>;
  std::unique_ptr<const Table> table_;
  bool with_derivatives_;
};

}  // namespace limitsurf::bench
