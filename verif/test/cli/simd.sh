#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# KAGE_SIMD: the instruction sets that it names make the same pictures and orders; what it cannot name is refused.
. "$(dirname "$0")/common.bash"
mesh=$source/verif/test/meshes/sixteen_faces.obj

# The message lists what this machine can run.
unset KAGE_SIMD
for command in order "render --frames 1" "info"; do
  # shellcheck disable=SC2086
  trouble "KAGE_SIMD=none: " env KAGE_SIMD=none "$kage" $command "$mesh"
done
trouble "KAGE_SIMD=AVX2: " env KAGE_SIMD=AVX2 "$kage" order "$mesh" # names are in small letters
names=$(sed -n 's/.*it can run \(.*\) here$/\1/p' stderr | tr -d ,)
[[ " $names " == *" emu128 "* ]] || fail "the build lacks emu128: $names"
for name in avx3_dl avx3 avx2 sse4 ssse3 sse2; do
  [[ " $names " == *" $name "* ]] || trouble "KAGE_SIMD=$name: this " env KAGE_SIMD=$name "$kage" order "$mesh"
done

expect 0 env KAGE_SIMD= "$kage" order "$mesh" --eyes 3 --repeats 1 --save best.bsp
expect 0 "$kage" render "$mesh" --alpha 0.5 --frames 2 --size 160x120 --out best
for name in $names; do
  export KAGE_SIMD=$name
  expect 0 "$kage" order "$mesh" --eyes 30 --repeats 1 --save "$name.bsp" --json "$name.json"
  json "$name.json" 'all(r["identical"] for r in j)'
  cmp -s best.bsp "$name.bsp" || fail "$name makes another tree"
  expect 0 "$kage" render "$mesh" --alpha 0.5 --frames 2 --size 160x120 --out "$name"
  expect 0 "$kage" diff best "$name"
  expect 0 "$kage" cosim glass --size 60x45 --frames 1 --out "cosim-$name" --json cosim.json
  json cosim.json 'j["same"] is True and j["frames"]==1'
done
done_testing
