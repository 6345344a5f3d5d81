#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Help, version, and a command line that makes no sense.
. "$(dirname "$0")/common.bash"

expect 0 "$kage" --help
expect 0 "$kage" --version
for command in cosim render stream info diff model; do
  expect 0 "$kage" $command --help
  grep -q Examples: stdout || fail "$command --help has no examples"
done

# The last of an option given twice counts.
expect 0 "$kage" stream courtyard --size 640x480 --size 32x24 --frames 2 --frames 1 --out twice.kage
expect 0 "$kage" info twice.kage --json twice.json
json twice.json 'j["frames"]==1 and j["lines"]==24'

trouble "no command" "$kage"
trouble "nonsense" "$kage" nonsense
trouble "A is required" "$kage" diff
trouble "--lsb" "$kage" diff a b --lsb many
trouble "--size" "$kage" render courtyard --size 640
trouble "--size" "$kage" render courtyard --size 0x480
trouble "--size" "$kage" render courtyard --size 640x480x3
trouble "--size" "$kage" render courtyard --size -1x480
trouble "--frames" "$kage" render courtyard --frames 0
trouble "--threads" "$kage" render courtyard --threads 0
trouble "--out" "$kage" stream courtyard
trouble "no such file" "$kage" model nowhere.yaml
printf 'Z_BITS: 40\n' >wide.yaml
trouble "wide.yaml" "$kage" model wide.yaml
printf 'Z_BITS: [\n' >broken.yaml
trouble "broken.yaml" "$kage" model broken.yaml
printf 'DEPTH: 4\n' >unknown.yaml
trouble "DEPTH" "$kage" model unknown.yaml
done_testing
