// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/surface/batch/patch_kernels.h"
#include "limitsurf/surface/batch/row_order.h"
#include "limitsurf/surface/location_batch.h"
#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {

/// Evaluates many locations. Those that follow each other on one face and lie on the same bicubic
/// patch are evaluated together; what that gives is the same to the bit as TileEvaluator's results
/// one by one. Each thread needs an evaluator of its own.
template <typename Real>
class BatchEvaluator {
 public:
  /// `results` has room for all rows. Derivatives up to `order` are written, and normals if there
  /// is an array for them.
  BatchEvaluator(const TileTable& table, const Pose& pose, int order,
                 const PatchResults<Real>& results);

  /// The rows at places `begin` to `end` - 1 of an order, of a batch that has been checked. Each
  /// location is read once and looked at again, because an array of another program may be changed
  /// by another of its threads; throws LocationError if that made it invalid.
  void evaluate(const LocationBatch& at, const RowOrder& order, std::size_t begin, std::size_t end);

 private:
  /// At most so many rows are put in order at a time.
  static constexpr unsigned kMostRows = 512;

  /// A bicubic patch of a tile: all of a regular tile, or what a quarter of a ring tile is after
  /// some steps.
  struct Patch {
    std::uint64_t key;
    TileLocation place;  // of one of its rows
    unsigned rows;       // how many there are
    unsigned first;      // where they begin, in order
  };

  /// The rows of one face that splits into tiles, or is a ring tile.
  void evaluateFace(int face, const double* u, const double* v, const std::size_t* rows,
                    unsigned count);
  void evaluatePatch(const TileLocation& place, const double* u, const double* v,
                     const std::size_t* rows, unsigned count);
  void setBSpline(const TileLocation& place, PatchRun& run);
  void setRing(const TileLocation& place, PatchRun& run);
  /// By TileEvaluator, alone.
  void evaluateAlone(const TileLocation& place, std::size_t row);
  void putNormal(const TileLocation& place, const Jet& jet, std::size_t row);

  /// Whether a location belongs to a patch of the kernels; if so, u and v become its parameters.
  bool onPatch(const TileLocation& place, double& u, double& v, std::uint64_t& key) const;
  unsigned patchOf(std::uint64_t key, const TileLocation& place);

  const TileTable& table_;
  const Pose& pose_;
  const PatchKernels& kernels_;
  const typename PatchKernels::Evaluate<Real> kernel_;
  const int order_;
  const PatchResults<Real> results_;
  TileEvaluator alone_;

  alignas(64) double window_[16][4];
  Padded deep_[tile_grid::kSlots];  // the grid of the last ring tile below those that are kept
  std::uint64_t deep_key_ = 0;

  // Of the rows of one face.
  std::vector<Patch> patches_;
  static constexpr unsigned kSlots = 2 * kMostRows;
  std::vector<unsigned> slots_;     // a hash table of numbers in patches_, plus 1
  std::vector<unsigned> patch_of_;  // by row
  std::vector<double> u_, v_;       // by row
  std::vector<double> sorted_u_, sorted_v_;
  std::vector<std::size_t> sorted_rows_;
};

extern template class BatchEvaluator<double>;
extern template class BatchEvaluator<float>;

}  // namespace limitsurf
