#!/usr/bin/env bash
# Holonom on a bare Debian: bookworm, trixie, sid. For each suite that is named a root file system is made by debootstrap,
# with make, git and certificates in it and nothing else, and in it, in a copy of the last commit, the targets are made.
#
#     tests/fresh_root.sh bookworm trixie sid
#
# MIRROR     where the packages come from; without it debootstrap knows (its manual page)
# TARGETS    what is made, one after the other: "paper check" without it
# COMMAND    what is run after that, without it nothing
# WITH       files and directories of this machine that the root needs as well, for instance its own certificates
# KEEP       a directory in which the roots stay, to be looked at and used again; without it they are removed
#
# It needs root rights, and debootstrap (apt-get install debootstrap).
set -eu
repository=$(cd "$(dirname "$0")/.." && pwd)

[ $# -gt 0 ] || { sed -n '2,/^set/{s/^# \{0,1\}//p}' "$0"; exit 2; }
[ "$(id -u)" = 0 ] || { echo "fresh_root.sh: a root file system takes root rights; try sudo $0 $*" >&2; exit 2; }
command -v debootstrap >/dev/null || { echo "fresh_root.sh: debootstrap is missing; apt-get install debootstrap" >&2; exit 2; }

roots=${KEEP:-$(mktemp -d)}
mkdir -p "$roots"
leave() {
  for root in "$roots"/*; do mountpoint -q "$root/proc" && umount "$root/proc"; done
  [ -n "${KEEP:-}" ] || rm -rf --one-file-system "$roots"
}
trap leave EXIT

bare_root() {    # suite, directory
  [ -e "$2/made" ] || { rm -rf --one-file-system "$2"
    debootstrap --variant=minbase --include=make,git,ca-certificates "$1" "$2" ${MIRROR:+"$MIRROR"} > "$2.log" 2>&1 ||
      { tail -n 5 "$2.log" >&2; return 1; }
    touch "$2/made"; }
  cp --dereference /etc/resolv.conf "$2/etc/resolv.conf"
  for each in ${WITH:-}; do mkdir -p "$2/$(dirname "$each")" && cp -r --dereference "$each" "$2/$(dirname "$each")/"; done
  mountpoint -q "$2/proc" || mount -t proc proc "$2/proc"
}

within() {    # directory, command: a change of root as bubblewrap needs it, which works in no chroot
  unshare --mount sh -c 'root=$1; shift
    mount --rbind "$root" "$root" && cd "$root" && mkdir -p .outside && pivot_root . .outside && umount -l .outside &&
      exec "$@"' sh "$@"
}

failed=
for suite; do
  root=$roots/$suite
  bare_root "$suite" "$root" || { failed="$failed $suite"; continue; }
  rm -rf "$root/holonom"
  git clone --quiet "$repository" "$root/holonom"
  for target in ${TARGETS-paper check}; do
    if within "$root" /usr/bin/env HOME=/root make -C /holonom "$target"; then echo "$suite: make $target passes"
    else echo "$suite: make $target fails" >&2; failed="$failed $suite"; break; fi
  done
  [ -z "${COMMAND:-}" ] || within "$root" /usr/bin/env HOME=/root sh -c "cd /holonom && $COMMAND" || failed="$failed $suite"
done
[ -z "$failed" ] || { echo "Not all passes on:$failed" >&2; exit 1; }
