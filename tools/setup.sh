#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Sets up what this checkout needs on Debian 12: the libraries (apt), the Python environment .venv
# with Blender as a module (pip), and the limitsurf module inside it.
#
#   tools/setup.sh [--blender VERSION]
#
# Does only what is missing, so that running it again takes a second. VERSION is a version of the
# `bpy` wheel, 4.5.15 unless given; any other has an environment of its own, .venv-VERSION.
#
# Other scripts source it and call set_up; afterwards $VENV is the environment, and its programs
# (python, cmake, ninja, ...) come first on PATH.

DEFAULT_BLENDER=4.5.15
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
JOBS=${LIMITSURF_JOBS:-$(nproc)}

APT_PACKAGES=(
  g++ libosd-dev libtbb-dev libeigen3-dev                # the library
  libgtest-dev libbenchmark-dev libboost-dev             # its tests and benchmarks
  libembree-dev                                          # a peer in the benchmarks
  libx11-6 libxrender1 libxfixes3 libxi6 libxkbcommon0   # what Blender as a module loads
  libsm6 libgl1 libegl1
)

say() { printf '== %s\n' "$*"; }

fail() {
  printf '\nError: %s\n' "$1" >&2
  shift
  (($#)) && printf '       %s\n' "$@" >&2
  exit 1
}

# Blender as a module exists for one version of Python: 3.11 for Blender 4.2 to 5.0, 3.13 for later
# ones.
find_python() {
  local blender=$1 wanted=3.11 major minor candidate
  IFS=. read -r major minor _ <<<"$blender"
  if ((major > 5 || (major == 5 && minor > 0))); then
    wanted=3.13
  fi
  for candidate in "python$wanted" python3 "/usr/bin/python$wanted"; do
    if "$candidate" -c "import sys; sys.exit('%d.%d' % sys.version_info[:2] != '$wanted')" \
      2>/dev/null; then
      PYTHON=$("$candidate" -c 'import sys; print(sys._base_executable)') # no virtual environment's
      return
    fi
  done
  fail "Python $wanted is needed (Blender $blender as a module exists for no other): none found." \
    "Debian 12 has 3.11: apt-get install python3. Otherwise put a python$wanted on PATH."
}

install_apt_packages() {
  if ! command -v dpkg-query >/dev/null; then
    say "No dpkg here: expecting the equivalents of ${APT_PACKAGES[*]} to be installed"
    return
  fi
  local wanted=("${APT_PACKAGES[@]}") missing=() package
  if [[ $("$PYTHON" -c 'import sys; print(sys.base_prefix)') == /usr ]]; then
    wanted+=(python3-dev python3-venv)
  fi
  for package in "${wanted[@]}"; do
    [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
      missing+=("$package")
  done
  ((${#missing[@]})) || return 0

  local as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null && sudo -v ||
      fail "These Debian packages are missing, and adding them takes root or sudo:" \
        "${missing[*]}" "Have them installed with:" \
        "apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  say "Debian packages: ${missing[*]}"
  local log
  log=$(mktemp)
  # Some unrelated source may fail to update: what counts is whether the packages can be installed.
  "${as_root[@]}" apt-get -o DPkg::Lock::Timeout=300 update >"$log" 2>&1 </dev/null || true
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 \
    install -y --no-install-recommends "${missing[@]}" >>"$log" 2>&1 </dev/null; then
    tail -n 40 "$log" >&2
    fail "apt-get did not install: ${missing[*]}" "(its whole output: $log)"
  fi
  rm -f "$log"
}

# The environment is made for one place and one Python; what it holds is written down in
# tools/requirements.txt.
make_environment() {
  local blender=$1 home contents
  home="$ROOT $("$PYTHON" -c 'import sys; print(sys.version, sys.base_prefix)' | tr '\n' ' ')"
  contents="bpy $blender $(sha256sum <"$ROOT/tools/requirements.txt")"
  local stamp=$VENV/.limit-surface-setup
  if [[ $(cat "$stamp" 2>/dev/null) == "$home"$'\n'"$contents" ]]; then
    return
  fi
  if [[ $(head -n 1 "$stamp" 2>/dev/null) != "$home" ]]; then
    rm -rf "$VENV"
    "$PYTHON" -m venv "$VENV" || fail "$PYTHON could not make the environment $VENV."
  fi
  say "Python packages into ${VENV#"$ROOT"/} (Blender $blender is 350 MB)"
  "$VENV/bin/python" -m pip install -qq --disable-pip-version-check \
    -r "$ROOT/tools/requirements.txt" "bpy==$blender" ||
    fail "pip could not install tools/requirements.txt and bpy $blender."
  printf '%s\n%s\n' "$home" "$contents" >"$stamp"
}

# Sources of the Python module, as one hash: it is rebuilt when one of them changed.
module_hash() {
  (cd "$ROOT" && find CMakeLists.txt CMakePresets.json pyproject.toml native/CMakeLists.txt \
    native/cmake native/limitsurf native/python/CMakeLists.txt native/python/src \
    native/python/limitsurf -type f ! -path '*/__pycache__/*' -print0 |
    LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum)
}

# configure PRESET OPTIONS...: the build tree that CMakePresets.json describes under this name.
configure() {
  local log
  log=$(mktemp)
  (cd "$ROOT" && cmake --preset "$@") >"$log" 2>&1 || {
    tail -n 40 "$log" >&2
    fail "CMake could not configure the preset $1." "(Its whole output: $log)"
  }
  rm -f "$log"
}

# The library is compiled in the C++ tests' build tree, and the Python module links it from there.
install_module() {
  local stamp=$VENV/.limit-surface-module hash
  hash=$(module_hash) || fail "The sources of the Python module are incomplete."
  if [[ $(cat "$stamp" 2>/dev/null) == "$hash" ]]; then
    return
  fi
  say "The library limitsurf (some minutes the first time)"
  configure release
  cmake --build "$ROOT/build/cpp" --target limitsurf --parallel "$JOBS" ||
    fail "The library could not be compiled."
  say "The Python module limitsurf"
  CMAKE_BUILD_PARALLEL_LEVEL=$JOBS "$VENV/bin/python" -m pip install -qq \
    --disable-pip-version-check --no-build-isolation --no-deps --force-reinstall \
    --config-settings="cmake.define.LIMITSURF_PREBUILT=$ROOT/build/cpp/native" "$ROOT" ||
    fail "The Python module could not be built."
  echo "$hash" >"$stamp"
}

set_up() {
  local blender=${1:-$DEFAULT_BLENDER}
  VENV=$ROOT/.venv
  [[ $blender == "$DEFAULT_BLENDER" ]] || VENV=$ROOT/.venv-$blender
  find_python "$blender"
  mkdir -p "$ROOT/build"
  (
    flock 9 # two scripts at once would spoil each other's environment
    install_apt_packages
    make_environment "$blender"
    PATH=$VENV/bin:$PATH install_module
  ) 9>"$ROOT/build/setup.lock" || exit
  export PATH=$VENV/bin:$PATH
}

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then
  set -euo pipefail
  case ${1-} in
    '') set_up ;;
    --blender) set_up "${2:?--blender needs a version, such as 5.0.1}" ;;
    *)
      sed -n '4,11s/^# \{0,1\}//p' "$0"
      exit 2
      ;;
  esac
  say "Ready: ${VENV#"$ROOT"/}"
fi
