#!/bin/sh
# Builds a preset and, where its programs run under an emulator, its tests.
# usage: build_preset.sh TOP PRESET [test [TARGET...]]
#   TARGET: only these are built, and only the tests of their names run
cd "$1" || exit 2
preset=$2
tested=${3:-}
if [ $# -gt 3 ]; then shift 3; else set --; fi
log=build/$preset.log
mkdir -p build
# shellcheck disable=SC2086
{ cmake --preset "$preset" && cmake --build --preset "$preset" ${1:+--target} "$@"; } >"$log" 2>&1 || {
    grep -E -A5 'error|undefined|FAILED' "$log" || tail -30 "$log"
    exit 1
}
[ "$tested" = test ] || exit 0
ctest --preset "$preset" ${1:+-R "^($(echo "$@" | tr ' ' '|'))\$"} --no-tests=error
