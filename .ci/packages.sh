# The Debian packages that the project needs, and how the missing ones are installed. Sourced.

# Builds the product.
host_packages="g++ cmake ninja-build libcli11-dev libcpp-httplib-dev libeigen3-dev libfmt-dev libpugixml-dev libserialport-dev libstb-dev libtbb-dev libtomlplusplus-dev
    nlohmann-json3-dev zlib1g-dev"
# Also reads STEP, IGES, BREP and 3MF, and letters of font files.
cad_packages="libocct-data-exchange-dev lib3mf-dev libharfbuzz-dev"
# Builds the images of the boards.
image_packages="gcc-arm-none-eabi libnewlib-dev libstdc++-arm-none-eabi-dev"
# Makes the Debian packages of it all, and checks them.
package_packages="$host_packages $cad_packages $image_packages dpkg-dev file help2man lintian pybind11-dev python3-dev
    python3-numpy python3-wheel"
# Runs all tests.
test_packages="$host_packages $cad_packages $image_packages cpputest fonts-dejavu-core libpolyclipping-dev python3 python3-jsonschema python3-numpy
    clang-format-14 libunicorn-dev qemu-system-arm g++-riscv64-linux-gnu qemu-user clang lld libclang-rt-14-dev doxygen git"
# Builds the core in WebAssembly, for the pages and npm.
wasm_packages="clang lld wasi-libc libc++-14-dev-wasm32 libclang-rt-14-dev-wasm32 binaryen"
# Builds the planners in WebAssembly (preset wasm-engine): ten minutes of emscripten, before a release and not in CI.
engine_packages="emscripten libfast-float-dev libeigen3-dev"
# Reads our programs as LinuxCNC does, and opens our USB as Linux does: before a release.
release_packages="linuxcnc-uspace qemu-system-x86 linux-image-amd64 busybox-static"
# Runs the demo and the packages in a bare root.
fresh_packages="mmdebstrap"

# Bundles the pages of cusp view; the commands may come from elsewhere.
npm_packages() {
    command -v node >/dev/null || echo nodejs
    command -v npm >/dev/null || echo npm
}
# Also tests them in a browser.
view_packages() {
    npm_packages
    command -v chromium >/dev/null || echo chromium
}

# missing_packages PACKAGE...: those that are not installed
missing_packages() {
    for package in "$@"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
            printf '%s ' "$package"
    done
}

# install_packages PACKAGE...: installs what is missing; quick where nothing is
install_packages() {
    missing=$(missing_packages "$@")
    [ -n "$missing" ] || return 0
    command -v apt-get >/dev/null || {
        echo "missing: $missing (no apt-get here to install them)" >&2
        return 1
    }
    as_root=""
    if [ "$(id -u)" != 0 ]; then
        as_root=sudo
        command -v sudo >/dev/null || {
            echo "missing: $missing (run as root: apt-get install $missing)" >&2
            return 1
        }
    fi
    echo "installing $missing"
    $as_root apt-get update -qq
    # shellcheck disable=SC2086
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
}

# fetch_sources FOLDER PACKAGE...: sources of Debian's packages, from the archives that this machine uses, in FOLDER/PACKAGE
fetch_sources() {
    folder=$1
    shift
    for package in "$@"; do
        [ ! -d "$folder/$package" ] || continue
        fetched=$(mktemp -d)
        mkdir -p "$fetched/lists/partial" "$folder"
        apt-get indextargets --format 'deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
            sort -u >"$fetched/sources.list"
        (
            cd "$fetched"
            set -- -qq -o APT::Sandbox::User=root -o "Dir::Etc::sourcelist=$fetched/sources.list" -o Dir::Etc::sourceparts=/dev/null -o "Dir::State::lists=$fetched/lists"
            apt-get "$@" update && apt-get "$@" source --download-only "$package"
            mkdir sources && tar -xf "$package"_*.orig.tar.* --strip-components=1 -C sources
        ) || return 1
        mv "$fetched/sources" "$folder/$package"
        rm -r "$fetched"
    done
}

if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
