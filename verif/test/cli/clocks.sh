#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage info STREAM --clocks: clocks by design are those that the RTL takes, for the core that --config names; what else
# the options may not say.
. "$(dirname "$0")/common.bash"

expect 0 "$kage" stream courtyard --frames 2 --size 64x48 --config default --out c.kage
printf 'LANES: 1\nMAX_WIDTH: 64\nBEAT_WORDS: 1\n' >narrow.yaml
printf 'LANES: 1\nMAX_WIDTH: 32\n' >short.yaml

# The clocks by design are the most that the RTL takes, but for what overlaps with no other line. Behind the tokens of the line
# that all others wait for, its own pixels leave: a width. Before the first frame the lanes are swept. Header and last pixels
# take 12 clocks at most (docs/rtl.md).
# A token counts as long as its words or its groups take, whichever is more. The words of one may come while the groups of
# another are at work, so the RTL takes at least half of that sum: the greater of all words and all groups.
within() { # STREAM OPTION...
  local stream=$1
  shift
  expect 0 "$kage" info "$stream" --clocks "$@" --json info.json
  expect 0 "$kage" cosim "$stream" "$@" --no-report --json run.json
  python3 - "$stream $*" <<'PYTHON' || fail "$stream $*: clocks by design and clocks of the RTL"
import json, sys
clocks, run = json.load(open("info.json"))["clocks"], json.load(open("run.json"))
design, c = clocks["worst_frame"], run["config"]
sweep = -(-c["MAX_WIDTH"] // (c["LANES"] if c["ARRANGEMENT"] else 1))
frames = [f["cycles"] for f in run["each"]]
rtl = max(frames[0] - sweep, *frames[1:])
print(f"{sys.argv[1]}: {design} by design, RTL {rtl}")
sys.exit(not design / 2 <= rtl <= design + run["width"] + 12)
PYTHON
}
within c.kage
for of in "glass glass" "glass glasslights" "three-lights systoliclights" "polyhedra polyhedra" "penumbra soft"; do
  expect 0 "$kage" stream ${of% *} --config ${of#* } --degrade --frames 2 --size 64x48 --out ${of#* }.kage
  within ${of#* }.kage
done
within c.kage --config narrow.yaml
json info.json 'j["clocks"]["config"]["LANES"]==1 and j["clocks"]["frames"]==2 and j["clocks"]["height"]==48'
json info.json 'j["clocks"]["mean_line"]<=j["clocks"]["worst_window"]["clocks_each"]<=j["clocks"]["worst_line"]["clocks"]<=j["clocks"]["worst_frame"]'
expect 0 "$kage" info c.kage --clocks
grep -q '^clocks of a line at most (LANES 8, BEAT_WORDS 4): mean [0-9]*, worst [0-9]* (line [0-9]* of frame [01]), worst 16 neighbours [0-9]* each$' stdout ||
  fail "no clocks in: $(cat stdout)"

trouble "c.kage: frame 0 is 64 pixels wide; the configuration's MAX_WIDTH is 32" "$kage" info c.kage --clocks --config short.yaml
trouble "c.kage: full: SMOOTH is 1, the stream's is 0" "$kage" info c.kage --clocks --config full
trouble "--config: kage info takes it with --clocks" "$kage" info c.kage --config full
trouble "courtyard: --clocks: only a stream file has tokens that take clocks" "$kage" info courtyard --clocks
done_testing
