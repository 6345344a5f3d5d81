#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage cosim --cache-verdicts: what an earlier run has compared is not run again, and nothing else is left out.
. "$(dirname "$0")/common.bash"

echo '{MAX_WIDTH: 64, LANES: 4}' >small.yaml
own_verdicts
verdicts=$PWD/cache/kage/verdicts
mkdir -p only/kage && ln -s "$verdicts" only/kage/verdicts
cache() { XDG_CACHE_HOME=$PWD/only "$kage" cache "$@"; } # as if there were no models

# RTL that the test may change.
data_copy data
export KAGE_DATA_DIR=$PWD/data

run=(courtyard --all-spans --size 64x48 --frames 5 --config small.yaml)
# cosim EXIT TAKEN KEPT OPTION...: a run with --cache-verdicts, and how many verdicts it takes and keeps.
cosim() {
  local rc=$1 taken=$2 kept=$3
  shift 3
  rm -rf out
  expect "$rc" "$kage" cosim "${run[@]}" --cache-verdicts --out out --json r.json --junit r.xml "$@"
  json r.json "(j['verdicts']['taken'], j['verdicts']['kept']) == ($taken, $kept)"
  grep -qE "^(same|different): [0-9]+ frames?, $taken of them taken from earlier runs, " stdout || [ "$taken" = 0 ] || fail "$*: $(cat stdout)"
  [ "$taken" != 0 ] || ! grep -q "earlier runs" stdout || fail "$*: none is taken, and yet: $(cat stdout)"
}

