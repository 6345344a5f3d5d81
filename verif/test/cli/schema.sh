#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The JSON that commands write by --json is of the schema that it names: docs/schema. Every command that has --json writes here,
# and every schema is one that a command names.
. "$(dirname "$0")/common.bash"
unset GITHUB_ACTIONS
mkdir json

# said RC COMMAND ARGUMENT...: the command ends so and leaves its JSON as json/COMMAND.N.json, and the same in $last.
number=0
said() {
  local want=$1 command=$2
  shift 2
  last=json/$command.$((number += 1)).json
  expect "$want" "$kage" "$command" "$@" --json "$last"
  [ -s "$last" ] || fail "kage $command $*: no JSON"
}
small=(--size 64x48 --frames 2 --config default)

# One scene: the same, with all that may be there besides; different; a hang; frames that end in an error; one that is kept.
said 0 cosim courtyard "${small[@]}" --coverage --out same
models=${XDG_CACHE_HOME:-$HOME/.cache}/kage
mkdir -p own/kage && ln -s "$models"/{models,verilator} own/kage/  # verdicts of its own, models of the common cache
for taken in 0 2; do
  XDG_CACHE_HOME=$PWD/own said 0 cosim courtyard "${small[@]}" --cache-verdicts --no-report --out taken
  json "$last" 'j["verdicts"]["taken"]=='$taken
done
XDG_CACHE_HOME=$PWD/own said 0 cache verify
json "$last" 'j["verdicts"]["verdicts"]==2 and j["verdicts"]["damaged"]==0'
said 0 cosim polyhedra --size 64x48 --frames 2 --config polyhedra --idle 20 --no-report --out same
json "$last" 'j["polyhedra"] and any(f["stalled_by_phase"] for f in j["each"])'
said 1 cosim courtyard "${small[@]}" --all-spans --fault wrong_compare --out different
cp "$last" found.json
json "$last" 'j["first_difference"]["divergence"] and j["first_difference"]["waveform"]'
said 1 cosim courtyard "${small[@]}" --all-spans --fault wrong_compare --no-divergence --no-report --out different
said 1 cosim courtyard "${small[@]}" --fault stub_hang --no-report --no-divergence --out hang
said 0 cosim random:damaged --frames 20 --config tiny --no-report --out damaged
# A difference of the register check, which no frame has.
number=$(python3 -c 'import sys, yaml; print([m["name"] for m in yaml.safe_load(open(sys.argv[1]))].index("registers_shape") + 1)' "$source/verif/mutants/mutants.yaml")
said 1 cosim random:mixed --frames 4 --config tiny --mutant "$number" --no-report --out registers
said 1 cosim random --frames 20 --config default --fault wrong_compare --no-shrink --no-divergence --no-report --out random
json "$last" 'j["kept"]["again"].startswith("kage cosim ")'

# Several scenes, in shards of which one has no frame of a scene; joined; likewise of one scene.
for i in 1 2; do
  said 0 cosim courtyard inside --size 64x48 --frames 1 --shard $i/2 --out few$i
  cp "$last" few$i.json
  said 1 cosim courtyard "${small[@]}" --shard $i/2 --all-spans --fault wrong_compare --no-divergence --out part$i
  cp "$last" part$i.json
done
said 0 merge few1.json few2.json --out few
said 1 merge part1.json part2.json
json "$last" 'j["schema"]=="kage.merge/1" and len(j["shards"])==2'
json part1.json 'j["schema"]=="kage.cosim/1"'

# Only reports of this version are joined.
python3 - <<'PY'
import json
j = json.load(open("part1.json"))
json.dump(j | {"schema": "kage.cosim/2"}, open("later.json", "w"))
del j["schema"]
json.dump(j, open("none.json", "w"))
PY
trouble 'later.json: no report of kage cosim: schema is "kage.cosim/2", and this kage reads kage.cosim/1' "$kage" merge later.json part2.json
trouble 'none.json: no report of kage cosim: it names no schema' "$kage" merge none.json part2.json

