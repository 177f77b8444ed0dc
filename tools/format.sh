#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Formats the C++ and Python sources; with --check it only lists what is not formatted.
set -euo pipefail
case ${1-} in
  '' | --check) ;;
  *)
    sed -n '4s/^# //p' "$0"
    exit 2
    ;;
esac
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
set_up
cd "$ROOT"

mapfile -t cpp < <(find native tools -name '*.h' -o -name '*.cpp')
if [[ ${1-} != --check ]]; then
  ruff check --fix
  ruff format
  clang-format -i "${cpp[@]}"
  exit
fi

status=0
ruff check || status=1
ruff format --check || status=1
report=$(clang-format --dry-run -Werror "${cpp[@]}" 2>&1) || {
  sed -nE 's/^([^:]+):[0-9]+:[0-9]+: error: .*/Would reformat: \1/p' <<<"$report" | sort -u
  status=1
}
exit $status
