#!/bin/sh
# Builds a preset and, where its programs run under an emulator, its tests.
# usage: build_preset.sh TOP PRESET [test]
cd "$1" || exit 2
log=build/$2.log
mkdir -p build
{ cmake --preset "$2" && cmake --build --preset "$2"; } >"$log" 2>&1 || {
    grep -E -A5 'error|undefined|FAILED' "$log" || tail -30 "$log"
    exit 1
}
[ "$3" != test ] || ctest --preset "$2"
