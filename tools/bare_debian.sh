#!/usr/bin/env bash
# tools/test --bare [bookworm|trixie] [OPTIONS of ctest]: proves that nothing but a bare Debian 12 (bookworm) or 13
# (trixie) is needed; without a name: the release that this machine runs, or else bookworm.
#
# Makes one with debootstrap in a temporary folder, copies the checkout into it (and ../shared, when it is
# there), runs tools/render and tools/test in it, says how long each took, and leaves the picture in the
# current folder as bare_final_cloud.png. Needs root. The packages come from where this machine's apt gets those of
# its own release.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
name=
case ${1-} in
    bookworm | trixie) name=$1; shift ;;
    -* | '') ;;
    *) echo "--bare takes bookworm or trixie; got $1" >&2; exit 2 ;;
esac
[ "$(id -u)" -eq 0 ] || { echo "--bare needs root: it makes a chroot" >&2; exit 3; }
command -v debootstrap >/dev/null || DEBIAN_FRONTEND=noninteractive apt-get install -qq --yes --no-install-recommends debootstrap

bare=$(mktemp -d "${TMPDIR:-/tmp}/bare_debian.XXXXXX")
chmod 755 "$bare" # apt downloads as a user of its own
# /proc is mounted in a namespace of its own (see inBare) and gone by now; one file system all the same.
trap 'rm -rf --one-file-system "$bare"' EXIT

# chooseRelease [NAME]: sets release.
chooseRelease() {
    release=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
    [ "$release" = trixie ] || release=bookworm
    [ -z "${1-}" ] || release=$1
}

# The file of apt's sources that names the given Debian release, and its first address.
findSourcesOf() {
    local file
    for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.sources /etc/apt/sources.list.d/*.list; do
        [ -f "$file" ] || continue
        mirror=$(awk -v release="$1" '
            /^URIs:/ { uri = $2 }
            /^Suites:/ { for (i = 2; i <= NF; ++i) if ($i == release) { print uri; exit } }
            $1 == "deb" { for (i = 2; i < NF; ++i) if ($i ~ /:\// && $(i + 1) == release) { print $i; exit } }' "$file")
        [ -n "$mirror" ] && { sources=$file; sourcesRelease=$1; return; }
    done
    return 1
}

# The mirrors of one release have the other too.
findSources() {
    findSourcesOf "$release" || findSourcesOf bookworm || findSourcesOf trixie && return
    echo "no source of Debian bookworm or trixie in /etc/apt" >&2
    exit 3
}

# What apt needs to reach the same packages: its sources, their keys, its network settings.
copyAptConfiguration() {
    local file
    : >"$bare/etc/apt/sources.list"
    sed "s/$sourcesRelease/$release/g" "$sources" >"$bare/etc/apt/${sources#/etc/apt/}"
    { grep -lrE 'Acquire|Proxy' /etc/apt/apt.conf.d || true; } | while read -r file; do cp "$file" "$bare/etc/apt/apt.conf.d/"; done
    [ -d /etc/apt/auth.conf.d ] && cp -a /etc/apt/auth.conf.d/. "$bare/etc/apt/auth.conf.d/"
    {
        grep -ohE '/[^] ]*\.(gpg|asc)' "$sources" || true
        printf '%s\n' /etc/hosts /etc/ssl/certs/ca-certificates.crt
    } | while read -r file; do
        [ -f "$file" ] && mkdir -p "$bare$(dirname "$file")" && cp "$file" "$bare$file"
    done || true
}

# The checkout as git sees it, or without its build folders where there is no git.
copyCheckout() {
    mkdir -p "$bare/src/parhelion"
    if git -C "$root" rev-parse --git-dir >/dev/null 2>&1; then
        git -C "$root" ls-files -z --cached --others --exclude-standard |
            while IFS= read -r -d '' file; do [ ! -e "$root/$file" ] || printf '%s\0' "$file"; done |
            tar -C "$root" --null --files-from - -cf -
    else
        tar -C "$root" --exclude='./build*' --exclude='./.git' -cf - .
    fi | tar -C "$bare/src/parhelion" -xf -
    [ -d "$root/../shared" ] && cp -aL "$root/../shared" "$bare/src/shared"
    return 0
}

# inBare COMMAND...: runs it in the chroot with a clean environment (proxies kept). Its mount of /proc and its
# processes end with it: they live in namespaces of their own. Where those are not allowed it does without /proc.
inBare() {
    local proxies=() namespaces=(unshare --mount --pid --fork --kill-child --mount-proc="$bare/proc")
    mapfile -t proxies < <(env | grep -iE '^[a-z]*_proxy=' || true)
    "${namespaces[@]}" true 2>/dev/null || namespaces=()
    "${namespaces[@]}" chroot "$bare" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 "${proxies[@]}" "$@"
}

# timed WHAT COMMAND...
timed() {
    local what=$1 start=$SECONDS status=0
    shift
    "$@" || status=$?
    times+=("$what: $((SECONDS - start)) s, exit code $status")
    return "$status"
}

times=()
status=0
chooseRelease "$name"
findSources
timed "bare Debian $release" debootstrap --variant=minbase "$release" "$bare" "$mirror" >&2
copyAptConfiguration
copyCheckout
timed "tools/render (installs, builds, renders)" inBare bash -c 'cd /src && bash parhelion/tools/render' || status=$?
[ -f "$bare/src/final_cloud.png" ] && cp "$bare/src/final_cloud.png" bare_final_cloud.png && echo "picture: $PWD/bare_final_cloud.png"
timed "tools/test" inBare bash /src/parhelion/tools/test "$@" || status=$?
printf '%s\n' "${times[@]}"
exit "$status"
