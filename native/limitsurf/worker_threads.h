// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// Whether oneTBB's threads can be used. They do not exist in a process that was forked from one
/// that had used them, and what they were doing then will never end: such a process has to do all
/// work on the calling thread. Asking counts as using them.
bool workerThreadsExist();

}  // namespace limitsurf
