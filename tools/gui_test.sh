#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Tests in a real Blender with a window: real clicks, keys and wheel, on a screen that nobody sees.
#
#   tools/gui_test.sh [--prepare | --bench | OPTIONS OF PYTEST]
#
# --prepare  only makes the Blender that they run in, where it is missing
# --bench    no tests, but how quickly the window answers (tools/bench_window.py)
#
# That is Debian 13's, in a folder of its own (tools/gui/chroot.sh), with the extension installed
# from its zip as users do it. Takes root; ends with 77 where the tests cannot be run, having said
# why. Screenshots and Blender's output come to build/window/out.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
source "$ROOT/tools/gui/chroot.sh"
cd "$ROOT"

CANNOT_RUN=77
HEADERS=$CHROOT/usr/include/python3.13
PACKAGES=build/window/packages
RESULTS=build/test-results

# The wheels are compiled again when the module's sources have changed, the zip is always new.
build_extension() {
  local options=() hash
  hash=$(module_hash)
  if [[ $(cat "$PACKAGES/module" 2>/dev/null) != "$hash" ]]; then
    say "The extension, with a native module for this Blender's Python"
    rm -rf "$PACKAGES"
    options=(--build-wheel --python-headers "$HEADERS")
  fi
  python tools/build_extension.py "${options[@]}" --wheels "$PACKAGES" --output "$CHROOT_OUT"
  echo "$hash" >"$PACKAGES/module"
}

obstacle=$(chroot_obstacle)
if [[ $obstacle ]]; then
  say "NO WINDOW TESTS HERE: $obstacle"
  exit $CANNOT_RUN
fi

mkdir -p build/window "$RESULTS"
exec 8>build/window/lock
flock 8 # the folder serves one at a time
make_chroot
if [[ ${1-} == --prepare ]]; then
  exit
fi
set_up
rm -rf "$CHROOT_OUT"/*
build_extension
if [[ ${1-} == --bench ]]; then
  in_chroot python3 -B /project/tools/bench_window.py
  exit
fi
status=0
in_chroot python3 -B -m pytest -q -p no:cacheprovider --confcutdir /project/blend_tests/gui \
  --basetemp /tmp/window-tests --junitxml /out/results.xml "$@" /project/blend_tests/gui ||
  status=$?
cp "$CHROOT_OUT/results.xml" "$RESULTS/Window tests.xml"
exit $status
