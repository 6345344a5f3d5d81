#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# RTL whose registers do not answer, or that ends the simulation while they are asked, is "different", in a frame and
# behind it, by kage cosim and kage regress.
. "$(dirname "$0")/common.bash"

data_copy data
echo '{MAX_WIDTH: 16, X_BITS: 5, LANES: 2, BEAT_WORDS: 1}' >small.yaml
export KAGE_DATA_DIR=$PWD/data XDG_CACHE_HOME=$PWD/cache
mixed=(random:mixed --frames 8 --config small.yaml)

# defect TEXT WITH: a change of the registers' RTL.
defect() {
  cp "$source/rtl/registers.sv" data/rtl/
  python3 - "$@" <<'PY'
import pathlib, sys
path = pathlib.Path("data/rtl/registers.sv")
text = path.read_text()
assert text.count(sys.argv[1]) == 1, sys.argv[1]
path.write_text(text.replace(sys.argv[1], sys.argv[2]))
PY
}

# No read is ever answered.
defect 'if (s_axil_arvalid_i && s_axil_arready_o) s_axil_rvalid_o <= 1' 'if (s_axil_arvalid_i && s_axil_arready_o) s_axil_rvalid_o <= 0 & 1'
expect 1 "$kage" cosim "${mixed[@]}" --out out --json r.json --junit r.xml --annotate github
grep -q '^first difference: frame 0: register FRAMES (0x30) does not answer$' stdout || fail "not told: $(cat stdout)"
grep -q '^::error title=.*::frame 0: register FRAMES (0x30) does not answer$' stdout || fail "no annotation: $(cat stdout)"
json r.json 'not j["same"] and j["first_difference"]["field"] == "register" and not j["first_difference"]["searched"] and j["kept"] is None'
grep -q '<failure .*register FRAMES (0x30) does not answer' r.xml || fail "JUnit does not tell it: $(cat r.xml)"
[ -s out/report.html ] || fail "no page"
expect 1 "$kage" cosim courtyard --size 16x12 --frames 1 --config small.yaml --out out
expect 1 "$kage" regress --rounds 1 --config small.yaml --out regress --json g.json
grep -q 'register FRAMES (0x30) does not answer$' stdout || fail "not told: $(cat stdout)"
json g.json 'not j["same"] and j["first_difference"]["field"] == "register"'

# No write is: only the check behind the frames writes.
defect 'assign write = aw_held_q' "assign write = rst_ni == 0 && aw_held_q"
expect 1 "$kage" cosim "${mixed[@]}" --no-report --out out --json w.json
grep -q ' does not answer' stdout || fail "not told: $(cat stdout)"
json w.json 'not j["same"] and j["first_difference"]["field"] == "register"'

# $finish while a register is read, in a frame, and while one is written.
for condition in 's_axil_rvalid_o && s_axil_rready_i && frames_q == 2' 'write && aw_addr_q == RegWatchdog'; do
  defect '  // ---- read channel -' "  always_ff @(posedge clk_i) if ($condition) \$finish;
  // ---- read channel -"
  expect 1 "$kage" cosim "${mixed[@]}" --no-report --no-shrink --out out --json f.json
  grep -q '^first difference: .*the RTL ends the simulation by \$finish' stdout || fail "$condition: not told: $(cat stdout)"
  json f.json 'not j["same"] and j["first_difference"]["field"] == "finish"'
done
expect 1 "$kage" regress --rounds 1 --config small.yaml --no-divergence --out regress
no_leftovers
done_testing
