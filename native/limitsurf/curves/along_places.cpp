// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/along_places.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "limitsurf/mesh/messages.h"
#include "limitsurf/random_bits.h"

namespace limitsurf {
namespace {

/// More locations than this are a mistake.
constexpr std::int64_t kMostLocations = std::int64_t{1} << 31;

void checkShare(double value, const char* name) {
  if (!(value >= 0 && value <= 1)) {
    throw std::invalid_argument(text(name, " is ", value, "; it must be from 0 to 1"));
  }
}

/// Throws if there would be too many locations. `what` says what asks for `on_curves` of them, in
/// one row.
void checkNumber(double on_curves, int rows, const std::string& what) {
  if (on_curves * rows > static_cast<double>(kMostLocations)) {
    throw std::invalid_argument(text(what, rows > 1 ? text(" and rows is ", rows) : "",
                                     "; the limit is ", kMostLocations, " locations"));
  }
}

/// Divides a number in proportion to lengths, by largest remainders.
std::vector<std::int64_t> shares(std::int64_t count, const std::vector<double>& lengths,
                                 double total) {
  std::vector<std::int64_t> result(lengths.size());
  std::vector<double> rest(lengths.size());
  std::int64_t given = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const double share = static_cast<double>(count) * (lengths[i] / total);
    result[i] = static_cast<std::int64_t>(share);
    rest[i] = share - static_cast<double>(result[i]);
    given += result[i];
  }
  std::vector<std::size_t> order(lengths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rest[a] > rest[b]; });
  for (std::size_t i = 0; given < count; i = (i + 1) % order.size()) {
    if (lengths[order[i]] > 0) {
      ++result[order[i]];
      ++given;
    }
  }
  return result;
}

}  // namespace

void checkAlongOptions(const AlongOptions& options) {
  if (options.count.has_value() == options.spacing.has_value()) {
    throw std::invalid_argument("exactly one of count and spacing must be given");
  }
  if (options.count && *options.count < 0) {
    throw std::invalid_argument(text("count is ", *options.count, "; it must be at least 0"));
  }
  if (options.spacing && !(*options.spacing > 0 && std::isfinite(*options.spacing))) {
    throw std::invalid_argument(
        text("spacing is ", *options.spacing, "; it must be finite and above 0"));
  }
  if (options.rows < 1) {
    throw std::invalid_argument(text("rows is ", options.rows, "; it must be at least 1"));
  }
  if (options.rows > 1 && !(options.row_distance > 0 && std::isfinite(options.row_distance))) {
    throw std::invalid_argument(
        text("row_distance is ", options.row_distance, "; it must be finite and above 0"));
  }
  checkShare(options.jitter, "jitter");
  checkShare(options.phase.value_or(0), "phase");
}

std::vector<std::int64_t> alongCounts(const EdgeCurves& curves, const AlongOptions& options) {
  std::vector<double> lengths;
  lengths.reserve(static_cast<std::size_t>(curves.count()));
  for (int curve = 0; curve < curves.count(); ++curve) {
    lengths.push_back(curves.length(curve));
  }
  const double total = std::accumulate(lengths.begin(), lengths.end(), 0.);
  if (options.count) {
    checkNumber(static_cast<double>(*options.count), options.rows,
                text("count is ", *options.count));
    if (*options.count == 0) {
      return std::vector<std::int64_t>(lengths.size(), 0);
    }
    if (!(total > 0)) {
      throw std::invalid_argument(
          text("count is ", *options.count, ", but the curves have no length"));
    }
    return shares(*options.count, lengths, total);
  }
  const double spacing = options.spacing.value_or(total);
  checkNumber(total / spacing, options.rows,
              text("spacing is ", spacing, " on curves of the length ", total));
  std::vector<std::int64_t> result;
  result.reserve(lengths.size());
  for (const double length : lengths) {
    result.push_back(length > 0 ? std::max<std::int64_t>(std::llround(length / spacing), 1) : 0);
  }
  return result;
}

AlongPlaces alongPlaces(const EdgeCurves& curves, const std::vector<std::int64_t>& counts,
                        const AlongOptions& options, int row) {
  AlongPlaces result;
  const auto all =
      static_cast<std::size_t>(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}));
  result.curve.reserve(all);
  result.arc.reserve(all);
  const std::uint64_t key = mixed(keyOf(options.seed) ^ mixed(static_cast<std::uint64_t>(row)));
  for (int curve = 0; curve < curves.count(); ++curve) {
    const std::uint64_t stream = mixed(key ^ mixed(static_cast<std::uint64_t>(curve)));
    const double phase = options.phase.value_or(uniformIn01(mixed(stream)));
    const double length = curves.length(curve);
    const std::int64_t count = counts[static_cast<std::size_t>(curve)];
    const auto number = static_cast<double>(count);
    for (std::int64_t i = 0; i < count; ++i) {
      const double random = uniformIn01(mixed(stream + 1 + static_cast<std::uint64_t>(i)));
      double place = static_cast<double>(i) + phase + options.jitter * (random - 0.5);
      if (curves.closed(curve)) {
        place = place < 0 ? place + number : place >= number ? place - number : place;
      } else {
        place = place < 0 ? -place : place > number ? 2 * number - place : place;
      }
      result.curve.push_back(curve);
      result.arc.push_back(std::clamp(place / number, 0., 1.) * length);
    }
  }
  return result;
}

}  // namespace limitsurf
