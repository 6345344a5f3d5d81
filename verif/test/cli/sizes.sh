#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Pictures of every size are rendered, from 1x1 to 32766 wide or high, by a named configuration and by a plan. They are
# co-simulated where a narrow band or a narrow column of them keeps that short.
. "$(dirname "$0")/common.bash"

same() { # SIZE OPTION...: one frame of the scene, RTL and golden core alike
  local size=$1
  shift
  expect 0 "$kage" cosim "$@" --size "$size" --frames 1 --no-report --out out
  grep -q "^same: 1 frame, $size, " stdout || fail "$size $*: $(cat stdout)"
}
for size in 1x1 1x64 2x3 63x5 65x5 640x1 1280x2 1281x2; do same $size courtyard; done
for size in 1x4096 4096x4 8192x4 32766x2; do
  same $size glass
  same $size three-lights
done
same 1x32766 edges
same 8192x2 courtyard --config plan

# Large pictures as a whole, by the golden core alone, and without words.
expect 0 "$kage" render courtyard --size 4096x4096 --frames 1 --out whole
expect 0 "$kage" render courtyard --size 4096x4096 --frames 1 --through-words --out large --json large.json
expect 0 "$kage" diff whole large
json large.json 'j["width"] == 4096 and j["height"] == 4096 and j["span_pixels"] > 4096 * 2048'
expect 0 "$kage" render penumbra --size 32766x32 --frames 1 --out whole
expect 0 "$kage" render penumbra --size 32766x32 --frames 1 --through-words --out large --json large.json
expect 0 "$kage" diff whole large
json large.json 'j["width"] == 32766'
trouble "--size: 32767x1: width and height are 1 .. 32766" "$kage" render courtyard --size 32767x1 --out out
done_testing