# The output of a run with verdicts is that of the run without them, clocks and pictures too.
plain() {
  python3 - "$1" <<'PY'
import json, sys
def without(j):
    if isinstance(j, dict):
        return {k: without(v) for k, v in j.items() if not k.endswith("seconds") and k not in ("again", "report_crc32", "verdicts", "taken")}
    return [without(v) for v in j] if isinstance(j, list) else j
print(json.dumps(without(json.load(open(sys.argv[1]))), indent=1))
PY
}
for stalls in "--idle 0" "--idle 20 --backpressure 30"; do
  rm -rf "$verdicts"
  # shellcheck disable=SC2086
  {
    cosim 0 0 5 $stalls --no-cache-verdicts --cache-verdicts
    cp -r out first && cp r.json first.json
    cosim 0 5 0 $stalls
    json r.json "j['verdicts'] == {'cached': True, 'taken': 5, 'taken_frames': [0, 1, 2, 3, 4], 'kept': 0, 'trouble': None} and j['rtl_seconds'] == 0"
    json r.json "all(f['taken'] and f['same'] for f in j['each']) and 'cache' not in j['again']"
    [ "$(grep -c 'taken from an earlier run</system-out>' r.xml)" = 5 ] || fail "JUnit does not say it: $(cat r.xml)"
    grep -q 'same: 5 frames, 5 of them taken from earlier runs' out/report.html || fail "the page does not say it"
    for file in $(cd first && ls ./*.png); do cmp -s "first/$file" "out/$file" || fail "$file is another picture"; done
    diff <(plain first.json) <(plain r.json) >difference || fail "other figures: $(head -c 600 difference)"
    # The same with verdicts of other ranges.
    for jobs in 2 4; do cosim 0 5 0 $stalls --jobs $jobs --threads 1; done
    expect 0 "$kage" cosim "${run[@]}" $stalls --out out --json r.json
    diff <(plain first.json) <(plain r.json) >difference || fail "a run of all frames has other figures: $(head -c 600 difference)"
    json r.json "j['verdicts'] == {'cached': False, 'taken': 0, 'taken_frames': [], 'kept': 0, 'trouble': None}"
    expect 0 "$kage" cosim "${run[@]}" $stalls --cache-verdicts --no-cache-verdicts --out out --json r.json
    json r.json "not j['verdicts']['cached'] and j['rtl_seconds'] > 0 and not any(f['taken'] for f in j['each'])"
  }
  rm -rf first
done
rm -rf "$verdicts"
cosim 0 0 5

# Anything else that decides what the RTL does is another verdict.
cosim 0 0 5 --seed 2
cosim 0 0 5 --idle 5
cosim 0 0 5 --backpressure 5
cosim 0 0 1 --frame 3 # without the frame before it
cosim 0 1 0 --frame 3
cosim 0 0 5 --alpha 0.5 --degrade --order centroid --cull --size 60x48
cosim 0 0 5 --jobs 1 # which is for what only a history of many frames shows
cosim 0 5 0 --jobs 1
cosim 0 5 0

# A verdict is of one frame behind one frame: where it is missing that frame alone is run; with --jobs 1 all behind it
# too, since one core has to see them in a row.
frames() { "$kage" cosim random --seed 7 --config small.yaml --out none --no-report --cache-verdicts --json r.json "$@" >said 2>&1 || fail "$*: $(cat said)"; }
for jobs in 2 1; do
  rm -rf "$verdicts" upto2 upto3
  frames --jobs $jobs --frames 2 && cp -a "$verdicts" upto2
  frames --jobs $jobs --frames 3 && cp -a "$verdicts" upto3
  frames --jobs $jobs --frames 6
  third=$(comm -13 <(ls upto2) <(ls upto3))
  [ "$(wc -w <<<"$third")" = 1 ] || fail "of frame 2 there is not one verdict: $third"
  rm "$verdicts/$third"
  frames --jobs $jobs --frames 6
  if [ $jobs = 2 ]; then
    json r.json "j['verdicts']['taken_frames'] == [0, 1, 3, 4, 5] and j['verdicts']['kept'] == 1"
  else
    json r.json "j['verdicts']['taken_frames'] == [0, 1] and j['verdicts']['kept'] == 4"
  fi
  frames --jobs $jobs --frames 6
  json r.json "j['verdicts']['taken'] == 6"
done
# Malformed frames too; those of random:mixed never, since what goes ahead of a frame there is not among its words.
malformed=(random:damaged --frames 40 --config small.yaml --out none --no-report --idle 10 --cache-verdicts --json m.json)
expect 0 "$kage" cosim "${malformed[@]}"
expect 0 "$kage" cosim "${malformed[@]}"
json m.json "j['verdicts']['taken'] == 40 and j['frames'] == 40"
ls "$verdicts" >before
for _ in 1 2; do
  expect 0 "$kage" cosim "${malformed[@]/random:damaged/random:mixed}" --seed 2
  json m.json "j['frames'] == 40 and not j['verdicts']['cached'] and 'random:mixed' in j['verdicts']['trouble']"
  grep -q '^kage: note: no verdicts of earlier runs are taken, and none is kept: random:mixed ' stderr || fail "$(cat stderr)"
done
diff before <(ls "$verdicts") || fail "random:mixed has left verdicts"

# Comments in the RTL are no other RTL: nothing is run, and no model is built for it. Any other change is.
rm -rf "$verdicts"
cosim 0 0 5 --jobs 1
cosim 0 0 5
sed -i -e "1a // one more, of $(date +%s.%N), so that no model is of this text" -e 's,^endmodule,/* an end\n*/\n\n&,' data/rtl/pixel_banked.sv
sed -i '1i // and here' data/rtl/include/kage_pixel_next.svh
sed -i 's/;$/; \/\/ so/' data/rtl/registers.sv
cosim 0 5 0
json r.json "j['build_seconds'] == 0"
# But a comment that Verilator takes for an assertion is other RTL: here of a case that leaves values out.
put_case() {
  cp "$source/rtl/registers.sv" data/rtl/
  python3 - data/rtl/registers.sv "$1" <<'PY'
import pathlib, sys
path, comment = pathlib.Path(sys.argv[1]), sys.argv[2]
added = f"""
  // verilator lint_off CASEINCOMPLETE
  logic [1:0] turn_q;
  logic unused_met;
  always_ff @(posedge clk_i) begin
    turn_q <= rst_ni ? turn_q + 2'd1 : 2'd0;
    case (turn_q)  {comment}
      2'd0, 2'd1: unused_met <= rst_ni;
    endcase
  end
endmodule
"""
text = path.read_text()
assert text.count("\nendmodule\n") == 1
path.write_text(text.replace("\nendmodule\n", added))
PY
}
put_case "// of four"
cosim 0 0 5
cosim 0 5 0
put_case "// synopsys full_case"
expect 1 "$kage" cosim "${run[@]}" --cache-verdicts --no-divergence --out out --json r.json
json r.json "j['verdicts']['taken'] == 0"
rm -rf data/rtl && cp -r "$source/rtl" data/
cosim 0 5 0
# A fault in the RTL itself, which no verdict of the sound RTL may hide; and none is kept of what differs.
put_fault wrong_compare data
for jobs in 1 2; do
  expect 1 "$kage" cosim "${run[@]}" --cache-verdicts --jobs $jobs --no-divergence --out out --json r.json
  json r.json "j['verdicts']['taken'] == 0 and j['verdicts']['cached'] and j['verdicts']['kept'] < 5"
  rm -rf out
  expect 1 "$kage" cosim "${run[@]}" --cache-verdicts --jobs $jobs --no-divergence --out out --json r.json
  json r.json "not j['same'] and j['first_difference']['frame'] not in j['verdicts']['taken_frames']"
done
rm -rf data/rtl && cp -r "$source/rtl" data/
cosim 0 5 0
cosim 0 5 0 --jobs 1

# --fault neither takes nor keeps, and says so in one line.
cp -r "$verdicts" kept-verdicts
cosim 1 0 0 --fault wrong_compare --no-divergence
grep -qx 'kage: note: no verdicts of earlier runs are taken, and none is kept: with --fault every frame is run' stderr || fail "$(cat stderr)"
json r.json "not j['verdicts']['cached'] and '--fault' in j['verdicts']['trouble']"
diff <(ls "$verdicts") <(ls kept-verdicts) || fail "--fault has left verdicts"
# Neither does a tool that is not what its version says.
mkdir tools
printf '#!/bin/sh\ncase "$*" in --version) echo "Verilator 5.006 rev v5.006-7-g0123abc (mod)" ;; *) exec verilator "$@" ;; esac\n' >tools/verilator
chmod +x tools/verilator
VERILATOR=$PWD/tools/verilator cosim 0 0 0
grep -q 'does not say of what sources it was built: Verilator 5.006 rev v5.006-7-g0123abc (mod)$' stderr || fail "$(cat stderr)"
diff <(ls "$verdicts") <(ls kept-verdicts) || fail "a changed tool has left verdicts"

# A damaged verdict is none, and is whole again behind the run.
rm -rf "$verdicts"
cosim 0 0 5
damage() { # COMMAND...: does it to one verdict
  "$@"
  expect 1 cache verify
  grep -q '5 verdicts, .*, 1 of them damaged' stdout || fail "$*: $(cat stdout)"
  cosim 0 4 1
  [ ! -s stderr ] || fail "$*: $(cat stderr)"
  expect 0 cache verify
}
one=$verdicts/$(ls "$verdicts" | head -n 1) two=$verdicts/$(ls "$verdicts" | tail -n 1)
damage truncate -s 100 "$one"
damage truncate -s 0 "$one"
damage truncate -s 1G "$one"
damage sed -i '3s/[0-9]/x/' "$one"
damage cp "$two" "$one" # one of another frame
damage chmod 666 "$one"
damage ln -sf "$two" "$one"
damage sh -c 'rm "$1" && mkfifo "$1"' sh "$one"
[ "$(stat -c %a "$one" "$verdicts" | tr '\n' ' ')" = "600 700 " ] || fail "others may see verdicts"

# Trouble with the store costs the store: one line, and every frame is run.
line() { # TEXT
  [ "$(wc -l <stderr)" = 1 ] && grep -q "^kage: note: .*$1" stderr || fail "not the one line '$1': $(cat stderr)"
  json r.json "j['same'] and j['verdicts']['taken'] == 0 and j['verdicts']['trouble'] is not None"
}
chmod 777 "$verdicts"
cosim 0 0 0 && line "verdicts: others may write to it"
chmod 700 "$verdicts" && mv "$verdicts" aside && touch "$verdicts"
cosim 0 0 0 && line "verdicts: is no folder"
rm "$verdicts" && mkdir -m 700 "$verdicts"
for name in aside/*; do mkdir "$verdicts/${name#aside/}"; done # nothing can be written there
cosim 0 0 0 && line "verdicts are not kept: $verdicts: cannot be written to: Is a directory"
rm -rf "$verdicts" && mkdir -m 700 "$verdicts"
if mount -t tmpfs -o size=4k,mode=700 tmpfs "$verdicts" 2>/dev/null; then # a page: room for one verdict
  trap 'umount "$verdicts"; rm -rf "$temp"' EXIT
  cosim 0 0 1 && line "verdicts are not kept: $verdicts: cannot be written to: No space left on device"
  [ "$(ls "$verdicts" | wc -l)" = 1 ] || fail "half a verdict lies on the full disk"
  mount -o remount,ro "$verdicts" && rm -f r.json
  expect 0 "$kage" cosim "${run[@]}" --cache-verdicts --out out --json r.json
  json r.json "j['same'] and j['verdicts']['taken'] == 1 and j['verdicts']['kept'] == 0 and j['verdicts']['trouble']"
  [ "$(wc -l <stderr)" = 1 ] && grep -q "verdicts are not kept: .*Read-only file system" stderr || fail "$(cat stderr)"
  umount "$verdicts" && trap 'rm -rf "$temp"' EXIT
else
  echo "no tmpfs can be mounted here: a full disk is not tried"
fi
rm -rf "$verdicts" && mv aside "$verdicts"
cosim 0 5 0

# The frames that an interrupted run has finished are kept, and no more.
rm -rf "$verdicts"
long=(courtyard --size 64x3000 --frames 30 --config small.yaml --out long --no-report --cache-verdicts)
"$kage" cosim "${long[@]}" >/dev/null 2>&1 &
until compgen -G "$verdicts/*" >/dev/null || ! kill -0 $! 2>/dev/null; do sleep 0.02; done
kill -INT $! && wait $!
rc=$?
[ $rc = 130 ] || fail "the run was not interrupted: exit $rc"
kept=$(ls "$verdicts" | wc -l)
[ "$kept" -ge 1 ] && [ "$kept" -lt 30 ] || fail "an interrupted run has kept $kept verdicts"
expect 0 "$kage" cosim "${long[@]}" --json r.json
json r.json "j['verdicts']['taken'] == $kept and j['verdicts']['kept'] == 30 - $kept"
# Two at a time.
rm -rf "$verdicts"
for i in 1 2; do "$kage" cosim "${run[@]}" --cache-verdicts --out two$i >/dev/null 2>&1 & done
wait
expect 0 cache verify --json c.json
json c.json "j['verdicts']['verdicts'] == 5 and j['verdicts']['damaged'] == 0"
cosim 0 5 0

# Shards and scenes: the joined report says it too.
sharded() {
  for i in 1 2; do expect 0 "$kage" cosim courtyard edges --frames 2 --size 64x48 --config small.yaml --shard $i/2 --out s$i --json s$i.json "$@"; done
  expect 0 "$kage" merge s1.json s2.json --json joined.json --junit joined.xml --out joined
}
rm -rf "$verdicts"
sharded --cache-verdicts
json joined.json "j['verdicts'] == {'cached': True, 'taken': 0, 'kept': 4, 'trouble': None}"
sharded --cache-verdicts
json joined.json "j['verdicts']['taken'] == 4 and [s['verdicts']['taken_frames'] for s in j['scenes']] == [[0, 1], [0, 1]]"
grep -q '^same: 2 scenes, 4 frames of 4 in 2 shards, 4 of them taken from earlier runs, ' stdout || fail "$(cat stdout)"
[ "$(grep -c 'taken from an earlier run</system-out>' joined.xml)" = 4 ] || fail "JUnit does not say it"
grep -q '4 frames of 4 in 2 shards, 4 of them taken from earlier runs' joined/report.html || fail "the joined page does not say it"
python3 - s1.json <<'PY'
import json, sys
j = json.load(open(sys.argv[1]))
del j["scenes"][0]["verdicts"]["taken_frames"]
json.dump(j, open("wrong.json", "w"))
PY
trouble "wrong.json: no report of kage cosim: taken_frames" "$kage" merge wrong.json s2.json

# kage cache counts and prunes them.
n=$(ls "$verdicts" | wc -l)
expect 0 cache --json c.json
json c.json "j['verdicts']['verdicts'] == $n and j['verdicts']['folder'].endswith('/kage/verdicts') and j['verdicts']['damaged'] is None"
touch -d '2 days ago' "$verdicts/$(ls "$verdicts" | head -n 1)" && truncate -s 10 "$verdicts/$(ls "$verdicts" | tail -n 1)"
expect 0 cache prune --older-than 3d --json c.json
json c.json "j['verdicts']['removed'] == 1 and j['verdicts']['verdicts'] == $n - 1"
expect 0 cache prune --older-than 1d --json c.json
json c.json "j['verdicts']['removed'] == 1 and j['verdicts']['verdicts'] == $n - 2"
expect 0 cache prune --max-size 1K
[ "$(du -bc "$verdicts"/* | tail -n 1 | cut -f 1)" -le 1024 ] || fail "verdicts take more than a kibibyte"
expect 0 cache prune --older-than 0m --max-size 0K
[ -z "$(ls "$verdicts")" ] || fail "verdicts are left"
no_leftovers
done_testing
