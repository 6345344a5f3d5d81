#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Holds the models of an FPGA family's cells (verif/cosim/model/cells) against yosys' own models, and against RTL that yosys
# makes such cells of. With --damage, each model is damaged then, and the damage must be found.
#
# usage: verif/test/cells/run.sh ice40|ecp5 [--damage]
set -euo pipefail
family=${1:?ice40 or ecp5}
case $family in ice40) factor=6 ;; ecp5) factor=18 ;; *) echo "run.sh: $family: neither ice40 nor ecp5" >&2; exit 2 ;; esac
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
cells=$top/verif/cosim/model/cells/$family.v
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "run.sh: $family: $1" >&2; exit 1; }

# ---- yosys' own models, by other names; what they say of delays is no part of them ----
read -ra yosys <<<"${YOSYS:-yosys}"
own=${KAGE_YOSYS_SHARE:-$(dirname "$(dirname "$(realpath "$(command -v "${yosys[0]}")")")")/share/yosys}/$family/cells_sim.v
names=$(sed -nE 's/^module \\?([A-Za-z0-9_$]+).*/\1/p' "$own" | sort -u)
rename=$(for n in $names; do printf 's/(^|[^A-Za-z0-9_$"])%s\\b/\\1tool_%s/g;' "${n//$/\\$}" "${n//$/}"; done)
sed -E "s/^(module )\\\\\\$/\\1/; $rename" "$own" | grep -v '`include' | awk '/specify/ && !/endspecify/{skip=1} !skip; /endspecify/{skip=0}' >"$work/tool.v"

# ---- the netlist of pieces.sv ----
"${yosys[@]}" -q -l "$work/yosys.log" -p "read_verilog -defer -sv $top/rtl/ram_1r1w.sv $here/pieces.sv
  hierarchy -top pieces -chparam FACTOR $factor; synth_$family -top pieces; rename pieces pieces_netlist; write_verilog -noattr $work/netlist.v" \
  >/dev/null || fail "yosys failed: $(tail -1 "$work/yosys.log")"
modelled=$(sed -nE 's/^module ([A-Za-z0-9_]+).*/\1/p' "$cells")
for cell in $modelled; do
  grep -qE "^ *$cell " "$work/netlist.v" || fail "$cell: yosys makes none of pieces.sv, so RTL does not check its model"
done

# Prints what the testbenches say; true if both passed.
play() { # CELLS
  local said
  iverilog -g2012 -DNO_ICE40_DEFAULT_ASSIGNMENTS -o "$work/cells.vvp" -s cells_tb "$here/${family}_tb.sv" "$1" "$work/tool.v" 2>"$work/iverilog.log" || { cat "$work/iverilog.log"; return 1; }
  iverilog -g2012 -o "$work/pieces.vvp" -s pieces_tb -P pieces_tb.FACTOR=$factor "$here/pieces_tb.sv" "$here/pieces.sv" "$top/rtl/ram_1r1w.sv" "$work/netlist.v" "$1" \
    2>"$work/iverilog.log" || { cat "$work/iverilog.log"; return 1; }
  said=$(vvp -n "$work/cells.vvp" & vvp -n "$work/pieces.vvp"; wait)
  echo "$said"
  [ "$(grep -c '_tb: passed: ' <<<"$said")" = 2 ]
}
play "$cells" || fail "a model is not what it stands for"

# ---- damage: each defect of defects.yaml in the family's models, and a testbench must fail by it ----
n=0
[ "${2:-}" = --damage ] || { echo "run.sh: $family: $(wc -w <<<"$modelled") cells as they should be"; exit 0; }
defects=(/usr/bin/python3 -B "$top/verif/cosim/model/driver/defects.py" "$here/defects.yaml")
listed=$("${defects[@]}" list) || fail "no list of defects"
damaged=$work/verif/cosim/model/cells/$family.v
mkdir -p "$(dirname "$damaged")"
for name in $(cut -f1 <<<"$listed" | grep "^${family}_"); do
  cp "$cells" "$damaged"
  "${defects[@]}" put "$name" "$work"
  if said=$(play "$damaged"); then fail "$name is not found"; fi
  grep -q "_tb: FAILED" <<<"$said" || fail "$name does not even compile: $said"
  n=$((n + 1))
done
[ $n -gt 0 ] || fail "no defect was tried"
echo "run.sh: $family: $(wc -w <<<"$modelled") cells as they should be, $n of $n damages found"
