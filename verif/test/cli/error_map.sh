#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage render --error-map from outside. Pixels of a map, its line and its JSON say the same, and the same as a row of kage sweep
# for the same point. A drawing that is as fine as it can be has no map; an input without a scene is refused in one line.
. "$(dirname "$0")/common.bash"

# coloured FILE KIND: how many pixels of a map that is 160 wide, and so shown four times as large, have a colour of the kind,
# by the numbers in docs/sweep.md, "Error maps".
coloured() {
  oiiotool "$1" -o map.ppm && python3 - "$2" <<'PY'
import re, sys
content = open("map.ppm", "rb").read()
header = re.match(rb"P6\s(\d+)\s(\d+)\s255\s", content)
width, height, data = int(header[1]), int(header[2]), content[header.end():]
assert width == 4 * 160, width
def of(r, g, b):
    if (r, g, b) == (255, 225, 0): return "face"
    if (r, g, b) == (255, 255, 255): return "gross"
    if r == g == b: return "right"
    if r <= 95 and 90 <= g <= 190 and b >= 165: return "shadow"
    assert 105 <= r <= 225 and 40 <= g <= 85 and b <= 20, (r, g, b)
    return "colour"
count = sum(of(*data[3 * i:3 * i + 3]) == sys.argv[1] for i in range(width * height))
assert count % 16 == 0, count
print(count // 16)
PY
}

# A coarse snap: the same as a row of kage sweep, in numbers and in pixels.
coarse=(--size 160x120 --frames 2 --config default)
expect 0 "$kage" render courtyard "${coarse[@]}" --sub-bits 4 --error-map --out coarse --json coarse.json
cp stdout line
expect 0 "$kage" sweep courtyard "${coarse[@]}" --axes SUB_BITS=4 --no-area --no-cosim --no-flip --json sweep.json
python3 - <<'PY' || fail "maps and the row differ"
import json, re
j, row = json.load(open("coarse.json")), json.load(open("sweep.json"))[1]["accuracy"]
errors, said = j["errors"], open("line").read().splitlines()
lines, alone = ([l for l in said if l.startswith(begin)] for begin in ("frame ", "  each source alone against finest pictures, "))
assert len(errors) == len(lines) == len(alone) == 2
for key in "pixels", "visible_wrong", "shadow_wrong", "gross_wrong", "color_wrong":
    assert sum(e[key] for e in errors) == row[key], key
for name, of_row in row["sources"].items():
    if name == "all": continue
    for key in "visible_wrong", "shadow_wrong", "color_wrong":
        assert sum(e["sources"][name][key] for e in errors) == of_row[key], (name, key)
    assert abs(sum(e["sources"][name]["mean_square"] for e in errors) / 2 - of_row["mean_square"]) < 1e-9, name
for e, line, of_sources in zip(errors, lines, alone):
    told = re.match(r"frame (\d+): wrong face (\d+), wrong shadow (\d+), other colour (\d+), gross \(beyond any stated error\) (\d+): (.*)", line)
    assert told and [int(told[k]) for k in range(1, 6)] == [e[k] for k in ("frame", "visible_wrong", "shadow_wrong", "color_wrong", "gross_wrong")], line
    s = e["sources"]["snapping"]
    assert f'snapping {s["visible_wrong"]}/{s["shadow_wrong"]}/{s["color_wrong"]}' in of_sources, of_sources
    assert told[6] == e["file"] and of_sources.endswith(e["file"].replace("_error", "_error_SOURCE")), (line, of_sources)
of_light = [l for l in said if l.startswith("  light at the pixel, ")]
assert len(of_light) == 2
for e, line in zip(errors, of_light):
    told = re.match(r"  light at the pixel, of (\d+) pixels (\d+) in some shadow, is off by ([\d.]+) steps of 255 there and ([\d.]+) elsewhere, ([\d.]+) dB: (.*)", line)
    light = e["light"]
    assert told and [int(told[1]), int(told[2]), told[6]] == [light["pixels"], light["shadowed"], light["file"]], line
    assert abs(float(told[3]) - light["shadow_mean"]) < 0.006 and abs(float(told[5]) - light["psnr"]) < 0.06, line
assert sum(e["light"]["pixels"] for e in errors) == row["light"]["drawn"]["pixels"] > 10000
assert max(e["light"]["shadow_worst"] for e in errors) == row["light"]["drawn"]["shadow_worst"] > 5
assert row["visible_wrong"] > 0 and row["color_wrong"] > 0 and row["sources"]["snapping"]["visible_wrong"] > 0
PY
for kind in face:visible_wrong shadow:shadow_wrong colour:color_wrong; do
  for map in "" snapping; do
    want=$(python3 -c 'import json, sys
e = json.load(open("coarse.json"))["errors"][1]
print((e["sources"][sys.argv[1]] if sys.argv[1] else e)[sys.argv[2]])' "$map" "${kind#*:}")
    got=$(coloured "coarse/courtyard_0001_error${map:+_$map}.png" "${kind%:*}")
    [ "$got" = "$want" ] || fail "${map:-all}: $got pixels are of the colour of ${kind%:*}, and $want are counted"
  done
done
[ ! -e coarse/courtyard_0000_error_order.png ] || fail "a map of a source that the scene has nothing of"

# All but colour at its finest: the sources are without an error, and a map of the run before goes.
cat >fine.yaml <<'YAML'
Z_BITS: 28
Z_FRAC: 16
YAML
touch coarse/kept.png
expect 0 "$kage" render courtyard --size 160x120 --frames 2 --config fine.yaml --error-map --out coarse --json fine.json
json fine.json 'all(e["visible_wrong"] == e["shadow_wrong"] == e["gross_wrong"] == 0 for e in j["errors"])'
json fine.json 'all(e["sources"][s]["file"] is None and e["sources"][s]["mean_square"] == 0 for e in j["errors"] for s in ("snapping", "depth", "samples", "order"))'
for map in snapping depth; do
  [ ! -e coarse/courtyard_0000_error_$map.png ] || fail "a map of $map, which has no error, stays from an earlier run"
done
[ -e coarse/kept.png ] || fail "a file of another is gone"
[ "$(coloured coarse/courtyard_0000_error.png face)" = 0 ] || fail "an exact picture has a wrong face"

# The picture is the same with maps beside it; without the option there are none. EXR pictures have PNG maps.
expect 0 "$kage" render courtyard "${coarse[@]}" --sub-bits 4 --exr --error-map --out exr --json exr.json
expect 0 "$kage" render courtyard "${coarse[@]}" --sub-bits 4 --out plain --json plain.json
json plain.json 'j["errors"] is None'
cmp plain/courtyard_0001.png <("$kage" render courtyard "${coarse[@]}" --sub-bits 4 --error-map --out again >/dev/null; cat again/courtyard_0001.png) || fail "the picture is another"
[ ! -e plain/courtyard_0001_error.png ] || fail "maps that were not asked for"
cmp exr/courtyard_0000_error.png <(cat again/courtyard_0000_error.png) || fail "EXR pictures have other maps"
[ -e exr/courtyard_0000.exr ] || fail "no EXR picture"

# Soft shadows, layers and lights: each source where it is.
expect 0 "$kage" render penumbra --size 96x72 --frames 1 --samples 3 --error-map --out soft --json soft.json
grep -qE 'wrong shadow [0-9]+ \(of 3 samples a light\), ' stdout || fail "$(cat stdout)"
grep -qF 'alone against finest pictures (of 255 samples a light), face/shadow/colour: ' stdout || fail "$(cat stdout)"
json soft.json 'j["errors"][0]["sources"]["samples"]["shadow_wrong"] > 0 and j["errors"][0]["gross_wrong"] == 0'
expect 0 "$kage" render glass --size 96x72 --frames 1 --order submission --error-map --out glass --json glass.json
json glass.json 'j["errors"][0]["sources"]["order"]["color_wrong"] > 0 and j["errors"][0]["sources"]["order"]["visible_wrong"] == 0'
[ -s glass/glass_0000_error_order.png ] || fail "no map of the order"

# A grey scene before a background that is none: no error but what rounding of its own colours gives.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >grey.obj
expect 0 "$kage" render grey.obj --size 64x48 --frames 1 --config full --error-map --out grey --json grey.json
json grey.json 'j["errors"][0]["color_wrong"] == j["errors"][0]["sources"]["color"]["color_wrong"] < 64 * 48 / 4'

# Inputs without a scene.
"$kage" stream courtyard --size 64x48 --frames 1 --config default --out small.kage >/dev/null
trouble "small.kage: --error-map: what is wrong is told from the scene" "$kage" render small.kage --error-map --out none
"$kage" vectors courtyard --size 64x48 --frames 1 --config default --out pack >/dev/null
trouble "pack: a folder of kage vectors is no scene" "$kage" render pack --error-map --out none
trouble "random frames are for" "$kage" render random --error-map --out none
[ ! -e none ] || fail "trouble leaves a folder"
no_leftovers
done_testing
