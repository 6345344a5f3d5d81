#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every scene is drawn in every named configuration with --degrade: kage regress gives each to each.
. "$(dirname "$0")/common.bash"

drawn=0
for config in $("$kage" list configs); do
  for scene in $("$kage" list scenes); do
    expect 0 "$kage" render "$scene" --degrade --config "$config" --size 64x48 --frames 1 --out pictures --json drawn.json
    grep -q 'lacks' stderr && fail "$scene, $config: $(cat stderr)"
    drawn=$((drawn + 1))
  done
done
[ $drawn -gt 100 ] || fail "only $drawn pictures"

# Counters of 2 bits have no room for 15 samples: the light is a point, in the shares of several jobs too.
expect 0 "$kage" cosim penumbra --degrade --config systoliclights --size 64x48 --frames 4 --jobs 2 --out cosim
grep -q 'drawn without soft shadows (COUNT_BITS >= 4)' stdout || fail "$(cat stdout)"
grep -q '^same: 4 frames' stdout || fail "$(cat stdout)"

# Counts of 3 bits without FSF hold seven casters on a way to the light. Where a scene has more of them, one volume a light
# sample stays, and a note says so; without --degrade the frame is refused.
expect 0 "$kage" cosim canopy --degrade --config systoliclights --size 64x48 --frames 3 --jobs 2 --out cosim
grep -q 'canopy: drawn with one shadow volume a light sample: more need FSF' stdout || fail "$(cat stdout)"
grep -q '^same: 3 frames' stdout || fail "$(cat stdout)"
sed -n '/^systoliclights:/,/^$/p' "$source/rtl/defs/configs.yaml" | sed 1d | grep -vE 'COUNT|LIGHTS|CLASS' >no_fsf.yaml
trouble "canopy: frame 0: several shadow volumes need FSF, which the configuration lacks" \
  "$kage" render canopy --config no_fsf.yaml --size 64x48 --frames 1 --out x
done_testing
