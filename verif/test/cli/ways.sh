#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Which components a unit had and which became spans, and why: in cosim's JSON, in a stream's file, in kage info.
. "$(dirname "$0")/common.bash"

# Three loose triangles are one entry, a tetrahedron another.
cat >mixed.obj <<'OBJ'
v 0 0 0
v 1 0 0
v 0 1 0
v 2 0 0
v 3 0 0
v 2 1 0
v 0 2 0
v 1 2 0
v 0 3 1
v 4 0 0
v 5 0 0
v 4 1 0
v 4 0 1
o soup
f 1 2 3
f 4 5 6
f 7 8 9
o tetrahedron
f 10 12 11
f 10 11 13
f 10 13 12
f 11 12 13
OBJ
ways='[(w["object"], w["component"], w["components"], w["unit_frames"], w["span_frames"]) for w in j["polyhedra"]]==[("soup",0,3,0,1),("tetrahedron",3,1,1,0)]'
expect 0 "$kage" stream mixed.obj --config polyhedra --size 64x48 --frames 1 --out mixed.kage
expect 0 "$kage" info mixed.kage --json info.json
json info.json 'j["units"]==1 and j["segments"]>48'
json info.json "$ways and 'belongs to one face only' in j['polyhedra'][0]['why'] and j['polyhedra'][1]['why'] is None"
expect 0 "$kage" info mixed.kage
grep -q '^soup, components 0 to 2: by spans in 1 frame: ' stdout || fail "info does not join the soup: $(cat stdout)"
grep -q '^tetrahedron, component 3: by segments in 1 frame$' stdout || fail "info lacks the tetrahedron: $(cat stdout)"
done_testing
