#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage explain: the history of a pixel, in words and JSON, of scenes and streams, with the RTL beside it; bad input.
. "$(dirname "$0")/common.bash"

# An obelisk's edge: drawn, a cap that ties and one behind, the end of the volume, RESOLVE.
expect 0 "$kage" explain courtyard --config default --all-spans --pixel 316,116 --json e.json
grep -q 'tokens touch it' stdout || fail "no count of tokens"
grep -q 'from obelisk, face 12' stdout || fail "the span's object and face are missing"
grep -q 'from the cap of the shadow of obelisk, face 10, light 0' stdout || fail "the shadow's object is missing"
grep -q 'no nearer: equal, and the first stays' stdout || fail "the tie is not told"
json e.json '(j["frame"],j["x"],j["y"])==(0,316,116) and [t["kind"] for t in j["touches"]]==["OP","SP","SP","EV","RESOLVE"]'
json e.json 'j["touches"][0]["source"]["object"]=="obelisk" and j["touches"][0]["after"]["color"]==j["color"] and j["rtl"] is None'
json e.json 'all(a["after"]==b["before"] for a,b in zip(j["touches"],j["touches"][1:]))'
json e.json 'j["left_out"] is None'

# Without --all-spans: what is left out at the pixel, and why. Kept and left out are together what --all-spans shows, but
# for shadow spans that need no comparison, which come together as NC and IF.
left_out() { # SCENE PIXEL
  expect 0 "$kage" explain "$1" --config default --degrade --size 160x120 --frames 1 --pixel "$2" --json kept.json
  cp stdout kept.txt
  expect 0 "$kage" explain "$1" --config default --degrade --size 160x120 --frames 1 --pixel "$2" --all-spans --json all.json
  python3 - kept.json all.json kept.txt >left <<'PY' || fail "$1, pixel $2: tokens are lost, or told that are not"
import collections, json, sys
kept, every = (json.load(open(f)) for f in sys.argv[1:3])
assert kept["color"] == every["color"] and every["left_out"] is None
of = lambda j: collections.Counter(t["kind"] for t in j["touches"])
left, text = collections.Counter(), open(sys.argv[3]).read()
for l in kept["left_out"]:
    left[l["kind"]] += l["tokens"]
    assert f"{l['tokens']} {l['kind']}: {l['why']}\n" in text
for kind in ("OP", "SP", "TP", "EV", "ES", "RESOLVE"):
    assert of(every)[kind] == of(kept)[kind] + left[kind], (kind, of(every), of(kept), left)
behind = lambda j: sum(t["kind"] == "SP" and t["effect"].startswith("not counted") for t in j["touches"])
told = sum(l["tokens"] for l in kept["left_out"] if l["kind"] == "SP" and l["why"] == "not before what is drawn")
assert told == behind(every) - behind(kept), (told, behind(every), behind(kept))
assert ("left out" in text) == bool(left)
print(sum(left.values()))
PY
}
some=0
for pixel in 20,60 80,60 80,75 140,60 80,20 80,100 3,3; do
  for scene in courtyard penumbra glass three-lights; do
    left_out $scene $pixel
    some=$((some + $(cat left)))
  done
done
[ $some -gt 50 ] || fail "only $some tokens were left out"
expect 0 "$kage" explain courtyard --config default --pixel 316,116 --json e.json
json e.json '[t["kind"] for t in j["touches"]]==["OP"] and {"SP","EV","RESOLVE"}=={l["kind"] for l in j["left_out"]}'
expect 0 "$kage" explain courtyard --config default --all-spans --pixel 316,116 --json e.json

# A stream says the same but for the names.
expect 0 "$kage" stream courtyard --config default --all-spans --frames 8 --out c.kage
expect 0 "$kage" explain c.kage --pixel 316,116 --json s.json
python3 - e.json s.json <<'PY' || fail "a stream's history is not its scene's"
import json, sys
a, b = (json.load(open(f))["touches"] for f in sys.argv[1:])
for t in a + b: t.pop("source")
sys.exit(a != b)
PY

# The path through the tree.
expect 0 "$kage" explain polyhedra --config polyhedra --pixel 320,200
grep -q 'level 3: Z [0-9]* of index [0-9]* against nothing: the first wins' stdout || fail "no path through the tree"
grep -q 'by segments' stdout || fail "the polyhedron has no name"

# Beside the RTL: all the same, and with a defect the token that it shows at.
expect 0 "$kage" explain courtyard --config default --all-spans --pixel 316,116 --rtl --json r.json
json r.json 'len(j["rtl"])>=6 and all(t["same"] for t in j["rtl"])'
expect 0 "$kage" explain courtyard --config default --pixel 316,116 --rtl --all-spans --fault wrong_compare --json r.json
json r.json '[t["token"] for t in j["rtl"] if not t["same"]][0]==j["touches"][2]["token"]'
grep -q 'differs' stdout || fail "the difference is not marked"
expect 1 "$kage" explain courtyard --config default --pixel 316,116 --rtl --check --all-spans --fault wrong_compare --json r.json
expect 0 "$kage" explain courtyard --config default --pixel 316,116 --rtl --check --json sound.json
expect 1 "$kage" explain courtyard --config default --pixel 316,116 --rtl --check --all-spans --fault wrong_compare --changes
trouble "--check requires --rtl" "$kage" explain courtyard --pixel 316,116 --check

