#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What a feature costs: cells of kage_top for iCE40 (Debian's yosys), one configuration a row, each without one feature of the first.
#
# usage: verif/synth/cells.sh [--quick | --tree | NAME PARAM=VALUE...]
#   without arguments the table below; --quick: no-shadow, one-channel and small-z only; NAME ...: one configuration
#   --tree: the parts of the compare tree alone
# Columns: LUTs, flip-flops, carry cells, block RAMs. Exit 1 if a configuration that leaves a feature out is not smaller
# (LUTs; without FSF, a bit per pixel in block RAM, flip-flops).
set -euo pipefail
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cells() { # NAME PARAM=VALUE...: prints a row
  local name=$1 sets= p
  shift
  for p in "$@"; do sets+=" -set ${p%%=*} ${p#*=}"; done
  yosys -q -l "$work/$name.log" -p "read_verilog -sv -Irtl/include rtl/*.sv; chparam$sets kage_top; synth_ice40 -top kage_top; tee -o $work/$name.stat stat" \
    >"$work/$name.out" 2>&1 || { echo "cells.sh: $name: yosys failed" >&2; tail -5 "$work/$name.log" >&2; exit 2; }
  if grep -q "Warning" "$work/$name.out"; then echo "cells.sh: $name: yosys warns" >&2; grep -m3 Warning "$work/$name.out" >&2; fi
  awk -v name="$name" -v params="$*" '
    / SB_LUT4 /{lut=$2} / SB_CARRY /{carry=$2} / SB_DFF/{ff+=$2} / SB_RAM40/{ram+=$2}
    END{printf "| %s | %d | %d | %d | %d | `%s` |\n", name, lut, ff, carry, ram, params}' "$work/$name.stat"
}

# ---- the compare tree's parts alone ----
part() { # NAME TOP PARAM=VALUE...: prints a row
  local name=$1 top=$2 sets= p
  shift 2
  for p in "$@"; do sets+=" -set ${p%%=*} ${p#*=}"; done
  [ -z "$sets" ] || sets="chparam$sets $top;"
  yosys -q -l "$work/$name.log" -p "read_verilog -sv -Irtl/include rtl/*.sv; $sets synth_ice40 -top $top; tee -o $work/$name.stat stat" \
    >"$work/$name.out" 2>&1 || { echo "cells.sh: $name: yosys failed" >&2; tail -5 "$work/$name.log" >&2; exit 2; }
  if grep -q "Warning" "$work/$name.out"; then echo "cells.sh: $name: yosys warns" >&2; grep -m3 Warning "$work/$name.out" >&2; fi
  awk -v name="$name" -v params="$top${*:+ $*}" '
    / SB_LUT4 /{lut=$2} / SB_CARRY /{carry=$2} / SB_DFF/{ff+=$2} / SB_RAM40/{ram+=$2}
    END{printf "| %s | %d | %d | %d | %d | `%s` |\n", name, lut, ff, carry, ram, params}' "$work/$name.stat"
}
tree_parts() { # prints the table; exit 1 if a tree is smaller than one of fewer units
  local last=0 luts units row
  echo "| part | LUT4 | flip-flops | carry | RAM 4k | module and parameters |"
  echo "| --- | --- | --- | --- | --- | --- |"
  part cell compare_cell
  part unit expansion_unit UNITS=2
  part unit-classic expansion_unit UNITS=2 CLASSIC=1 Z_BITS=15 Z_FRAC=0
  for units in 2 4 8 16 32 64; do
    row=$(part tree$units compare_tree UNITS=$units)
    echo "$row"
    luts=$(awk -F'|' '{print $3 + 0}' <<<"$row")
    [ "$luts" -gt "$last" ] || { echo "cells.sh: tree$units has no more LUTs than half of it" >&2; exit 1; }
    last=$luts
  done
  part check4 segment_check UNITS=4
  part check64 segment_check UNITS=64
}
if [ "${1:-}" = --tree ]; then tree_parts; exit; fi

quick=
if [ "${1:-}" = --quick ]; then quick=1; elif [ $# -gt 0 ]; then cells "$@"; exit; fi

base="LANES=2 MAX_WIDTH=64 X_BITS=7 Z_FRAC=7"
echo "| configuration | LUT4 | flip-flops | carry | RAM 4k | parameters |"
echo "| --- | --- | --- | --- | --- | --- |"
rows=(
  "full $base"
  "no-fsf $base FSF=0"
  "no-shadow $base FSF=0 DSF_BITS=0"
  "one-channel $base CHANNELS=1"
  "small-z $base Z_BITS=12"
  "smooth $base SMOOTH=1 COLOR_FRAC=7"
  "one-lane $base LANES=1"
  "one-word-beats $base BEAT_WORDS=1"
  "systolic16 ${base/MAX_WIDTH=64/MAX_WIDTH=16} ARRANGEMENT=0"
)
[ -z "$quick" ] || rows=("${rows[0]}" "${rows[@]:2:3}")
export -f cells
export work
printf '%s\n' "${rows[@]}" | xargs -P 2 -I{} bash -c 'set -euo pipefail; set -- {}; cells "$@" >"$work/$1.row"'
for row in "${rows[@]}"; do cat "$work/${row%% *}.row"; done

luts() { awk -F'|' '{print $3 + 0}' "$work/$1.row"; }
ffs() { awk -F'|' '{print $4 + 0}' "$work/$1.row"; }
bad=0
for row in "${rows[@]:1}"; do
  name=${row%% *}
  case $name in
    smooth) [ "$(luts smooth)" -gt "$(luts full)" ] || { echo "cells.sh: smooth has no more LUTs than full" >&2; bad=1; } ;;
    systolic*) ;;
    no-fsf) [ "$(ffs no-fsf)" -lt "$(ffs full)" ] || { echo "cells.sh: no-fsf has no fewer flip-flops than full" >&2; bad=1; } ;;
    *) [ "$(luts "$name")" -lt "$(luts full)" ] || { echo "cells.sh: $name has no fewer LUTs than full" >&2; bad=1; } ;;
  esac
done
exit $bad
