// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_raster.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "limitsurf/interruption_point.h"
#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"
#include "limitsurf/uv/nearest_chords.h"

namespace limitsurf {
namespace {

/// An image is rasterized in bands of about this many texels: the slots of a band fit into the
/// cache, and there are enough bands for all threads.
constexpr int kTexelsPerBand = 1 << 17;

/// Where pieces lie on each other in more layers than this, bands are smaller, so that the progress
/// is reported often enough. The boxes of pieces make two or three layers of any map.
constexpr double kFewLayers = 8;
/// Bands are not so small that the lists of their pieces have more entries than this together,
/// besides one for each piece.
constexpr double kMostListed = 1 << 25;

/// The number of texels of all layers between two reports of the progress, and the limits on the
/// number of bands between them.
constexpr double kTexelsPerReport = 1 << 22;
constexpr double kFewestBandsPerReport = 4, kMostBandsPerReport = 16;

/// The number of texels with a margin, relative to those without, that is seldom exceeded. Chosen.
constexpr double kShareWithMargin = 1.5;

template <typename Number>
void checkRange(const char* name, Number value, Number least, Number most) {
  if (!(value >= least && value <= most)) {
    std::ostringstream message;
    message << name << " is ";
    if constexpr (std::is_integral_v<Number>) {
      message << value;
    } else {
      message << numberText(value);
    }
    message << "; it must be " << least << " to " << most;
    throw std::invalid_argument(message.str());
  }
}

/// The bands of rows of an image, and for each the pieces of the map that may have a part in it.
class Bands {
 public:
  Bands(const UvPatches& map, const RasterOptions& options)
      : width_(options.width),
        height_(options.height),
        frame_{{static_cast<double>(options.tile_x), static_cast<double>(options.tile_y)},
               {static_cast<double>(width_), static_cast<double>(height_)},
               -0.5},
        tolerance_(map.tolerance() * frame_.scale) {
    chooseRows(map, options.margin);
    std::vector<std::size_t>& begins = begins_;
    begins.assign(count() + 2, 0);
    const auto forEachBand = [&](const auto& body) {
      for (std::size_t piece = 0; piece < map.pieces().size(); ++piece) {
        const Lattice inside = texelsOf(map.pieces()[piece]);
        if (!inside.empty()) {
          for (int band = inside.y0 / rows_; band <= inside.y1 / rows_; ++band) {
            body(static_cast<int>(piece), band);
          }
        }
      }
    };
    forEachBand([&](int, int band) { ++begins[band + 2]; });
    for (std::size_t band = 2; band < begins.size(); ++band) {
      begins[band] += begins[band - 1];
    }
    pieces_.resize(begins.back());
    forEachBand([&](int piece, int band) { pieces_[begins[band + 1]++] = piece; });
  }

  int rows() const { return rows_; }
  Lattice image() const { return {0, 0, width_ - 1, height_ - 1}; }
  std::size_t count() const { return static_cast<std::size_t>((height_ + rows_ - 1) / rows_); }
  Lattice lattice(std::size_t band) const {
    const int first = static_cast<int>(band) * rows_;
    return {0, first, width_ - 1, std::min(first + rows_, height_) - 1};
  }
  Span<int> pieces(std::size_t band) const {
    return Span<int>(pieces_).subspan(begins_[band], begins_[band + 1] - begins_[band]);
  }
  std::size_t countPerReport() const { return per_report_; }
  /// About the number of texels that the map covers, seldom too small. What is reserved too much
  /// takes addresses, but no memory.
  std::size_t mostTexels() const { return most_texels_; }
  const PlaneFrame& frame() const { return frame_; }
  const Point2& tolerance() const { return tolerance_; }

 private:
  /// The texels in the box of a piece.
  Lattice texelsOf(const UvPiece& piece) const {
    return image().within(frame_.at(piece.box).grown(tolerance_));
  }

  void chooseRows(const UvPatches& map, double margin) {
    double texels = 0, rows = 0;  // those of all pieces, added up
    for (const UvPiece& piece : map.pieces()) {
      const Lattice inside = texelsOf(piece);
      if (!inside.empty()) {
        const double high = inside.y1 - inside.y0 + 1;
        rows += high;
        texels += high * (inside.x1 - inside.x0 + 1);
      }
    }
    const double layers = texels / width_ / height_;
    most_texels_ = static_cast<std::size_t>(
        std::min(1., layers * (margin > 0 ? kShareWithMargin : 1)) * width_ * height_);
    const int whole_rows = kTexelsPerBand / width_;
    const double wanted = whole_rows / std::max(1., layers / kFewLayers);
    rows_ = static_cast<int>(
        std::clamp(std::max(wanted, rows / kMostListed), 1., static_cast<double>(height_)));
    per_report_ =
        static_cast<std::size_t>(std::clamp(kTexelsPerReport / (layers * width_ * rows_ + 1),
                                            kFewestBandsPerReport, kMostBandsPerReport));
  }

