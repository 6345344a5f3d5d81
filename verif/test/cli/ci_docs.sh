#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# docs/ci.md: its YAML is sound, its jobs do what it says of them, and so do the commands that it shows.
. "$(dirname "$0")/common.bash"

for system in github gitlab; do
  for rtl in sound broken; do
    python3 "$source/verif/test/cli/ci_docs.py" "$kage" "$source" $system $rtl ||
      { fail "docs/ci.md on $system, $rtl RTL"; tail -n 30 $system-$rtl/log; }
  done
done

mkdir bin && ln -s "$kage" bin/kage
awk '/^```sh$/ { on = 1; next } /^```$/ { on = 0 } on' "$source/docs/ci.md" >commands.sh
[ "$(wc -l <commands.sh)" = 3 ] || fail "docs/ci.md shows other commands"
expect 0 env PATH="$PWD/bin:$PATH" bash -e commands.sh
grep -q '^same: 2 scenes, 12 frames of 12 in 2 shards' stdout || fail "$(cat stdout)"
[ -s cosim.json ] && [ -s cosim.xml ] && [ -s joined/report.html ] || fail "no joined report"
done_testing
