#!/usr/bin/env bash
# Runs every fuzz target of build/fuzz, its seeds first. Usage: tools/fuzz.sh SECONDS, shared by all targets.
# A crash leaves its input in build/fuzz/findings and fails.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:?usage: tools/fuzz.sh SECONDS}
targets=(build/fuzz/bin/fuzz_*)
each=$(( (seconds * $(nproc) + ${#targets[@]} - 1) / ${#targets[@]} ))
[ "$each" -ge 1 ] || each=1
mkdir -p build/fuzz/findings
one() {
    local name=${1##*/fuzz_} seeds=tests/fuzz/seeds/${1##*/fuzz_} corpus=build/fuzz/corpus/${1##*/fuzz_}
    mkdir -p "$corpus"
    [ -d "$seeds" ] || { echo "$name has no seeds in $seeds" >&2; return 1; }
    if ! "$1" "$corpus" "$seeds" -max_total_time="$2" -rss_limit_mb=2048 -timeout=10 -print_final_stats=1 \
            -artifact_prefix=build/fuzz/findings/"$name"- >"build/fuzz/$name.log" 2>&1; then
        tail -n 40 "build/fuzz/$name.log"
        echo "fuzz_$name failed; its input is in build/fuzz/findings"
        return 1
    fi
    echo "fuzz_$name: $(sed -n 's/^stat::number_of_executed_units: *//p' "build/fuzz/$name.log") inputs in $2 s, no finding"
}
export -f one
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I{} bash -c 'one "$@"' _ {} "$each"
