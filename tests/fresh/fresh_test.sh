#!/bin/sh
# The first steps of a stranger, in bare roots: the demo from a clone, and the packages.
# usage: fresh_test.sh [--quick] FOLDER-OF-PACKAGES
#   --quick  the clone's program is built without optimisation, and plans one example in place of the demo
# Needs root, mmdebstrap and a way to Debian's packages. Says how long each took.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
quick=no
[ "$1" != --quick ] || { quick=yes && shift; }
packages=$(cd "$1" && pwd)
version=$(sed -n 's/^project(cusp VERSION \([0-9.]*\).*/\1/p' "$here/../../CMakeLists.txt")
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
passed=0
failed=0

# check FUNCTION NAME: shows the output of what failed; its status is the function's
check() {
    begun=$(date +%s)
    if "$1" >"$work/$1.log" 2>&1; then
        echo "fresh: $2: passed in $(($(date +%s) - begun)) s"
        grep 'first picture' "$work/$1.log" || true
    else
        tail -40 "$work/$1.log"
        echo "fresh: $2: failed after $(($(date +%s) - begun)) s"
        return 1
    fi
}

# count STATUS
count() {
    if [ "$1" -eq 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
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
        grep -q '<svg' "$work/out/demo/left.svg" && grep -q M30 "$work/out/demo/pocket.ngc" &&
        grep -q packed-script "$work/out/demo/RUN.html"
}

# Half of what the demo costs is optimising, and planning without it would take minutes.
example() {
    "$here/bare_root.sh" --keep "$work/demo" --user --out "$work/out" \
        "sed -i 's/-O2 -DNDEBUG\"/-O0\", \"CUSP_COLD_OPTIONS\": \"\"/' CMakePresets.json && ./demo.sh --help && mkdir -p out &&
        build/release/bin/cusp plan examples/hull_rough/tap.toml -o out/tap.ngc" &&
        grep -q M30 "$work/out/tap.ngc"
}

installed() {
    "$here/bare_root.sh" --keep "$work/deb" --copy "$packages/cusp_${version}_amd64.deb" \
        --copy "$packages/cusp-dev_${version}_amd64.deb" \
        --copy "$packages/python3-cusp_${version}_amd64.deb" --copy "$(echo "$packages"/cusp-"$version"-*.whl)" --copy "$here/installed.sh" 'cd && sh installed.sh'
}

# Both mostly unpack packages: together. The demo, whose time counts, comes alone.
check installed "packages as root" &
installing=$!
status=0
check lacking "a missing package is named" || status=$?
count $status
status=0
wait $installing || status=$?
count $status
status=0
if [ $quick = yes ]; then
    check example "build and plan as a user" || status=$?
else
    check demo "demo as a user" || status=$?
fi
count $status
echo "fresh: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
