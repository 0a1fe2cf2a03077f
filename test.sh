#!/bin/sh
# Installs what is missing, builds, cross-builds the images and runs the tests. See docs/testing.md.
# usage: ./test.sh [--all | --release]
#   --all, or CI=true: also the long tests, with a fifth of the random cases, the unit tests under ASan and UBSan, loops on
#   several threads under ThreadSanitizer, bounded fuzzing, the packages, and a clone and the packages in bare roots
#   --release: all of that with all random cases, the demo in that clone, the tests labelled `release`, programs beside LinuxCNC's
#     rs274, a build with clang, make and neither Eigen nor Open CASCADE, and the studio in one file made anew
set -eu
cd "$(dirname "$0")"
. ./.ci/packages.sh

all=no
release=no
case "${1:-}" in
    --release) all=yes release=yes ;;
    --all) all=yes ;;
    *) [ -z "${CI:-}" ] || all=yes ;;
esac
jobs=$(nproc)
passed=0
failed=0

install_packages $test_packages
view_tests=AUTO
preset=dev
if [ "$all" = yes ]; then
    # The packages are made of what the tests ran; the quick tier compiles each source alone, without optimisation.
    preset=ci
    install_packages $package_packages $wasm_packages $(view_packages)
    view_tests=ON
fi
linuxcnc_tests=OFF
if [ "$release" = yes ]; then
    install_packages $release_packages
    linuxcnc_tests=ON
elif [ "$all" = yes ]; then
    export CUSP_PROPERTY_SHARE=0.2
fi

# quietly LOG COMMAND...: the output goes to LOG and is shown where the command fails
quietly() {
    log=$1
    shift
    begin=$(date +%s)
    "$@" >"$log" 2>&1 || {
        tail -60 "$log"
        echo "failed: $*" >&2
        exit 1
    }
    echo "  $(basename "$log" .log): $(($(date +%s) - begin)) s"
}

# run_tests PRESET [OPTION...]: adds to passed and failed
run_tests() {
    preset=$1
    shift
    results=$PWD/build/${preset%-release}/results.xml
    rm -f "$results"
    # Two more than cores: the tests of senders and of pages mostly wait.
    ctest --preset "$preset" -j $((jobs + 2)) --output-junit "$results" "$@" || true
    [ -s "$results" ] || { echo "no results of the tests: $preset" >&2; exit 1; }
    count() { sed -n "s/^[[:space:]]*$1=\"\([0-9]*\)\".*/\1/p" "$results" | head -1; }
    tests=$(count tests)
    broken=$(($(count failures) + $(count disabled) + $(count skipped)))
    [ "$tests" -gt 0 ] || { echo "no test ran: $preset" >&2; exit 1; }
    passed=$((passed + tests - broken))
    failed=$((failed + broken))
}

# step NAME COMMAND...: one more test, by its exit status
step() {
    name=$1
    shift
    if "$@"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "failed: $name"
    fi
}

# Packs what the tests ran, and tries it and the demo in bare roots.
packages_and_roots() {
    echo "making the packages"
    quietly build/package.log .ci/package ci
    step packages tests/fresh/lint.sh out/packages
    step "bare roots" tests/fresh/fresh_test.sh $([ "$release" = yes ] || echo --quick) out/packages
}

# beside COMMAND: runs it while what follows goes on, up to join_beside, which shows its output and adds its steps
beside() {
    rm -f build/beside.count
    (passed=0 failed=0; "$@"; echo "$passed $failed" >build/beside.count) >build/beside.log 2>&1 &
    trap wait EXIT
}

join_beside() {
    wait
    cat build/beside.log
    [ -s build/beside.count ] || { echo "failed: what ran beside" >&2; exit 1; }
    read -r more_passed more_failed <build/beside.count
    passed=$((passed + more_passed))
    failed=$((failed + more_failed))
}

# Says how many tests the quick tier leaves out, and which.
leave_out() {
    echo "left to ./test.sh --all: $(ctest --preset dev -N -L long | sed -n 's/^Total Tests: //p') long tests" \
        "($(ctest --preset dev -N -L long | sed -n 's/^ *Test *#[0-9]*: //p' | tr '\n' ' ' | sed 's/ $//'))," \
        "ASan and UBSan, ThreadSanitizer, fuzzing, the packages, bare roots"
    sed -n 's/^-- \(left out: \)/\1/p' build/configure-dev.log
}

mkdir -p build
echo "building ($preset)"
quietly build/configure-$preset.log cmake --preset $preset -DCUSP_TARGET_TESTS=ON -DCUSP_VIEW_TESTS=$view_tests \
    -DCUSP_WASM=$view_tests -DCUSP_LINUXCNC_TESTS=$linuxcnc_tests
if [ "$all" = yes ]; then
    # The cost of a build from nothing on any machine; a compiler cache would hide it.
    step "build cost" env CCACHE_DISABLE=1 sh -c \
        'tests/fresh/build_cost.py 100 cmake --build --preset ci --target cusp >build/build-cusp.log 2>&1'
    grep '^build_cost:' build/build-cusp.log || tail -40 build/build-cusp.log
fi
quietly build/build-$preset.log cmake --build --preset $preset -j "$jobs"

if [ "$all" = no ]; then
    run_tests dev -LE long
    leave_out
else
    if [ "$release" = yes ]; then run_tests ci-release; else run_tests ci; fi
    install_packages $fresh_packages
    # Downloading, unpacking and packing leave cores idle. Before a release the demo, whose time counts, has the machine for itself.
    [ "$release" = yes ] || beside packages_and_roots
    echo "building (sanitize)"
    quietly build/configure-sanitize.log cmake --preset sanitize -DCUSP_FUZZ_SECONDS=10 -DCUSP_TARGET_TESTS=OFF \
        -DCUSP_SLOW_UNIT_TESTS=$([ "$release" = yes ] && echo ON || echo OFF)
    quietly build/build-sanitize.log cmake --build --preset sanitize -j "$jobs" --target unit_tests cusp fuzz
    run_tests sanitize -L 'unit|fuzz'
    echo "building (thread)"
    quietly build/configure-thread.log cmake --preset thread
    quietly build/build-thread.log cmake --build --preset thread -j "$jobs"
    run_tests thread
    if [ "$release" = yes ]; then
        echo "building without Eigen, Open CASCADE and lib3mf, with clang and make"
        quietly build/configure-least.log cmake -S . -B build/least -G "Unix Makefiles" -DCMAKE_CXX_COMPILER=clang++ \
            -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DBUILD_TESTING=OFF -DCUSP_EIGEN=OFF -DCUSP_OCCT=OFF -DCUSP_3MF=OFF \
            -DCUSP_FONTS=OFF -DCUSP_VIEW=OFF -DCUSP_UNITY=ON
        quietly build/build-least.log cmake --build build/least -j "$jobs" --target cusp
        step "the studio in one file" .ci/studio --compare
    fi
    if [ "$release" = yes ]; then packages_and_roots; else join_beside; fi
fi

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
