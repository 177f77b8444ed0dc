# SPDX-License-Identifier: Apache-2.0
#
# Functions for a Debian 13 with its own Blender, in a chroot. tools/gui_test.sh sources this file.
#
#   chroot_obstacle          prints the reason why a chroot is not possible here, if there is one
#   make_chroot              makes the chroot if it is missing (a minute or two, 1.3 GB)
#   in_chroot COMMAND...     runs a command in it, without network
#
# It lies in build/window and is kept. Everything is mounted in a namespace of its own, so that
# nothing stays mounted and no process survives, however the command ends.

CHROOT=$ROOT/build/window/trixie
CHROOT_OUT=$ROOT/build/window/out # /out inside; the checkout is /project, read-only

CHROOT_PACKAGES=(
  blender python3-numpy libgl1-mesa-dri libegl-mesa0 # Blender, and OpenGL without a graphics card
  xvfb xauth xdotool imagemagick                     # a virtual screen, a mouse, and screenshots
  python3-pytest
  libpython3.13-dev # headers to compile the module that this Blender loads
)

chroot_obstacle() {
  local program
  if [[ $(uname -sm) != "Linux x86_64" ]]; then
    echo "they need Linux on x86-64"
  elif ((EUID != 0)); then
    echo "a chroot needs the rights of root"
  elif ! unshare --mount --pid --net --fork true 2>/dev/null; then
    echo "this system allows no namespaces (unshare), as in a container without privileges"
  elif ! command -v debootstrap >/dev/null && ! command -v apt-get >/dev/null; then
    echo "debootstrap is missing, and there is no apt to install it"
  fi
}

chroot_stamp() {
  echo "${CHROOT_PACKAGES[*]}"
}

chroot_is_ready() {
  [[ $(cat "$CHROOT/etc/limit-surface" 2>/dev/null) == "$(chroot_stamp)" ]]
}

make_chroot() {
  local log=$ROOT/build/window/setup.log
  mkdir -p "$CHROOT_OUT"
  chroot_is_ready && return
  say "Fetching a Debian 13 with Blender for the window tests (a minute or two, 1.3 GB)"
  if ! fetch_debian "$CHROOT.partial" >"$log" 2>&1 </dev/null; then
    tail -n 40 "$log" >&2
    fail "The Debian for the window tests could not be fetched." "(The whole output: $log)"
  fi
  rm -rf --one-file-system "$CHROOT"
  mv "$CHROOT.partial" "$CHROOT"
}

# The steps are joined by &&, because `set -e` has no effect in a function that is called by `if`.
fetch_debian() {
  local folder=$1
  rm -rf --one-file-system "$folder" &&
    install_debootstrap &&
    use_proxy_of_apt &&
    unshare --mount --fork --kill-child --propagation private \
      debootstrap --variant=minbase trixie "$folder" "$(debian_mirror)" &&
    hasten_dpkg "$folder" &&
    enter "$folder" env DEBIAN_FRONTEND=noninteractive sh -c \
      'apt-get -qq update && apt-get -qq install -y --no-install-recommends "$@" && apt-get clean' \
      sh "${CHROOT_PACKAGES[@]}" &&
    chroot_stamp >"$folder/etc/limit-surface"
}

hasten_dpkg() {
  local settings=$1/etc/dpkg/dpkg.cfg.d/limit-surface
  echo force-unsafe-io >"$settings" # the chroot is replaceable: dpkg need not wait for the disk
  printf 'path-exclude=/usr/share/%s/*\n' doc man locale info >>"$settings"
}

in_chroot() {
  enter "$CHROOT" --net "$@"
}

# enter FOLDER [--net] COMMAND...: --net gives the command an empty network of its own
enter() {
  local folder=$1 options=(--mount --pid --fork --kill-child --propagation private)
  shift
  if [[ $1 == --net ]]; then
    options+=(--net)
    shift
  fi
  unshare "${options[@]}" bash -ec '
    folder=$1 project=$2 out=$3
    shift 3
    mkdir -p "$folder"/{project,out}
    mount --bind "$project" "$folder/project"
    mount -o remount,bind,ro "$folder/project"
    mount --bind "$out" "$folder/out"
    mount -t tmpfs tmpfs "$folder/tmp"
    mount -t proc proc "$folder/proc"
    mount --rbind /dev "$folder/dev"
    mount --rbind /sys "$folder/sys"
    exec chroot "$folder" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
      ${http_proxy:+http_proxy="$http_proxy"} "$@"
  ' bash "$folder" "$ROOT" "$CHROOT_OUT" "$@"
}

install_debootstrap() {
  command -v debootstrap >/dev/null && return
  apt-get -o DPkg::Lock::Timeout=300 update || true
  DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 install -y \
    --no-install-recommends debootstrap
}

# Prints the mirror that this system's own apt uses.
debian_mirror() {
  local found
  found=$(apt-get indextargets --format '$(ORIGIN) $(SITE) $(RELEASE) $(COMPONENT)' \
    'Created-By: Packages' 2>/dev/null |
    awk '$1 == "Debian" && $3 !~ /security/ && $4 == "main" { print $2; exit }')
  echo "${found:-http://deb.debian.org/debian}"
}

use_proxy_of_apt() {
  local proxy=${http_proxy-}
  command -v apt-config >/dev/null && eval "$(apt-config shell proxy Acquire::http::Proxy)"
  [[ $proxy ]] && export http_proxy=$proxy
  return 0
}
