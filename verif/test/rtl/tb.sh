#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# verif/tb/kage_axi_tb.sv in Icarus Verilog: it passes with sound RTL of three configurations, and fails with a defect each of
# pixels, counters and handshake.
# usage: tb.sh SOURCE_DIR WORK_DIR
set -euo pipefail
source=$1 work=$2
rm -rf "$work" && mkdir -p "$work"
cp -r "$source/rtl" "$source/verif/tb" "$work"
cd "$work"
# run PARAM=VALUE...: the testbench's last line; its exit code is the simulation's
run() {
  local sets=() set
  for set in "$@"; do sets+=("-Pkage_axi_tb.$set"); done
  iverilog -g2012 -Irtl/include "${sets[@]}" -o tb.vvp -s kage_axi_tb rtl/*.sv rtl/kage_axi.v tb/kage_axi_tb.sv >iverilog.log 2>&1 || { cat iverilog.log; return 2; }
  timeout 60 vvp tb.vvp >vvp.log 2>&1
}
bad=0
for sets in "MAX_WIDTH=24" "BEAT_WORDS=1 MAX_WIDTH=8 LANES=1 CHANNELS=1" "ARRANGEMENT=0 MAX_WIDTH=16 SMOOTH=1" "GBR_ORDER=1 MAX_WIDTH=8" "GBR_ORDER=1 CHANNELS=1 MAX_WIDTH=8"; do
  # shellcheck disable=SC2086 # a word a parameter
  if ! run $sets || ! grep -q '^kage_axi_tb: passed: ' vvp.log; then echo "$sets: not passed"; tail -3 vvp.log; bad=1; fi
done
# defect WORDS FILE SED-EXPRESSION: the testbench says so
defect() {
  sed -i "$3" "rtl/$2"
  if cmp -s "rtl/$2" "$source/rtl/$2"; then echo "$3 changes nothing"; bad=1; fi
  if run MAX_WIDTH=24; then echo "passed with the defect $3"; bad=1; fi
  grep -q "^kage_axi_tb: FAILED: $1" vvp.log || { echo "$3: says something else"; tail -3 vvp.log; bad=1; }
  cp "$source/rtl/$2" "rtl/$2"
}
defect "a pixel is not the background" line_out.sv 's/color_q <= background_q;/color_q <= ~background_q;/'
defect "a register has another value" registers.sv "s/frames_q + 32'd1/frames_q + 32'd2/"
defect "TLAST is not on a line's last pixel" line_out.sv "s/issue_last_q <= left_q == X_BITS'(2)/issue_last_q <= left_q == X_BITS'(3)/"
# The order of a pixel's bytes is seen.
sed -i "s/{video\[7:0\], video\[23:16\], video\[15:8\]}/{video[23:16], video[7:0], video[15:8]}/" rtl/kage_axi.v
if run GBR_ORDER=1 MAX_WIDTH=24; then echo "passed with red and blue crossed"; bad=1; fi
exit $bad
