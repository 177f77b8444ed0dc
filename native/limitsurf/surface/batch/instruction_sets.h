// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace limitsurf
