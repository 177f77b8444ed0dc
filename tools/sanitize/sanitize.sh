# SPDX-License-Identifier: Apache-2.0
#
# The tests under a sanitizer of the compiler: sourced by tools/test.sh --sanitize.
#
# Each sanitizer has a preset and a build tree of its own (CMakePresets.json). OpenSubdiv, TBB, Python
# and numpy are Debian's or PyPI's and are not compiled with a sanitizer. ThreadSanitizer needs
# suppressions (thread.supp) and leaves out some tests (thread.skip): the files give the reasons. It
# runs no Python tests, because Python and numpy would have to be compiled with it.

run_sanitized() {
  local preset
  case $1 in
    address) preset=asan ;;
    undefined) preset=ubsan ;;
    thread) preset=tsan ;;
  esac
  local tree=$ROOT/build/$preset
  export ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1
  export UBSAN_OPTIONS=print_stacktrace=1:suppressions=$ROOT/tools/sanitize/undefined.supp
  # The suppressions name functions of TBB: ThreadSanitizer needs a long history to know the stack of
  # the earlier one of two accesses.
  TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1:history_size=7
  export TSAN_OPTIONS=$TSAN_OPTIONS:suppressions=$ROOT/tools/sanitize/thread.supp

  local skip=()
  if [[ $1 == thread ]]; then
    skip=(-E "$(grep -v -e '^#' -e '^$' tools/sanitize/thread.skip | paste -s -d '|')")
  fi

  part "C++ build" build_sanitized "$preset" || return 0
  part "C++ tests" run_ctest "$tree" "${skip[@]}" || true
  if [[ $1 != thread ]]; then
    part "Python tests" run_sanitized_pytest "$1" "$tree" || true
  fi
}

build_sanitized() {
  configure "$1" -D Python_EXECUTABLE="$VENV/bin/python" \
    -D pybind11_DIR="$(python -m pybind11 --cmakedir)"
  cmake --build "build/$1" --parallel "$JOBS"
}

# The package limitsurf with the sanitized module in it stands before the environment's own. Python
# itself is not linked with the sanitizer's library, which has to be loaded first.
run_sanitized_pytest() {
  local package=$2/package preload=
  rm -rf "$package"
  cmake --install "$2" --component python --prefix "$package" >/dev/null
  cp native/python/limitsurf/{*.py,*.pyi,py.typed} "$package/limitsurf"
  if [[ $1 == address ]]; then
    preload="$(g++ -print-file-name=libasan.so) $(g++ -print-file-name=libstdc++.so)"
    export ASAN_OPTIONS=detect_leaks=0 # Python ends without freeing all of its own objects
  fi
  LD_PRELOAD=$preload PYTHONPATH=$package run_pytest "Python tests" native/python/tests
}
