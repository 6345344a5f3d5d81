#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# RTL whose own nets have other names than the monitors know: what they watch is not looked at, the rest is, and it is said.
. "$(dirname "$0")/common.bash"

data_copy data
grep -q keep_q data/rtl/line_out.sv || fail "line_out has no keep_q"
grep -q loading_q data/rtl/frame_control.sv || fail "frame_control has no loading_q"
sed -i 's/\bkeep_q\b/kept_share_q/g' data/rtl/line_out.sv
sed -i 's/\bloading_q\b/awaits_line_q/g' data/rtl/frame_control.sv
export KAGE_DATA_DIR=$PWD/data XDG_CACHE_HOME=$PWD/cache
expect 0 "$kage" cosim courtyard --size 160x120 --frames 1 --out sound
expect 1 "$kage" cosim courtyard --size 160x120 --frames 1 --all-spans --fault wrong_compare --out out --json j.json
grep -q 'not looked at: kage_top_handshakes_monitor, light_resolve_monitor$' stdout || fail "not told what is not looked at: $(cat stdout)"
json j.json 'j["first_difference"]["divergence"]["module"] == "pixel_banked" and j["first_difference"]["waveform"]'
json j.json 'any("light_resolve_monitor" in n for n in j["notes"])'
# An error of the RTL's own is one: no monitor is left out for it.
sed -i 's/kept_share_q <=/nothing_q <=/' data/rtl/line_out.sv
trouble "verilator" "$kage" cosim courtyard --size 160x120 --frames 1 --out out
done_testing
