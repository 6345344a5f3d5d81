#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage cosim for continuous integration: shards and kage merge, JUnit XML, annotations, progress in a pipe.
. "$(dirname "$0")/common.bash"
unset GITHUB_ACTIONS

# junit FILE EXPRESSION: true in Python, with the suite as s and its cases as c.
junit() {
  python3 - "$1" "$2" <<'PY' || { fail "$1: not so: $2"; head -c 900 "$1"; }
import sys, xml.etree.ElementTree as E
s = E.parse(sys.argv[1]).getroot()[0]
c = list(s)
sys.exit(0 if eval(sys.argv[2]) else 1)
PY
}
run=(courtyard --size 64x48 --frames 5 --config default)

# Whole, and in three shards: the same sums, whatever the order in which they are joined.
expect 0 "$kage" cosim "${run[@]}" --out whole --json whole.json --junit whole.xml
junit whole.xml 's.get("tests")=="5" and s.get("failures")=="0" and s.get("name")=="kage cosim" and len(s.get("timestamp"))==19 and s.get("hostname")'
junit whole.xml 'all(k.get("classname")=="kage.cosim.courtyard" for k in c)'
junit whole.xml '[k.get("name") for k in c]==["frame %d" % i for i in range(5)] and all(len(k)==0 for k in c)'
junit whole.xml 'abs(sum(float(k.get("time")) for k in c)-float(s.get("time")))<0.01'
json whole.json 'j["shard"] is None and j["total_frames"]==5 and len(j["frame_seconds"])==5 and j["scene"]=="courtyard"'
for i in 1 2 3; do
  expect 0 "$kage" cosim "${run[@]}" --out shard --shard $i/3 --json $i.json --junit $i.xml
done
json 1.json 'j["frames"]==2 and j["shard"]=={"index":1,"count":3} and [p[-8:] for p in j["pictures"]]==["0000.png","0003.png"]'
json 3.json 'j["frames"]==1 and j["total_frames"]==5'
junit 2.xml '[k.get("name") for k in c]==["frame 1","frame 4"]'
for i in 0 1 2 3 4; do expect 0 "$kage" diff shard/courtyard_000$i.png whole/courtyard_000$i.png; done
expect 0 "$kage" merge 3.json 1.json 2.json --json all.json --junit all.xml
json all.json 'j["report"] is None and [f["frame"] for f in j["each"]]==[0,1,2,3,4]'
json whole.json 'j["options"]["order"]=="exact" and all(f["same"] and f["stalled"]=={"input_starved":0,"output_blocked":0} for f in j["each"])'
grep -q '^same: 5 frames of 5 in 3 shards, 64x48, 15360 pixels compared' stdout || fail "$(cat stdout)"
junit all.xml '[k.get("name") for k in c]==["frame %d" % i for i in range(5)] and s.get("failures")=="0"'
python3 - <<'PY' || fail "the shards' sums are not those of the whole"
import json
a, w = json.load(open("all.json")), json.load(open("whole.json"))
same = ["same", "frames", "width", "height", "pixels_compared", "spans", "span_pixels", "segments", "config", "seed", "scene", "total_frames"]
assert all(a[k] == w[k] for k in same), [(k, a[k], w[k]) for k in same if a[k] != w[k]]
assert len(a["frame_seconds"]) == 5 and a["first_difference"] is None and len(a["shards"]) == 3
PY
expect 0 "$kage" merge 1.json 2.json 3.json --json -
json stdout 'j["same"] is True and j["shard"] is None'

for file in *.xml; do
  grep -q '<testsuite name="[^>]* timestamp=' "$file" && ! grep -q '<testsuite [^>]*  ' "$file" || fail "$file: blanks within its tag"
done

# A JUnit file that cannot be written is told before the run, and one that fails in the end does not hide the difference.
trouble "no/x.xml" timeout 60 "$kage" cosim random --frames 1000000 --config tiny --no-report --out unwritten --junit no/x.xml
expect 2 "$kage" cosim "${run[@]}" --all-spans --fault wrong_compare --no-divergence --out unwritten --junit /dev/full
grep -q '^different: ' stdout && grep -q '^first difference: frame 0, ' stdout || fail "the difference is lost: $(cat stdout)"

