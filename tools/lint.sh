#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Looks for defects in the C++ sources by clang-tidy; .clang-tidy names the checks.
#
#   tools/lint.sh [FILE.cpp...]
#
# Without files it takes all of the library and of the Python module, which takes minutes:
# tools/test.sh --slow runs it.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
set_up
cd "$ROOT"

# clang reads no header that another compiler has precompiled, and clang-tidy needs the options of
# each file, which a unity build does not state.
configure release -B build/lint -D CMAKE_DISABLE_PRECOMPILE_HEADERS=ON -D CMAKE_UNITY_BUILD=OFF \
  -D LIMITSURF_BUILD_PYTHON=ON -D Python_EXECUTABLE="$VENV/bin/python" \
  -D pybind11_DIR="$(python -m pybind11 --cmakedir)"
files=("$@")
if ((${#files[@]} == 0)); then
  mapfile -t files < <(find native/limitsurf native/python/src -name '*.cpp')
fi
printf '%s\0' "${files[@]}" |
  xargs -0 -n 1 -P "$JOBS" clang-tidy -p build/lint --quiet 2> >(grep -v 'warnings\? generated' >&2)
