#!/usr/bin/env bash
# Runs every test of the project, installing what is missing. `--quick`: the unit tests only.
# Prints the time of each stage, and the number of tests per tier against tests/minimum.txt. With CI=true a run of more
# than 40 minutes is a failure.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/packages.sh

quick=false
for argument in "$@"; do
    case "$argument" in
        --quick) quick=true ;;
        *) echo "usage: tools/test.sh [--quick]" >&2; exit 2 ;;
    esac
done

began=$SECONDS
summary=()
export CTEST_PARALLEL_LEVEL=${CTEST_PARALLEL_LEVEL:-$(nproc)}
mkdir -p build

# stage NAME COMMAND …: runs it, quietly unless it fails, and notes the time.
stage() {
    local name=$1 start=$SECONDS log="build/stage-${1// /-}.log"
    shift
    echo "== $name"
    if ! "$@" >"$log" 2>&1; then
        grep -E '(\*\*\*|error:|FAILED|Failed)' "$log" | head -n 40 >&2 || true
        tail -n 60 "$log" >&2
        echo "== $name failed after $((SECONDS - start)) s; the whole output is in $log" >&2
        exit 1
    fi
    summary+=("$(printf '%5d s  %s' $((SECONDS - start)) "$name")")
}
build() { cmake --preset "$1" && cmake --build "build/$1" --target "${@:2}"; }

# ctest_in PRESET ARGUMENTS …: runs tests and repeats why any were skipped.
ctest_in() {
    local preset=$1
    shift
    ctest --test-dir "build/$preset" --output-on-failure --no-tests=error "$@"
}
skip_reasons() {
    local log=build/dev/Testing/Temporary/LastTest.log
    [ -f "$log" ] && grep -h '^SKIPPED:' "$log" | sort | uniq -c || true
}

# count_tests PATTERN: in each tier that matches, at least as many tests passed as tests/minimum.txt promises. The names of
# tests begin with their tier.
count_tests() {
    local tier minimum passed short=false
    while read -r tier minimum; do
        [[ "$tier" =~ ^($1)$ && "$tier" != '#'* && -n "$tier" ]] || continue
        passed=$(grep -cE "Test +#[0-9]+: $tier[.:].* Passed " "$tests_log" || true)
        printf '%6d passed  %-10s (at least %d)\n' "$passed" "$tier" "$minimum"
        [ "$passed" -ge "$minimum" ] || { echo "tier $tier has lost tests: $passed of $minimum" >&2; short=true; }
    done <tests/minimum.txt
    [ $short = false ]
}

# What runs in several threads.
threaded='^(contract.transport|unit.session|cli.program)|^unit.device:.*(ring|interrupts)|^unit.host:.*(framebuffer|page exchange|shared frames.*full speed)|^unit.voxelizer:.*(threads|region|slabs|batches|stopped|same time|moves|rounds)'

need $packages_build $packages_test
export XORVOX_REQUIRE=${XORVOX_REQUIRE:-}

if $quick; then
    stage "build dev" build dev all
    stage "unit tests" ctest_in dev -L unit
    tests_log=build/stage-unit-tests.log
    skip_reasons
    count_tests unit
else
    stage "build dev" build dev all
    stage "headers compile alone" cmake --build build/dev --target all_verify_interface_header_sets
    stage "all tests" ctest_in dev
    tests_log=build/stage-all-tests.log
    skip_reasons
    count_tests '.*'
    stage "build asan" build asan all
    stage "asan" ctest_in asan -LE '^(gl|house|embedded)$'
    stage "build tsan" build tsan contract_transport unit_session unit_device unit_host unit_voxelizer cli_program
    stage "tsan" ctest_in tsan -R "$threaded"
    stage "build with clang, fuzzers" build fuzz fuzzers xorvox
    stage "fuzz, 60 s over all targets" tools/fuzz.sh 60
fi

echo
printf '%s\n' "${summary[@]}"
total=$((SECONDS - began))
printf '%5d s  in all\n' $total
if [ "${CI:-}" = true ] && [ $total -gt 2400 ]; then
    echo "the whole run may take 40 minutes at most" >&2
    exit 1
fi
grep -E '^[0-9]+% tests passed' "$tests_log"
