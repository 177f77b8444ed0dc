#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Checks the spelling (codespell), the types (mypy), and the native module's stub (stubtest).
#
# pyproject.toml holds the settings of codespell and mypy.
set -euo pipefail
case ${1-} in
  '') ;;
  *)
    sed -n '4s/^# //p' "$0"
    exit 2
    ;;
esac
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
set_up
cd "$ROOT"

status=0
codespell || status=1
mypy || status=1
MYPYPATH=native/python python -m mypy.stubtest --concise limitsurf || status=1
exit $status