# A fault: every shard ends with its first difference; the frames behind it are skipped, and the stage's file is named.
for i in 1 2; do
  expect 1 "$kage" cosim "${run[@]}" --out broken --shard $i/2 --all-spans --fault wrong_compare --json b$i.json --junit b$i.xml
  grep -q '^::' stdout && fail "an annotation that nobody asked for"
done
junit b1.xml 's.get("tests")=="3" and s.get("failures")=="1" and s.get("skipped")=="2"'
junit b1.xml 'c[0].get("file").startswith("rtl/pixel_") and c[0][0].tag=="failure" and c[0][0].get("message").startswith("frame 0, ")'
junit b1.xml '"first divergence: frame 0, " in c[0][0].text and c[1][0].tag=="skipped"'
json b2.json 'j["first_difference"]["frame"]==1 and j["first_difference"]["divergence"]["text"].startswith("frame 1, ")'
expect 1 "$kage" merge b2.json b1.json --json b.json --junit b.xml
# A waveform without a divergence is nothing that kage writes, and no reason to fall over.
python3 - <<'PY'
import json
d = json.load(open("b1.json"))
d["first_difference"]["divergence"], d["first_difference"]["waveform"] = None, "x.fst"
json.dump(d, open("odd1.json", "w"))
PY
expect 1 "$kage" merge b2.json odd1.json --json odd.json --out odd
json b.json 'j["same"] is False and j["first_difference"]["frame"]==0 and j["frame_seconds"][2:]==[None]*3 and j["frames"]==2'
json b.json '[s["first_difference"]["frame"] for s in j["shards"]]==[0,1]'
junit b.xml 's.get("tests")=="5" and s.get("failures")=="2" and s.get("skipped")=="3"'
grep -q '^shard 2/2, first divergence: frame 1, ' stdout || fail "$(cat stdout)"

# A shard's second frame is the first that differs: it is named by its number, and so are its pictures.
expect 1 "$kage" cosim inside --frames 10 --size 3x2 --config default --all-spans --fault swallowed_toggle --shard 1/2 --out late --json late.json --junit late.xml
json late.json 'j["frames"]==2 and j["first_difference"]["frame"]==2 and j["first_difference"]["divergence"]["text"].startswith("frame 2, ")'
junit late.xml '[len(k) for k in c]==[0]+[1]*4 and c[1].get("name")=="frame 2" and c[1][0].tag=="failure" and s.get("skipped")=="3"'
[ -s late/inside_0002_difference.png ] || fail "no picture of frame 2's difference"

# GitHub: a line by which it finds the file, by itself in its actions, on standard error where standard output is JSON.
annotation='^::error file=rtl/pixel_banked\.sv,title=kage cosim courtyard%3A frame 0 is different::frame 0, [^%]*%0Afirst divergence: '
broken=("$kage" cosim "${run[@]}" --frames 1 --out broken --all-spans --fault wrong_compare)
expect 1 "${broken[@]}" --annotate github
grep -qE "$annotation" stdout || fail "no annotation: $(cat stdout)"
expect 1 env GITHUB_ACTIONS=true "${broken[@]}" --json -
json stdout 'j["same"] is False'
grep -qE "$annotation" stderr || fail "no annotation: $(cat stderr)"
expect 1 env GITHUB_ACTIONS=true "${broken[@]}" --annotate none
if grep -q '^::' stdout stderr; then fail "an annotation although none is wanted"; fi
expect 0 env GITHUB_ACTIONS=true "$kage" cosim "${run[@]}" --frames 1 --out shard
if grep -q '^::' stdout stderr; then fail "an annotation although all is the same"; fi

# Without the monitors no stage can be named; the verdict stands, and says so.
data_copy data && rm -r data/verif/cosim/diverge/monitors
expect 1 env KAGE_DATA_DIR="$PWD/data" "${broken[@]}" --annotate github --json d.json --junit d.xml
json d.json 'j["first_difference"]["divergence"] is None and "was not found: " in j["notes"][-1]'
junit d.xml 's.get("failures")=="1" and c[0].get("file") is None'
grep -q '^::error title=kage cosim courtyard%3A frame 0 is different::frame 0, ' stdout || fail "no annotation: $(cat stdout)"

