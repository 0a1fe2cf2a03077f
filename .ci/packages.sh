# The Debian packages that the project needs, and how the missing ones are installed. Sourced.

# Builds the host program.
host_packages="g++ cmake ninja-build pkg-config python3 cpputest libeigen3-dev libcli11-dev libfmt-dev
    libtomlplusplus-dev nlohmann-json3-dev libserialport-dev"
# Also builds the images and runs all tests.
test_packages="$host_packages python3-numpy clang-format-14 libpolyclipping-dev libbenchmark-dev
    libocct-data-exchange-dev
    gcc-arm-none-eabi libnewlib-dev libstdc++-arm-none-eabi-dev qemu-system-arm
    g++-riscv64-linux-gnu qemu-user clang libclang-rt-14-dev"

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
    [ "$(id -u)" = 0 ] || as_root=sudo
    echo "installing $missing"
    $as_root apt-get update -qq
    # shellcheck disable=SC2086
    DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends $missing
}

if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
