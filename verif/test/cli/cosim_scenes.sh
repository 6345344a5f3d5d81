#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Several scenes in one kage cosim, shards over their frames as one list, and the page of a joined run.
. "$(dirname "$0")/common.bash"
unset GITHUB_ACTIONS
run=(courtyard inside --size 64x48 --frames 4 --config default)

# cases FILE NAMES: JUnit's cases are just these, each its scene (the class) and its name, none failed.
cases() {
  python3 - "$1" "$2" <<'PY' || fail "$1: cases other than $2"
import sys, xml.etree.ElementTree as E
s = E.parse(sys.argv[1]).getroot()[0]
names = [c.get("classname").removeprefix("kage.cosim.") + " " + c.get("name") for c in s]
sys.exit(0 if names == sys.argv[2].split(",") and s.get("failures") == "0" and s.get("name") == "kage cosim" else 1)
PY
}
all=$(printf '%s,' courtyard\ frame\ {0,1,2,3} inside\ frame\ {0,1,2,3})
all=${all%,}

# Whole: a folder and a page for each scene, one over both, and sums.
expect 0 "$kage" cosim "${run[@]}" --out whole --json whole.json --junit whole.xml
grep -q '^same: 2 scenes, 8 frames of 8, 24576 pixels compared' stdout || fail "$(cat stdout)"
[ "$(tail -n 1 stdout)" = "report: whole/report.html" ] || fail "the last line does not name the page over all"
for scene in courtyard inside; do
  [ -s whole/$scene/${scene}_0003.png ] && [ -s whole/$scene/report.html ] || fail "no pictures or page of $scene"
done
json whole.json 'j["same"] is True and j["total_frames"]==8 and [s["scene"] for s in j["scenes"]]==["courtyard","inside"]'
json whole.json 'all(j[k]==sum(s[k] for s in j["scenes"]) for k in ["frames","pixels_compared","spans","span_pixels","cycles"])'
json whole.json 'all(len(s["each"])==4 and sum(f["cycles"] for f in s["each"])==s["cycles"] for s in j["scenes"])'
json whole.json 'all(s["options"]["order"]=="exact" and s["again"].startswith("kage cosim courtyard inside ") for s in j["scenes"])'
cases whole.xml "$all"

# With three shards over the eight frames the second begins with inside's frame 0; all have each frame once, as the whole.
for i in 1 2 3; do
  expect 0 "$kage" cosim "${run[@]}" --out $i --shard $i/3 --json $i.json --junit $i.xml
done
cases 2.xml "courtyard frame 1,inside frame 0,inside frame 3"
expect 0 "$kage" merge 3.json 1.json 2.json --out joined --json all.json --junit all.xml
grep -q '^same: 2 scenes, 8 frames of 8 in 3 shards, 24576 pixels compared' stdout || fail "$(cat stdout)"
cases all.xml "$all"
python3 - <<'PY' || fail "the shards' sums are not those of the whole"
import json
a, w = json.load(open("all.json")), json.load(open("whole.json"))
for x, y in [(a, w), *zip(a["scenes"], w["scenes"])]:
    for k in ["same", "frames", "total_frames", "pixels_compared", "spans", "span_pixels", "seed", "first_difference"]:
        assert x[k] == y[k], (k, x[k], y[k])
for x, y in zip(a["scenes"], w["scenes"]):
    spans = lambda s: [(f["frame"], f["spans"], f["words"]) for f in s["each"]]
    assert spans(x) == spans(y) and len(x["frame_seconds"]) == 4 and None not in x["frame_seconds"]
PY
for i in 0 1 2 3; do
  expect 0 "$kage" diff "$(ls [123]/inside/inside_000$i.png)" whole/inside/inside_000$i.png
done

# A shard may have none of a scene's frames.
for i in 1 2; do expect 0 "$kage" cosim courtyard inside --size 64x48 --frames 1 --out few$i --shard $i/2 --json few$i.json; done
json few2.json 'j["frames"]==1 and j["scenes"][0]=={"same":None,"frames":0,"scene":"courtyard","total_frames":1}'
[ ! -e few2/courtyard ] || fail "a folder for a scene that was not run"
expect 0 "$kage" merge few1.json few2.json --out few
trouble "--shard 3/3: the scenes have only 2 frames" "$kage" cosim courtyard inside --size 64x48 --frames 1 --out none --shard 3/3

