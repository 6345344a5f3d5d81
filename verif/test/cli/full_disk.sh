#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A disk that fills up, or a limit on the length of files, in the midst of every file that kage writes: full_disk.py.
# shellcheck disable=SC2034  # common.bash takes its arguments from the caller's
. "$(dirname "$0")/common.bash"

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# A file system of its own needs root, or a namespace in which anybody is root.
own=()
mkdir disk
if mount -t tmpfs -o size=64k tmpfs disk 2>/dev/null; then
  umount disk
  disks=yes
elif unshare -Urm sh -c 'mount -t tmpfs -o size=64k tmpfs "$1"' sh "$PWD/disk" 2>/dev/null; then
  own=(unshare -Urm)
  disks=yes
else
  echo "no tmpfs can be mounted here: files are limited in their length only"
  disks=no
fi
"${own[@]}" python3 "$here/full_disk.py" "$kage" "$source" "$disks" || fail "full_disk.py"
# Half of it was left out: ctest calls that skipped, and not passed.
[ $failures != 0 ] || [ $disks = yes ] || exit 77
done_testing
