// SPDX-License-Identifier: Apache-2.0
#pragma once

#if !defined(_WIN32)
#include <unistd.h>
#endif

namespace limitsurf {

/// Tells a process from those that were forked from it. Systems without fork() have one number.
#if defined(_WIN32)
using ProcessNumber = int;
inline ProcessNumber thisProcess() { return 0; }
#else
using ProcessNumber = pid_t;
inline ProcessNumber thisProcess() { return getpid(); }
#endif

}  // namespace limitsurf
