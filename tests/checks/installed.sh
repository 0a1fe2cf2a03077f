#!/bin/sh
# Installs the core, finds it from a project of its own, builds that and runs it.
# installed.sh SOURCE_FOLDER BUILD_FOLDER GENERATOR MAKE_PROGRAM: the build is complete already.
set -eu
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cmake --install "$2" --prefix "$place/installed" >/dev/null
cmake -S "$1/tests/checks/installed" -B "$place/build" -DCMAKE_PREFIX_PATH="$place/installed" \
    -G "$3" -DCMAKE_MAKE_PROGRAM="$4" >/dev/null
cmake --build "$place/build" >/dev/null
"$place/build/board"
# Far from the tree, cusp still runs.
"$place/installed/bin/cusp" --help >/dev/null
