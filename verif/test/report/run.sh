#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The report page in headless Chromium: bash run.sh KAGE SOURCE CHROMIUM PICTURES. Screenshots are left in PICTURES.
chromium=$3 pictures=$4
. "$2/verif/test/cli/common.bash"
mkdir -p "$pictures"

# A run that is the same, one that is not, and a page too small for all tokens.
expect 0 "$kage" cosim courtyard --out same --json same.json
[ "$(tail -n 1 stdout)" = "report: same/report.html" ] || fail "the last line does not name the report: $(tail -n 1 stdout)"
json same.json 'j["report"] == "same/report.html"'
expect 1 "$kage" cosim courtyard --all-spans --fault wrong_compare --out different
expect 1 "$kage" cosim courtyard --front-end rtl --size 160x120 --frames 2 --all-spans --fault front_end_edge --out front-end
# The page has what is left out at the pixels that the run tells.
expect 1 "$kage" cosim courtyard --front-end rtl --size 160x120 --frames 2 --fault front_end_edge --out left-out
grep -q '"left_out":\["[1-9][0-9]* [A-Z]*: ' left-out/report.html || fail "the page does not tell what is left out"
expect 0 "$kage" cosim polyhedra --config polyhedra --all-spans --out full
for run in same different full; do
  [ "$(stat -c %s $run/report.html)" -le 10000000 ] || fail "$run/report.html has $(stat -c %s $run/report.html) bytes"
done
expect 0 "$kage" cosim courtyard --size 64x48 --frames 1 --out none --no-report --json none.json
[ ! -e none/report.html ] || fail "--no-report writes one"
json none.json 'j["report"] is None'

# A run of which an earlier one has compared all frames but one. Verdicts of its own, models of the common cache.
models=${XDG_CACHE_HOME:-$HOME/.cache}/kage
mkdir -p own/kage && ln -s "$models"/{models,verilator} own/kage/
recalled=(env XDG_CACHE_HOME="$PWD/own" "$kage" cosim courtyard --size 160x120 --frames 3 --cache-verdicts --out taken --json taken.json)
expect 0 "${recalled[@]}"
rm "own/kage/verdicts/$(ls own/kage/verdicts | head -n 1)"
expect 0 "${recalled[@]}"
json taken.json 'j["verdicts"]["taken"] == 2'

# Names are text, whatever is in them; options come through a shell again as they were.
name="a<b>&'\"\$x <!-- --> <script>alert(1)"
expect 0 "$kage" stream courtyard --size 64x48 --frames 2 --out "$name.kage"
expect 0 "$kage" cosim "$name.kage" --idle 20 --backpressure 10 --seed 9 --out odd

# The histories that the script tells, in all that a core can have.
scene() { # FOLDER SCENE OPTIONS...
  local folder=$1
  shift
  expect 0 "$kage" cosim "$@" --frames 2 --out "$folder"
}
scene default courtyard --size 160x120
scene inside inside --config default --all-spans --size 160x120  # by parity, where a volume that holds the eye is an IF
scene meshes inside --config meshes --size 160x120
scene soft penumbra --config soft --size 96x72
scene lights three-lights --config lights --size 96x72
scene glass glass --config glass --size 160x120
scene polyhedra polyhedra --config polyhedra --size 160x120
scene smooth knot --config full --size 160x120
scene polygons courtyard --front-end rtl --size 160x120 --idle 30 --backpressure 10 --json polygons.json
scene polygons-inside inside --front-end rtl --size 160x120
scene polygons-glass glass --front-end rtl --size 96x64
scene tiny courtyard --config tiny --degrade --size 150x40

# Shards of two scenes, and the page of them joined; one that is the same, one that is not.
for i in 1 2; do
  expect 1 "$kage" cosim courtyard penumbra --size 160x120 --frames 3 --all-spans --fault wrong_compare --out joined/$i --shard $i/2 --json joined/$i.json
  expect 0 "$kage" cosim courtyard --size 160x120 --frames 3 --idle 30 --out joined-same/$i --shard $i/2 --json joined-same/$i.json
done
expect 0 "$kage" cosim courtyard --size 64x48 --frames 6 --shard 2/3 --out part
expect 1 "$kage" merge joined/1.json joined/2.json --out joined --json joined.json
expect 0 "$kage" merge joined-same/1.json joined-same/2.json --out joined-same --json joined-same.json
mkdir gone && cp joined/[12].json gone
sed -i 's,"folder": ".*","folder": "/nowhere",' gone/[12].json
expect 1 "$kage" merge gone/1.json gone/2.json --out gone

python3 "$source/verif/test/report/report.py" "$kage" "$chromium" "$pictures" || fail "the page"
done_testing
