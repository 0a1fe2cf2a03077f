#!/bin/sh
# Runs a command in a bare Debian 12: mmdebstrap's minbase, with git, sudo and certificates and nothing else.
# The commit of this tree is cloned into its home folder first.
#
# usage: bare_root.sh [--user] [--keep FOLDER] [--copy FILE]... [--out FOLDER] COMMAND...
#   --user         as a plain user who may sudo, not as root
#   --keep FOLDER  the root is this folder; made if there is none, and left there
#   --copy FILE    into the home folder, beside the clone
#   --out FOLDER   gets the clone's folder out/ afterwards
# Needs root and mmdebstrap. Exit status: the command's. Example: tests/fresh/bare_root.sh --user ./demo.sh
set -eu
# In a mount namespace of its own: what is mounted below is seen by nothing else, and is gone at the end whatever happens.
[ -n "${BARE_ROOT_INSIDE:-}" ] || BARE_ROOT_INSIDE=yes exec unshare --mount "$0" "$@"
top=$(cd "$(dirname "$0")/../.." && pwd)
user=root home=/root keep="" copies="" out=""
while [ $# -gt 0 ]; do
    case $1 in
    --user) user=miller home=/home/miller && shift ;;
    --keep) keep=$2 && shift 2 ;;
    --copy) copies="$copies $2" && shift 2 ;;
    --out) out=$2 && shift 2 ;;
    *) break ;;
    esac
done
[ $# -gt 0 ] || { sed -n 's/^# usage: /usage: /p' "$0" >&2; exit 2; }
[ "$(id -u)" = 0 ] || { echo "bare_root: only root can make a root folder" >&2; exit 2; }

root=${keep:-$(mktemp -d)/root}
leave() {
    umount "$root/dev/pts" "$root/proc" 2>/dev/null || true
    [ -n "$keep" ] || rm -rf --one-file-system "$(dirname "$root")"
}
trap leave EXIT

if [ ! -d "$root/etc" ]; then
    # The sources of this machine: where it gets its packages, the bare one can.
    sources=/etc/apt/sources.list.d/debian.sources
    [ -f "$sources" ] || sources=/etc/apt/sources.list
    # A root that goes again need not wait for its disk after each file.
    mmdebstrap --quiet --variant=minbase --dpkgopt=force-unsafe-io --include=ca-certificates,git,sudo bookworm "$root" "$sources"
fi
# The root has device nodes of its own, from mmdebstrap: this machine's /dev is never reached from it.
mount -t proc proc "$root/proc"
mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"

if [ "$user" != root ]; then
    chroot "$root" useradd --create-home --shell /bin/bash "$user" 2>/dev/null || true
    echo "$user ALL=(ALL) NOPASSWD:ALL" >"$root/etc/sudoers.d/$user"
fi
rm -rf "$root$home/cusp"
git -c safe.directory='*' clone -q --no-hardlinks "$top" "$root$home/cusp"
for file in $copies; do
    cp "$file" "$root$home/"
done
chroot "$root" chown -R "$user" "$home"
status=0
chroot "$root" su - "$user" -c "cd cusp && TERM=dumb $*" || status=$?
if [ -n "$out" ]; then
    mkdir -p "$out"
    cp -r "$root$home/cusp/out/." "$out/"
fi
exit $status
