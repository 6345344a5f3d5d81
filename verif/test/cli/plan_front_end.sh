#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage plan --front-end rtl: ACTIVE is the least with which no polygon goes as spans for want of room, the words of both levels
# are those of the streams, and commands take the plan.
. "$(dirname "$0")/common.bash"
mkdir json

# stream NAME INPUT CONFIG OPTION...: NAME.kage at the polygon level, and NAME.json; what was said is in stdout.
stream() {
  local name=$1 input=$2 config=$3
  shift 3
  expect 0 "$kage" stream "$input" --level polygons --config "$config" "$@" --out "$name.kage" --json "$name.json"
  json "$name.json" 'j["level"]=="polygons" and j["polygons"]["span_level_frames"]==0'
}
left='j["polygons"]["ways"]["active"]["polygons"]'
said='^spans in the stream: .*more at once than ACTIVE [0-9.]* % ([0-9]* polygons\{0,1\})'

for scene in courtyard inside glass penumbra polyhedra; do
  size=(--size 96x72 --frames 2)
  [ $scene != penumbra ] || size=(--size 48x36 --frames 1)
  expect 0 "$kage" plan $scene "${size[@]}" --front-end rtl --json json/plan.$scene.json
  cp stdout plan.yaml
  active=$(sed -n 's/^ACTIVE: \([0-9]*\) .*/\1/p' plan.yaml)
  json json/plan.$scene.json "j['config']['ACTIVE']==$active>1"
  grep -qE "^ACTIVE: $active +# $active polygons at once in frame [01]; with one less, some go as spans$" plan.yaml || fail "$scene: $(grep ACTIVE plan.yaml)"

  # With it none goes as spans for want of room; with one less some do, and both is said.
  stream fits $scene plan.yaml "${size[@]}"
  json fits.json "$left==0 and j['polygons']['active']==$active==j['config']['ACTIVE']"
  grep -q "of $active polygons at once at most$" stdout || fail "$scene: $(cat stdout)"
  ! grep -q 'more at once than ACTIVE' stdout || fail "$scene: with the plan's ACTIVE: $(cat stdout)"
  sed "s/^ACTIVE: .*/ACTIVE: $((active - 1))/" plan.yaml >less.yaml
  stream less $scene less.yaml "${size[@]}"
  json less.json "$left>0 and j['polygons']['active']==$active-1"
  grep -q "$said" stdout || fail "$scene: one less changes nothing: $(cat stdout)"

  # Words of both levels, of all frames.
  expect 0 "$kage" stream $scene --config plan.yaml "${size[@]}" --out spans.kage --json spans.json
  python3 - json/plan.$scene.json fits.json spans.json plan.yaml <<'PY' || fail "$scene: the plan's words are not those of its streams"
import json, re, sys
plan, polygons, spans = (json.load(open(name)) for name in sys.argv[1:4])
head = open(sys.argv[4]).read()
fewer = re.search(r"^# at the polygon level the frames take ([0-9.]+) times fewer words, (\d+) words$", head, re.M)
none = re.search(r"^# at the polygon level the frames take no fewer words: (\d+) words, not (\d+)$", head, re.M)
assert plan["polygon_words"] == polygons["words"] == int(fewer[2] if fewer else none[1]), (plan["polygon_words"], polygons["words"], head)
assert round(plan["cost"]["words_per_frame"] * plan["frames"]) == spans["words"]
if fewer: assert fewer[1] == f"{spans['words'] / polygons['words']:.1f}", (fewer[1], spans["words"], polygons["words"])
else: assert int(none[2]) == spans["words"] <= polygons["words"]
assert plan["reasons"]["ACTIVE"].startswith(f"{plan['config']['ACTIVE']} polygons at once in frame ")
PY
  # Clocks are those behind the front end, by the stream's own tokens.
  expect 0 "$kage" info fits.kage --clocks --json clocks.json
  python3 - json/plan.$scene.json clocks.json "${size[1]%x*}" <<'PY' || fail "$scene: the plan's clocks are not those of its stream"
import json, sys
plan, clocks = (json.load(open(name)) for name in sys.argv[1:3])
clocks = clocks["clocks"]
assert plan["cost"]["worst_line_cycles"] == clocks["worst_line"]["clocks"], (plan["cost"], clocks)
assert abs(plan["cost"]["clocks_per_pixel"] * int(sys.argv[3]) / clocks["mean_line"] - 1) < 1e-9, (plan["cost"], clocks)
PY
  # The front end makes the very same spans, where none is left out: the levels leave out other ones.
  stream all $scene plan.yaml "${size[@]}" --all-spans
  expect 0 "$kage" stream $scene --config plan.yaml "${size[@]}" --all-spans --out spans.kage
  expect 0 "$kage" diff spans.kage all.kage
done

