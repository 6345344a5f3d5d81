#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# examples/cocotb without make clean: another stream or configuration is another core, however old the stream's file is, and
# what is the same is not built again. A core of another stream, if one is run, is told by its PARAM_HASH.
#
# usage: verif/test/axi/rebuild.sh BUILD WORK
# Exit code 0: as it should be. 1: not. 77: cocotb is not installed.
set -euo pipefail
build=$1 work=$2
top=$(cd "$(dirname "$0")/../../.." && pwd)
. "$top/tools/pypi.sh"
cocotb=$(pypi_folder cocotb)
[ -d "$cocotb" ] || { echo "rebuild.sh: cocotb is not installed: tools/deps axi does that"; exit 77; }
export PATH=$cocotb/bin:$PATH PYTHONPATH=$cocotb KAGE_GOLDEN=$build/lib/libkage_golden.so
unset COCOTB_TESTCASE COCOTB_TEST_MODULES KAGE_STREAM
export COCOTB_TEST_FILTER='frame/pattern=none$'
rm -rf "$work"
mkdir -p "$work"
"$build/bin/kage" stream courtyard --size 16x12 --frames 1 --config default --out "$work/mine.kage"
touch -d 2000-01-01 "$work/mine.kage"
# built NAME ARGUMENT...: the example runs, and passes; its simulation is kept as NAME.
built() {
  local name=$1
  shift
  timeout 100 make -C "$top/examples/cocotb" WORK="$work/sim" KAGE="$build/bin/kage" SIZE=16x12 "$@" >"$work/log" 2>&1 || true
  grep -q 'TESTS=1 PASS=1 ' "$work/log" || { tail -n 20 "$work/log"; echo "rebuild.sh: $*: does not pass"; exit 1; }
  cp -p "$work/sim/sim.vvp" "$work/$name"
}
built tiny
built mine KAGE_STREAM="$work/mine.kage"
built again KAGE_STREAM="$work/mine.kage"
[ ! "$work/again" -nt "$work/mine" ] || { echo "rebuild.sh: the same stream is built again"; exit 1; }
built default CONFIG=default
built tiny CONFIG=tiny
# A core of other parameters than the stream's.
if timeout 100 make -C "$top/examples/cocotb" WORK="$work/sim" KAGE_STREAM="$work/mine.kage" PARAMETERS=Z_BITS=20 >"$work/log" 2>&1 &&
  grep -q 'TESTS=1 PASS=1 ' "$work/log"; then
  echo "rebuild.sh: a core of other parameters passes"
  exit 1
fi
grep -q 'the core has PARAM_HASH [0-9a-f]*, the stream [0-9a-f]*: make clean' "$work/log" || { tail -n 20 "$work/log"; echo "rebuild.sh: a core of other parameters is not told"; exit 1; }
