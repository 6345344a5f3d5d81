#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A few mutants of each generated module are found: by the vectors of rtl/hls_kernels, by all inputs, or by the proof. All
# mutants: tools/hls mutate.
#
# usage: verif/test/hls/mutants.sh
set -euo pipefail
[ "${1:-}" != --help ] || { sed -n '3,6s/^# \{0,1\}//p' "$0"; exit 0; }
cd "$(dirname "$0")/../../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mutate() { /usr/bin/python3 hls/tool mutate "$@" 2>"$work/said"; }

mutate --count 8 edge_setup plane_step segment_make span_setup pixel_blend_tiny compare_cell pixel_next_default pixel_next_lights
mutate edge_step
# A mutant that no vector finds is named, and the command fails: here for want of vectors.
rc=0
mutate edge_step --vectors 0 >"$work/printed" || rc=$?
if [ $rc != 1 ] || ! grep -q '^LIVES: hls_edge_step.sv:[0-9]*: ' "$work/printed"; then
  echo "mutants.sh: with 12 vectors: exit code $rc, $(tail -1 "$work/printed")" >&2
  exit 1
fi
rc=0
mutate no_such >"$work/printed" || rc=$?
if [ $rc != 2 ] || [ -s "$work/printed" ] || ! grep -q '^tools/hls: no_such: neither a kernel nor a generated module' "$work/said"; then
  echo "mutants.sh: no_such: exit code $rc, $(cat "$work/said")" >&2
  exit 1
fi
