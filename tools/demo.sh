#!/usr/bin/env bash
# The main job from nothing: installs what is missing, builds the program, and shows the shipped model on a simulated
# rotating display. Leaves build/demo.png and names it.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/packages.sh

need $packages_build

echo "build: cmake --preset release && cmake --build --preset release"
mkdir -p build
if ! { cmake --preset release && cmake --build --preset release; } >build/demo.log 2>&1; then
    tail -n 30 build/demo.log >&2
    echo "build: failed; the whole output is in build/demo.log" >&2
    exit 1
fi

run() {
    printf '\n$ %s\n' "$*"
    "$@"
}
run build/release/bin/xorvox info examples/duck.ply
run build/release/bin/xorvox voxelize examples/duck.ply --size 64 -o build/duck.nrrd
run build/release/bin/xorvox show examples/duck.ply --display vortex --color gradient:orange,yellow --png build/demo.png
printf '\nThe picture is %s\n' "$PWD/build/demo.png"
