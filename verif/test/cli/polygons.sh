#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Frames at the polygon level from outside: what info, diff and explain say of a stream whose frame is made by hand, and
# --front-end of random frames.
. "$(dirname "$0")/common.bash"

KAGE_GOLDEN=$(dirname "$kage")/../lib/libkage_golden.so
export KAGE_GOLDEN
expect 0 python3 "$source/verif/test/cli/polygons.py" "$source"

expect 0 "$kage" info polygons.kage --tokens 0
for line in 'tokens: SHADE 1 NC 1 EOL 6 END 1 POLYGON 2 EDGE 4 AT 3' \
  'level: 1 frame at the polygon level, 5 of the spans made of polygons, 2 polygons at once at most' \
  '       0  header: 16x6, background 0,0,0, frame number 0, at the polygon level' \
  '       3  AT layer 0 sample 0 light 0 volume 0 rank 0' \
  '       4  POLYGON value 1000 right 2 down 3 color 200,100,50 w +0 alpha 0 lit' \
  '       5  EDGE side 0 last (2, 1) to (2, 4)' '      12  AT layer 1 sample 0 light 0 volume 6 rank 0'; do
  grep -qxF "$line" stdout || fail "info lacks: $line"
done
expect 0 "$kage" info polygons.kage --json info.json
json info.json '[j[k] for k in ("version", "polygon_frames", "made_spans", "active", "spans")] == [2, 1, 5, 2, 5]'
expect 0 "$kage" info spans.kage --json info.json
json info.json '[j[k] for k in ("version", "polygon_frames", "made_spans", "active", "spans")] == [1, 0, 0, 0, 5]'

# A frame of each level: compared are the spans.
expect 0 "$kage" diff polygons.kage spans.kage --json diff.json
grep -q '^1 frame at the polygon level in one stream alone: compared by the spans' stdout || fail "diff: $(cat stdout)"
json diff.json 'j["same"] and j["expanded_frames"] == 1'
expect 0 "$kage" diff spans.kage polygons.kage
expect 1 "$kage" diff spans.kage other.kage
grep -q 'first difference: frame 0, line 1, token 3, field z' stdout || fail "diff: $(cat stdout)"
# Both at the polygon level: token by token.
expect 1 "$kage" diff polygons.kage other.kage --json diff.json
grep -q 'first difference: frame 0, line 1, token 4, field value' stdout || fail "diff: $(cat stdout)"
grep -q 'A: POLYGON value 1000 right 2' stdout || fail "diff: $(cat stdout)"
json diff.json 'not j["same"] and j["expanded_frames"] == 0 and j["different_tokens"] == 1'
# A stream that the front end refuses has no spans to be compared by.
expect 1 "$kage" diff broken.kage spans.kage
grep -q 'field magic_version' stdout || fail "diff: $(cat stdout)"
expect 1 "$kage" diff polygons.kage broken.kage
grep -q 'first difference: frame 0, line 1, token 3, field kind' stdout || fail "diff: $(cat stdout)"

