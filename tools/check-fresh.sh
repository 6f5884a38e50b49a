#!/usr/bin/env bash
# The proof that demo.sh and test.sh need nothing but Debian 12: makes a bare debootstrap chroot, clones the committed
# state of this repository into it, and runs both there. Needs root, debootstrap and 10 GB; about 30 minutes.
#
#   tools/check-fresh.sh [--demo-only] [--keep] [FOLDER]
#
# FOLDER (default: a new one under $TMPDIR) must not exist; it is deleted at the end unless --keep is given. The package
# mirror and apt's settings are taken from the running machine.
set -euo pipefail
self=$(realpath "$0")

demo_only=false keep=false folder=
for argument in "$@"; do
    case "$argument" in
        --demo-only) demo_only=true ;;
        --keep) keep=true ;;
        -*) echo "usage: tools/check-fresh.sh [--demo-only] [--keep] [FOLDER]" >&2; exit 2 ;;
        *) folder=$(realpath -m "$argument") ;;
    esac
done

die() { echo "check-fresh: $*" >&2; exit 1; }
[ "$(id -u)" -eq 0 ] || die "run it as root: it makes a chroot"
command -v debootstrap >/dev/null || die "debootstrap is missing: apt-get install debootstrap"
if [ -z "${CHECK_FRESH_INSIDE:-}" ]; then
    # A mount namespace of our own: nothing mounted below outlives this script.
    CHECK_FRESH_INSIDE=1 exec unshare --mount --propagation private "$self" "$@"
fi
folder=${folder:-${TMPDIR:-/tmp}/xorvox-fresh-$$}
[ ! -e "$folder" ] || die "$folder exists already; name a folder that does not"
unmount() {
    local mounted
    for mounted in $(awk -v root="$folder/" 'index($2, root) == 1 { print $2 }' /proc/self/mounts | sort -r); do
        umount "$mounted" || umount --lazy "$mounted"
    done
}
finish() {
    unmount
    if $keep; then
        echo "check-fresh: kept $folder"
    else
        rm -rf --one-file-system "$folder"
    fi
}
trap finish EXIT
mkdir -p "$folder"
cd "$(dirname "$self")/.."
free_kib=$(df --output=avail -k "$folder" | tail -n 1)
[ "$free_kib" -gt $((10 * 1024 * 1024)) ] || die "$folder has $((free_kib / 1024)) MiB free; 10 GB are needed"

# "SITE CODENAME COMPONENT" of every Debian archive that this machine uses.
archives=$(apt-get indextargets --format '$(ORIGIN) $(SITE) $(CODENAME) $(COMPONENT)' 'Identifier: Packages' |
    awk '$1 == "Debian" && $3 ~ /^bookworm/ { print $2, $3, $4 }' | sort -u)
mirror=$(awk '$2 == "bookworm" { print $1; exit }' <<<"$archives")
[ -n "$mirror" ] || die "apt on this machine knows no Debian bookworm archive (apt-get update first)"

echo "== a bare Debian 12 in $folder"
start=$SECONDS
log=$(mktemp)
debootstrap --variant=minbase bookworm "$folder" "$mirror" >"$log" 2>&1 || { tail "$log" >&2; die "debootstrap failed; its output is in $log"; }
rm -f "$log"
awk '{ print "deb", $1, $2, $3 }' <<<"$archives" >"$folder/etc/apt/sources.list"
cp -a /etc/apt/apt.conf.d/. "$folder/etc/apt/apt.conf.d/"
for file in /etc/apt/auth.conf /etc/resolv.conf /etc/hosts; do
    [ ! -e "$file" ] || cp -L "$file" "$folder$file"
done
printf '#!/bin/sh\nexit 101\n' >"$folder/usr/sbin/policy-rc.d"  # no service starts
chmod +x "$folder/usr/sbin/policy-rc.d"
mount -t proc proc "$folder/proc"
mount -t devpts devpts "$folder/dev/pts"
mount -t tmpfs tmpfs "$folder/tmp"
mount -t tmpfs tmpfs "$folder/dev/shm"
git clone --quiet --no-hardlinks . "$folder/root/xorvox"
echo "   $((SECONDS - start)) s"

inside() {
    chroot "$folder" /usr/bin/env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
        CI="${CI:-}" ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
        bash -c "cd /root/xorvox && $*"
}
echo "== tools/demo.sh"
start=$SECONDS
inside tools/demo.sh
[ -s "$folder/root/xorvox/build/demo.png" ] || die "the demo left no picture"
echo "   $((SECONDS - start)) s"
echo "== tools/demo.sh again changes nothing"
again=$(inside tools/demo.sh)
grep -q '^packages: all' <<<"$again" || die "the second demo installed packages again"
if ! $demo_only; then
    echo "== tools/test.sh"
    start=$SECONDS
    inside 'XORVOX_REQUIRE=gl,embedded tools/test.sh'
    echo "   $((SECONDS - start)) s"
fi
[ -z "$(git -C "$folder/root/xorvox" status --porcelain)" ] || die "the two commands changed files of the repository"
echo "check-fresh: passed"
