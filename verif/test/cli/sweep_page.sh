#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The output of kage sweep --out. The page has all rows as --json has them, and plots are well-formed SVG and PNG of the stated
# size. Each row has its pictures, and its command line draws the same. The page appears whole or not at all, and an output that
# cannot be written is refused before the work. The page's behaviour is tested by verif/test/report/sweep.py.
. "$(dirname "$0")/common.bash"
quick=(--size 64x48 --config default --no-area --no-cosim --store s.sqlite)
axes=(--axes "Z_BITS=8,24" --axes "SUB_BITS=4,5" --axes "LANES=1,16" --axes CHANNELS=1 --axes SIZE=32x24)

# checked FOLDER JSON: all that a page promises.
checked() {
  python3 - "$1" "$2" <<'PY' || fail "$1: the page"
import json, os, re, struct, sys
import xml.etree.ElementTree as xml
folder, rows = sys.argv[1], json.load(open(sys.argv[2]))
text = open(f"{folder}/sweep.html", encoding="utf-8").read()
data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)[1])
for r in rows: del r["schema"]
assert data["rows"] == rows, "rows are not those of --json"
assert not re.search(r'(src|href)="(?!data:)', text), "the page loads something"
def png_size(path):
    head = open(path, "rb").read(24)
    assert head[:8] == b"\x89PNG\r\n\x1a\n", path
    return struct.unpack(">II", head[16:24])
def rows_of(svg):
    found = [int(g.get("data-row")) for g in xml.fromstring(svg).iter("{http://www.w3.org/2000/svg}g") if g.get("data-row")]
    assert len(found) == len(set(found)), found
    return sorted(found)
named, plots = set(), set()
for group in data["groups"]:
    own = [i for i, r in enumerate(rows) if (r["scene"], r["look"]["width"], r["look"]["height"]) == (group["scene"], group["width"], group["height"])]
    assert group["rows"] == own, (group["rows"], own)
    assert (len(group["plots"]) >= 3) == (len(own) > 1), "plots of a group"
    for plot in group["plots"]:
        svg = open(f'{folder}/{plot["file"]}.svg', encoding="utf-8").read()
        assert svg == plot["wide"], "the page's plot is not the file's"
        assert rows_of(svg) == own and rows_of(plot["narrow"]) == own, "a plot lacks rows"
        assert f'{group["scene"]} at {group["width"]}x{group["height"]}' in xml.fromstring(svg).find("{http://www.w3.org/2000/svg}title").text
        assert png_size(f'{folder}/{plot["file"]}.png') == (1720, 1120), "a plot's size"
        plots |= {plot["file"] + ".svg", plot["file"] + ".png"}
for row, more in zip(rows, data["more"]):
    assert [p["frame"] for p in more["pictures"]] == list(range(row["frames"]))
    for what in ("visible_wrong", "shadow_wrong", "gross_wrong", "color_wrong"):
        assert sum(p[what] for p in more["pictures"]) == row["accuracy"][what], what
    assert row["accuracy"]["psnr"] is None or any(p["map"] for p in more["pictures"]), "what is wrong is not shown"
    for p in more["pictures"]:
        # Maps of pictures so small are four times as wide and high.
        for name, times in ((p["picture"], 1), (p["map"], 4)):
            if name is None: continue
            assert png_size(f"{folder}/{name}") == (times * row["look"]["width"], times * row["look"]["height"]), name
            named.add(name)
there = {f"{at}/{name}"[len(folder) + 1:] for at, _, names in os.walk(folder) for name in names}
assert there == named | plots | {"sweep.html"}, there ^ (named | plots | {"sweep.html"})
PY
}

expect 0 "$kage" sweep courtyard penumbra "${quick[@]}" "${axes[@]}" --frames 2 --out page --json all.json
[ "$(tail -1 stdout)" = "# page: page/sweep.html" ] || fail "the last line does not name the page: $(tail -1 stdout)"
checked page all.json