  int width_, height_, rows_ = 1;
  std::size_t per_report_ = 1, most_texels_ = 0;
  PlaneFrame frame_;
  Point2 tolerance_;
  std::vector<std::size_t> begins_;  // where each band begins, and the end of the last
  std::vector<int> pieces_;          // band after band
};

/// A texel of the result.
struct Texel {
  double u, v;
  std::int32_t x, y, face;
  std::uint8_t inside, overlap, flipped;
};
/// What is needed to rasterize a band.
struct BandWork {
  std::vector<LatticeFinds::Slot> slots;
  std::vector<NearestChords::Nearest> nearest;  // if there is a margin
};

/// Hands the memory of bands that are done to the next ones, so that it is not made anew.
class BandWorks {
 public:
  BandWork take() {
    const std::lock_guard<std::mutex> hold(mutex_);
    if (free_.empty()) {
      return {};
    }
    BandWork work = std::move(free_.back());
    free_.pop_back();
    return work;
  }
  void giveBack(BandWork&& work) {
    const std::lock_guard<std::mutex> hold(mutex_);
    free_.push_back(std::move(work));
  }

 private:
  std::mutex mutex_;
  std::vector<BandWork> free_;
};

Texel texelOf(int x, int y, const LatticeFinds::Slot& slot) {
  return {slot.u, slot.v, x, y, slot.face, true, slot.overlap, slot.flipped};
}
Texel texelOf(int x, int y, const NearestChords::Foot& foot) {
  return {foot.at.u, foot.at.v, x, y, foot.at.face, false, false, foot.flipped};
}

/// Finds the texels of a band that the map covers, and those of the margin if there are chords.
void findTexels(const LatticeFinds& finds, const Lattice& lattice, const BorderChords* chords,
                std::size_t band, std::vector<NearestChords::Nearest>& memory,
                std::vector<Texel>& out) {
  std::optional<NearestChords> nearest;
  if (chords && !chords->inBand(band).empty()) {
    nearest.emplace(*chords, lattice, memory);
    InterruptionStride stride;
    for (const int chord : chords->inBand(band)) {
      stride.step();
      nearest->add(chords->chord(chord), [&](int x, int y) { return finds.at(x, y).face < 0; });
    }
  }
  out.clear();
  out.reserve(static_cast<std::size_t>(lattice.x1 - lattice.x0 + 1) *
              static_cast<std::size_t>(lattice.y1 - lattice.y0 + 1));
  for (int y = lattice.y0; y <= lattice.y1; ++y) {
    for (int x = lattice.x0; x <= lattice.x1; ++x) {
      NearestChords::Foot foot;
      if (finds.at(x, y).face >= 0) {
        out.push_back(texelOf(x, y, finds.at(x, y)));
      } else if (nearest && nearest->foot(x, y, foot)) {
        out.push_back(texelOf(x, y, foot));
      }
    }
  }
}

/// Calls use() with each array of the texels.
template <typename Use>
void forEachArray(Texels& texels, const Use& use) {
  use(texels.x);
  use(texels.y);
  use(texels.face);
  use(texels.uv);
  use(texels.inside);
  use(texels.overlap);
  use(texels.flipped);
}

/// Appends the texels of `count` bands, one band after the other.
void append(const std::vector<std::vector<Texel>>& bands, std::size_t count, int threads,
            Texels& all) {
  std::vector<std::size_t> begins;
  std::size_t size = all.size();
  for (std::size_t band = 0; band < count; ++band) {
    begins.push_back(size);
    size += bands[band].size();
  }
  forEachArray(all, [&](auto& array) { array.resize(size); });
  parallelFor(count, 1, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t band = first; band < last; ++band) {
      std::size_t row = begins[band];
      for (const Texel& texel : bands[band]) {
        all.x[row] = texel.x;
        all.y[row] = texel.y;
        all.face[row] = texel.face;
        all.uv[row] = {texel.u, texel.v};
        all.inside[row] = texel.inside;
        all.overlap[row] = texel.overlap;
        all.flipped[row] = texel.flipped;
        ++row;
      }
    }
  });
}

}  // namespace

