#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The design in docs/integration.md compiles as it stands there: Verilator without a warning, and yosys where there is one.
#
# usage: template.sh SOURCE_DIR
set -euo pipefail
cd "$1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
awk '/^```systemverilog$/{on=1; next} /^```$/{on=0} on' docs/integration.md >"$work/my_design.sv"
[ "$(grep -c '^module my_design' "$work/my_design.sv")" = 1 ] || { echo "template.sh: no design in docs/integration.md" >&2; exit 1; }

lint() { verilator --lint-only -Wall -Irtl/include --top-module my_design "$1" rtl/*.sv; }
lint "$work/my_design.sv"
# The check can say no: to a port that is not there, and to one of another width.
mkdir "$work/bad"
for change in s/s_axis_tlast_i/s_axis_tend_i/ 's/\[127:0\]/[ 63:0]/' s/LANES/LANE/; do
  sed "$change" "$work/my_design.sv" >"$work/bad/my_design.sv"
  if lint "$work/bad/my_design.sv" >/dev/null 2>&1; then echo "template.sh: $change is accepted" >&2; exit 1; fi
done
if command -v yosys >/dev/null; then
  cp -r rtl "$work/rtl"
  (cd "$work" && yosys -q -p "read_verilog -sv -Irtl/include rtl/*.sv my_design.sv; hierarchy -check -top my_design; proc; check -assert")
fi
