#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# examples/cocotb with the pinned cocotb and cocotbext-axi (tools/deps axi): kage_axi under AXI models that are not kage's.
#
# usage: verif/test/axi/run.sh BUILD WORK CONFIG SCENE SIZE [FAULT]
#   BUILD   the folder of a build: its program kage and its libkage_golden are used
#   WORK    the folder of the simulation
#   CONFIG  a name in rtl/defs/configs.yaml or constraints/cores.yaml
#   SCENE   a built-in scene, whose first frame is drawn
#   SIZE    of the frame, such as 64x48
#   FAULT   of verif/cosim/model/faults.yaml: the RTL with this defect, which must be found; polite_ready is none, and must pass
# Exit code 0: as it should be. 1: not. 77: cocotb is not installed.
set -euo pipefail
build=$1 work=$2 config=$3 scene=$4 size=$5 fault=${6:-}
top=$(cd "$(dirname "$0")/../../.." && pwd)
. "$top/tools/pypi.sh"
cocotb=$(pypi_folder cocotb)
[ -d "$cocotb" ] || { echo "run.sh: cocotb is not installed: tools/deps axi does that"; exit 77; }
unset COCOTB_TESTCASE COCOTB_TEST_FILTER COCOTB_TEST_MODULES
export PATH=$cocotb/bin:$PATH PYTHONPATH=$cocotb KAGE_GOLDEN=$build/lib/libkage_golden.so
rm -rf "$work"
mkdir -p "$work"
"$top/tools/core_config.py" "$config" >"$work/config.yaml"
rtl=$top/rtl
if [ -n "$fault" ]; then
  cp -r "$top/rtl" "$work/rtl"
  rtl=$work/rtl
  /usr/bin/python3 -B "$top/verif/cosim/model/driver/defects.py" "$top/verif/cosim/model/faults.yaml" put "$fault" "$work"
fi
# A defect must be found, so the frame has the spans that no pixel needs, too.
[ -z "$fault" ] || scene="$scene --all-spans"
rc=0
make -C "$top/examples/cocotb" WORK="$work" RTL="$rtl" KAGE="$build/bin/kage" CONFIG="$work/config.yaml" SCENE="$scene" SIZE="$size" >"$work/log" 2>&1 || rc=$?
passed=0
# Newer cocotbs end make with an error where a test fails, older ones tell it in results.xml alone.
if [ $rc = 0 ] && [ -f "$work/results.xml" ] && ! grep -q '<failure\|<error' "$work/results.xml" &&
  grep -q 'TESTS=9 PASS=9 ' "$work/log"; then passed=1; fi
grep -E '\*\* (test_kage|TESTS)' "$work/log" | sed 's/^ *//' || true
case $fault in
  '' | polite_ready)
    [ $passed = 1 ] || { grep -m5 -B2 -A2 'Error' "$work/log" || tail -20 "$work/log"; echo "run.sh: $config${fault:+ with $fault}: failed; log: $work/log"; exit 1; }
    ;;
  *)
    [ $passed = 0 ] || { echo "run.sh: $config with the defect $fault passes"; exit 1; }
    grep -qE '^ *\*\* TESTS=[0-9]+ PASS=[0-9]+ FAIL=[1-9]|AssertionError' "$work/log" || { tail -20 "$work/log"; echo "run.sh: $config with $fault: it does not run"; exit 1; }
    grep -m1 -E '(AssertionError|SimTimeoutError)' "$work/log" | sed 's/^ *//'
    ;;
esac