# Progress: nothing in a pipe where the work is short; a line each so often where that is asked for. Here every frame has
# its line: two threads' frames may begin within a microsecond.
expect 0 env -u KAGE_PROGRESS "$kage" cosim "${run[@]}" --frames 1 --out shard
[ ! -s stderr ] || fail "says something in a pipe: $(cat stderr)"
expect 0 env KAGE_PROGRESS=1e-9 "$kage" cosim "${run[@]}" --out shard
grep -qE '^courtyard: frame 5/5' stderr || fail "no progress: $(cat stderr)"
if grep -q $'\r' stderr; then fail "a line is written over in a pipe"; fi
expect 0 env KAGE_PROGRESS=0 "$kage" cosim "${run[@]}" --out shard
[ ! -s stderr ] || fail "progress although none is wanted: $(cat stderr)"

# One frame that lasts says so too.
expect 0 env KAGE_PROGRESS=0.05 "$kage" cosim courtyard --frames 1 --size 1280x960 --config default --out shard
[ "$(grep -cE '^courtyard: frame 1/1' stderr)" -ge 2 ] || fail "one long frame, and no progress within it: $(cat stderr)"

# On a terminal a line is written over and over; on a dumb one, as in a pipe, there are lines.
python3 - "$kage" "${run[@]}" <<'PY' || fail "progress on a terminal"
import os, pty, subprocess, sys
def shown(term):
    master, slave = pty.openpty()
    subprocess.run([*sys.argv[1:2], "cosim", *sys.argv[2:], "--out", "shard"], stdout=subprocess.DEVNULL, stderr=slave, check=True,
                   env={**os.environ, "TERM": term, "KAGE_PROGRESS": "1e-9"})
    text = os.read(master, 1 << 16).decode()
    os.close(slave), os.close(master)
    return text
smart, dumb = shown("xterm"), shown("dumb")
assert smart.startswith("\r\033[K") and smart.endswith("\r\033[K") and "\n" not in smart, smart
assert "\033" not in dumb and dumb.endswith("\n") and "frame 5/5" in dumb, dumb
PY

# Options that make no sense: one line.
for shard in 0/2 3/2 2 /2 1/ 1/2/3 a/b 1/-2 1/0 -1/2; do trouble "--shard" "$kage" cosim "${run[@]}" --out none --shard=$shard; done
trouble "--shard 7/8: courtyard has only 5 frames" "$kage" cosim "${run[@]}" --out none --shard 7/8
trouble "--annotate" "$kage" cosim "${run[@]}" --out none --annotate gitlab
trouble "no such folder" "$kage" cosim "${run[@]}" --out none --junit nowhere/c.xml
trouble "two outputs have this name" "$kage" cosim "${run[@]}" --out none --junit c.json --json c.json
[ ! -e none ] && [ ! -e c.json ] || fail "a refused run leaves something"
trouble "shard 2/3 is missing" "$kage" merge 1.json 3.json --json none.json
trouble "b1.json: its option fault is wrong_compare, that of 1.json is not given" "$kage" merge 1.json b1.json
trouble "whole.json: the report of all frames" "$kage" merge whole.json
trouble "nowhere.json: cannot be read" "$kage" merge nowhere.json
trouble "1.xml: line 1, column 1: not JSON" "$kage" merge 1.xml
trouble "1.json: this output would overwrite an input" "$kage" merge 1.json 2.json 3.json --json 1.json
ln -s 2.json link.json
for o in "--json ./1.json" "--json $PWD/1.json" "--junit link.json"; do
  trouble ".json: this output would overwrite an input" "$kage" merge 1.json 2.json 3.json $o
done
trouble "REPORT is missing" "$kage" merge
# unit/cosim/shards has the other ways in which reports are spoilt, or are not of one run.
python3 -c "import json; j=json.load(open('1.json')); j['frames']=3; json.dump(j, open('spoilt.json','w'))"
trouble "spoilt.json: shard 1/3 of 5 frames cannot have the 3 that it claims" "$kage" merge spoilt.json 2.json 3.json
done_testing
