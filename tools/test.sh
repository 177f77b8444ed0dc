#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Sets up, builds, and runs every test, those in a real window included.
#
#   tools/test.sh [--quick | --slow] [--blender VERSION]
#   tools/test.sh --sanitize address | undefined | thread
#
# --quick     only the C++ and Python tests and the style: no Blender, no window
# --slow      also the tests that take minutes, the benchmark programs and tools, the fuzzers for a
#             minute (where Clang 19 is installed), and clang-tidy over all files
# --blender   only the Python and Blender tests, under another version of the `bpy` wheel (4.2.23 or
#             5.0.1, say) in an environment of its own
# --sanitize  only the C++ tests, and the Python module's own ones, under a sanitizer of the
#             compiler, in a build tree of its own (tools/sanitize/ says what is left out and why)
#
# The last line counts the tests. A part that is no test, or did not get as far as its tests, counts
# as one failure if it fails and not at all if it succeeds. The window tests count as one skipped
# test where they cannot be run (tools/gui_test.sh says why).
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

usage() {
  sed -n '4,20s/^# \{0,1\}//p' "$0"
  exit 2
}

quick=false slow=false blender=$DEFAULT_BLENDER sanitizer=
while (($#)); do
  case $1 in
    --quick) quick=true ;;
    --slow) slow=true ;;
    --blender) blender=${2-} && [[ $blender ]] || usage && shift ;;
    --sanitize) sanitizer=${2-} && [[ $sanitizer =~ ^(address|undefined|thread)$ ]] || usage && shift ;;
    *) usage ;;
  esac
  shift
done
$quick && $slow && usage
marked=() # the tests that pytest selects by their marks; pyproject.toml leaves the slow ones out
$slow && marked=(-m 'slow or not slow')

default=false windows=false
if [[ $blender == "$DEFAULT_BLENDER" && ! $sanitizer ]]; then
  default=true
  $quick || windows=true
fi

# What runs in the background ends with this script.
background=()
trap 'for group in "${background[@]}"; do kill -- -"$group" 2>/dev/null || true; done' EXIT

# The Blender for the window tests is fetched meanwhile.
if $windows; then
  mkdir -p "$ROOT/build"
  setsid "$ROOT/tools/gui_test.sh" --prepare >"$ROOT/build/window.log" 2>&1 </dev/null &
  background+=($!)
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

# build_cpp PRESET TREE [TARGET]
build_cpp() {
  configure "$1"
  cmake --build "build/$2" --parallel "$JOBS" ${3:+--target "$3"}
}

# run_ctest TREE OPTIONS...
run_ctest() {
  local tree=$1 selection=(-LE slow)
  shift
  $slow && selection=()
  ctest --test-dir "$tree" --output-on-failure --no-tests=error --parallel "$JOBS" \
    "${selection[@]}" "$@" --output-junit "$results/C++ tests.xml" >"$results/ctest.log" ||
    { grep -v ' Passed ' "$results/ctest.log" && return 1; }
  tail -n 5 "$results/ctest.log"
}

# Several processes at a time; what a file's tests share is mostly made once.
run_pytest() {
  local name=$1
  shift
  python -m pytest -q -n "$JOBS" --dist worksteal "${marked[@]}" \
    --junitxml "$results/$name.xml" "$@"
}

# The window tests wait for the screen most of the time: other tests run meanwhile.
start_window_tests() {
  window_start=$SECONDS
  setsid "$ROOT/tools/gui_test.sh" "${marked[@]}" >"$results/window.log" 2>&1 </dev/null &
  window_tests=$!
  background+=("$window_tests")
}

finish_window_tests() {
  local status=0
  say "Window tests"
  wait "$window_tests" || status=$?
  cat "$results/window.log"
  outcomes+=("Window tests"$'\t'"$status"$'\t'"$((SECONDS - window_start))")
}

if [[ $sanitizer ]]; then
  source tools/sanitize/sanitize.sh
  run_sanitized "$sanitizer"
else
  built=false
  target=limitsurf_tests # the benchmarks and tools take a minute more
  $slow && target=
  if $default && part "C++ build" build_cpp release cpp "$target"; then
    built=true
  fi
  $windows && start_window_tests
  $built && { part "C++ tests" run_ctest build/cpp || true; }
  part "Python tests" run_pytest "Python tests" native/python/tests tools/tests || true
  $quick || part "Blender tests" run_pytest "Blender tests" blend_tests || true
  $windows && finish_window_tests
  $default && { part "Style" tools/format.sh --check || true; }
  if $default && ! $quick; then
    part "Types and spelling" tools/types.sh || true
  fi
  $default && $slow && { part "Fuzzers" tools/fuzz.py || true; }
  $default && $slow && { part "Lint" tools/lint.sh || true; }
fi

say "Summary"
printf '%s\n' "${outcomes[@]}" | python tools/tests/summary.py "$results"
