#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Sets up, then makes two pictures in out/: figure1.png, the paper's figure 1 (hair on the limit
# surface of a small open mesh, in two densities), with its scene in figure1.blend; and follow.png,
# frames of hair on a mesh that bends, and the distance of its roots from the surface.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
set_up
cd "$ROOT"
python docs/figures/make.py figure1 --output out --keep-scene "$@"
exec python docs/figures/make.py follow --output out
