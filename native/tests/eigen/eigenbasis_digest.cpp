// SPDX-License-Identifier: Apache-2.0
//
// Prints a checksum of each eigenbasis's numbers, to the last bit: the same lines on every platform
// (tools/tests/test_aarch64.py).
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

#include "limitsurf/eigen/eigenbasis.h"

// OpenSubdiv's masks need these constants of its library, which the platform may lack, and of that
// library nothing else.
const float OpenSubdiv::OPENSUBDIV_VERSION::Sdc::Crease::SHARPNESS_SMOOTH = 0;
const float OpenSubdiv::OPENSUBDIV_VERSION::Sdc::Crease::SHARPNESS_INFINITE = 10;

namespace limitsurf {
namespace {

/// FNV-1a over the bits of doubles. The two zeros count as one.
class Digest {
 public:
  void add(double value) {
    value = value == 0 ? 0 : value;
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 8; ++i) {
      hash_ = (hash_ ^ (bits >> (8 * i) & 0xff)) * 0x100000001b3u;
    }
  }
  template <typename Values>
  void addAll(const Values& values) {
    for (const double value : values) {
      add(value);
    }
  }
  unsigned long long hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

void print(const Ring& ring) {
  const char* names[] = {"interior", "boundary", "pinned", "cone", "dart"};
  const Eigenbasis basis(ring);
  Digest digest;
  for (int mode = 0; mode < basis.modeCount(); ++mode) {
    digest.add(basis.eigenvalue(mode));
    digest.addAll(basis.ringVector(mode));
    for (const int face : {0, ring.faces / 2, ring.faces - 1}) {
      const Eigenbasis::Table table = basis.table(mode, face);
      digest.addAll(table.outer);
      digest.addAll(table.grid);
    }
  }
  for (const auto& chain : basis.chains()) {
    digest.add(chain.rate);
  }
  for (const ModePair& pair : basis.pairs()) {
    digest.addAll(std::vector<double>{pair.mean, pair.forth, pair.back});
  }
  const auto& outer = basis.outerModes(0);
  digest.addAll(outer.vectors().reshaped());
  digest.addAll(outer.inverse().reshaped());
  std::printf("%s of %d: %016llx\n", names[static_cast<int>(ring.kind)], ring.faces, digest.hash());
}

}  // namespace
}  // namespace limitsurf

int main() {
  using namespace limitsurf;
  for (const RingKind kind :
       {RingKind::interior, RingKind::boundary, RingKind::pinned, RingKind::cone, RingKind::dart}) {
    for (int faces = 2; faces <= 50; ++faces) {
      print({kind, faces});
    }
    for (const int faces : {99, 100, 360}) {
      print({kind, faces});
    }
  }
}
