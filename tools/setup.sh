# shellcheck shell=bash
# Sourced by tools/render and tools/test: installs what is missing, configures, builds. Prints to stderr only.
# Works in a bare Debian 12 or 13, in a chroot, with or without /proc; needs no git and no sudo.

# ccache may take a precompiled header for what it was made from.
export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build

missingPackages() {
    {
        dpkg-query --show --showformat '${db:Status-Status} ${Package}\n'
        sed 's/#.*//; s/ *$//; /^$/d; s/^/wanted /' "$root/tools/packages.txt"
    } | awk '$1 == "installed" { installed[$2] } $1 == "wanted" && !($2 in installed) { print $2 }'
}

installPackages() {
    local missing
    missing=$(missingPackages)
    [ -z "$missing" ] && return
    # shellcheck disable=SC2086 # one word a package: splitting is meant
    set -- $missing
    if [ "$(id -u)" -ne 0 ]; then
        printf 'Missing packages. As root:\n    apt-get install --no-install-recommends %s\n' "$*" >&2
        exit 3
    fi
    echo "Installing $# packages: $*" >&2
    export DEBIAN_FRONTEND=noninteractive
    apt-get update -qq >&2
    apt-get install -qq --yes --no-install-recommends -o Dpkg::Use-Pty=0 "$@" >&2
}

# Fresh when the folder was made elsewhere (a moved or copied checkout) or with another generator.
configure() {
    local cache=$build/CMakeCache.txt fresh=() launcher=()
    [ -f "$build/build.ninja" ] && grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache" && return
    [ -f "$cache" ] && fresh=(--fresh)
    command -v ccache >/dev/null && launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    cmake "${fresh[@]}" -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release "${launcher[@]}" >&2
}

# A compiler process takes up to 1.5 GB (OpenVDB's headers): no more of them than memory has room for.
parallelJobs() {
    local cores available jobs
    cores=$(nproc)
    available=$(sed -n 's/^MemAvailable: *\([0-9]*\) kB/\1/p' /proc/meminfo 2>/dev/null) || true
    jobs=$((${available:-3000000} / 1500000))
    [ "$jobs" -gt "$cores" ] && jobs=$cores
    [ "$jobs" -lt 1 ] && jobs=1
    echo "$jobs"
}

# buildTargets [TARGET...]: everything without arguments.
buildTargets() {
    installPackages
    configure
    ninja -C "$build" -j "$(parallelJobs)" "$@" >&2
}
