#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage cosim can say no: the RTL is built with each defect of verif/faults, and each must be found, with its place and its pictures.
. "$(dirname "$0")/common.bash"

expect 0 "$kage" stream courtyard --size 160x120 --frames 2 --out c.kage
count=0
for patch in "$source"/verif/faults/*.patch; do
  [ -e "$patch" ] || continue
  name=$(basename "$patch" .patch)
  count=$((count + 1))
  expect 1 "$kage" cosim c.kage --fault "$name" --idle 30 --backpressure 30 --out "$name" --json "$name.json"
  json "$name.json" 'j["same"] is False and j["first_difference"]["frame"] is not None and j["first_difference"]["field"]'
  [ -n "$(find "$name" -name '*_expected.png')" ] && [ -n "$(find "$name" -name '*_difference.png')" ] || fail "$name: no pictures of the difference"
  echo "$name: $(grep '^first difference' stdout)"
done
[ $count -ge 3 ] || fail "only $count faults to try"
done_testing