# Commands take the file, and plan themselves what it has.
small=(--size 64x48 --frames 1)
expect 0 "$kage" plan courtyard "${small[@]}" --front-end rtl --json json/plan.small.json
cp stdout small.yaml
active=$(sed -n 's/^ACTIVE: \([0-9]*\) .*/\1/p' small.yaml)
stream by_file courtyard small.yaml "${small[@]}"
stream by_plan courtyard plan "${small[@]}"
cmp by_file.kage by_plan.kage || fail "the file's stream is not that of --config plan"
expect 0 "$kage" cosim courtyard "${small[@]}" --front-end rtl --config small.yaml --no-report --out out --json run.json
json run.json "j['same'] and j['config']['ACTIVE']==$active"
expect 0 "$kage" cosim courtyard "${small[@]}" --front-end rtl --config plan --no-report --out out --json run.json
json run.json "j['same'] and j['config']['ACTIVE']==$active"
grep -q '^kage: the RTL model of .* is there$' stderr || fail "--config plan has another core than the file: $(cat stderr)"

# With several scenes the one that has most at once decides, and the reason names it.
expect 0 "$kage" plan inside courtyard "${small[@]}" --front-end rtl --json json/plan.both.json
cp stdout both.yaml
active=$(sed -n 's/^ACTIVE: \([0-9]*\) .*/\1/p' both.yaml)
grep -q "^ACTIVE: $active .*# $active polygons at once in courtyard, frame 0; with" both.yaml || fail "$(grep ACTIVE both.yaml)"
stream both inside both.yaml "${small[@]}"
json both.json "$left==0 and j['polygons']['active']<$active"
stream both courtyard both.yaml "${small[@]}"
json both.json "$left==0 and j['polygons']['active']==$active"

# More than a front end keeps; one; none.
most=(penumbra --size 320x240 --samples 128 --frames 1)
expect 0 "$kage" plan "${most[@]}" --front-end rtl --json json/plan.most.json
cp stdout most.yaml
stream most "${most[0]}" most.yaml "${most[@]:1}"
python3 - json/plan.most.json most.json <<'PY' || fail "more than a front end keeps: $(grep ACTIVE most.yaml)"
import json, sys
plan, stream = (json.load(open(name)) for name in sys.argv[1:])
left = stream["polygons"]["ways"]["active"]["polygons"]
assert left > 1 and plan["config"]["ACTIVE"] == stream["polygons"]["active"] == 4096
assert plan["reasons"]["ACTIVE"] == f"the most that a front end keeps; for {left} polygons it has no room, and they go as spans"
PY
expect 0 "$kage" plan courtyard --size 2x3 --front-end rtl
grep -q '^ACTIVE: 1 .*# 1 polygon at once in frame [0-7]; with one less, some go as spans$' stdout || fail "$(grep ACTIVE stdout)"
expect 0 "$kage" plan courtyard --size 1x1 --frames 1 --front-end rtl --json json/plan.none.json
cp stdout none.yaml
grep -q '^ACTIVE: 1 .*# no polygon goes to the front end, and 0 is a core without one$' none.yaml || fail "$(grep ACTIVE none.yaml)"
grep -qE '^# at the polygon level the frames take no fewer words: [0-9]+ words, not [0-9]+$' none.yaml || fail "$(cat none.yaml)"
stream none courtyard none.yaml --size 1x1 --frames 1
json none.json 'j["polygons"]["active"]==0'
json json/plan.none.json "j['polygon_words']==$(python3 -c 'import json; print(json.load(open("none.json"))["words"])')"

# Spans from the host: the same plan but for the front end and what it takes.
expect 0 "$kage" plan courtyard "${small[@]}" --front-end host --json json/plan.host.json
cp stdout host.yaml
grep -q '^ACTIVE: 0 .*# spans come from the host' host.yaml || fail "$(grep ACTIVE host.yaml)"
json json/plan.host.json 'j["config"]["ACTIVE"]==0 and j["polygon_words"] is None'
expect 0 "$kage" plan courtyard "${small[@]}"
cmp stdout host.yaml || fail "--front-end host is not what there is without it"
values() { grep '^[A-Z]' "$1" | grep -vE '^(ACTIVE|DSF_BITS|FSF):' | sed 's/ *#.*//'; }
diff <(values host.yaml) <(values small.yaml) || fail "a front end changes more than ACTIVE, the way of shadows, clocks and cells"
[ "$(grep -c '^# words are those with spans from the host' small.yaml)" = 1 ] || fail "not said what the costs are of: $(cat small.yaml)"
# Each way that was costed has its cells with a front end, as kage area estimates those of the chosen one.
luts() { unwrapped "$1" | grep -o '[0-9]* LUTs (within' | sort -n; }
[ "$(luts host.yaml | wc -l)" -gt 1 ] && [ "$(luts host.yaml | wc -l)" = "$(luts small.yaml | wc -l)" ] || fail "$(cat host.yaml small.yaml)"
paste -d' ' <(luts host.yaml) <(luts small.yaml) | awk '{ if ($4 < $1 + 5000) exit 1 }' || fail "no front end in the cells"
expect 0 "$kage" area small.yaml --estimate
grep -q ": some $(unwrapped small.yaml | grep -m1 -o '[0-9]* LUTs') and " stdout || fail "$(cat stdout)"

trouble "--front-end: card not in {host,rtl}" "$kage" plan courtyard --front-end card
expect 0 "$kage" help plan
grep -q -- '^  --front-end host|rtl  ' stdout || fail "$(grep -- --front-end stdout)"

python3 "$source/verif/test/cli/schema.py" "$source/docs/schema" json || fail "JSON and schema"
done_testing
