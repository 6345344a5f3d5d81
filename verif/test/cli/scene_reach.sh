#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The built-in scenes reach what they are made for: mutants of the RTL (docs/mutants.md) that need a rare thing in a frame
# make these scenes come out different. With all spans: much of what they are made for is hidden, so that nobody needs it.
. "$(dirname "$0")/common.bash"

# reaches SCENE CONFIGURATION SIZE MUTANT...: each is found, and the sound RTL draws the same.
reaches() {
  local scene=$1 config=$2 size=$3 mutant number run
  run=(cosim "$scene" --config "$config" --size "$size" --all-spans --no-divergence --out out)
  expect 0 "$kage" "${run[@]}"
  for mutant in "${@:4}"; do
    number=$(python3 -c "
import sys, yaml
print([m['name'] for m in yaml.safe_load(open(sys.argv[1]))].index(sys.argv[2]) + 1)" "$source/verif/mutants/mutants.yaml" "$mutant")
    expect 1 "$kage" "${run[@]}" --mutant "$number"
    grep -q '^different: ' stdout || fail "$mutant: $(cat stdout)"
  done
}

# has SCENE KIND... [--config NAME]: each kind of token is in the scene's frames, as they are drawn without further options but
# for the size, or by another configuration.
has() {
  local scene=$1 kind kinds=()
  shift
  while [ $# != 0 ] && [ "$1" != --config ]; do kinds+=("$1"); shift; done
  expect 0 "$kage" stream "$scene" --size 64x48 "$@" --out frames.kage
  expect 0 "$kage" info frames.kage
  for kind in "${kinds[@]}"; do
    grep -qE "^tokens:.* $kind [1-9]" stdout || fail "$scene $*: no $kind: $(grep ^tokens: stdout)"
  done
}

# Between them the scenes have every kind of token. No line of inside is whole within the one volume that its own configuration
# counts in, so it has IF only by parity.
has courtyard SHADE OP SP EV RESOLVE EOL END --config default
has courtyard TABLE
has inside NC
has inside NC IF --config default
has cutaway NC IF
has three-lights TABLE ES IF
has glass TP
has polyhedra FACE SEG TREE --config polyhedra

# Depths in both halves of the range, and ties between units of which the later has the body that was drawn first. Depths beyond
# both ends come from units, from spans in groups and in columns. A draw index is of one body, so no scene has equal keys in two
# units, which cell_tie needs: random frames have.
reaches depths polyhedra 160x120 next_signed next_tie cell_signed cell_index unit_clamp unit_clamp_high
reaches depths default 160x120 ramp_under ramp_over
reaches depths default 320x240 ramp_under ramp_over
reaches depths systolic64 64x48 systolic_clamp
# A core without FSF darkens on a line's way out, by the count and by what the eye is within.
reaches cutaway counting 64x48 command_eol_bias
done_testing
