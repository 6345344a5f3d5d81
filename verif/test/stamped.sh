#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tools/stamped.py runs a test again when anything that it reads is another, and only then. usage: stamped.sh SOURCE
set -euo pipefail
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
mkdir -p "$temp/tree/tools" "$temp/tree/rtl/include" "$temp/tree/build" "$temp/bin"
cp "$1/tools/stamped.py" "$temp/tree/tools"
cd "$temp/tree"
export XDG_CACHE_HOME=$temp/cache PATH=$temp/bin:$PATH
unset KAGE_FRESH KAGE_DATA_DIR KAGE_SHARD
echo one >rtl/a.sv
echo one >rtl/include/b.svh
echo one >other
echo one >build/program
printf '#!/bin/sh\necho 1.0\n' >"$temp/bin/a-tool"
chmod +x "$temp/bin/a-tool"
printf '#!/bin/sh\ncat "$1/rtl/a.sv" "$1/rtl/include/b.svh" "$2" >&2\ncat "$1/other" 2>/dev/null && exit 1\necho ran >>"%s/runs"\nexit ${RESULT:-0}\n' "$temp" >"$temp/bin/a-test"
chmod +x "$temp/bin/a-test"
stamped=(python3 tools/stamped.py --reads 'rtl/**' --program "$PWD/build/program" --tool 'a-tool --version' --variable KAGE_SHARD -- a-test "$PWD" "$PWD/build/program")
fail() { echo "stamped.sh: $*" >&2; exit 1; }
# runs WHETHER WHEN [RC]: whether the test runs.
runs() {
  local rc=0 before after
  touch "$temp/runs"
  before=$(wc -l <"$temp/runs")
  "${stamped[@]}" >"$temp/said" 2>&1 || rc=$?
  after=$(wc -l <"$temp/runs")
  [ "$rc" = "${3:-0}" ] || { cat "$temp/said" >&2; fail "exit code $rc $2"; }
  [ $((after - before)) = "$1" ] || { cat "$temp/said" >&2; fail "runs $((after - before)) times $2"; }
}
RESULT=1 runs 1 "where it fails" 1
runs 1 "after it failed: that leaves no stamp"
runs 0 "with the same of everything"
grep -q "^not run again, for the same 2 files, command and tools: passed on " "$temp/said" || fail "does not say so: $(cat "$temp/said")"
echo two >rtl/a.sv
runs 1 "after a file changed"
echo two >rtl/include/b.svh
runs 1 "after a header changed"
echo three >rtl/c.sv
runs 1 "after a file came"
chmod +x rtl/c.sv
runs 1 "after a file became a program"
mv rtl/c.sv rtl/d.sv
runs 1 "after a file was renamed"
echo two >build/program
runs 1 "after the program changed"
printf '#!/bin/sh\necho 1.1\n' >"$temp/bin/a-tool"
runs 1 "after a tool's version changed"
KAGE_SHARD=1/2 runs 1 "for another part"
stamped+=(more)
runs 1 "with another command"
runs 0 "with the same again"
echo two >other
runs 0 "after a file changed that it may not read"
echo '#' >>tools/stamped.py
runs 1 "after the runner changed"
KAGE_FRESH=1 runs 1 "where nothing is taken"
KAGE_FRESH=1 RESULT=1 runs 1 "where nothing is taken and it fails" 1
runs 1 "after that: a failure ends a stamp"
printf '#!/bin/sh\nexit 1\n' >"$temp/bin/a-tool"
runs 0 "with a tool that tells no version" 1
printf '#!/bin/sh\necho 1.1\n' >"$temp/bin/a-tool"
touch -d '100 days ago' "$temp/cache/kage/stamps/"*
KAGE_SHARD=5/6 runs 1 "for one more part"
[ "$(find "$temp/cache/kage/stamps" -type f | wc -l)" = 1 ] || fail "stamps of long ago stay"
runs 1 "after its stamp was dropped"
rm other
KAGE_DATA_DIR=/ runs 1 "where the data are elsewhere"
runs 0 "with the same again"
stamped[3]='rtl/no_such/**'
runs 0 "for files that there are not" 1
stamped[3]='rtl/**'
stamped[5]=$temp/runs
runs 0 "with a word that is not declared" 1
echo "passed"
