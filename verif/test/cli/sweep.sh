#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage sweep from outside: table, JSON and CSV say the same. Rows that are in the store are not measured again, and a sweep that
# is killed goes on. Shards are the whole; clocks by phases are those of the RTL; an option that is no axis is refused in one
# line.
. "$(dirname "$0")/common.bash"
quick=(--size 64x48 --frames 1 --config default --no-area --no-cosim)
axes=(--axes "Z_BITS=8,24" --axes "SUB_BITS=4,5" --axes "LANES=1,16" --axes SHADE_FRAC=3)

# measured FILE: the rows without what differs from run to run.
measured() {
  python3 -c 'import json, sys
j = json.load(open(sys.argv[1]))
for r in j: del r["speed"]["golden_ns_per_pixel"], r["speed"]["cosim_frames_per_second"]
json.dump(j, sys.stdout, indent=1)' "$1"
}

# One sweep, told in three ways.
expect 0 "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --json a.json --csv a.csv
cp stdout table
[ "$(tail -2 stdout)" = "# 7 measured now, kept in sweep.sqlite
# csv: a.csv" ] || fail "$(tail -2 stdout)"
json a.json 'len(j) == 7 and [r["axis"] for r in j] == ["base", "Z_BITS", "SUB_BITS", "SUB_BITS", "LANES", "LANES", "SHADE_FRAC"]'
json a.json 'all(r["accuracy"]["gross_wrong"] == 0 and 0 < r["accuracy"]["z_error_max_lsb"] <= r["accuracy"]["z_error_bound_lsb"] for r in j)'
json a.json 'j[1]["accuracy"]["visible_wrong"] + j[1]["accuracy"]["shadow_wrong"] > 0 and j[2]["accuracy"]["sources"]["snapping"]["visible_wrong"] > 0'
json a.json 'j[0]["accuracy"]["visible_wrong"] == 0 and j[4]["speed"]["rtl_cycles_per_pixel"] > 1.5 * j[5]["speed"]["rtl_cycles_per_pixel"]'
json a.json 'all(r["accuracy"]["sources"]["all"] == j[0]["accuracy"]["sources"]["all"] for r in j[4:6])'
python3 - <<'PY' || fail "table, JSON and CSV differ"
import csv, json, math, re
rows, table = json.load(open("a.json")), [line for line in open("table") if not line.startswith("#")]
head = next(line for line in open("table") if line.startswith("# axis value"))
for name in head.replace("z LSB", "z_LSB").replace("sim fps", "sim_fps").split()[3:]:
    column = re.escape(name.replace("_", " "))
    assert name in ("pixels", "LUTs") or any(re.search(rf"(^# |[,;] ){column}[,: ]", line) for line in open("table")), f"no word on {name}"
sheet = list(csv.DictReader(open("a.csv")))
assert len(rows) == len(sheet) == len(table), (len(rows), len(sheet), len(table))
def flat(value, name=""):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from flat(inner, f"{name}.{key}" if name else key)
    else:
        yield name, value
for row, cells, line in zip(rows, sheet, table):
    for name, value in flat(row):
        if name == "schema": continue
        if value is None: assert cells.get(name, "") == "", name
        elif isinstance(value, str): assert cells[name] == value, name
        else: assert json.loads(cells[name]) == value, name
    told = line.split()[-14:]
    a, s, area = row["accuracy"], row["speed"], row["area"]
    assert line.startswith("*") == row["pareto"], line
    assert told[:4] == [str(a[k]) for k in ("pixels", "visible_wrong", "shadow_wrong", "gross_wrong")], line
    assert f'{s["rtl_cycles_per_pixel"]:.3f}' in line and f'{area["luts"]:.0f}~' in line, line
    assert f'{a["z_error_max_lsb"]:.2f}/{a["z_error_bound_lsb"]:.2f}' in told, line
    assert str(math.floor(s["words_per_frame"] + 0.5)) in told, line
PY

# Both go to standard output, alone on it.
expect 0 "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --resume --csv - --json b.json
cmp stdout a.csv || fail "--csv - is not the CSV alone"
cmp a.json b.json || fail "beside --csv - the JSON is another"
expect 0 "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --resume --json - --csv b.csv
cmp stdout a.json || fail "--json - is not the JSON alone"
cmp a.csv b.csv || fail "beside --json - the CSV is another"
[ ! -e - ] || fail "a file is called -"

# Rows that are kept are not measured again; without --resume a store is not touched.
# A sweep that was killed at once leaves a file of no bytes, which is no store yet.
: >at_once.sqlite
expect 0 "$kage" sweep courtyard "${quick[@]}" --axes SHADE_FRAC=3 --store at_once.sqlite
grep -q "kept in at_once.sqlite" stdout || fail "$(tail -2 stdout)"
trouble "at_once.sqlite: there is a store already" "$kage" sweep courtyard "${quick[@]}" --store at_once.sqlite
trouble "sweep.sqlite: there is a store already: --resume goes on with it" "$kage" sweep courtyard "${quick[@]}"
expect 0 "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --resume --json again.json
tail -1 stdout | grep -qxF '# 0 measured now, 7 others were in sweep.sqlite' || fail "$(tail -1 stdout)"
cmp a.json again.json || fail "a resumed sweep says something else"
expect 0 "$kage" sweep courtyard "${quick[@]}" --axes Z_BITS=8,12 --resume
tail -1 stdout | grep -qxF '# 1 measured now, 2 others were in sweep.sqlite' || fail "$(tail -1 stdout)"

# A row is kept for its scene and its truth, not only for its words. A core without TRANSLUCENCY has the same words whatever
# --alpha is, and a core with a light table the same whether its base has one.
printf 'v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -1 -1 -1\nv 1 -1 -1\nv 0 1.5 -1\nf 1 2 3 4\nf 5 6 7\n' >panes.obj
for alpha in 0.9 0.2; do
  opaque=(panes.obj --size 64x48 --frames 1 --no-area --no-cosim --no-flip --alpha "$alpha" --axes TRANSLUCENCY=0)
  expect 0 "$kage" sweep "${opaque[@]}" --store panes.sqlite --resume --json panes.$alpha.json
  tail -1 stdout | grep -qF '# 2 measured now' || fail "--alpha $alpha: $(tail -1 stdout)"
done
python3 -c 'import json; a, b = (json.load(open(f"panes.{alpha}.json"))[1]["accuracy"]["psnr"] for alpha in ("0.9", "0.2")); assert a > b + 10, (a, b)' || fail "--alpha changes no error"
printf '{COUNT_BITS: 1}\n' >counters.yaml
expect 0 "$kage" sweep courtyard --config counters.yaml --size 32x24 --frames 1 --no-area --no-cosim --no-flip --axes CLASS_BITS=8 --store table.sqlite --json table.json
json table.json 'j[1]["accuracy"]["sources"]["classes"]["mean_square"] < 0.01 * j[0]["accuracy"]["sources"]["classes"]["mean_square"]'

# Volumes that a core without FSF leaves out are wrong shadows, and none of them is a bug. One frame is no "frames".
for scene in "courtyard --config default" three-lights; do
  # shellcheck disable=SC2086
  expect 0 "$kage" sweep $scene --size 64x48 --frames 1 --no-area --no-cosim --no-flip --axes FSF=0 --store fsf.sqlite --resume --json fsf.json
  json fsf.json 'j[1]["accuracy"]["shadow_wrong"] > 100 and j[1]["accuracy"]["gross_wrong"] == 0'
done
grep -qF '# three-lights: 1 frame;' stdout || fail "$(head -1 stdout)"

# A store is a file, whatever its name means to SQLite.
for store in :memory: 'file:a?mode=memory'; do
  expect 0 "$kage" sweep courtyard "${quick[@]}" --axes Z_BITS=8 --store "$store"
  expect 0 "$kage" sweep courtyard "${quick[@]}" --axes Z_BITS=8 --store kept.sqlite --resume --take "$store"
  grep -qF '# 0 measured now' stdout || fail "$store: $(tail -1 stdout)"
done

# A name that is no text: what is not UTF-8 of it is replaced, as in every JSON of kage.
cp "$source/scenes/courtyard.gltf" "$(printf 'b\xffd.gltf')"
expect 0 "$kage" sweep "$(printf 'b\xffd.gltf')" "${quick[@]}" --axes Z_BITS=8 --store name.sqlite --out name --json name.json
json name.json 'j[0]["scene"] == "b\ufffdd.gltf"'

# Killed, as often as it takes, it goes on and ends with the same rows; what was measured is not lost.
runs=0
for _ in 1 2 3 4; do
  "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --jobs 1 --store killed.sqlite --resume >/dev/null 2>&1 &
  pid=$!
  for _ in $(seq 200); do
    now=$(python3 -c 'import sqlite3; print(sqlite3.connect("file:killed.sqlite?mode=ro", uri=True).execute("select count(*) from run").fetchone()[0])' 2>/dev/null || echo 0)
    [ "$now" -gt "$runs" ] && break
    sleep 0.02
  done
  kill -9 $pid 2>/dev/null
  wait $pid 2>/dev/null
  now=$(python3 -c 'import sqlite3; print(sqlite3.connect("killed.sqlite").execute("select count(*) from run").fetchone()[0])')
  [ "$now" -ge "$runs" ] && [ "$now" -gt 0 ] || fail "a run is lost: $now of $runs"
  runs=$now
done
expect 0 "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --store killed.sqlite --resume --json killed.json
grep -qF "# $((7 - runs)) measured now" stdout || fail "$runs were kept: $(tail -1 stdout)"
[ "$(measured killed.json)" = "$(measured a.json)" ] || fail "a killed sweep ends with other rows"

# Two shards are the whole.
for i in 1 2; do
  expect 0 "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --shard $i/2 --store part$i.sqlite --json part$i.json
done
json part1.json 'len(j) == 4'
json part2.json 'len(j) == 3'
expect 0 "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --take part1.sqlite --take part2.sqlite --store whole.sqlite --json whole.json
grep -qF '# 0 measured now' stdout || fail "$(tail -1 stdout)"
[ "$(measured whole.json)" = "$(measured a.json)" ] || fail "shards are not the whole"

# Rows that are in the store of another build, scene or tool are measured anew, and a line says how many and why.
cp part1.sqlite old.sqlite
python3 - <<'PY' || fail "the store is not what this test edits"
import hashlib, sqlite3, struct
db = sqlite3.connect("old.sqlite")
def sum_of(*columns):
    return hashlib.sha256(b"".join(struct.pack("<Q", len(c.encode())) + c.encode() for c in columns)).hexdigest()
db.create_function("sum_of", 7, sum_of)
columns = "key, scene, point, row, build, faces, tools"
assert not db.execute(f"select 1 from run where sum != sum_of({columns})").fetchall()
points = [key for (key,) in db.execute("select key from run order by key")]
assert len(points) == 4
db.execute("update run set key = 'a' || key, build = 'kage 0.0.1' where key != ?", points[:1])
db.execute("update run set key = 'b' || key, faces = 'others' where key = ?", points[:1])
db.execute(f"update run set sum = sum_of({columns})")
db.commit()
PY
cp old.sqlite changed.sqlite
python3 -c 'import sqlite3; db = sqlite3.connect("changed.sqlite"); db.execute("update run set row = replace(row, 1, 2)"); db.commit()'
trouble 'changed.sqlite: the store is damaged, so begin another: table run, row ' "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --take changed.sqlite --store no.sqlite
cp part1.sqlite changed.sqlite
python3 -c 'import sqlite3; db = sqlite3.connect("changed.sqlite"); db.execute("update run set row = \"{\""); db.commit()'
trouble 'changed.sqlite: the store is damaged, so begin another: table run, row ' "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --shard 1/2 --store changed.sqlite --resume
expect 0 "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --take old.sqlite --take part2.sqlite --store anew.sqlite
grep -qF '# 4 measured now' stdout || fail "$(tail -1 stdout)"
cat >want <<'EOF'
kage: 3 rows are measured anew, because anew.sqlite has them of another build of kage
kage: 1 row is measured anew, because anew.sqlite has it of another scene of this name
EOF
cmp stderr want || fail "$(cat stderr)"
expect 0 "$kage" sweep courtyard "${quick[@]}" "${axes[@]}" --store anew.sqlite --resume
[ ! -s stderr ] || fail "rows that are there are said to be old: $(cat stderr)"

# Samples that no light of a scene has are told of that scene. A half of words is rounded up.
expect 0 "$kage" sweep courtyard penumbra --size 32x24 --frames 2 --no-area --no-cosim --no-flip --samples 1 --axes SAMPLES=3 --store soft.sqlite --json soft.json
[ "$(cat stderr)" = "kage: courtyard: no light is soft, so SAMPLES changes no picture: what it adds to COUNT_BITS only costs" ] || fail "$(cat stderr)"
json soft.json 'j[0]["config"]["COUNT_BITS"] < j[1]["config"]["COUNT_BITS"] and j[0]["accuracy"]["sources"] == j[1]["accuracy"]["sources"]'

# A row of another size has its own number of pixels.
expect 0 "$kage" sweep courtyard "${quick[@]}" --axes SIZE=32x24 --store size.sqlite
[ "$(sed '/^#/d; s/^[ *]//' stdout | awk '{print $1, $(NF - 13)}')" = "base 3072
SIZE 768" ] || fail "pixels of rows: $(cat stdout)"

# About a plan of the scene for the sweep's size and frames: what kage plan prints for them.
expect 0 "$kage" sweep courtyard --config plan --size 64x48 --no-area --no-cosim --axes Z_BITS=20 --store plan.sqlite --json plan.json
expect 0 "$kage" plan courtyard --size 64x48 --frames 2 --json planned.json
python3 - <<'PY' || fail "the base of --config plan is not what kage plan prints"
import json
rows, plan = json.load(open("plan.json")), json.load(open("planned.json"))["config"]
assert [r["axis"] for r in rows] == ["base", "Z_BITS"] and rows[0]["frames"] == 2, rows
assert rows[0]["config"] == plan, (rows[0]["config"], plan)
assert rows[1]["config"] == {**plan, "Z_BITS": 20}, rows[1]["config"]
assert rows[0]["accuracy"]["gross_wrong"] == 0
PY

# A grid, seeds, and what would be measured.
expect 0 "$kage" sweep penumbra --size 64x48 --axes SAMPLES=1,4 --axes Z_BITS=12,24 --grid --seeds 2 --list
[ "$(wc -l <stdout)" = 6 ] || fail "$(cat stdout)"
! grep -q ' $' stdout || fail "--list: a line ends with a blank"
# Values that exclude each other are no row under a name that is not theirs: they are left out, and a line says so.
grid() { expect 0 "$kage" sweep courtyard --size 64x48 --frames 1 "$@" --grid --list; }
grid --axes SMOOTH=0,1 --axes COLOR_FRAC=0,8
[ "$(cat stdout)" = "courtyard: grid SMOOTH=0 COLOR_FRAC=0
courtyard: grid SMOOTH=1 COLOR_FRAC=0
courtyard: grid SMOOTH=1 COLOR_FRAC=8" ] || fail "$(cat stdout)"
[ "$(cat stderr)" = "kage: courtyard: 1 combination of --grid is left out, because values exclude each other: SMOOTH=0 COLOR_FRAC=8: SMOOTH becomes 1" ] || fail "$(cat stderr)"
expect 0 "$kage" sweep courtyard "${quick[@]}" --axes SMOOTH=0,1 --axes COLOR_FRAC=0,8 --axes DSF_BITS=0,1 --axes COUNT_BITS=0,4 --grid --store grid.sqlite --json grid.json
json grid.json 'len(j) == 9 and all(r["value"] == " ".join("%s=%d" % (k, r["config"][k]) for k in ("SMOOTH", "COLOR_FRAC", "DSF_BITS", "COUNT_BITS")) for r in j)'
grep -qF 'kage: courtyard: 7 combinations of --grid are left out' stderr || fail "$(cat stderr)"
grid --axes SAMPLES=1,64 --axes COUNT_BITS=2
[ "$(cat stdout)" = "courtyard: grid SAMPLES=1 COUNT_BITS=2" ] || fail "$(cat stdout)"
trouble "--grid: no combination can have all the values that it names, as SAMPLES=64 COUNT_BITS=2: SAMPLES becomes 1" "$kage" sweep courtyard "${quick[@]}" --axes SAMPLES=64 --axes COUNT_BITS=2 --grid --store no.sqlite
# An axis that is named again has all of its values.
grid --axes Z_BITS=8 --axes LANES=1 --axes Z_BITS=9
[ "$(cat stdout)" = "courtyard: grid Z_BITS=8 LANES=1
courtyard: grid Z_BITS=9 LANES=1" ] || fail "$(cat stdout)"

# Seeds: of scenes with a soft light alone, each row with its seed behind its name. --samples 1 is where a sweep begins, and
# no reason to leave samples out.
expect 0 "$kage" sweep courtyard --seeds 3 --axes SAMPLES=4 --list
[ "$(cat stdout)" = "courtyard: base
courtyard: SAMPLES 4" ] || fail "$(cat stdout)"
expect 0 "$kage" sweep penumbra --seeds 2 --axes SAMPLES=4 --list
[ "$(cat stdout)" = "penumbra: base
penumbra: SAMPLES 4
penumbra: base seed 2
penumbra: SAMPLES 4 seed 2" ] || fail "$(cat stdout)"
expect 0 "$kage" sweep penumbra --samples 1 --list
grep -qx 'penumbra: SAMPLES 255' stdout || fail "$(cat stdout)"

expect 0 "$kage" sweep courtyard --list
grep -qx 'courtyard: base' stdout || fail "$(head -1 stdout)"
[ "$(wc -l <stdout)" -gt 50 ] || fail "$(wc -l <stdout) configurations"

# Clocks by phases are those of the RTL within a thousandth: the base's model stands for the other, which is built to check it.
expect 0 "$kage" sweep courtyard --size 64x48 --frames 1 --config default --no-area --axes Z_BITS=20 --store rtl.sqlite --json rtl.json
json rtl.json 'j[0]["speed"]["rtl_cycles_from"] == j[1]["speed"]["rtl_cycles_from"] == "cosim"'
json rtl.json 'abs(j[1]["speed"]["phases_cycles_per_pixel"] / j[1]["speed"]["rtl_cycles_per_pixel"] - 1) < 1e-3'
json rtl.json 'j[0]["speed"]["cosim_frames_per_second"] > 0'

# Cells that another yosys has counted are counted anew; those that an earlier one has counted are still in the store.
cat >fake-yosys <<'SH'
#!/bin/sh
[ "$1" = -V ] && { echo "Yosys $FAKE"; exit 0; }
printf '     LUT4   %s000\n     MULT18X18D   %s\n' "$FAKE" "$FAKE" >"$(echo "$3" | sed 's/.*tee -q -o \([^ ]*\) stat.*/\1/')"
SH
chmod +x fake-yosys
# counted VERSION FILE: a sweep with a yosys of this version, whose cores have as many thousand look-up tables.
counted() {
  YOSYS=$PWD/fake-yosys FAKE=$1 XDG_CACHE_HOME=$PWD/cache expect 0 "$kage" sweep courtyard --size 64x48 --frames 1 \
    --config tiny --no-cosim --axes SUB_BITS=4 --store tools.sqlite --resume --json "$2"
}
counted 7 seven.json
json seven.json '[(r["area"]["luts"], r["area"]["dsps"]) for r in j] == [(7000, 7)] * 2'
counted 8 eight.json
tail -1 stdout | grep -qF '# 2 measured now' || fail "$(tail -1 stdout)"
grep -qF 'kage: 2 rows are measured anew, because tools.sqlite has them of other tools' stderr || fail "$(cat stderr)"
json eight.json '[r["area"]["luts"] for r in j] == [8000, 8000]'
counted 7 seven-again.json
tail -1 stdout | grep -qF '# 0 measured now' || fail "$(tail -1 stdout)"
cmp seven.json seven-again.json || fail "rows of an earlier yosys differ"

# Two scenes that ask for one core at the same time: it is counted once, and both rows have it.
sed '2a echo >>counts; sleep 1' fake-yosys >slow-yosys
chmod +x slow-yosys
YOSYS=$PWD/slow-yosys FAKE=9 XDG_CACHE_HOME=$PWD/cache-two expect 0 "$kage" sweep courtyard depths --size 64x48 --frames 1 \
  --config tiny --no-cosim --no-flip --axes SUB_BITS=4 --jobs 4 --store two.sqlite --json two.json
json two.json '[r["area"]["luts"] for r in j] == [9000] * 4'
[ "$(wc -l <counts)" = 1 ] || fail "a core was counted $(wc -l <counts) times"

# Tools that are missing, or a device that is not there, end a sweep before it measures.
mkdir few
for name in bash env dirname nproc sed grep wc; do ln -s "$(command -v $name)" few/; done
ln -s /usr/bin/python3 few/
PATH=$PWD/few XDG_CACHE_HOME=$PWD/nothing trouble "--place ecp5-85f: tools/fpga: yosys: not found; Debian's package is yosys, tools/deps fpga installs it" "$kage" sweep courtyard "${quick[@]}" --place --store no.sqlite
trouble "--place nowhere: tools/fpga: nowhere: no such device or board; there are ecp5-12f, ecp5-25f" "$kage" sweep courtyard "${quick[@]}" --place=nowhere --store no.sqlite
data_copy data
KAGE_DATA_DIR=$PWD/data trouble "data/tools/fpga: cores are placed by a kage in its source tree" "$kage" sweep courtyard "${quick[@]}" --place --store no.sqlite
YOSYS=/nonexistent trouble "/nonexistent: not found" "$kage" sweep courtyard --config tiny --no-cosim --store no.sqlite

trouble "--axes DEPTH=3: there is no axis DEPTH; there are SUB_BITS, SAMPLES" "$kage" sweep courtyard "${quick[@]}" --axes DEPTH=3 --store no.sqlite
trouble "--axes z_bits=3: there is no axis z_bits (did you mean Z_BITS?)" "$kage" sweep courtyard "${quick[@]}" --axes z_bits=3 --store no.sqlite
trouble "--axes ZBITS=3: there is no axis ZBITS (did you mean Z_BITS?)" "$kage" sweep courtyard "${quick[@]}" --axes ZBITS=3 --store no.sqlite
trouble "--axes Z_BITS: 99 is no whole number from 4 to 28" "$kage" sweep courtyard "${quick[@]}" --axes Z_BITS=99 --store no.sqlite
trouble "--axes Z_BITS: an empty value is no whole number" "$kage" sweep courtyard "${quick[@]}" --axes Z_BITS=12, --store no.sqlite
trouble "--axes Z_BITS: it has no values" "$kage" sweep courtyard "${quick[@]}" --axes Z_BITS --store no.sqlite
trouble "LANES is 3" "$kage" sweep courtyard "${quick[@]}" --axes LANES=3 --store no.sqlite
trouble "--grid: of the axes that --axes names, and there is none" "$kage" sweep courtyard "${quick[@]}" --grid --store no.sqlite
trouble "part3.sqlite: no such file" "$kage" sweep courtyard "${quick[@]}" --take part3.sqlite --store no.sqlite
echo text >text.sqlite
trouble "text.sqlite: no store of kage sweep" "$kage" sweep courtyard "${quick[@]}" --store text.sqlite --resume
[ "$(cat text.sqlite)" = text ] || fail "a file that is no store was written to"
# A store that cannot be used says why; --resume is named where it would help. A store to take from is asked before one is made.
trouble "text.sqlite: no store of kage sweep: it is no SQLite file" "$kage" sweep courtyard "${quick[@]}" --store text.sqlite
trouble "text.sqlite: no store of kage sweep: it is no SQLite file" "$kage" sweep courtyard "${quick[@]}" --take text.sqlite --store no.sqlite
[ "$(cat text.sqlite)" = text ] || fail "a file that is no store was written to"
trouble "none/a.sqlite: cannot be written: no such folder" "$kage" sweep courtyard "${quick[@]}" --store none/a.sqlite
trouble "few: exists and is not a file" "$kage" sweep courtyard "${quick[@]}" --store few --resume
trouble "few: a folder, and no store" "$kage" sweep courtyard "${quick[@]}" --take few --store no.sqlite
head -c 5000 sweep.sqlite >half.sqlite
trouble "half.sqlite: the store is damaged, so begin another: " "$kage" sweep courtyard "${quick[@]}" --store half.sqlite --resume
trouble "courtyard: given twice" "$kage" sweep courtyard glass courtyard "${quick[@]}" --store no.sqlite
trouble "random frames are for" "$kage" sweep random --store no.sqlite
[ ! -e no.sqlite ] || fail "trouble leaves a store"
no_leftovers
done_testing
