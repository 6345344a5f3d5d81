#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage cosim --front-end rtl --stages of all built-in scenes, in both arrangements and with stalls: pixels and every stage,
# the front end's spans token by token.
. "$(dirname "$0")/common.bash"

# By one core, which the other tests have built, where it can draw the scene.
for scene in $("$kage" list scenes --json - | python3 -c 'import json,sys; print(*(s["name"] for s in json.load(sys.stdin)["scenes"]))'); do
  core=(--config polygonlights)
  [ "$scene" != three-lights ] || core=()
  expect 0 "$kage" cosim "$scene" "${core[@]}" --front-end rtl --stages --size 64x48 --frames 2 --out "$scene"
  expect 0 "$kage" cosim "$scene" "${core[@]}" --front-end rtl --size 160x120 --frames 1 --idle 30 --backpressure 30 --out "$scene"
done
echo '{ARRANGEMENT: 0, MAX_WIDTH: 64, ACTIVE: 64}' >systolic.yaml
for scene in courtyard edges fifteen depths; do
  expect 0 "$kage" cosim "$scene" --front-end rtl --stages --config systolic.yaml --size 64x48 --frames 2 --out systolic
done
done_testing
