#!/bin/bash
# The pictures of docs/displays.md: the demo model on every preset, drawn by the program. Build first (tools/demo.sh does).
#   tools/pictures.sh [PROGRAM]
set -euo pipefail
cd "$(dirname "$0")/.."
xorvox="${1:-build/release/bin/xorvox}"
[[ -x $xorvox ]] || { echo "there is no $xorvox: build it, or give its path" >&2; exit 2; }
mkdir -p docs/images/displays
for name in $("$xorvox" displays | cut -d' ' -f1); do
    "$xorvox" show examples/duck.ply --display "$name" --color gradient:orange,yellow --light uniform --size 480x360 \
        --png "docs/images/displays/$name.png"
done