# Each token that polygons are made of, by its place in both streams and with the words of kage info.
expect 0 "$kage" diff polygons.kage polygons.kage --json diff.json
json diff.json 'j["same"] and j["different_tokens"] == 0 and j["expanded_frames"] == 0'
# differs OTHER TOKEN FIELD TOKENS: at this token of polygons.kage.
differs() {
  local side shown
  expect 1 "$kage" diff polygons.kage "$1.kage" --json diff.json
  cp stdout said
  grep -q "^first difference: frame 0, line 1, token $2, field $3\$" said || fail "diff with $1: $(cat said)"
  json diff.json "j['different_lines'] == 1 and j['different_tokens'] == $4 and j['expanded_frames'] == 0"
  for side in A:polygons "B:$1"; do
    expect 0 "$kage" info "${side#*:}.kage" --tokens 0
    shown=$(awk -v n="$2" '$1 == n { $1 = ""; print substr($0, 2) }' stdout)
    grep -qxF "  ${side%%:*}: $shown" said || fail "token $2 of ${side#*:} is '$shown', not as said: $(cat said)"
  done
}
differs edge 6 top_x 1
differs place 7 volume 1
differs fewer 7 kind 4
# Another place of a volume alone changes no span.
expect 0 "$kage" diff spans.kage place.kage
expect 1 "$kage" diff spans.kage edge.kage
grep -q '^first difference: frame 0, line 1, token 3, field xr$' stdout || fail "diff: $(cat stdout)"
# How many polygons the core keeps is a difference of two streams of polygons, and none of a token.
expect 1 "$kage" diff polygons.kage smaller.kage --json diff.json
grep -qx 'configuration: ACTIVE is 8 in A, 2 in B' stdout || fail "diff: $(cat stdout)"
json diff.json 'j["different_frames"] == 0 and j["different_tokens"] == 0 and j["first"] is None'
expect 0 "$kage" diff spans.kage smaller.kage

# Frames of both levels in one stream.
expect 0 "$kage" info mixed.kage --tokens 1 --json info.json
json info.json '[j[k] for k in ("frames", "polygon_frames", "made_spans", "active", "spans")] == [2, 1, 5, 2, 10]'
grep -qxF '       0  header: 16x6, background 0,0,0, frame number 1' stdout && ! grep -q '^ *[0-9]*  POLYGON' stdout ||
  fail "frame 1 is not of spans: $(cat stdout)"
expect 0 "$kage" info mixed.kage --tokens 0
grep -qxF '       0  header: 16x6, background 0,0,0, frame number 0, at the polygon level' stdout || fail "frame 0: $(cat stdout)"
expect 0 "$kage" diff mixed.kage same.kage --json diff.json --junit diff.xml
json diff.json 'j["same"] and j["expanded_frames"] == 1'
grep -q 'tests="4" failures="0"' diff.xml || fail "JUnit: $(cat diff.xml)"
expect 1 "$kage" diff mixed.kage two.kage --json diff.json --junit diff.xml
json diff.json 'j["expanded_frames"] == 1 and [j["first"][k] for k in ("frame", "line", "token", "field")] == [1, 1, 3, "xr"]'
grep -A1 'name="frame 1"' diff.xml | grep -q '<failure' && grep -q 'failures="1"' diff.xml || fail "JUnit: $(cat diff.xml)"
expect 1 "$kage" diff same.kage two.kage --json diff.json
json diff.json 'j["expanded_frames"] == 0 and [j["first"][k] for k in ("frame", "line", "token", "field")] == [1, 1, 6, "top_x"]'
expect 0 "$kage" explain two.kage --frame 1 --pixel 10,2
grep -qxF '      13  OP [2, 11) z 1010.5 dz 2 color 200,100,50 lit, made by the front end' stdout || fail "frame 1: $(cat stdout)"
expect 0 "$kage" explain two.kage --frame 0 --pixel 10,2
! grep -q ' OP ' stdout || fail "frame 0 has the span of frame 1: $(cat stdout)"

# The core behind the front end has the clocks that it has with spans.
clocks=()
for level in polygons spans; do
  expect 0 "$kage" info $level.kage --clocks
  clocks+=("$(grep '^clocks of ' stdout)")
done
[ -n "${clocks[0]}" ] && [ "${clocks[0]}" = "${clocks[1]}" ] || fail "clocks: ${clocks[*]}"

# A frame that is not sound, as the port may get it: nothing of it is counted, and an error is background.
expect 0 "$kage" info broken.kage --json info.json
json info.json '[j[k] for k in ("polygon_frames", "made_spans", "active", "spans")] == [1, 0, 0, 0] and j["unchecked_frames"] == 1'
expect 0 "$kage" explain broken.kage --pixel 5,2 --json explain.json
json explain.json 'j["touches"] == [] and j["color_text"] == "background: the frame has an error on this line or before"'

