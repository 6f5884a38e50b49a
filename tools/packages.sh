# Sourced by demo.sh and test.sh: what Debian 12 packages they need, and how to get the missing ones.

packages_build="cmake ninja-build g++ pkg-config libglm-dev libexpected-dev libfmt-dev libtomlplusplus-dev libcli11-dev
    libpng-dev libjpeg62-turbo-dev zlib1g-dev libtinygltf-dev libassimp-dev liblz4-dev libhwy-dev libgl-dev libegl-dev
    libegl1 libgl1-mesa-dri libosmesa6"
packages_test="ccache catch2 assimp-testmodels python3 clang clang-format libclang-rt-14-dev gcc-arm-none-eabi
    libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib qemu-system-arm g++-aarch64-linux-gnu qemu-user sigrok-cli zstd"

# need PACKAGE …: installs what is missing, says so; changes nothing when all is there.
need() {
    local missing=() package as_root=()
    for package in "$@"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
    done
    if [ ${#missing[@]} -eq 0 ]; then
        echo "packages: all $# are installed"
        return
    fi
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "packages missing: ${missing[*]}" >&2
            echo "neither root nor sudo: install them as root with apt-get install, then run this again" >&2
            exit 1
        fi
        as_root=(sudo)
    fi
    echo "packages: installing ${#missing[@]} of $# with apt-get: ${missing[*]}"
    local log
    log=$(mktemp)
    if ! { "${as_root[@]}" apt-get -q update &&
           "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends install "${missing[@]}"
         } >"$log" 2>&1; then
        tail -n 20 "$log" >&2
        echo "packages: apt-get failed; its whole output is in $log" >&2
        exit 1
    fi
    rm -f "$log"
}