void LatticeFinds::add(const Find& find) {
  const std::int64_t point = (find.y - lattice_.y0) * width_ + (find.x - lattice_.x0);
  Slot& slot = slots_[static_cast<std::size_t>(point)];
  if (find.on_border && find.wedge_count > 0) {
    border_finds_.push_back({point, find.wedge_count, {find.wedges[0], find.wedges[1]}});
  } else if (!find.on_border) {
    slot.overlap |= slot.within_cell;
    slot.within_cell = true;
  }
  const Location at = on_.at(find.s, find.t);
  if (isBefore(at, slot)) {
    slot.face = at.face;
    slot.u = at.u;
    slot.v = at.v;
    slot.flipped = find.flipped;
  }
}

bool LatticeFinds::wants(int x, int y, const UvCell& cell) const {
  const FaceRectangle on = on_.part(cell.low[0], cell.low[1], cell.size[0], cell.size[1]);
  const double s = on.us < 0 || on.vs < 0 ? 1 : 0, t = on.ut < 0 || on.vt < 0 ? 1 : 0;
  return isBefore(on.at(s, t), at(x, y));
}

bool LatticeFinds::isBefore(const Location& at, const Slot& slot) {
  return slot.face < 0 || at.face < slot.face ||
         (at.face == slot.face && (at.v < slot.v || (at.v == slot.v && at.u < slot.u)));
}

void LatticeFinds::finish() {
  std::stable_sort(border_finds_.begin(), border_finds_.end(),
                   [](const BorderFind& a, const BorderFind& b) { return a.point < b.point; });
  const BorderFind* const end = border_finds_.data() + border_finds_.size();
  WedgeOverlap overlap;
  for (const BorderFind* first = border_finds_.data(); first != end;) {
    const BorderFind* last = first + 1;
    while (last != end && last->point == first->point) {
      ++last;
    }
    Slot& slot = slots_[static_cast<std::size_t>(first->point)];
    slot.overlap |= slot.within_cell || overlap.of(first, last);
    first = last;
  }
  border_finds_.clear();
}

void checkOptions(const RasterOptions& options) {
  checkRange("width", options.width, 1, RasterOptions::kMostTexels);
  checkRange("height", options.height, 1, RasterOptions::kMostTexels);
  checkRange("tile's column", options.tile_x, -RasterOptions::kMostTile, RasterOptions::kMostTile);
  checkRange("tile's row", options.tile_y, -RasterOptions::kMostTile, RasterOptions::kMostTile);
  checkRange<double>("margin", options.margin, 0, RasterOptions::kMostMargin);
}

Texels rasterize(const UvPatches& map, const std::function<const UvBorders&()>& borders,
                 const RasterOptions& options, int threads, const Progress& progress) {
  const Bands bands(map, options);
  std::optional<BorderChords> chords;
  if (options.margin > 0) {
    chords.emplace(borders(), bands.frame(), bands.image(), bands.rows(), options.margin);
  }
  Texels all;
  forEachArray(all, [&](auto& array) { array.reserve(bands.mostTexels()); });
  BandWorks works;
  std::vector<std::vector<Texel>> found(std::min(bands.countPerReport(), bands.count()));
  for (std::size_t begin = 0; begin < bands.count(); begin += found.size()) {
    const std::size_t count = std::min(found.size(), bands.count() - begin);
    parallelFor(count, 1, threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const std::size_t band = begin + i;
        const Lattice lattice = bands.lattice(band);
        BandWork work = works.take();
        LatticeFinds finds(lattice, work.slots);
        LatticeInverse inverse(lattice, bands.tolerance(), finds);
        InterruptionStride stride;
        for (const int piece : bands.pieces(band)) {
          stride.step();
          map.invert(map.pieces()[static_cast<std::size_t>(piece)], bands.frame(), inverse, finds);
        }
        finds.finish();
        findTexels(finds, lattice, chords ? &*chords : nullptr, band, work.nearest, found[i]);
        works.giveBack(std::move(work));
      }
    });
    append(found, count, threads, all);
    if (progress) {
      progress(static_cast<double>(begin + count) / static_cast<double>(bands.count()));
    }
  }
  return all;
}

}  // namespace limitsurf
