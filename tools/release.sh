#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Makes a release in dist/VERSION: a wheel for each Python of Blender 4.2 to 5.2, the extension with
# both, the source package, the pages of the API, notes and checksums. Each package is then tried in
# a fresh environment, and the extension in every Blender that tools/setup.sh has set up here.
#
#   tools/release.sh [--trial] [--sources FOLDER] [--python PYTHON]
#
# The wheels are for every Linux with glibc 2.28 or later, as Blender itself is: Zig compiles them, and
# is installed from PyPI where it is missing.
#
# --trial    makes one of uncommitted changes, of a version that the changelog calls unreleased, and
#            while pyproject.toml has no address of the project; its notes say that it is none
# --sources  takes OpenSubdiv's and oneTBB's sources from the folders opensubdiv and tbb in FOLDER,
#            instead of fetching them
# --python   the Python of Blender 5.1 and later, with its headers; python3.13 unless given
#
# Nothing is uploaded, and no tag is set.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

usage() {
  sed -n '4,21s/^# \{0,1\}//p' "$0"
  exit 2
}

ZIG=ziglang==0.17.1

trial=false sources=() other_python=python3.13
while (($#)); do
  case $1 in
    --trial) trial=true ;;
    --sources) sources=(--sources "$(realpath "${2:?}")") && shift ;;
    --python) other_python=${2:?} && shift ;;
    *) usage ;;
  esac
  shift
done

cd "$ROOT"
version=$(sed -nE 's/^project\(limitsurf VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)
heading=$(grep -m 1 '^## ' CHANGELOG.md)
release=$ROOT/dist/$version

# What stands against a release.
objections=()
[[ -z $(git status --porcelain) ]] || objections+=("There are uncommitted changes.")
[[ $heading == "## $version" || $heading == "## $version ("[0-9]* ]] ||
  objections+=("CHANGELOG.md begins with \"$heading\", not with \"## $version (DATE)\".")
! git rev-parse -q --verify "refs/tags/v$version" >/dev/null ||
  [[ $(git rev-parse "v$version^{commit}") == $(git rev-parse HEAD) ]] ||
  objections+=("The tag v$version is at another commit.")
! grep -q '//example\.org' pyproject.toml ||
  objections+=("pyproject.toml has no address of the project: it says example.org.")
grep -q '^website = ' addon/limit_surface/blender_manifest.toml ||
  objections+=("blender_manifest.toml has no website: it is the address of the project.")
if ((${#objections[@]})) && ! $trial; then
  fail "This is not ready to be released." "${objections[@]}"
fi

other_headers=$("$other_python" -c 'import sysconfig; print(sysconfig.get_paths()["include"])') ||
  fail "$other_python does not run: it is needed for the wheel of Blender 5.1 and later." \
    "Name another one by --python."
[[ -e $other_headers/patchlevel.h ]] ||
  fail "$other_python has no headers in $other_headers."

set_up
python -c 'import ziglang' 2>/dev/null || python -m pip install -q "$ZIG"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
rm -rf "$release"
mkdir -p "$release"

say "Wheels and extension"
python tools/build_extension.py --build-wheel --bundled --glibc 2.28 "${sources[@]}" \
  --python-headers "$other_headers" --wheels "$release" --output "$release"
say "Source package"
python -m build --sdist --no-isolation --outdir "$release" . >"$scratch/sdist.log" 2>&1 ||
  fail "The source package could not be made." "$(tail -n 20 "$scratch/sdist.log")"
say "Pages of the API"
python tools/api_pages.py --output "$scratch/limitsurf-$version-api"
tar -C "$scratch" -czf "$release/limitsurf-$version-api.tar.gz" "limitsurf-$version-api"

# try_package PYTHON PACKAGE OPTIONS...: in an environment that holds nothing but numpy. All
# libraries that wheels could find in the system are named by the module itself if it needs them
# (blend_tests/tools/test_bundled.py).
try_package() {
  local python=$1 package=$2 environment
  shift 2
  environment=$(mktemp -d "$scratch/environment.XXXX")
  say "Trying $(basename "$package") with $("$python" --version)"
  "$python" -m venv "$environment"
  "$environment/bin/python" -m pip install -q --disable-pip-version-check "$@" "$package"
  (cd "$environment" && bin/python - "$version") <<'PYTHON'
import sys

import limitsurf
import numpy as np

assert limitsurf.__version__ == sys.argv[1], limitsurf.__version__
assert limitsurf.__file__.startswith(sys.prefix), limitsurf.__file__
corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
surface = limitsurf.LimitSurface(limitsurf.ControlMesh.from_faces(corners, [[0, 1, 2, 3]]))
corner = surface.evaluate([0], [[0, 0]]).position[0]
assert np.abs(corner - [1 / 6, 1 / 6, 0]).max() < 1e-15, corner
assert len(surface.scatter_blue_noise(count=1000, seed=1, threads=2)) == 1000
print("limitsurf", limitsurf.__version__, "with numpy", np.__version__)
PYTHON
}

own_python=$(python -c 'import sys; print(sys._base_executable)')
try_package "$own_python" "$(echo "$release"/limitsurf-*-cp311-*.whl)"
try_package "$other_python" "$(echo "$release"/limitsurf-*-cp313-*.whl)"
try_package "$own_python" "$release/limitsurf-$version.tar.gz"

tried=()
for environment in "$ROOT"/.venv "$ROOT"/.venv-*; do
  [[ -x $environment/bin/python ]] || continue
  blender=$("$environment/bin/python" -c \
    'from importlib.metadata import version; print(version("bpy"))' 2>/dev/null) || continue
  say "Trying the extension in Blender $blender"
  LIMIT_SURFACE_ZIP=$release/limit_surface-$version.zip "$environment/bin/python" -m pytest -q \
    blend_tests/tools/test_extension_zip.py -k 'contents or installed_into_a_clean_folder'
  tried+=("$blender")
done

say "Notes and checksums"
{
  printf '# Limit Surface %s\n' "$version"
  if ((${#objections[@]})); then
    printf '\nThis is a trial, no release:\n\n'
    printf -- '- %s\n' "${objections[@]}"
  fi
  awk '/^## / { if (inside) exit; inside = 1; next } inside' CHANGELOG.md
  printf '\n## Tried\n\nThe wheels and the source package in fresh environments, and the extension '
  printf 'in Blender %s.\n' "$(sed 's/ /, /g' <<<"${tried[*]}")"
} >"$release/NOTES.md"
(cd "$release" && sha256sum -- *.whl *.zip *.tar.gz NOTES.md >SHA256SUMS)
cat "$release/SHA256SUMS"
say "Ready: ${release#"$ROOT"/}"
