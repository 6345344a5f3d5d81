#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage stream --level polygons: the file is smaller and draws the same, and the program says what the front end makes.
. "$(dirname "$0")/common.bash"

small=(--size 160x120 --frames 2 --all-spans)
expect 0 "$kage" stream courtyard "${small[@]}" --out spans.kage --json s.json
expect 0 "$kage" stream courtyard "${small[@]}" --level spans --out same.kage
cmp -s spans.kage same.kage || fail "--level spans is not what there is without it"
json s.json 'j["level"]=="spans" and j["polygons"] is None and j["config"]["ACTIVE"]==0'
expect 0 "$kage" stream courtyard "${small[@]}" --level polygons --out polygons.kage --json p.json
cp stdout said
grep -Eq '^polygons.kage: 2 frames, [0-9]+ spans over [0-9]+ pixels, [0-9]+ words \([0-9]+ bytes\)$' said || fail "no bytes: $(cat said)"
grep -Eq '^front end makes 9[0-9]\.[0-9] % of the spans \(9[0-9]\.[0-9] % of those of polygons of three lines or more\), of [0-9]+ polygons at once at most$' said || fail "no share: $(cat said)"
grep -Eq '^spans in the stream: no fewer words [0-9.]+ % \([0-9]+ polygons\)$' said || fail "no causes: $(cat said)"
json p.json 'j["level"]=="polygons" and j["config"]["ACTIVE"]==512 and j["polygons"]["share"]>0.9 and j["polygons"]["tall_share"]>0.95'
json p.json 'j["polygons"]["span_level_frames"]==0 and 0<j["polygons"]["active"]<=512'
json p.json "j['words']*2 < $(python3 -c 'import json;print(json.load(open("s.json"))["words"])')"
json p.json "j['spans'] == $(python3 -c 'import json;print(json.load(open("s.json"))["spans"])')"
expect 0 "$kage" stream courtyard "${small[@]}" --level polygons --threads 1 --out one.kage
cmp -s polygons.kage one.kage || fail "one thread writes another stream"

# It draws the same.
expect 0 "$kage" render courtyard "${small[@]}" --out direct
expect 0 "$kage" render polygons.kage --out through
for frame in 0000 0001; do
  expect 0 "$kage" diff direct/courtyard_$frame.png through/polygons_$frame.png
done

# A configuration's own ACTIVE stays; few polygons at once are said to be the cause.
echo '{ACTIVE: 4}' >few.yaml
expect 0 "$kage" stream courtyard "${small[@]}" --config few.yaml --level polygons --out few.kage --json f.json
grep -q 'of 4 polygons at once at most$' stdout || fail "more than ACTIVE at once: $(cat stdout)"
grep -q 'more at once than ACTIVE [0-9.]* %' stdout || fail "ACTIVE is no cause: $(cat stdout)"
json f.json 'j["config"]["ACTIVE"]==4 and j["polygons"]["ways"]["active"]["spans"]>0'

# Translucent faces that are cut; units; a copy.
expect 0 "$kage" stream glass --size 96x64 --frames 1 --level polygons --out glass.kage
grep -q 'parted by other translucent faces or by dicing [0-9.]* %' stdout || fail "cuts are no cause: $(cat stdout)"
expect 0 "$kage" stream polyhedra --size 96x64 --frames 1 --config polyhedra --level polygons --out units.kage
expect 0 "$kage" render units.kage --out units
expect 0 "$kage" render polyhedra --size 96x64 --frames 1 --config polyhedra --out units_direct
expect 0 "$kage" diff units_direct/polyhedra_0000.png units/units_0000.png
expect 0 "$kage" stream polygons.kage --out copy.kage --json c.json
cmp -s polygons.kage copy.kage || fail "a copy differs"
json c.json 'j["level"]=="polygons" and j["polygons"] is None'

# Impossible requests.
for level in spans polygons; do trouble "polygons.kage: --level: a stream has its own level" "$kage" stream polygons.kage --level $level --out x.kage; done
[ ! -e x.kage ] || fail "a refused stream leaves a file"
expect 2 "$kage" stream courtyard --level edges --out x.kage
# A copy for another core that would refuse it.
active=$("$kage" info polygons.kage --json - | python3 -c 'import json, sys; print(json.load(sys.stdin)["config"]["ACTIVE"])')
for row in "ACTIVE: 1,ACTIVE_FULL" "ACTIVE: 0,HEADER" "ACTIVE: $active,"; do
  printf 'LANES: 2\nDSF_BITS: 4\nCOUNT_BITS: 1\nCLASS_BITS: 4\n%s\n' "${row%,*}" >other.yaml
  cause=${row#*,}
  if [ -z "$cause" ]; then
    expect 0 "$kage" stream polygons.kage --config other.yaml --out other.kage
  else
    trouble "polygons.kage, for other.yaml: frame 0, line " "$kage" stream polygons.kage --config other.yaml --out x.kage
    grep -q "($cause)$" stderr || fail "$row: $(cat stderr)"
    [ ! -e x.kage ] || fail "a refused copy leaves a file"
  fi
done
expect 0 "$kage" stream --help
grep -q 'ACTIVE, which is 512' stdout || tr '\n' ' ' <stdout | tr -s ' ' | grep -q 'ACTIVE, which is 512' || fail "--help does not say what ACTIVE becomes"

no_leftovers
done_testing