# Stored rows make a page without a measurement; the same rows the same files. Pictures of an earlier page go, all else stays.
touch page/pictures/0123456789abcdef.png page/pictures/mine.png page/mine.txt
cp -r page first
expect 0 "$kage" sweep courtyard penumbra "${quick[@]}" "${axes[@]}" --frames 2 --resume --out page --json again.json
grep -qF '# 0 measured now' stdout || fail "$(tail -2 stdout)"
[ ! -e page/pictures/0123456789abcdef.png ] || fail "a picture of no row is left"
rm page/pictures/mine.png page/mine.txt || fail "what is the reader's own is gone"
rm first/pictures/0123456789abcdef.png first/pictures/mine.png first/mine.txt
for end in svg png; do
  for file in first/*.$end first/pictures/*.$end; do
    [ ! -e "$file" ] || cmp "$file" "page/${file#first/}" || fail "$file comes out different"
  done
done
checked page again.json

# The command line of a row draws its pictures: with all in the core, with less, and with a configuration that lacks something.
python3 - page/sweep.html <<'PY' >lines || fail "the lines"
import json, re, sys
data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', open(sys.argv[1], encoding="utf-8").read(), re.S)[1])
rows = data["rows"]
for i in [0, next(i for i, r in enumerate(rows) if (r["axis"], r["value"]) == ("SUB_BITS", "4")), next(i for i, r in enumerate(rows) if r["scene"] == "penumbra")]:
    open(f"{i}.yaml", "w").write(data["more"][i]["yaml"])
    line = data["more"][i]["command"]
    assert f'--config {data["config_file"]} ' in line
    print(i, data["more"][i]["pictures"][1]["picture"], line.replace(data["config_file"], f"{i}.yaml").replace("kage ", "", 1))
PY
[ "$(wc -l <lines)" = 3 ] || fail "$(cat lines)"
while read -r i picture line; do
  eval "expect 0 '$kage' $line --out drawn$i"
  expect 0 "$kage" diff "page/$picture" drawn"$i"/*_0001.png
done <lines

# A row's sources of error in the page agree with the maps that its other command line draws.
read -r i picture line <lines
eval "expect 0 '$kage' $line --error-map --out maps --json maps.json"
python3 - "$i" <<'PY' || fail "the maps of sources"
import json, sys
row, drawn = json.load(open("all.json"))[int(sys.argv[1])], json.load(open("maps.json"))
for source, told in row["accuracy"]["sources"].items():
    if source == "all": continue
    for what in ("visible_wrong", "color_wrong"):
        assert sum(e["sources"][source][what] for e in drawn["errors"]) == told[what], (source, what)
PY

# "Make it again" makes the same page, whatever the sweep was given, and measures nothing.
python3 - page/sweep.html <<'PY' >again || fail "no line"
import json, re, sys
print(json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', open(sys.argv[1], encoding="utf-8").read(), re.S)[1])["command"].replace("kage ", "", 1))
PY
grep -qF -- '--store s.sqlite --resume' again || fail "$(cat again)"
cp page/sweep.html before.html
eval "expect 0 '$kage' $(cat again)"
grep -qF '# 0 measured now' stdout || fail "$(tail -2 stdout)"
cmp page/sweep.html before.html || fail "the page's own command line makes another page"
[ "$(stat -c %s page/sweep.html)" -le 10000000 ] || fail "the page has $(stat -c %s page/sweep.html) bytes"

# A command line with options that come several times is on the page as it was.
grep -qF -- '--axes Z_BITS=8,24 --axes SUB_BITS=4,5 --axes LANES=1,16' page/sweep.html || fail "the page's command line"

# A page of the rows of other stores, and of a shard alone, which may have none.
expect 0 "$kage" sweep courtyard penumbra "${quick[@]}" "${axes[@]}" --frames 2 --store taken.sqlite --take s.sqlite --shard 2/3 --out shard --json shard.json
grep -qF '# 0 measured now' stdout || fail "$(tail -2 stdout)"
checked shard shard.json
expect 0 "$kage" sweep courtyard "${quick[@]}" --axes Z_BITS=8 --frames 2 --store none.sqlite --shard 9/9 --out none --json none.json
checked none none.json

# Killed at any time it leaves a whole page or none, and the next one is whole.
for wait in 0 0.02 0.05 0.1 0.15 0.2 0.3 0.4; do
  "$kage" sweep courtyard penumbra "${quick[@]}" "${axes[@]}" --frames 2 --resume --out killed --json killed.json >/dev/null 2>&1 &
  pid=$!
  until [ -n "$(find killed -name '*.png' -path '*/.kage-*' 2>/dev/null | head -1)" ] || ! kill -0 $pid 2>/dev/null; do sleep 0.01; done
  sleep $wait  # from the first picture on
  kill -9 $pid 2>/dev/null
  wait $pid 2>/dev/null
  [ ! -e killed/sweep.html ] || python3 - <<'PY' || fail "killed after $wait s: the page lacks files"
import json, os, re
text = open("killed/sweep.html", encoding="utf-8").read()
data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)[1])
for more in data["more"]:
    for p in more["pictures"]: assert open("killed/" + p["picture"], "rb").read(4) == b"\x89PNG"
PY
done
expect 0 "$kage" sweep courtyard penumbra "${quick[@]}" "${axes[@]}" --frames 2 --resume --out killed --json killed.json
checked killed killed.json

# A name may be anything.
name="a<b>&'\"\$x <!-- --> <script>alert(1)"
cp "$source/scenes/courtyard.gltf" "$name.gltf"
expect 0 "$kage" sweep "$name.gltf" "${quick[@]}" --axes Z_BITS=8 --frames 1 --store odd.sqlite --out odd --json odd.json
checked odd odd.json

# An output that cannot be written is refused before the work, and nothing is left.
echo text >file
trouble "file" "$kage" sweep courtyard "${quick[@]}" --store no.sqlite --out file
trouble "/proc/none" "$kage" sweep courtyard "${quick[@]}" --store no.sqlite --out /proc/none
mkdir -p taken/sweep.html
trouble "taken/sweep.html: exists and is not a file" "$kage" sweep courtyard "${quick[@]}" --axes Z_BITS=8 --store no.sqlite --out taken
trouble "two outputs have this name" "$kage" sweep courtyard "${quick[@]}" --store no.sqlite --out same --json same/sweep.html
[ ! -e no.sqlite ] && [ ! -e same ] || fail "trouble leaves something"
expect 0 "$kage" sweep courtyard "${quick[@]}" --list --store no.sqlite --out listed
[ ! -e listed ] || fail "--list makes a folder"
KAGE_PLUGIN_DIR=$PWD/nowhere trouble "plots are drawn with it" "$kage" sweep courtyard "${quick[@]}" --axes Z_BITS=8 --store no.sqlite --out unplotted
[ ! -e unplotted ] || fail "a page without plots"
no_leftovers
done_testing
