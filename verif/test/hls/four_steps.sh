#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# docs/hls/four-steps.md shows what its commands print: each ```sh block is run, and the block behind it is held against
# that.
#
# usage: verif/test/hls/four_steps.sh [PAGE]
# Exit 0: the same; 1: not; 2: the page has too few commands; 77: no clang 14, which the commands need.
set -euo pipefail
[ "${1:-}" != --help ] || { sed -n '3,7s/^# \{0,1\}//p' "$0"; exit 0; }
cd "$(dirname "$0")/../../.."
page=${1:-docs/hls/four-steps.md}
command -v clang-14 >/dev/null || command -v clang++-14 >/dev/null || { echo "four_steps.sh: skipped: no clang 14"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Blocks as files 1, 2, ...; commands and what they print take turns.
awk -v to="$work" '
  /^```/ { if (open) { close(to "/" n); open = 0 } else { open = 1; print substr($0, 4) > (to "/" ++n ".kind"); printf "" > (to "/" n) } next }
  open { print > (to "/" n) }' "$page"
tried=0 bad=0
for ((i = 1; ; i += 2)); do
  [ -f "$work/$i" ] || break
  read -r kind <"$work/$i.kind"
  if [ "$kind" != sh ] || [ ! -f "$work/$((i + 1))" ]; then
    echo "four_steps.sh: $page: block $i is no command with its text behind it" >&2
    exit 2
  fi
  tried=$((tried + 1))
  if ! bash -euo pipefail "$work/$i" >"$work/printed"; then
    echo "four_steps.sh: $page: this fails: $(cat "$work/$i")" >&2
    bad=1
  elif ! diff -u --label "$page" --label printed "$work/$((i + 1))" "$work/printed" >&2; then
    echo "four_steps.sh: $page: this prints another text: $(cat "$work/$i")" >&2
    bad=1
  fi
done
rc=0
tools/hls steps no_such >"$work/printed" 2>"$work/said" || rc=$?
if [ $rc != 2 ] || [ -s "$work/printed" ] || ! grep -q '^tools/hls: no_such: none of the kernels .*edge_step' "$work/said"; then
  echo "four_steps.sh: tools/hls steps no_such: exit code $rc, $(cat "$work/said")" >&2
  bad=1
fi
[ $tried -ge 6 ] || { echo "four_steps.sh: $page: $tried commands, fewer than the steps are" >&2; exit 2; }
[ $bad = 1 ] || echo "$tried commands print what the page has"
exit $bad
