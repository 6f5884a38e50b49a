#!/bin/bash
# The pictures of docs/displays.md and docs/color.md: the demo model on every preset, and by each command of the page on
# colours, drawn by the program. Build first (tools/demo.sh does).
#   tools/pictures.sh [PROGRAM]
set -euo pipefail
cd "$(dirname "$0")/.."
xorvox="${1:-build/release/bin/xorvox}"
[[ -x $xorvox ]] || { echo "there is no $xorvox: build it, or give its path" >&2; exit 2; }
mkdir -p docs/images/displays
for name in $("$xorvox" displays | cut -d' ' -f1); do
    color=gradient:orange,yellow
    [[ $name == perspecta ]] && color=constant:yellow # one bit a channel: there is no orange
    light=uniform
    [[ $name == candle ]] && light=bright # so few samples that every one is needed
    "$xorvox" show examples/duck.ply --display "$name" --color "$color" --light "$light" --size 480x360 \
        --png "docs/images/displays/$name.png"
done
mkdir -p docs/images/color
grep -oE '^    xorvox show examples/.* --png [a-z]+\.png$' docs/color.md | while read -r _ arguments; do
    eval "\"$xorvox\" ${arguments% --png *} --size 320x240 --png docs/images/color/${arguments##* --png }"
done
