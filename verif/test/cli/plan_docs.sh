#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# docs/plan.md: its commands print what it shows, and its table of scenes is what kage info prints.
. "$(dirname "$0")/common.bash"

mkdir bin && ln -s "$kage" bin/kage
python3 "$source/verif/test/cli/shown.py" "$source/docs/plan.md" 0 0 0 || fail "docs/plan.md shows something else than its commands print"
python3 - "$kage" "$source/docs/plan.md" <<'PY' || fail "docs/plan.md: the table of scenes"
import json, re, subprocess, sys
kage, page = sys.argv[1], open(sys.argv[2]).read()
rows = re.findall(r"^\| ([a-z-]+) \| ([a-z]+) \| ([0-9,]+), ([0-9,]+) \| (?:([a-z]+): ([0-9,]+), ([0-9,]+))? *\|$", page, flags=re.M)
scenes = [s["name"] for s in json.loads(subprocess.run([kage, "list", "scenes", "--json", "-"], capture_output=True, text=True).stdout)["scenes"]]
assert [r[0] for r in rows] == scenes, (rows, scenes)
whole = lambda text: int(text.replace(",", ""))  # noqa: E731
bad = False
for scene, taken, clocks, luts, other, other_clocks, other_luts in rows:
    ran = subprocess.run([kage, "info", scene, "--size", "640x480", "--json", "-"], capture_output=True, text=True, check=True)
    j = json.loads(ran.stdout)
    costs = {c["name"]: (round(c["clocks"]), round(c["luts"])) for c in j["costs"]}
    bad |= j["configuration"] != taken or costs[taken] != (whole(clocks), whole(luts))
    if other: bad |= costs[other] != (whole(other_clocks), whole(other_luts))
sys.exit(bad)
PY
done_testing
