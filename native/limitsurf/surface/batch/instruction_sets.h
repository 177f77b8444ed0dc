// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whether code is compiled for AVX2 and AVX-512, too.
/// GCC for Windows does not align vectors of more than 16 bytes on the stack.
#if defined(__GNUC__) && defined(__x86_64__) && !(defined(_WIN32) && !defined(__clang__))
#define LIMITSURF_X86_SETS 1
#else
#define LIMITSURF_X86_SETS 0
#endif

namespace limitsurf {

/// The instruction sets for which batches of locations are compiled. All of them give the same
/// bits: none uses fused multiply-adds, and all do the same operations in the same order.
enum class InstructionSet {
  baseline,  ///< what every processor of the architecture has
  avx2,
  avx512,
};

/// Whether this processor has the instruction set, and the compiler knew it.
bool isAvailable(InstructionSet set);

/// The one that is used: the last available one, unless useInstructionSet() chose another.
InstructionSet instructionSet();

/// For tests and benchmarks: from now on this one is used, by all threads. It must be available.
void useInstructionSet(InstructionSet set);

/// Of kernels that are compiled for each instruction set, those for the set in use.
template <typename Kernels>
const Kernels& inUse(const Kernels* baseline, const Kernels* avx2, const Kernels* avx512) {
  switch (instructionSet()) {
    case InstructionSet::avx512:
      return *avx512;
    case InstructionSet::avx2:
      return *avx2;
    case InstructionSet::baseline:
      break;
  }
  return *baseline;
}

}  // namespace limitsurf
