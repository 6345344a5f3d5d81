#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Soft shadows and several lights: golden model and RTL draw the same, options count, and what a configuration lacks is said.
. "$(dirname "$0")/common.bash"

for scene in penumbra three-lights; do
  expect 0 "$kage" cosim "$scene" --size 160x120 --frames 2 --idle 20 --backpressure 20 --out "$scene" --json "$scene.json"
  grep -q '^same: 2 frames' stdout || fail "$scene: $(cat stdout)"
  json "$scene.json" 'j["same"] is True and j["spans"] > 10000'
done
json penumbra.json 'j["config"]["COUNT_BITS"] == 8 and j["config"]["CLASS_BITS"] == 4'
json three-lights.json 'j["config"]["LIGHTS"] >= 3 and j["config"]["CLASS_BITS"] > 1'

# Translucent spans over soft shadows: the line leaves and comes back.
echo '{COUNT_BITS: 4, SHADE_FRAC: 12, TRANSLUCENCY: 1, LANES: 4, MAX_WIDTH: 160}' >soft-glass.yaml
expect 0 "$kage" cosim glass --size 160x120 --frames 2 --config soft-glass.yaml --out sg
grep -q '^same: 2 frames' stdout || fail "glass with counters: $(cat stdout)"

# Samples and seed change the picture; a seed is repeated exactly. One sample is the middle, whatever the seed.
draw() { expect 0 "$kage" render penumbra --size 160x120 --frames 1 "${@:2}" --out "$1"; }
draw a --samples 7
draw b --samples 7 --seed 2
draw c --samples 7
draw d --samples 1
draw e --samples 1 --seed 2
expect 1 "$kage" diff a/penumbra_0000.png b/penumbra_0000.png
expect 0 "$kage" diff a/penumbra_0000.png c/penumbra_0000.png
expect 1 "$kage" diff a/penumbra_0000.png d/penumbra_0000.png
expect 0 "$kage" diff d/penumbra_0000.png e/penumbra_0000.png

trouble "three-lights: configuration default lacks shadows of several lights (LIGHTS >= 3), soft shadows (COUNT_BITS >= 4), smooth colour (SMOOTH)" \
  "$kage" render three-lights --config default --out x
trouble "three-lights: configuration lights lacks soft shadows (COUNT_BITS >= 5)" "$kage" render three-lights --config lights --samples 16 --out x

# As many lights as a table tells apart, and one more, which come one after the other; as many as a scene has, and one more.
many() {
  python3 - "$source/scenes/three-lights.gltf" "$1" >"many$1.gltf" <<'PY'
import json, sys
scene = json.load(open(sys.argv[1]))
for i in range(int(sys.argv[2]) - 3):
    node = {"rotation": [-0.4, 0.01 * i, 0, 0.9], "extensions": {"KHR_lights_punctual": {"light": 1}}}
    scene["scenes"][0]["nodes"].append(len(scene["nodes"]))
    scene["nodes"].append(node)
print(json.dumps(scene))
PY
}
for n in 8 9 64 65; do many $n; done
echo '{SMOOTH: 1, COLOR_FRAC: 8, COUNT_BITS: 2, LIGHTS: 8, CLASS_BITS: 8, SHADE_FRAC: 12, MAX_WIDTH: 160}' >eight.yaml
expect 0 "$kage" render many8.gltf --config eight.yaml --samples 3 --size 64x48 --frames 1 --out x
# More samples than most configurations count are drawn by the one that counts all, and those that a list has none for by the
# line that is offered.
expect 0 "$kage" render three-lights --samples 64 --size 64x48 --frames 1 --out x --json wide.json
json wide.json 'j["config"]["COUNT_BITS"]==8 and j["config"]["LIGHTS"]==8 and not any("nothing is to be seen" in n for n in j["notes"])'
expect 0 "$kage" render many8.gltf --samples 31 --size 64x48 --frames 1 --out x --json wide.json
json wide.json 'j["config"]["COUNT_BITS"]==8 and j["config"]["LIGHTS"]==8 and not any("nothing is to be seen" in n for n in j["notes"])'
list_without_widest narrower
KAGE_DATA_DIR=$PWD/narrower trouble "many8.gltf: no named configuration (rtl/defs/configs.yaml) can draw this: the nearest, " \
  "$kage" render many8.gltf --samples 31 --size 64x48 --out x
sed -n 's/.*with this line in it: //p' stderr >offered.yaml
grep -q 'COUNT_BITS: 5, LIGHTS: 8' offered.yaml || fail "the line offered is another: $(cat offered.yaml)"
expect 0 "$kage" render many8.gltf --config offered.yaml --samples 31 --size 64x48 --frames 1 --out x
for n in 9 64; do
  expect 0 "$kage" render many$n.gltf --samples 3 --size 64x48 --frames 1 --out x --json many.json
  json many.json 'j["config"]["LINEAR_BITS"]==12 and j["config"]["LIGHTS"]==1 and not any("nothing is to be seen" in n for n in j["notes"])'
  trouble "many$n.gltf: no named configuration (rtl/defs/configs.yaml) can draw this: the nearest, linear, lacks soft shadows (COUNT_BITS >= 5)" \
    "$kage" render many$n.gltf --samples 31 --size 64x48 --out x
  sed -n 's/.*with this line in it: //p' stderr >offered.yaml
  expect 0 "$kage" render many$n.gltf --config offered.yaml --samples 31 --size 64x48 --frames 1 --out x --json many.json
  json many.json 'j["config"]["LINEAR_BITS"]==12 and j["config"]["COUNT_BITS"]==5'
  trouble "many$n.gltf: configuration eight.yaml lacks shadows of $n lights (LINEAR_BITS; a table has LIGHTS 8 at most)" \
    "$kage" render many$n.gltf --config eight.yaml --samples 3 --out x
  expect 0 "$kage" render many$n.gltf --config eight.yaml --samples 3 --degrade --size 64x48 --frames 1 --out x
done
expect 0 "$kage" cosim many9.gltf --samples 3 --size 64x48 --frames 1 --out many
grep -q '^same: 1 frame' stdout || fail "nine lights: $(cat stdout)"
trouble "many65.gltf: light 1: there are more than 64 lights" "$kage" render many65.gltf --out x

expect 0 "$kage" render three-lights --config default --degrade --size 160x120 --frames 1 --out degraded --json degraded.json
json degraded.json 'len(j["degraded"]) == 3'
expect 0 "$kage" stream penumbra --size 64x48 --frames 1 --samples 3 --out p.kage
expect 0 "$kage" info p.kage --json info.json
json info.json 'j["tokens"]["ES"] > 50'
trouble "p.kage: --samples, --classes: only a scene takes them, and this is a stream" "$kage" render p.kage --samples 5 --out x
trouble "p.kage: --max-shading: only a scene takes it, and this is a stream" "$kage" render p.kage --max-shading 0 --out x
trouble "p.kage: --sub-bits: only a scene takes it, and this is a stream" "$kage" render p.kage --sub-bits 5 --out x
done_testing
