// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace limitsurf::fuzz {

/// Reads the bytes of a fuzzer's input as numbers. After the last byte everything is 0.
///
/// No expression may read twice: compilers differ in which operand they evaluate first, and an
/// input must mean the same for all of them.
class ByteReader {
 public:
  ByteReader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool ended() const { return at_ >= size_; }
  int byte() { return ended() ? 0 : data_[at_++]; }
  /// 0 to count - 1.
  int below(int count) { return byte() % count; }
  bool flag() { return (byte() & 1) != 0; }

  /// A parameter: mostly in [0, 1], with 0, 1 and tiny values often; rarely something invalid.
  double parameter() {
    const int kind = byte();
    if (kind < 160) {
      return kind / 159.;
    }
    if (kind < 240) {
      const int mantissa = byte();
      return std::ldexp(1 + mantissa / 256., -below(80));
    }
    return kind < 248 ? 1 - std::ldexp(1., -below(54)) : anyDouble();
  }

  /// A coordinate: mostly of moderate size; rarely huge, tiny or not finite.
  double coordinate() {
    const int kind = byte();
    if (kind < 240) {
      return (kind - 120) / 32.;
    }
    if (kind >= 250) {
      return anyDouble();
    }
    const int mantissa = byte();
    return std::ldexp((mantissa - 128) / 64., byte() - 128);
  }

  /// Any bits at all.
  double anyDouble() {
    std::uint64_t bits = 0;
    for (int i = 0; i < 8; ++i) {
      bits = (bits << 8) | static_cast<std::uint64_t>(byte());
    }
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

}  // namespace limitsurf::fuzz