expect 0 "$kage" explain polygons.kage --pixel 5,2 --json explain.json
for line in '      13  OP [2, 10) z 1010.5 dz 2 color 200,100,50 lit, made by the front end' \
  '      13  IF w +1, made by the front end' '      14  EV [0, 16), made by the front end' \
  '      14  RESOLVE, made by the front end'; do
  grep -qxF "$line" stdout || fail "explain lacks: $line: $(cat stdout)"
done
json explain.json 'all(t["made"] for t in j["touches"] if t["kind"] in ("OP", "SP", "EV", "IF", "RESOLVE"))'
expect 0 "$kage" explain spans.kage --pixel 5,2 --json explain.json
json explain.json 'len(j["touches"]) > 3 and not any(t["made"] for t in j["touches"])'

# With --changes, only made tokens that changed something.
expect 0 "$kage" explain polygons.kage --pixel 9,1 --json explain.json
expect 0 "$kage" explain polygons.kage --pixel 9,1 --changes --json changes.json
python3 - <<'PY' || fail "--changes does not show what changed something"
import json
a, b = (json.load(open(f))["touches"] for f in ("explain.json", "changes.json"))
assert b == [t for t in a if t["before"] != t["after"] or t["kind"] == "IF"] and all(t["made"] for t in b) and 0 < len(b) < len(a), (a, b)
PY

# A pixel of a scene has the same history at both levels, and all of it comes from the same parts of the scene. The front end
# makes some spans, several with the index of one token; others go on as they came. With all spans: the levels leave out
# different ones.
python3 - "$kage" <<'PY' || fail "histories at the polygon level are not those of the span level"
import json, random, subprocess, sys
chance = random.Random(1)
made, sent, shared, roles, bad = 0, 0, 0, set(), []
for scene, width, height in ("courtyard", 160, 120), ("inside", 160, 120), ("glass", 96, 64), ("penumbra", 48, 36), ("polyhedra", 96, 64):
    for _ in range(12):
        pixel = f"{chance.randrange(width)},{chance.randrange(height)}"
        line = [sys.argv[1], "explain", scene, "--size", f"{width}x{height}", "--all-spans", "--pixel", pixel, "--json", "-"]
        spans, polygons = (subprocess.run(line + more, capture_output=True, text=True) for more in ([], ["--front-end", "rtl"]))
        if spans.returncode or polygons.returncode:
            bad.append(f"{scene} {pixel}: exit {spans.returncode}, {polygons.returncode}")
            continue
        spans, polygons = (json.loads(run.stdout) for run in (spans, polygons))
        told = [[[t["kind"], t["effect"], t["source"], t["before"], t["after"]] for t in j["touches"]] for j in (spans, polygons)]
        if told[0] != told[1] or spans["color"] != polygons["color"]:
            bad.append(f"{scene} {pixel}: {next(([a, b] for a, b in zip(*told) if a != b), told)}")
        indices = [t["token"] for t in polygons["touches"]]
        shared += len(indices) - len(set(indices))
        for t in polygons["touches"]:
            if t["source"] is None: continue
            roles.add(t["source"]["role"])
            made += t["made"]
            sent += not t["made"]
print(*bad[:3], sep="\n")
assert not bad and min(made, sent, shared) > 20 and roles >= {"face", "cap", "side", "end", "front"}, (made, sent, shared, roles)
PY

# Random frames at the level.
echo 'ACTIVE: 6' >front.yaml
expect 0 "$kage" explain random --front-end rtl --config front.yaml --frame 3 --pixel 0,0
expect 0 "$kage" explain random:damaged --front-end rtl --config front.yaml --frame 8 --pixel 0,0
expect 0 "$kage" explain random --front-end rtl --frame 3 --pixel 0,0
trouble 'polygons.kage: --front-end rtl: a stream has its own level' "$kage" cosim polygons.kage --front-end rtl
expect 2 "$kage" cosim random --front-end card
done_testing
