#!/bin/sh
# What a stranger does first, in bare roots: the demo from a clone, and the packages.
# usage: fresh_test.sh FOLDER-OF-PACKAGES
# Needs root, mmdebstrap and a way to Debian's packages. Says how long each took; the goals are in docs/testing.md.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
packages=$(cd "$1" && pwd)
version=$(sed -n 's/^project(cusp VERSION \([0-9.]*\).*/\1/p' "$here/../../CMakeLists.txt")
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
passed=0
failed=0

# check NAME COMMAND...: counts, and shows the output of what failed
check() {
    name=$1
    shift
    begun=$(date +%s)
    if "$@" >"$work/log" 2>&1; then
        passed=$((passed + 1))
        echo "fresh: $name: passed in $(($(date +%s) - begun)) s"
        grep 'first picture' "$work/log" || true
    else
        failed=$((failed + 1))
        tail -40 "$work/log"
        echo "fresh: $name: failed after $(($(date +%s) - begun)) s"
    fi
}

# A package that the lists lack is noticed, and named.
lacking() {
    ! "$here/bare_root.sh" --keep "$work/demo" --user 'sed -i s/libfmt-dev// .ci/packages.sh && ./demo.sh' >"$work/lack" 2>&1 || {
        echo "the demo passed without libfmt-dev"
        return 1
    }
    cat "$work/lack"
    grep -q 'these packages are missing: libfmt-dev' "$work/lack"
}

demo() {
    "$here/bare_root.sh" --keep "$work/demo" --user --out "$work/out" ./demo.sh &&
        grep -q '<svg' "$work/out/demo/left.svg" && grep -q M30 "$work/out/demo/pocket.ngc"
}

installed() {
    "$here/bare_root.sh" --keep "$work/deb" --copy "$packages/cusp_${version}_amd64.deb" \
        --copy "$packages/cusp-dev_${version}_amd64.deb" --copy "$here/installed.sh" 'cd && sh installed.sh'
}

check "a missing package is named" lacking
check "demo as a user" demo
rm -rf --one-file-system "$work/demo"
check "packages as root" installed
echo "fresh: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
