#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Sets up, then makes the paper's figure 1: hair on the limit surface of a small open mesh, in two
# densities, rendered to out/figure1.png, and the scene itself in out/figure1.blend.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
set_up
cd "$ROOT"
exec python docs/figures/make.py figure1 --output out --keep-scene "$@"
