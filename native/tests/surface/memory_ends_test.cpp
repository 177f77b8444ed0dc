// SPDX-License-Identifier: Apache-2.0
//
// Arrays behind which there is no memory: nothing may be read or written there, not even by
// instructions that leave out what they would find.
#if !defined(_WIN32)
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

#include "limitsurf/surface/batch/instruction_sets.h"
#include "limitsurf/surface/surface_data.h"
#include "support/cages/meshes.h"
#include "support/cages/poles.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

/// An array that ends where a page does. The next page cannot be touched.
template <typename T>
class ArrayAtEnd {
 public:
  explicit ArrayAtEnd(std::size_t count) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t bytes = (count * sizeof(T) + page - 1) / page * page;
    size_ = bytes + page;
    void* const memory =
        mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED ||
        mprotect(static_cast<char*>(memory) + bytes, page, PROT_NONE) != 0) {
      throw std::bad_alloc();
    }
    memory_ = static_cast<char*>(memory);
    data_ = reinterpret_cast<T*>(memory_ + bytes) - count;
    std::fill(data_, data_ + count, T(-1));
  }
  ~ArrayAtEnd() { munmap(memory_, size_); }
  ArrayAtEnd(const ArrayAtEnd&) = delete;
  ArrayAtEnd& operator=(const ArrayAtEnd&) = delete;

  T* data() { return data_; }
  T& operator[](std::size_t i) { return data_[i]; }

 private:
  std::size_t size_;
  char* memory_;
  T* data_;
};

/// Random locations, on one face (so that many lie on each patch) or on all.
struct Inputs {
  Inputs(const LimitSurface& surface, std::size_t count, int face, Random& random)
      : faces(count), uv(2 * count) {
    for (std::size_t i = 0; i < count; ++i) {
      faces[i] = face >= 0 ? face : random.below(surface.faceCount());
      const double depth = std::ldexp(1., -random.below(4));
      uv[2 * i] = depth * random.uniform();
      uv[2 * i + 1] = depth * random.uniform();
    }
    at = LocationBatch(Span<std::int32_t>(faces.data(), count), Span<double>(uv.data(), 2 * count));
  }

  ArrayAtEnd<std::int32_t> faces;
  ArrayAtEnd<double> uv;
  LocationBatch at;
};

template <typename Real>
void evaluate(const LimitSurface& surface, const LocationBatch& at) {
  const std::size_t count = at.size();
  ArrayAtEnd<Real> results[7] = {ArrayAtEnd<Real>(3 * count), ArrayAtEnd<Real>(3 * count),
                                 ArrayAtEnd<Real>(3 * count), ArrayAtEnd<Real>(3 * count),
                                 ArrayAtEnd<Real>(3 * count), ArrayAtEnd<Real>(3 * count),
                                 ArrayAtEnd<Real>(3 * count)};
  const auto rows = [&](int i) ->
      typename EvaluationArrays<Real>::Rows { return {results[i].data(), count}; };
  surface.evaluate<Real>(at, Derivatives::none, {rows(0), {}, {}, {}, {}, {}, {}}, 1);
  surface.evaluate<Real>(at, Derivatives::first, {rows(0), rows(1), rows(2), {}, {}, {}, rows(6)},
                         1);
  surface.evaluate<Real>(at, Derivatives::second,
                         {rows(0), rows(1), rows(2), rows(3), rows(4), rows(5), rows(6)}, 1);
}

void evaluateAll(const LimitSurface& surface, const SurfaceData& data, std::size_t count, int face,
                 Random& random) {
  const Inputs inputs(surface, count, face, random);
  evaluate<double>(surface, inputs.at);
  evaluate<float>(surface, inputs.at);
  ArrayAtEnd<double> positions(3 * count), frames(9 * count), values(2 * count);
  surface.frames(inputs.at, {{positions.data(), count}, {frames.data(), count}}, 1);
  data.evaluate<double>(inputs.at, Derivatives::none, {{values.data(), count}}, 1);
  EXPECT_TRUE(std::isfinite(frames[9 * count - 1]) && values[2 * count - 1] != -1);
}

TEST(MemoryEnds, NothingBehindArraysIsTouched) {
  const InstructionSet before = instructionSet();
  Random random(1);
  for (const Cage& cage : {cross(), openFan(5), grid(3, 3)}) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceData data = surface.vertexData(cage.positions.leftCols(2), 1);
    for (const InstructionSet set :
         {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
      if (!isAvailable(set)) continue;
      useInstructionSet(set);
      for (const int face : {0, 3, -1}) {
        for (std::size_t count = 1; count <= 30; ++count) {
          evaluateAll(surface, data, count, face, random);
        }
        for (std::size_t count = 150; count < 1500; count += 45) {
          evaluateAll(surface, data, count, face, random);
        }
      }
    }
  }
  useInstructionSet(before);
}

}  // namespace
}  // namespace limitsurf::test
#endif
