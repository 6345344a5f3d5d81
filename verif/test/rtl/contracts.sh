#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every module opens with its contract: what it costs, after how many clocks it answers, and how often (docs/rtl.md).
# usage: contracts.sh SOURCE_DIR
set -u
cd "${1:?}/rtl" || exit 1

# lacks FILE: the labels that the comment at the top of FILE has not.
lacks() {
  local label head
  head=$(sed '/^`default_nettype none/q; /^[^/`]/q' "$1")
  for label in latency throughput cost; do
    grep -qiw "$label" <<<"$head" || printf '%s ' "$label"
  done
}

bad=0
for file in *.sv board/*.sv; do
  lacking=$(lacks "$file")
  [ -z "$lacking" ] || { echo "rtl/$file: its contract lacks: $lacking"; bad=1; }
done

# The test can fail: a contract without its cost is noticed.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
sed '/^\/\/ Cost:/,$d' skid_buffer.sv >"$scratch/skid_buffer.sv"
[ "$(lacks "$scratch/skid_buffer.sv")" = "cost " ] || { echo "a contract without its cost was taken"; bad=1; }
exit $bad
