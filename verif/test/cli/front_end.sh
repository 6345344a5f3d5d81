#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage cosim --front-end rtl: a core that makes spans of polygons. It gets random frames of both levels, sound and damaged, and a
# scene. Every stage of the scene is held against the golden core: the front end's spans token by token.
. "$(dirname "$0")/common.bash"

echo '{LANES: 4, X_BITS: 6, MAX_WIDTH: 40, ACTIVE: 6}' >small.yaml
echo '{LANES: 4, X_BITS: 7, MAX_WIDTH: 80, ACTIVE: 48}' >front.yaml
expect 0 "$kage" cosim random:mixed --front-end rtl --config small.yaml --frames 120 --seed 5 --out random --json r.json
json r.json 'j["same"] and j["frames"] == 120'
expect 0 "$kage" cosim random:mixed --config small.yaml --frames 60 --seed 6 --out spans --json r.json
json r.json 'j["same"] and j["frames"] == 60 and j["config"]["ACTIVE"] == 6'
# Frames that wait for an edge while the next frame fills the reader: what moves is said to move (kage_top's first assertion).
echo '{ACTIVE: 3}' >few.yaml
expect 0 "$kage" cosim random:mixed --front-end rtl --config few.yaml --frames 100 --seed 311 --idle 30 --out few --json r.json
json r.json 'j["same"] and j["frames"] == 100'
expect 0 "$kage" cosim courtyard --front-end rtl --stages --config front.yaml --size 80x60 --frames 1 --out scene --json s.json
json s.json 'j["same"] and j["config"]["ACTIVE"] == 48'
grep -q '^courtyard: ACTIVE: ' stdout && fail "the configuration has a front end: $(cat stdout)"
# A configuration without gets one, which is told; it is the model that kage model builds with the same option.
expect 0 "$kage" cosim courtyard --front-end rtl --size 32x24 --frames 1 --out given --json g.json
grep -qx 'courtyard: ACTIVE: 512 polygons at once, since meshes has no front end' stdout || fail "ACTIVE is not told: $(cat stdout)"
json g.json 'j["same"] and j["config"]["ACTIVE"] == 512 and j["options"]["front_end"] == "rtl"'
expect 0 "$kage" model meshes --front-end rtl --json m.json
grep -q '^meshes with ACTIVE 512: .* (was there)$' stdout || fail "it is another model: $(cat stdout)"
json m.json 'j[0]["config"]["ACTIVE"] == 512'
# One EOL brings hundreds of spans of a core of one lane: it works for long without a move at its ports, and is not hung.
echo '{SMOOTH: 1, COLOR_FRAC: 8, COUNT_BITS: 4, LIGHTS: 4, CLASS_BITS: 8, SHADE_FRAC: 12, LANES: 1, MAX_WIDTH: 160, ACTIVE: 512}' >long.yaml
expect 0 "$kage" cosim three-lights --size 160x120 --frames 1 --front-end rtl --config long.yaml --out long --no-report --json l.json
json l.json 'j["same"] and j["config"]["LIGHTS"] == 4'
# Shards of unlike levels are not of one run.
expect 0 "$kage" cosim courtyard --front-end rtl --config front.yaml --size 32x24 --frames 2 --shard 1/2 --out shard --json 1.json
expect 0 "$kage" cosim courtyard --config front.yaml --size 32x24 --frames 2 --shard 2/2 --out shard --json 2.json
expect 2 "$kage" merge 1.json 2.json --json both.json
grep -q '2.json: its option front_end is host, that of 1.json is rtl' stderr || fail "shards of unlike levels are merged: $(cat stderr)"
# A defect that no pixel shows is found by the stages alone: spans of one pixel keep their step.
data_copy data
sed -i "s/single_i(single_q)/single_i(1'b0)/" data/rtl/polygon_walk.sv
! cmp -s data/rtl/polygon_walk.sv "$source/rtl/polygon_walk.sv" || fail "the RTL is not what this test edits"
expect 1 env KAGE_DATA_DIR="$PWD/data" "$kage" cosim courtyard --front-end rtl --stages --config front.yaml --size 80x60 --frames 1 --all-spans --out stage --json d.json
grep -q 'the pixels are the same, and a stage is not: output of a module$' stdout || fail "no stage: $(cat stdout)"
grep -q 'first divergence: .*rtl/polygon_walk.sv), output: .*\[40, 41)' stdout || fail "no divergence: $(cat stdout)"
json d.json 'not j["same"] and j["first_difference"]["field"] == "stage"'
# The RTL's events stand below the span that they belong to, also where several spans are made of one token.
for pixel in 40,20 40,40 20,45 60,50; do
  expect 0 "$kage" explain courtyard --front-end rtl --config front.yaml --size 80x60 --all-spans --pixel $pixel --rtl
  cat stdout
done >told
python3 - told <<'PY' || fail "what the RTL did stands elsewhere: $(cat told)"
import re, sys
shared, below, last = 0, None, ""
for line in [*open(sys.argv[1]), "       0  END"]:
    token = re.match(r" *(\d+)  ([A-Z]+)\b", line)
    if token:
        # A span, or the end of a volume, changes the state of its pixels once; IF and RESOLVE none in this configuration.
        assert below is None or below[1] == (below[0] in ("OP", "SP", "NC", "EV")), (below, token[0])
        shared += token[1] == last
        below, last = [token[2], 0], token[1]
    elif "state of a pixel" in line:
        below[1] += 1
    elif line.startswith("frame "):
        below, last = None, ""
assert shared > 3, shared
PY
# The first module that differs is named within the front end.
expect 1 "$kage" cosim courtyard --front-end rtl --config front.yaml --size 80x60 --frames 1 --out wrong --fault front_end_edge
grep -q 'first divergence: .*rtl/front_merge.sv' stdout || fail "no divergence of front_merge: $(cat stdout)"
# The place is told, by the token that the front end works on there and by what that is of.
expect 1 "$kage" cosim depths --front-end rtl --config front.yaml --size 80x60 --frames 1 --out depths --no-report --all-spans --fault front_end_edge --json c.json
json c.json '(d:=j["first_difference"]["divergence"])["module"]=="front_merge" and d["token_text"].endswith(", made by the front end") and "lower crest" in d["source"]'
done_testing
