#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Sets up, builds, and runs every test, those in a real window included.
#
#   tools/test.sh [--slow] [--blender VERSION]
#
# --slow     also the tests that take minutes
# --blender  only the Python and Blender tests, under another version of the `bpy` wheel (4.2.23 or
#            5.0.1, say) in an environment of its own
#
# The last line counts the tests. A part that is no test, or did not get as far as its tests, counts
# as one failure if it fails and not at all if it succeeds. The window tests count as one skipped
# test where they cannot be run (tools/gui_test.sh says why).
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

usage() {
  sed -n '4,14s/^# \{0,1\}//p' "$0"
  exit 2
}

slow=false blender=$DEFAULT_BLENDER
while (($#)); do
  case $1 in
    --slow) slow=true ;;
    --blender) blender=${2-} && [[ $blender ]] || usage && shift ;;
    *) usage ;;
  esac
  shift
done

# The Blender for the window tests is fetched meanwhile.
if [[ $blender == "$DEFAULT_BLENDER" ]]; then
  mkdir -p "$ROOT/build"
  setsid "$ROOT/tools/gui_test.sh" --prepare >"$ROOT/build/window.log" 2>&1 </dev/null &
  fetching=$!
  trap 'kill -- -$fetching 2>/dev/null || true' EXIT
fi

set_up "$blender"
cd "$ROOT"
results=$ROOT/build/test-results
rm -rf "$results"
mkdir -p "$results"

# part NAME COMMAND...: runs it and remembers how it ended; 77 means that it cannot be run here.
outcomes=()
part() {
  local name=$1 status=0 start=$SECONDS
  shift
  say "$name"
  "$@" || status=$?
  outcomes+=("$name"$'\t'"$status"$'\t'"$((SECONDS - start))")
  return "$status"
}

build_cpp() {
  cmake -S . -B build/cpp -G Ninja -D CMAKE_BUILD_TYPE=Release \
    -D LIMITSURF_BUILD_TESTS=ON -D LIMITSURF_BUILD_TOOLS=ON -D LIMITSURF_BUILD_BENCH=ON \
    >"$results/configure.log" ||
    { cat "$results/configure.log" && return 1; }
  cmake --build build/cpp --parallel "$JOBS"
}

run_ctest() {
  local selection=(-LE slow)
  $slow && selection=()
  ctest --test-dir build/cpp --output-on-failure --no-tests=error --parallel "$JOBS" \
    "${selection[@]}" --output-junit "$results/C++ tests.xml" >"$results/ctest.log" ||
    { grep -v ' Passed ' "$results/ctest.log" && return 1; }
  tail -n 5 "$results/ctest.log"
}

run_pytest() {
  local name=$1 selection=()
  shift
  $slow && selection=(-m 'slow or not slow')
  python -m pytest -q "${selection[@]}" --junitxml "$results/$name.xml" "$@"
}

if [[ $blender == "$DEFAULT_BLENDER" ]]; then
  if part "C++ build" build_cpp; then
    part "C++ tests" run_ctest || true
  fi
fi
part "Python tests" run_pytest "Python tests" native/python/tests tools/tests || true
part "Blender tests" run_pytest "Blender tests" blend_tests || true
if [[ $blender == "$DEFAULT_BLENDER" ]]; then
  part "Window tests" tools/gui_test.sh || true
  part "Style" tools/format.sh --check || true
fi

say "Summary"
printf '%s\n' "${outcomes[@]}" | python tools/tests/summary.py "$results"
