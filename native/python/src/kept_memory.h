// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace limitsurf::python {

constexpr std::size_t kLeastKept = std::size_t{1} << 17;

/// The memory of arrays. Freed blocks serve later arrays of about the same size: memory that comes
/// from the system page by page takes several times as long as the evaluation of what is written to
/// it. Blocks of kLeastKept bytes to 64 MiB are kept, and 64 MiB of them in all. Any thread may
/// call these functions. They return null where there is no memory; as with malloc(), it has no
/// values.
void* takeMemory(std::size_t bytes) noexcept;
void returnMemory(void* memory) noexcept;
/// As realloc() does.
void* resizeMemory(void* memory, std::size_t bytes) noexcept;

}  // namespace limitsurf::python
