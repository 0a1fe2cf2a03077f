#!/bin/sh
# Installs cusp, finds it from a project of its own, builds that and runs it: a board, and programs that plan,
# verify and simulate.
# installed.sh SOURCE_FOLDER BUILD_FOLDER GENERATOR MAKE_PROGRAM: the build is complete already.
set -eu
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cmake --install "$2" --prefix "$place/installed" >/dev/null
cmake -S "$1/tests/checks/installed" -B "$place/build" -DCMAKE_PREFIX_PATH="$place/installed" \
    -G "$3" -DCMAKE_MAKE_PROGRAM="$4" >/dev/null
cmake --build "$place/build" >/dev/null
"$place/build/board"
# Planned by a stranger's program, as by cusp; verified and run by two others.
job=$1/examples/hull_rough/tap.toml
"$place/build/plan_example" "$job" >"$place/tap.ngc" 2>/dev/null
"$place/installed/bin/cusp" plan "$job" -o "$place/cusp.ngc" >/dev/null
tail -n +2 "$place/cusp.ngc" >"$place/cusp.moves"
tail -n +2 "$place/tap.ngc" | cmp - "$place/cusp.moves"
"$place/build/verify_example" "$job" "$place/tap.ngc" | grep -q 'all bounds hold'
"$place/build/simulate_example" "$place/tap.ngc" | grep -q 's in motion'
# Far from the tree, cusp still runs.
"$place/installed/bin/cusp" --help >/dev/null
