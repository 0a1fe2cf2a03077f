#!/bin/sh
# Installs what is missing, builds, cross-builds the images, runs every test. See docs/testing.md.
# usage: ./test.sh [--all]
#   --all, or CI=true: also the unit tests under ASan and UBSan, bounded fuzzing, and a build without Eigen and Open CASCADE
set -eu
cd "$(dirname "$0")"
. ./.ci/packages.sh

all=no
{ [ "${1:-}" != --all ] && [ -z "${CI:-}" ]; } || all=yes
jobs=$(nproc)
passed=0
failed=0

install_packages $test_packages

# quietly LOG COMMAND...: the output goes to LOG and is shown where the command fails
quietly() {
    log=$1
    shift
    "$@" >"$log" 2>&1 || {
        tail -60 "$log"
        echo "failed: $*" >&2
        exit 1
    }
}

# run_tests PRESET [OPTION...]: adds to passed and failed
run_tests() {
    preset=$1
    shift
    results=$PWD/build/$preset/results.xml
    rm -f "$results"
    # One more than cores: the tests of senders mostly wait.
    ctest --preset "$preset" -j $((jobs + 1)) --output-junit "$results" "$@" || true
    [ -s "$results" ] || { echo "no results of the tests: $preset" >&2; exit 1; }
    count() { sed -n "s/^[[:space:]]*$1=\"\([0-9]*\)\".*/\1/p" "$results" | head -1; }
    tests=$(count tests)
    broken=$(($(count failures) + $(count disabled) + $(count skipped)))
    [ "$tests" -gt 0 ] || { echo "no test ran: $preset" >&2; exit 1; }
    passed=$((passed + tests - broken))
    failed=$((failed + broken))
}

mkdir -p build
echo "building (dev)"
quietly build/configure-dev.log cmake --preset dev -DCUSP_TARGET_TESTS=ON
quietly build/build-dev.log cmake --build --preset dev -j "$jobs"
run_tests dev

if [ "$all" = yes ]; then
    echo "building (sanitize)"
    quietly build/configure-sanitize.log cmake --preset sanitize -DCUSP_TARGET_TESTS=OFF
    quietly build/build-sanitize.log cmake --build --preset sanitize -j "$jobs" --target unit_tests cusp
    run_tests sanitize -L unit
    echo "building the fuzz targets"
    quietly build/configure-fuzz.log cmake --preset fuzz -DCUSP_FUZZ_SECONDS=10 \
        -DCUSP_TARGET_TESTS=OFF
    quietly build/build-fuzz.log cmake --build --preset fuzz -j "$jobs"
    run_tests fuzz
    echo "building without Eigen and Open CASCADE"
    quietly build/configure-no-eigen.log cmake --preset dev -B build/no-eigen -DCUSP_EIGEN=OFF -DCUSP_OCCT=OFF \
        -DCUSP_TARGET_TESTS=OFF -DCUSP_UNITY=ON -DCMAKE_CXX_FLAGS_DEBUG=-O0
    quietly build/build-no-eigen.log cmake --build build/no-eigen -j "$jobs" --target cusp
fi

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
