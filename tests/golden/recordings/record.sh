#!/bin/sh
# Makes the golden recordings anew, by the commands in commands.txt: tests/golden/recordings/record.sh PROGRAM
set -eu
program=$(realpath "${1:?"usage: record.sh PROGRAM, as build/dev/bin/xorvox"}")
cd "$(dirname "$0")/../../.."
grep -v '^#' tests/golden/recordings/commands.txt | while read -r name arguments; do
    # shellcheck disable=SC2086 # they are words, without spaces in them
    "$program" record $arguments -o "tests/golden/recordings/$name" >/dev/null
    echo "tests/golden/recordings/$name"
done
