#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage order: the table, JSON, plot, saved trees, and bad input.
. "$(dirname "$0")/common.bash"

python3 - <<'PY'
# Two balls through one another, and a plane.
import math
v, f = [], []
def ball(x, n=12):
    base = len(v)
    for i in range(n + 1):
        for j in range(2 * n):
            a, b = math.pi * i / n, math.pi * j / n
            v.append((x + math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)))
    at = lambda i, j: base + i * 2 * n + j % (2 * n)
    for i in range(n):
        for j in range(2 * n):
            if i > 0: f.append((at(i, j), at(i + 1, j), at(i, j + 1)))
            if i < n - 1: f.append((at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
ball(0)
ball(0.7)
base = len(v)
v += [(-2, -2, 0.1), (2, -2, 0.1), (2, 2, 0.1)]
f.append((base, base + 1, base + 2))
open("balls.off", "w").write("OFF\n%d %d 0\n" % (len(v), len(f)) + "".join("%r %r %r\n" % p for p in v) + "".join("3 %d %d %d\n" % t for t in f))
PY

few=(--eyes 20 --repeats 2)
expect 0 "$kage" order balls.off "${few[@]}" --json r.json --plot r.svg --save balls.bsp
for text in "nodes" "bytes per node" "random" "struct Node"; do grep -q "$text" stdout || fail "the table lacks '$text'"; done
json r.json '[r["step_degrees"] for r in j]==[0,0.1,1,10,100,"random"]'
json r.json 'all(r["identical"] is True and r["eyes"]==20 and r["polygons"]==1057 and r["nodes"]>=1000 for r in j)'
json r.json 'all(r["recursion_seconds"]>0 and r["switching_seconds"]>0 and abs(r["speedup"]*r["switching_seconds"]/r["recursion_seconds"]-1)<1e-9 for r in j)'
json r.json 'j[0]["flips_share"]==0 and 0<j[1]["flips_share"]<j[2]["flips_share"]<j[3]["flips_share"]<j[4]["flips_share"]<1'
json r.json 'all(0<r["bsp_bytes"]==56*r["nodes"] and r["list_bytes"]>0 and r["fragments"]==r["faces"]+r["splits"] for r in j)'
python3 -c 'import xml.dom.minidom as x; x.parse("r.svg")' || fail "the plot is no XML"
for command in info render cosim "stream --out none" "explain --pixel 1,1"; do
  # shellcheck disable=SC2086
  trouble "balls.bsp: a visibility order's tree; kage order takes it" "$kage" $command balls.bsp
done
python3 - r.svg <<'PY' || fail "labels of the plot's lines lie over each other"
import re, sys
ends = re.findall(r'<text x="570" y="([\d.]+)" fill="[^"]*">([^<]*)<', open(sys.argv[1]).read())
assert len(ends) == 4, ends
heights = sorted(float(y) for y, _ in ends)
assert all(b - a >= 14.8 for a, b in zip(heights, heights[1:])), ends
PY

# --json - leaves standard output to the JSON; a saved tree is the same tree, whatever the threads.
expect 0 "$kage" order balls.bsp "${few[@]}" --json -
cp stdout s.json
json s.json 'all(r["identical"] and r["build_seconds"] is None for r in j)'
python3 - <<'PY' || fail "the saved tree is another"
import json
r, s = (json.load(open(n))[0] for n in ("r.json", "s.json"))
raise SystemExit(any(r[k] != s[k] for k in ("polygons", "nodes", "fragments", "splits", "depth", "bsp_bytes", "flips_share")))
PY
expect 0 "$kage" order balls.off "${few[@]}" --threads 1 --save one.bsp
expect 0 "$kage" order balls.off "${few[@]}" --threads 5 --save five.bsp
cmp -s balls.bsp one.bsp || fail "one thread makes another tree"
cmp -s balls.bsp five.bsp || fail "five threads make another tree"
expect 0 "$kage" order balls.off "${few[@]}" --seed 2 --save two.bsp
cmp -s balls.bsp two.bsp && fail "another seed makes the same tree"
expect 0 "$kage" order courtyard "${few[@]}"

# A small mesh, whose tree needs the room for exchanges that vectors of one width need and others do not.
expect 0 "$kage" order "$source/verif/test/meshes/sixteen_faces.obj" --eyes 50 --repeats 1 --json few.json
json few.json 'all(r["identical"] and r["faces"]==16 for r in j)'

# Bad input.
head -c 5000 balls.bsp >cut.bsp
trouble "cut.bsp: byte" "$kage" order cut.bsp
python3 -c 'b=bytearray(open("balls.bsp","rb").read()); b[4000]^=1; open("bad.bsp","wb").write(b)'
trouble "bad.bsp: byte" "$kage" order bad.bsp
trouble "missing.off" "$kage" order missing.off
trouble "balls.off: to be put in order, polygons would be cut into more than 100 fragments" "$kage" order balls.off --max-fragments 100 --save none.bsp
[ ! -e none.bsp ] || fail "a refused build leaves a file"
trouble "nowhere" "$kage" order balls.off --save nowhere/x.bsp
trouble "nowhere" "$kage" order balls.off --plot nowhere/x.svg
trouble "nowhere" "$kage" order balls.off --json nowhere/x.json
trouble "--eyes" "$kage" order balls.off --eyes 1
trouble "--repeats" "$kage" order balls.off --repeats 0
trouble "MESH is missing" "$kage" order
printf 'OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n' >nan.off
trouble "nan.off" "$kage" order nan.off
no_leftovers
done_testing