# Plans: bound, measured, for a display; areas, which are counted in cli/area.
said 0 plan courtyard glass --size 64x48 --frames 1
json "$last" 'j["meets_clock"] is None and j["limits"]["max_wrong"] is None'
said 0 plan courtyard --size 64x48 --frames 1 --clock 50 --prefer speed
json "$last" 'j["meets_clock"] is True and j["cost"]["worst_line_at"]["frame"] == 0'
said 0 plan courtyard --size 64x48 --frames 1 --guarantee measured --max-wrong 5000
json "$last" 'j["limits"]["max_wrong"] == 5000 and "measured: " in j["reasons"]["Z_BITS"]'
said 0 plan courtyard --size 64x48 --frames 1 --front-end rtl
json "$last" '0 < j["polygon_words"] < j["cost"]["words_per_frame"] and j["config"]["ACTIVE"] > 1'
said 0 area tiny default --estimate

# Sweeps: soft lights, and none; with the RTL, and without.
said 0 sweep penumbra --size 32x24 --frames 1 --axes SAMPLES=1,4 --no-area --no-cosim --no-flip
said 0 sweep courtyard --size 64x48 --frames 1 --config default --axes SIZE=32x24 --no-area --store second.sqlite
json "$last" '[r["speed"]["rtl_cycles_from"] for r in j] == ["cosim", "phases"]'

# Trouble has no JSON.
expect 2 "$kage" cosim nowhere.obj --json trouble.json
[ ! -e trouble.json ] || fail "trouble leaves JSON"

# The regression: the same, different, and ended by a signal.
said 0 regress --rounds 1 --config tiny --out regress
said 1 regress --rounds 1 --config default --fault wrong_compare --no-divergence --out regress
cp "$last" regressed.json
KAGE_PROGRESS=0.2 "$kage" regress --minutes 60 --config tiny --out regress --json json/regress.0.json >/dev/null 2>progress &
pid=$!
until grep -q "^[1-9][0-9]* run" progress || ! kill -0 $pid; do sleep 0.1; done
kill -INT $pid
wait $pid
json json/regress.0.json 'j["interrupted"] is True'

# Streams and pictures.
said 0 stream courtyard "${small[@]}" --out a.kage
said 0 stream courtyard "${small[@]}" --level polygons --out l.kage
said 0 stream polyhedra --size 64x48 --frames 1 --config polyhedra --out p.kage
"$kage" stream courtyard "${small[@]}" --out - --json json/stream.0.json >piped.kage 2>stderr || fail "a stream into a pipe"
"$kage" stream glass --size 64x48 --frames 1 --config glass --out g.kage >/dev/null
"$kage" stream inside "${small[@]}" --out b.kage >/dev/null
said 0 vectors courtyard "${small[@]}" --out v
cp v/manifest.json json/pack.1.json
said 0 vectors courtyard "${small[@]}" --sizes
said 0 vectors --check v
said 0 vectors --compare v v/pixels.hex
head -c 99 v/pixels.bin >few.raw
said 1 vectors --compare v few.raw
sed 2s/38/39/ v/pixels.hex >few.hex
said 1 vectors --compare v few.hex
said 0 vectors courtyard "${small[@]}" --sound-only --module line_out --out vm
cp vm/manifest.json json/pack.2.json
# board PACK FAULT...: a board (support/fake_board.cpp), whose device is $port, until the next one.
fake=
trap 'kill $fake 2>/dev/null; rm -rf "$temp"' EXIT
board() {
  [ -z "$fake" ] || kill "$fake"
  rm -f name && mkfifo name
  "$KAGE_FAKE_BOARD" "$@" >name &
  fake=$!
  read -r port <name
}
board v screen
said 0 board --port "$port" v --loop 0.1 --out board
json "$last" 'j["board"]["loop"]["repetitions"]'
board v line 5
said 1 board --port "$port" v
board v once 5
said 1 board --port "$port" v
said 0 info a.kage --clocks
said 0 info p.kage
said 0 info courtyard
said 0 info penumbra
said 0 render courtyard "${small[@]}" --out a
said 0 render inside "${small[@]}" --exr --out exr
said 0 render glass --size 64x48 --frames 1 --order submission --error-map --out maps
json "$last" 'j["errors"][0]["sources"]["order"]["file"] and j["errors"][0]["sources"]["classes"]["file"] is None'
"$kage" render inside "${small[@]}" --out b >/dev/null
"$kage" render courtyard --size 32x24 --frames 1 --config default --out tiny >/dev/null
said 0 diff a/courtyard_0000.png a/courtyard_0000.png
said 1 diff a/courtyard_0000.png b/inside_0000.png --perceptual
json "$last" 'j["flip"]["mean"] > 0 and j["regions"]'
said 1 diff exr/inside_0000.exr exr/inside_0001.exr
said 1 diff a/courtyard_0000.png tiny/courtyard_0000.png
json "$last" 'j["width"] is None'
mkdir other
cp a/courtyard_0000.png other && cp b/inside_0000.png other/courtyard_0001.png && cp a.kage other/s.kage && cp b.kage a/s.kage
echo text | tee a/only.txt >other/.hidden
said 1 diff a other
json "$last" 'j["first"]["frame"] and {f["missing"] for f in j["files"]}=={None, "B"} and j["not_compared"]'
said 1 diff --bless --dry-run other a
said 0 diff --bless --prune a other --exclude '*.txt'
said 0 diff a.kage piped.kage
said 1 diff a.kage b.kage
said 1 diff a.kage g.kage
json "$last" 'j["config"] and j["different_tokens"] is None'