# Only what changed something: the same tokens but for those that left all as it was; and those at which the RTL differs.
expect 0 "$kage" explain penumbra --config soft --all-spans --size 160x120 --frames 1 --pixel 80,75 --json whole.json
expect 0 "$kage" explain penumbra --config soft --all-spans --size 160x120 --frames 1 --pixel 80,75 --changes --json changes.json
python3 - whole.json changes.json stdout <<'PY' || fail "--changes does not show what changed something"
import json, sys
w, c = (json.load(open(f)) for f in sys.argv[1:3])
bias, changed = 0, []
for t in w["touches"]:
    if t["before"] != t["after"] or t["kind"] == "IF": changed.append(t)
assert c["touches"] == changed and 3 < len(changed) < len(w["touches"]) / 2, (len(changed), len(w["touches"]))
assert c["tokens"] == w["tokens"] == len(w["touches"]) and (w["changes_only"], c["changes_only"]) == (False, True) and c["color"] == w["color"]
text = open(sys.argv[3]).read()
assert f"{len(w['touches'])} tokens touch it; {len(changed)} are shown, where something changed\n" in text
assert all(("\n%8d  " % t["token"] in text) == (t in changed) for t in w["touches"]) and c["color_text"] in text
PY
# The RTL's work at tokens that do not touch the pixel is shown too: a line's first TP paints beside its span as well.
beside=0
for pixel in 20,60 80,60 140,60 80,20 80,100; do
  expect 0 "$kage" explain glass --size 160x120 --pixel $pixel --rtl --json r.json
  lines=$(grep -c '^            RTL, ' stdout)
  json r.json "len(j['rtl'])==$lines and all(isinstance(t['load'], bool) for t in j['rtl'])"
  beside=$((beside + $(grep -c '^            RTL, token ' stdout || true)))
done
[ $beside -gt 0 ] || fail "no pixel that is painted by a token that does not touch it"
expect 0 "$kage" explain courtyard --config default --pixel 316,116 --rtl --all-spans --fault wrong_compare --changes --json r.json
json r.json 'j["tokens"]==5 and [t["kind"] for t in j["touches"]]==["OP","SP","EV","RESOLVE"][:len(j["touches"])] and len(j["touches"])>=2'
grep -q 'differs' stdout || fail "--changes hides the difference"
for o in "--fault wrong_compare" "--idle 30" "--backpressure 30"; do
  trouble "${o%% *}: the RTL is run with --rtl only" "$kage" explain courtyard --pixel 316,116 $o
done
# With stalls: the same values, later.
expect 0 "$kage" explain courtyard --config default --pixel 316,116 --rtl --json fast.json
expect 0 "$kage" explain courtyard --config default --pixel 316,116 --rtl --backpressure 60 --json slow.json
python3 - fast.json slow.json <<'PY' || fail "--backpressure does not stall the RTL"
import json, sys
a, b = (json.load(open(f))["rtl"] for f in sys.argv[1:])
assert [t["text"] for t in a] == [t["text"] for t in b] and all(t["same"] for t in b)
assert all(s["cycle"] >= f["cycle"] for f, s in zip(a, b)) and b[-1]["cycle"] > a[-1]["cycle"]
PY

trouble "316;116" "$kage" explain courtyard --pixel "316;116"
trouble "-1,0" "$kage" explain courtyard --pixel=-1,0
trouble "1,2,3" "$kage" explain courtyard --pixel 1,2,3
trouble "640,0" "$kage" explain courtyard --pixel 640,0
trouble "--frame 8" "$kage" explain c.kage --frame 8 --pixel 0,0
trouble "--pixel" "$kage" explain courtyard
expect 0 "$kage" explain courtyard --pixel 0,0
grep -q 'pixel 0,0: [01] token' stdout || fail "what touches the background is not counted"
# info writes a frame's background as explain writes colours.
for config in default tiny; do
  expect 0 "$kage" stream courtyard --degrade --config $config --size 150x40 --frames 1 --out b.kage
  expect 0 "$kage" explain b.kage --pixel 0,0 --json b.json
  expect 0 "$kage" info b.kage --tokens 0
  color=$(python3 -c 'import json; j = json.load(open("b.json")); print(*j["color"], sep=",") if not j["touches"] else exit(1)') || fail "a pixel that something covers"
  grep -q "^ *0  header: 150x40, background $color, frame number 0$" stdout || fail "info does not give the background as $color: $(grep background stdout)"
done
trouble nowhere/e.json "$kage" explain courtyard --pixel 0,0 --json nowhere/e.json
done_testing
