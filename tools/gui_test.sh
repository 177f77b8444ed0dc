#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Tests in a real Blender with a window: real clicks, keys and wheel, on a screen that nobody sees.
#
#   tools/gui_test.sh [--prepare] [PYTEST OPTIONS]
#
# --prepare  only sets up what the tests need
#
# The Blender is Debian 13's, in a folder of its own (tools/gui/chroot.sh), with the extension
# installed from its zip as users do it. Takes root; ends with 3 where that is not to be had, having
# said why. Screenshots come to build/window/out.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
source "$ROOT/tools/gui/chroot.sh"
set_up
cd "$ROOT"

CANNOT_RUN=3
HEADERS=$CHROOT/usr/include/python3.13
PACKAGES=build/window/packages

obstacle=$(chroot_obstacle)
if [[ $obstacle ]]; then
  say "WINDOW TESTS SKIPPED: $obstacle"
  exit $CANNOT_RUN
fi

# The wheels are compiled again when the module's sources have changed, the zip is always new.
build_extension() {
  local options=() hash
  hash=$(module_hash)
  if [[ $(cat "$PACKAGES/module" 2>/dev/null) != "$hash" ]]; then
    say "The extension, with a native module for Python 3.13"
    rm -rf "$PACKAGES"
    options=(--build-wheel --python-headers "$HEADERS")
  fi
  python tools/build_extension.py "${options[@]}" --wheels "$PACKAGES" --output "$CHROOT_OUT"
  echo "$hash" >"$PACKAGES/module"
}

mkdir -p build/window
exec 8>build/window/lock
flock 8 # the folder serves one at a time
make_chroot
build_extension
if [[ ${1-} == --prepare ]]; then
  exit
fi
in_chroot python3 -B -m pytest -q --confcutdir /project/blend_tests/gui -p no:cacheprovider \
  --basetemp /tmp/window-tests --junitxml /out/results.xml /project/blend_tests/gui "$@"