# Pixels, with the RTL and without.
said 0 explain courtyard --size 64x48 --pixel 32,24 --rtl
said 0 explain penumbra --size 64x48 --pixel 32,40 --changes
said 0 explain p.kage --pixel 32,24
said 0 explain polyhedra --size 64x48 --config polyhedra --pixel 32,24
json "$last" 'any(t["kind"]=="TREE" for t in j["touches"])'

# Commands that say what there is.
said 0 list
said 0 list faults
said 0 model default
said 0 order glass --eyes 2 --repeats 1 --save glass.bsp
said 0 order glass.bsp --eyes 2 --repeats 1
said 0 cache
said 0 cache list
json "$last" 'j["models"]'
mkdir empty
XDG_CACHE_HOME=$PWD/empty said 0 cache prune --max-size 1M

# A tool that gives mutants to kage: to one that answers as kage did above.
cat >answers <<'SH'
#!/bin/sh
case "$*" in
  *--list*) printf '%s: kage cosim courtyard\n' random.default.0 mixed.default.0 courtyard.default; exit 0 ;;
  regress*) cat regressed.json ;;
  cosim*) cat found.json ;;
esac
exit 1
SH
chmod +x answers
mutants=(python3 "$source/tools/regress_mutants.py" ./answers "$source")
expect 0 "${mutants[@]}" --json json/mutants.1.json next_tie
cp json/mutants.1.json rows.json
expect 0 "${mutants[@]}" --json rows.json --resume next_tie cell_tie
json rows.json 'len(j)==2 and all(r["found"] for r in j)'
expect 0 "${mutants[@]}" --each --json json/mutants.2.json next_tie
json json/mutants.2.json '[("named" in r) for r in j[0]["runs"]]==[True]*3'
expect 1 "${mutants[@]}" --json json/mutants.2.json --resume next_tie  # rows of --each
python3 -c 'import json; r = json.load(open("rows.json")); [x.pop("schema") for x in r]; json.dump(r, open("old.json", "w"))'
expect 1 "${mutants[@]}" --json old.json --resume next_tie
[ "$(cat stderr)" = "tools/regress-mutants: old.json: not rows of kage.regress-mutants/1, which alone --resume goes on from" ] || fail "$(cat stderr)"

python3 "$source/verif/test/cli/schema.py" "$source/docs/schema" json "$kage" || fail "JSON and schemas"
done_testing
