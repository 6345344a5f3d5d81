#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A pack of kage vectors is played by Icarus Verilog and Verilator, and a core that is wrong fails it by name; --cover takes the
# frames that reach most of the RTL's lines.
. "$(dirname "$0")/common.bash"
. "$source/verif/test/cli/packs.bash"
make p courtyard --size 16x12 --frames 2 --config default

# ---- played: by Icarus Verilog, at both tops, with stalls and without ----
played() { # FOLDER RTL TEXT ARGUMENT...: by Icarus Verilog; the last line has TEXT, and no assertion fails in a sound core
  local folder=$1 rtl=$2 text=$3 last
  shift 3
  (cd "$folder" && iverilog -g2012 ${define:+-D$define} -I "$rtl/include" -o pack.vvp kage_pack_tb.v "$rtl"/*.sv "$rtl/kage_axi.v" >build 2>&1 &&
    vvp -N pack.vvp "$@" >said 2>&1)
  last=$(grep '^kage_pack_tb: ' "$folder/said" | tail -n1)
  [[ $last == "kage_pack_tb: $text"* ]] || { fail "$folder $*: not '$text': $last"; tail -n5 "$folder/build" "$folder/said"; }
  [ "$rtl" != "$source/rtl" ] || ! grep ^ERROR "$folder/said" || fail "$folder $*: an assertion fails"
}
played p "$source/rtl" "passed: "
played p "$source/rtl" "passed: " +seed=3 +stall=40 +capture=captured.hex
expect 0 "$kage" vectors --compare p p/captured.hex
define=KAGE_PACK_TOP played p "$source/rtl" "passed: " +seed=4 +stall=10
# A stream of polygons, by a core with a front end, and malformed frames of both levels.
echo '{LANES: 4, X_BITS: 6, MAX_WIDTH: 40, ACTIVE: 16}' >front.yaml
expect 0 "$kage" stream courtyard --size 32x24 --frames 1 --config front.yaml --level polygons --out front.kage
make f front.kage
for error in ': RANGE' ', of polygons: RANGE' ', of polygons: PLACE' ', of polygons: ACTIVE_FULL'; do
  json f/manifest.json "any(f['what'] == 'malformed$error' for f in j['frames'])"
done
played f "$source/rtl" "passed: " +seed=5 +stall=20
# Random frames of both levels.
make r random:mixed --frames 6 --config front.yaml --front-end rtl --seed 5
played r "$source/rtl" "passed: " +seed=5 +stall=20
expect 0 "$kage" vectors random:mixed --frames 30 --config front.yaml --front-end rtl --cover --out both --json both.json
json both.json 'all(sum(part in p for p in j["lines_of_rtl"]["reached"]) > 5 for part in ("front_merge.sv", "polygon_walk.sv", "volume_ends.sv"))'
# Every named configuration, where what is not known is X; with Icarus Verilog 11 from such a copy as docs/vectors.md says.
cp -r "$source/rtl" star
sed -i 's/\balways_comb\b/always @*/' star/*.sv
mapfile -t configs < <("$kage" list configs)
for config in "${configs[@]}"; do
  make "c_$config" random:mixed --frames 2 --config "$config" --seed 5 --no-rtl
  played "c_$config" "$PWD/star" "passed: " +seed=5 +stall=20
  if grep -m 1 ^ERROR "c_$config/said"; then fail "$config: an assertion fails"; fi
done
# The very lines of the pack's README and of docs/vectors.md, by both simulators; Verilator's program is slow, but soon made.
lines_of() { sed -n '/^iverilog .*kage_pack_tb/p; /^verilator /p; /^obj_dir/p' "$1"; }
lines_of p/README.md >lines
[ "$(wc -l <lines)" = 3 ] || fail "the pack's README does not say how to run it: $(cat lines)"
lines_of "$source/docs/vectors.md" | cmp -s - lines || fail "docs/vectors.md and the pack's README say different lines"
sed -i "s,RTL/,$source/rtl/,g; s/--binary/& -CFLAGS -O0/" lines
(cd p && bash -e ../lines >said 2>build)
[ "$(grep -c '^kage_pack_tb: passed: ' p/said)" = 2 ] || { fail "the README's lines: $(grep '^kage_pack_tb' p/said)"; tail -n5 p/build; }
# A netlist of the least core, whose file takes the RTL's place. The testbench itself is Verilog-2005, where slang is.
make t random:mixed --frames 3 --config tiny --seed 5 --no-rtl
sets=$(python3 -c 'import yaml; print(*(f"-chparam {k} {v}" for k, v in yaml.safe_load(open("'"$source"'/rtl/defs/configs.yaml"))["tiny"].items()))')
yosys -q -p "read_verilog -defer -sv -I$source/rtl/include $source/rtl/*.sv; hierarchy -top kage_top $sets; proc; flatten; opt; rename -top kage_top; write_verilog -noattr t/net.v" >t/build 2>&1
(cd t && iverilog -g2005 -DKAGE_PACK_NETLIST -o pack.vvp kage_pack_tb.v net.v >>build 2>&1 && vvp -N pack.vvp +seed=2 +stall=20 >said 2>&1)
grep -q '^kage_pack_tb: passed: ' t/said || { fail "a netlist: $(tail -n3 t/said)"; tail -n5 t/build; }
# Where files are missing nothing passes.
mkdir bare
(cd bare && vvp -N ../p/pack.vvp) >said 2>&1
grep -q '^kage_pack_tb: FAILED: a .hex file is missing or short' said || fail "a testbench without its files: $(tail -n1 said)"
cp -r p cut && head -n 4 p/registers.hex >cut/registers.hex
played cut "$source/rtl" "FAILED: a .hex file is missing or short"
# In C the tables compile as they are.
echo '#include "p/kage_pack.h"
int main(void) { return kage_pack_frames[0].width == 16 && kage_pack_signatures[0] && kage_pack_registers[0].address ? 0 : 1; }' >c.c
${CC:-cc} -std=c99 -Wall -Wextra -Werror -o c c.c && ./c || fail "kage_pack.h does not serve C"

# ---- a wrong core is found by name ----
wrong() { # FOLDER FILE EDIT: the RTL with this edit (of sed), which has to change the file
  cp -r "$source/rtl" "$1"
  sed -i "$3" "$1/$2"
  if cmp -s "$source/rtl/$2" "$1/$2"; then fail "$1: nothing was edited"; fi
}
wrong wrong include/kage_pixel_next.svh 's/in_front = z < /in_front = z <= /'
make w courtyard --size 64x48 --frames 1 --config default --all-spans --sound-only
played w "$PWD/wrong" "FAILED: frame 0, line "
[ "$(grep -c '^kage_pack_tb: ' w/said)" = 1 ] || fail "more than one line tells of failures: $(cat w/said)"
grep -q 'channel 0: expected [0-9]*, got [0-9]*, clock [0-9]*$' w/said || fail "the pixel is not told: $(cat w/said)"
wrong wrong5 kage_axi.v 's/assign m_axis_tdata = video;/assign m_axis_tdata = m_axis_tready ? video : ~video;/'
played w "$PWD/wrong5" "FAILED: frame 0, line 0, x " +seed=1 +stall=50
grep -q 'a pixel that waits changes or goes, clock' w/said || fail "a pixel that changes while it waits is not told: $(cat w/said)"
wrong wrong2 registers.sv 's/RegErrorToken: value = error_token_q/RegErrorToken: value = error_frame_q/'
played p "$PWD/wrong2" "FAILED: behind frame "
wrong wrong3 line_out.sv 's/first_q <= line\.first;/first_q <= 1;/'
played p "$PWD/wrong3" "FAILED: frame 0, line 1, x 0: expected TUSER 0 TLAST 0, got 1 0"
wrong wrong4 line_out.sv 's/assign next_begun = .*/assign next_begun = 1'"'b0;/"
played p "$PWD/wrong4" "FAILED: nothing moves: frame 0, line 0, x 0 is missing"

# ---- other packs: random frames, and the lines that a budget takes ----
make r random:mixed --frames 6 --config tiny --seed 5
played r "$source/rtl" "passed: " +seed=1 +stall=30
make b courtyard --size 64x48 --frames 2 --config default --budget 20000
played b "$source/rtl" "passed: " +seed=2 +stall=20

# ---- frames that reach what all reach: fewer than all, and each reaches something ----
expect 0 "$kage" vectors random:mixed --frames 40 --config tiny --cover --out cover --json cover.json
json cover.json 'j["frames"] < 25 and j["malformed"] > 3 and len(j["lines_of_rtl"]["reached"]) > 300'
json cover.json 'any("registers.sv" in p for p in j["lines_of_rtl"]["unreached"]) and not set(j["lines_of_rtl"]["reached"]) & set(j["lines_of_rtl"]["unreached"])'
expect 0 "$kage" vectors --check cover
no_leftovers
done_testing
