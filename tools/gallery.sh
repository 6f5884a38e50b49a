#!/bin/bash
# The pictures of the fault gallery in docs/bring-up.md, by the commands that stand there: each with its fault, as
# KIND.png, and without, as right-DISPLAY-PATTERN.png (of three views …-views.png). Build first (tools/demo.sh does).
#   tools/gallery.sh [PROGRAM [FOLDER [KIND]]]
# FOLDER instead of docs/images/faults; of KIND alone.
set -euo pipefail
cd "$(dirname "$0")/.."
xorvox="${1:-build/release/bin/xorvox}"
folder="${2:-docs/images/faults}"
kind="${3:-[a-z-]+}"
[[ -x $xorvox ]] || { echo "there is no $xorvox: build it, or give its path" >&2; exit 2; }
commands=$(grep -oE "^    xorvox pattern .* --fault ($kind)[: ].* --png \\1\.png$" docs/bring-up.md) ||
    { echo "docs/bring-up.md has no command for the fault $kind" >&2; exit 2; }
mkdir -p "$folder"
while read -r _ _ display pattern arguments; do
    arguments=${arguments% --png *}
    size="--size 400x300"
    views=""
    [[ $arguments == *orthographic* ]] && size="--size 720x240" && views="-views"
    right=$(sed -E 's/--fault [^ ]+//' <<<"$arguments")
    [[ $arguments =~ --fault\ ([a-z-]+) ]]
    # The words of the arguments are split on purpose.
    "$xorvox" pattern "$display" "$pattern" $arguments $size --png "$folder/${BASH_REMATCH[1]}.png"
    "$xorvox" pattern "$display" "$pattern" $right $size --png "$folder/right-$display-$pattern$views.png"
done <<<"$commands" >/dev/null
