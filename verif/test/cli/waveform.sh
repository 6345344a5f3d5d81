#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The waveform shows at its marker what the verdict says of that clock. It does so for a scene, for a frame among others, and for
# one that random:mixed sends right behind another, which is in the waveform too.
. "$(dirname "$0")/common.bash"

echo '{MAX_WIDTH: 64, LANES: 4, TRANSLUCENCY: 1}' >small.yaml
# wave FRAMES_BEFORE ARGUMENT...: kage cosim with a fault; the ends of so many frames are seen before the difference.
wave() {
  local before=$1
  shift
  rm -rf out
  expect 1 "$kage" cosim "$@" --config small.yaml --fault wrong_compare --no-shrink --no-report --out out --json j.json
  python3 "$source/verif/test/cli/waveform_clock.py" j.json out/*.gtkw 4 >seen || fail "$*"
  [ "$(cat seen)" = "$before" ] || fail "$*: $(cat seen) frames have ended in the waveform, and not $before: $(grep '^first div' stdout)"
}
wave 0 random --frames 60 --seed 3
wave 0 random --frames 60 --seed 7 --idle 40 --backpressure 40
wave 1 random:mixed --frames 60 --seed 10 --idle 20
done_testing