# The page: no larger than a run's, nothing loaded, links to the runs' pages only where those are.
links() { # PAGE COUNT
  python3 - "$1" "$2" <<'PY' || fail "$1: not $2 links to pages that are there"
import json, os, re, sys, urllib.parse
text = open(sys.argv[1]).read()
data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.S)[1])
pages = [r["page"] for p in data["parts"] for r in p["runs"] if r["page"]]
assert len(pages) == int(sys.argv[2]), pages
for p in pages: assert p.startswith("./") and os.path.isfile(os.path.join(os.path.dirname(sys.argv[1]), urllib.parse.unquote(p))), p
assert len(text) < 10_000_000 and len(data["frames"]) == sum(s["total_frames"] for s in data["scenes"])
PY
}
links joined/report.html 6
links whole/report.html 2
json all.json 'j["report"]=="joined/report.html"'
mkdir moved moved/a\ b && cp -r 1 1.json "moved/a b" && cp 2.json 3.json moved && mv 2 2-away && mv 3 3-away
expect 0 "$kage" merge "moved/a b/1.json" moved/2.json moved/3.json --out moved/joined
links moved/joined/report.html 2
grep -q '"page":"./../a%20b/1/courtyard/report.html"' moved/joined/report.html || fail "the link is not relative to the page"
echo >>"moved/a b/1/inside/report.html" && echo >>1/inside/report.html  # another page of that name is not linked to
expect 0 "$kage" merge "moved/a b/1.json" moved/2.json moved/3.json --out moved/joined
links moved/joined/report.html 1
mv 2-away 2 && mv 3-away 3

# A file that the joined page would replace stays, and a refused run leaves nothing.
cp 1/courtyard/report.html kept.html
trouble "1/courtyard/report.html: is the page of 1.json: it is not written over" "$kage" merge 1.json 2.json 3.json --out 1/courtyard
cmp -s kept.html 1/courtyard/report.html || fail "a shard's page was written over"
trouble "1/report.html: is the page of 1.json" "$kage" merge 1.json 2.json 3.json --out 1
trouble "shard 2/3 is missing" "$kage" merge 1.json 3.json --out none --json none.json
trouble "2.json: shard 2/3 once more, as 2.json" "$kage" merge 1.json 2.json 3.json 2.json --out none
trouble "no such folder" "$kage" merge 1.json 2.json 3.json --out none --json nowhere/all.json
[ ! -e none ] || fail "a refused merge leaves a folder"
for i in 1 2 3; do expect 0 "$kage" cosim inside courtyard --size 64x48 --frames 4 --config default --out turned --shard $i/3 --json turned$i.json; done
trouble "turned2.json: its scene is not that of 1.json" "$kage" merge 1.json turned2.json 3.json
# spoilt EXPRESSION: 2.json with its content as j changed.
spoilt() { python3 -c "import json; j=json.load(open('2.json')); s=j['scenes']; $1; json.dump(j, open('spoilt.json','w'))"; }
while IFS='|' read -r change text; do
  spoilt "$change"
  trouble "$text" "$kage" merge 1.json spoilt.json 3.json --out none
done <<'CASES'
s[1]['config']['LANES']=4|spoilt.json: its config is not that of 1.json
s[1]['seed']=2|spoilt.json: its seed is not that of 1.json
s[0]['options']['idle']=5|spoilt.json: its option idle is 5, that of 1.json is 0
s[0]['total_frames']=5|spoilt.json: its total_frames is not that of 1.json
s[1]['first_frame']=1|cannot have the 2 that it claims
s[1]['frame_step']=1|cannot have the 2 that it claims
s[1]['each'][1]['frame']=0|spoilt.json: frame 0 is there twice or is not of shard 2/3
s[1]['each'][1]['frame']=2|spoilt.json: frame 2 is there twice or is not of shard 2/3
s[1]['each'][0]['stalled']=1|stalled is not what it should be
s[0].update(frames=0)|frames is not what it should be
s.pop()|spoilt.json: its scenes are not those of 1.json
s.append(1)|scenes is not what it should be
j['scenes']=[]|scenes is not what it should be
j['scenes'][0].clear()|frames is missing (scenes/0/frames)
s[0]['report']=1|report is not what it should be
CASES
[ ! -e none ] || fail "a refused merge leaves a folder"

# A fault in one of two scenes: the exit code is the worse, the other scene has its verdict.
expect 1 "$kage" cosim inside courtyard --size 3x2 --frames 4 --config default --all-spans --fault swallowed_toggle --out broken --json broken.json --annotate github
json broken.json '[s["same"] for s in j["scenes"]].count(False)>=1 and j["same"] is False and j["first_difference"]["scene"]=="inside"'
[ "$(grep -c '^::error ' stdout)" = "$(python3 -c "import json; print([s['same'] for s in json.load(open('broken.json'))['scenes']].count(False))")" ] ||
  fail "not an annotation for each scene that differs"

trouble "courtyard: a scene called courtyard is there already: courtyard" "$kage" cosim courtyard courtyard --out none
trouble "nowhere.obj" "$kage" cosim courtyard nowhere.obj --out none
[ ! -e none ] || fail "a refused run leaves something"
done_testing
