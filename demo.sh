#!/bin/sh
# Installs what is missing, builds, and shows what cusp does: `cusp demo` leaves G-code, figures and
# pictures in out/demo. With --traces it leaves 470 MB of pulses and set points, too.
set -eu
cd "$(dirname "$0")"
. ./.ci/packages.sh

install_packages $host_packages

mkdir -p build

# The demo reads no STEP: the module that does is built by the whole build, and an older one does not fit this program.
rm -f build/release/lib/libcusp_cad.so

echo "building"
{ cmake --preset release &&
    cmake --build --preset release --target cusp; } >build/demo.log 2>&1 || {
    tail -40 build/demo.log
    echo "demo: the build failed" >&2
    exit 1
}

exec build/release/bin/cusp demo "$@" --out out/demo
