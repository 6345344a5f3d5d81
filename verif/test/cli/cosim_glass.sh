#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Translucent faces: golden core and RTL agree in every arrangement, a thousand layers deep, and on a real mesh; what
# other orders do can be seen; what a configuration lacks is named.
. "$(dirname "$0")/common.bash"

arrangements=("LANES: 1, BEAT_WORDS: 1" "LANES: 8" "ARRANGEMENT: 0")
for i in "${!arrangements[@]}"; do
  echo "{TRANSLUCENCY: 1, MAX_WIDTH: 64, ${arrangements[i]}}" >"arranged$i.yaml"
done
echo "{TRANSLUCENCY: 1, SMOOTH: 1, COLOR_FRAC: 8, MAX_WIDTH: 64, DSF_BITS: 2, FSF: 1}" >smooth.yaml

# The scene, in all arrangements, to the same picture.
for i in "${!arrangements[@]}"; do
  expect 0 "$kage" cosim glass --size 60x45 --frames 2 --config "arranged$i.yaml" --out "glass$i" --json "glass$i.json"
  json "glass$i.json" 'j["same"] is True and j["frames"]==2 and j["pixels_compared"]==5400'
  for frame in 0000 0001; do
    expect 0 "$kage" diff "glass0/glass_${frame}.png" "glass$i/glass_${frame}.png"
  done
done
expect 0 "$kage" cosim glass --size 60x45 --frames 1 --config smooth.yaml --out smooth
expect 0 "$kage" cosim glass --size 60x45 --frames 1 --out chosen --json chosen.json
json chosen.json 'j["same"] is True and j["config"]["TRANSLUCENCY"]==1 and j["config"]["CLASS_BITS"]==4'

# A thousand layers.
{
  echo "mtllib layers.mtl"
  echo "usemtl veil"
  awk 'BEGIN {
    for (i = 0; i < 1000; ++i) {
      z = i / 500
      printf "v -1 -1 %s\nv 1 -1 %s\nv 1 1 %s\nv -1 1 %s\n", z, z, z, z
      printf "f %d %d %d %d\n", 4 * i + 1, 4 * i + 2, 4 * i + 3, 4 * i + 4
    }
  }'
} >layers.obj
printf 'newmtl veil\nKd 0.9 0.3 0.1\nd 0.02\n' >layers.mtl
for i in 1 2; do
  expect 0 "$kage" cosim layers.obj --size 24x18 --frames 2 --config "arranged$i.yaml" --out layers --json layers.json
  json layers.json 'j["same"] is True and j["frames"]==2'
  grep -q "nothing is to be seen" stdout stderr && fail "layers of glass are nothing to be seen"
done
expect 0 "$kage" stream layers.obj --size 24x18 --frames 1 --config arranged1.yaml --out layers.kage
expect 0 "$kage" info layers.kage --json info.json
json info.json 'j["tokens"]["TP"] >= 10000'

# A real mesh as a translucent solid.
bunny=/usr/share/glmark2/models/bunny.obj
if [ -e $bunny ]; then
  for i in 1 2; do
    expect 0 "$kage" cosim $bunny --alpha 0.4 --size 60x45 --frames 1 --config "arranged$i.yaml" --out bunny --json bunny.json
    json bunny.json 'j["same"] is True'
  done
fi

# Other orders differ, and a stream has its own.
expect 0 "$kage" render glass --size 160x120 --frames 1 --out exact
for order in centroid submission; do
  expect 0 "$kage" render glass --size 160x120 --frames 1 --order $order --out $order
  expect 1 "$kage" diff exact/glass_0000.png $order/glass_0000.png
done
expect 0 "$kage" stream glass --size 60x45 --frames 1 --out glass.kage
trouble "glass.kage: --order: a stream has its own order" "$kage" render glass.kage --order centroid --out refused
trouble "glass.kage: --alpha: a stream has its own alphas" "$kage" render glass.kage --alpha 0.5 --out refused
trouble "--order: " "$kage" render glass --order nearest --out refused
trouble "--alpha: " "$kage" render glass --alpha 0 --out refused

# A core without a blender refuses the scene by name, or draws it opaque.
trouble "glass: configuration default lacks translucency (TRANSLUCENCY)" "$kage" render glass --config default --out refused
expect 0 "$kage" cosim glass --size 60x45 --frames 1 --config systolic64 --degrade --out degraded --json degraded.json
json degraded.json 'j["same"] is True and any("translucency" in d for d in j["degraded"])'
done_testing
