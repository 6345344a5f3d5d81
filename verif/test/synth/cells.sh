#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The cost of a feature: cells of kage_top for iCE40 (Debian's yosys). The first row is the base, the next ones differ from it in
# one feature; `default` is the named configuration.
#
# usage: verif/test/synth/cells.sh [--quick | --tree | NAME PARAM=VALUE...]
#   (none)   the table below
#   --quick  base, no-shadow, one-channel and small-z only
#   --tree   the parts of the compare tree alone, cells per compare cell, and the whole core with 1, 2, 4 and 8 units against none
#   NAME     one configuration
# Columns: LUTs, flip-flops, carry cells, block RAMs. Exit 1 if a row has not the block RAMs that its two memories take. Exit 1 too
# if it is not smaller (smooth, glass, counter, table2: larger) than the base by at least the LUTs and flip-flops that the
# feature's state implies: see `implied`.
set -euo pipefail
case ${1:-} in
  --quick | --tree | [!-]* | '') ;;
  --help) sed -n '3,13s/^# \{0,1\}//p' "$0"; exit 0 ;;
  *) echo "cells.sh: $1: no such option; see --help" >&2; exit 2 ;;
esac
cd "$(dirname "$0")/../../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

part() { # NAME TOP PARAM=VALUE...: prints a row
  local name=$1 top=$2 sets='' p
  local -A value=() # a parameter named twice has its last value
  shift 2
  for p in "$@"; do value[${p%%=*}]=${p#*=}; done
  for p in "${!value[@]}"; do sets+=" -chparam $p ${value[$p]}"; done
  # Deferred, since a part that the top leaves out may not exist with the defaults (tree_core of no units).
  yosys -q -l "$work/$name.log" -p "read_verilog -defer -sv -Irtl/include rtl/*.sv; hierarchy -top $top$sets; synth_ice40 -top $top; tee -o $work/$name.stat stat" \
    >"$work/$name.out" 2>&1 || { echo "cells.sh: $name: yosys failed" >&2; tail -5 "$work/$name.log" >&2; exit 2; }
  if grep -q "Warning" "$work/$name.out"; then echo "cells.sh: $name: yosys warns" >&2; grep -m3 Warning "$work/$name.out" >&2; fi
  awk -v name="$name" -v params="$top${*:+ $*}" '
    / SB_LUT4 /{lut=$2} / SB_CARRY /{carry=$2} / SB_DFF/{ff+=$2} / SB_RAM40/{ram+=$2}
    END{printf "| %s | %d | %d | %d | %d | `%s` |\n", name, lut, ff, carry, ram, params}' "$work/$name.stat"
}
cells() { # NAME PARAM=VALUE...: a row of the core
  local name=$1
  shift
  # shellcheck disable=SC2016
  part "$name" kage_top "$@" | if [ "$name" = base ]; then sed 's/`kage_top /`/'; else sed "s/\`kage_top $base /\`base, /; s/\`kage_top /\`/"; fi
}

base=$(python3 -c 'import yaml; print(*(f"{k}={v}" for k, v in yaml.safe_load(open("constraints/cores.yaml"))["base"].items()))')
export -f cells part
export work base
# ---- the compare tree's parts alone ----
column() { awk -F'|' -v c="$2" '{print $c + 0}' "$work/$1.row"; } # NAME COLUMN
luts() { column "$1" 3; }
ffs() { column "$1" 4; }
rams() { column "$1" 6; }

tree_parts() { # prints two tables; exit 1 if a tree is smaller than one of fewer units, or a core has not its units' block RAMs
  local last=0 units name bad=0
  local header="LUT4 | flip-flops | carry | RAM 4k | module and parameters |" line="| --- | --- | --- | --- | --- |"
  local small=${base#LANES=2 MAX_WIDTH=64 } # what of the base the parts have
  local jobs=(
    "cell compare_cell" "unit expansion_unit UNITS=2" "unit-classic expansion_unit UNITS=2 CLASSIC=1 Z_BITS=15 Z_FRAC=0"
    "check1 segment_check UNITS=1" "check2 segment_check UNITS=2" "check4 segment_check UNITS=4" "check8 segment_check UNITS=8"
    "check64 segment_check UNITS=64" "small-unit expansion_unit UNITS=2 $small"
  )
  for units in 2 4 8 16 32 64; do jobs+=("tree$units compare_tree UNITS=$units"); done
  for units in 0 1 2 4 8; do jobs+=("core$units kage_top $base UNITS=$units"); done
  printf '%s\n' "${jobs[@]}" | xargs -P 2 -I{} bash -c 'set -euo pipefail; set -- {}; part "$@" >"$work/$1.row"'

  printf '| part | %s\n| --- %s\n' "$header" "$line"
  for name in cell unit unit-classic small-unit tree2 tree4 tree8 tree16 tree32 tree64 check1 check2 check4 check8 check64; do cat "$work/$name.row"; done
  echo
  echo "| units | LUT4 a compare cell | flip-flops a compare cell |"
  echo "| --- | --- | --- |"
  for units in 2 4 8 16 32 64; do
    name=tree$units
    awk -v n=$units -v lut="$(luts $name)" -v ff="$(ffs $name)" 'BEGIN{printf "| %d | %.1f | %.1f |\n", n, lut / (n - 1), ff / (n - 1)}'
    [ "$(luts $name)" -gt "$last" ] || { echo "cells.sh: $name has no more LUTs than half of it" >&2; bad=1; }
    last=$(luts $name)
  done
  echo
  echo "The whole core, \`kage_top $base UNITS=N\`:"
  echo
  echo "| N | LUT4 | flip-flops | RAM 4k | LUT4 a further unit | flip-flops a further unit |"
  echo "| --- | --- | --- | --- | --- | --- |"
  # The tree's line buffer of 2 lanes: depth, colour and lit bit, in blocks of 16 bits.
  local buffer=$(((2 * (24 + 24 + 1) + 15) / 16)) before=0
  for units in 0 1 2 4 8; do
    name=core$units
    awk -v n=$units -v m=$before -v lut="$(luts $name)" -v ff="$(ffs $name)" -v ram="$(rams $name)" -v lut0="$(luts core$before)" -v ff0="$(ffs core$before)" 'BEGIN{
      printf "| %d | %d | %d | %d |", n, lut, ff, ram
      if (n > 1) printf " %.0f | %.0f |\n", (lut - lut0) / (n - m), (ff - ff0) / (n - m); else print "  |  |"}'
    [ $units = 0 ] || [ "$(rams $name)" = $(($(rams core0) + buffer + units * $(rams small-unit))) ] ||
      { echo "cells.sh: $name: $(rams $name) block RAMs are not those of its units and the tree's line" >&2; bad=1; }
    before=$units
  done
  return $bad
}
if [ "${1:-}" = --tree ]; then tree_parts; exit; fi

quick=
if [ "${1:-}" = --quick ]; then quick=1; elif [ $# -gt 0 ]; then cells "$@"; exit; fi

default=$(python3 -c 'import yaml; print(*(f"{k}={v}" for k, v in yaml.safe_load(open("rtl/defs/configs.yaml"))["default"].items()))')
rows=(
  "base $base"
  "no-fsf $base FSF=0"
  "no-shadow $base FSF=0 DSF_BITS=0"
  "one-channel $base CHANNELS=1"
  "small-z $base Z_BITS=12"
  "smooth $base SMOOTH=1 COLOR_FRAC=7"
  "glass $base TRANSLUCENCY=1"
  "counter $base COUNT_BITS=4"
  "table2 $base COUNT_BITS=4 LIGHTS=2 CLASS_BITS=5"
  "glass-table2 $base TRANSLUCENCY=1 COUNT_BITS=4 LIGHTS=2 CLASS_BITS=5"
  "one-lane $base LANES=1"
  "one-word-beats $base BEAT_WORDS=1"
  "systolic16 $base MAX_WIDTH=16 ARRANGEMENT=0"
  "default $default"
)
[ -z "$quick" ] || rows=("${rows[0]}" "${rows[@]:2:3}")
echo "| configuration | LUT4 | flip-flops | carry | RAM 4k | parameters |"
echo "| --- | --- | --- | --- | --- | --- |"
printf '%s\n' "${rows[@]}" | xargs -P 2 -I{} bash -c 'set -euo pipefail; set -- {}; cells "$@" >"$work/$1.row"'
for row in "${rows[@]}"; do cat "$work/${row%% *}.row"; done

# ---- block RAMs: exactly those of the line's state (banked), the way out's two lines, the light table ------------------------------------------
# A block holds 256 words of 16 bits, 512 of 8, 1024 of 4 or 2048 of 2.
expected_rams() { # PARAM=VALUE...
  python3 - "$@" <<'PY'
import sys, yaml
defs = yaml.safe_load(open("rtl/defs/kage.yaml"))
p = {d["name"]: d["default"] for d in defs["pixel_params"] + defs["impl_params"]}
p.update((a.split("=")[0], int(a.split("=")[1])) for a in sys.argv[1:])
lanes = p["LANES"] if p["ARRANGEMENT"] == 1 else 1
groups = -(-p["MAX_WIDTH"] // lanes)
shadows = p["DSF_BITS"] > 0
classes = p["CLASS_BITS"] if shadows else 0
counts = p["LIGHTS"] * p["COUNT_BITS"]
table = p["CLASS_BITS"] > 1
state = p["Z_BITS"] + 8 * p["CHANNELS"] + classes + p["DSF_BITS"] + p["FSF"] + counts
leaving = 8 * p["CHANNELS"] + 1 + (counts + table * classes if counts else shadows)
def blocks(words, bits):
    if words * bits <= 16 * 16:  # so little goes into flip-flops
        return 0
    width = next(w for w, depth in ((16, 256), (8, 512), (4, 1024), (2, 2048)) if words <= depth)
    return -(-bits // width)
shares = p["LIGHTS"] * blocks(2 ** p["CLASS_BITS"], p["CHANNELS"] * (p["SHADE_FRAC"] + 1)) if table else 0
print(shares + (blocks(groups, lanes * state) if p["ARRANGEMENT"] == 1 else 0) + blocks(2 * groups, lanes * leaving))
PY
}

# ---- a feature's state implies at least these LUTs and flip-flops, which go (smooth, glass, counters: come) with it --------------------------------------
# Counted are only bits that no optimizer can share or drop. In the base's numbers: L = 2 lanes, 24 bits of depth, 3 x 8 of colour,
# S = 9 bits of shade, `Last` = 4 stages behind the walker.
#   A bit of a pixel's state, per lane: flip-flops stored_q, recent_q, word_q, done_q, done2_q (5); LUTs of the three sources of
#   `settled` (2), of word_q (1), of the next state (1).
#   A bit of colour that leaves: exit_data_o, group_q per lane; pixel_q, plain_q, color_q, two in the skid buffer, one of the
#   product's upper 8, and background in frame_control, line_out and four times in the queue. LUTs: the lane's choice, dimmed or
#   plain, the skid buffer's choice, two for the queue's four words.
#   A product of 8 x S bits takes S - 1 additions of 8 bits: a LUT a bit.
#   A ramp of B bits, F of them fraction: start, slope, low; part, slope2; first, slope3; root, L leaves without fraction (the
#   last level), slope of the root. Then L x OUT for the integer part and again for the value. LUTs: low, part, root, right leaf,
#   and the clamp of each lane's OUT bits.
l=2 last=4 s=9
state_ff=$((5 * l)) state_lut=$((4 * l))
exit_ff=$((2 * l + 5 + 1 + 2 + 4)) exit_lut=$((1 + 1 + 1 + 2))
product_lut=$(((s - 1) * 8))
implied() { # NAME: "LUTs flip-flops"
  local bits
  case $1 in
    # One bit of state, and volume_open_q. LUTs: none, since DSF + bias is now read at the end of the line in place of FSF.
    no-fsf) echo 0 $((state_ff + 1)) ;;
    # lit, DSF and FSF; dark in exit_data_o, group_q, pixel_q and dark_q; the products with their upper 8 bits. Shade in
    # frame_control, line_out and queue; bias, phase and volume_open_q; the count in cmd, three set-up stages, walker and stages.
    no-shadow) echo $((3 * state_lut + 3 * product_lut + 24)) $((3 * state_ff + 2 * l + 2 + 3 * 8 + 6 * s + 4 + 5 + last)) ;;
    # 16 bits of colour: in state and exit, and on the way in: cmd, three set-up stages, walker, stages.
    one-channel) echo $((16 * (state_lut + exit_lut) + 2 * product_lut)) $((16 * (state_ff + exit_ff + 5 + last))) ;;
    # 12 bits of depth: in state, its two comparisons and the register in front of them, cmd_z, cmd_dz and the ramp.
    small-z) echo $((12 * (state_lut + 2 * l + 4 + l))) $((12 * (state_ff + l + 2 + 7 + 1 + l + 1 + 2 * l))) ;;
    # Three ramps of 17 bits, 7 of them fraction, colour and slope in cmd and token_q (187 bits in place of the header's 160), less
    # the flat colour's set-up stages, walker and stages.
    smooth)
      bits=17
      echo $((3 * (4 * bits + 8 * l))) $((3 * (9 * bits + l * (bits - 7) + 2 * 8 * l) + 3 * (bits - 8) + 3 * bits + 27 - 24 * (4 + last))) ;;
    # A blender's product a channel and lane; the share in cmd, three set-up stages, walker and stages; that a line is painted in
    # frame_control, the queue's four words, and four times in line_out.
    glass) echo $((3 * l * product_lut)) $((s * (5 + last) + 1 + 4 + 4)) ;;
    # Four bits of state, three more that leave than dark; two stages of colour and flags; product, factor; two flags of frame_control and
    # the top. Less plain_q, dark_q and the choice between them: every pixel has a factor. LUTs: some 44, by which ABC's outcome varies anyway.
    counter) echo 0 $((4 * state_ff + 3 * (2 * l + 1) + 2 * (25 + 4) + (3 + s) + s + 2 - 25)) ;;
    # Twelve bits of state and of what leaves; 4 of a command's count in cmd, three set-up stages, walker, stages; five stages of colour and flags;
    # counts twice, entries, products, sums, factors; table_check. Less shade in frame_control, line_out and the queue.
    table2)
      echo $((12 * state_lut + 6 * 3 * s + 3 * (s + 3) - 24 - 2 * s)) \
        $((12 * state_ff + 12 * (2 * l + 1) + 4 * (5 + last) + 5 * (25 + 4) + 2 * 8 + 6 * s + 6 * (3 + s) + 3 * (4 + s) + 3 * s + 8 + 2 - 25 - 6 * s)) ;;
    # table2, a blender without shade's products, and the place of a load.
    glass-table2)
      echo $((12 * state_lut + 6 * 3 * s + 3 * (s + 3) - 24 - 2 * s + 3 * l * 7 * 8)) \
        $((12 * state_ff + 12 * (2 * l + 1) + 4 * (5 + last) + 5 * (25 + 6) + 2 * 8 + 6 * s + 6 * (3 + s) + 3 * (4 + s) + 3 * s + 8 + 2 - 25 - 6 * s + 8 * (5 + last) + 7)) ;;
    # A lane's 51 bits of state with its comparison, its 26 bits of exit_data_o and group_q, the choice among lanes, two leaves, and
    # a stage of flat colour.
    one-lane) echo $((51 * 4 + 2 * 24 + 26 + 24)) $((51 * 5 + 24 + 2 * 26 + 2 * (33 - 7) + 2 * 24 + 24)) ;;
    # 8 words in place of 4 x 4, and a bit more in two pointers. LUTs: less alignment, but more words to choose from: no bound.
    one-word-beats) echo 0 $((32 * 8 - 2)) ;;
  esac
}

bad=0
for row in "${rows[@]}"; do
  name=${row%% *}
  # shellcheck disable=SC2086
  want=$(expected_rams ${row#* })
  [ "$(rams "$name")" = "$want" ] || { echo "cells.sh: $name: $(rams "$name") block RAMs, its memories take $want" >&2; bad=1; }
  case $name in base | default) continue ;; esac
  lut=$(($(luts base) - $(luts "$name"))) ff=$(($(ffs base) - $(ffs "$name")))
  if [ "$name" = systolic16 ]; then # 16 processors: state, kind, range, count, depth and slope, colour, two flags
    least=$((16 * (51 + 4 + 2 * 7 + 1 + 2 * 33 + 24 + 2)))
    [ "$(ffs "$name")" -ge $least ] || { echo "cells.sh: $name: $(ffs "$name") flip-flops, its processors hold $least" >&2; bad=1; }
    continue
  fi
  case $name in smooth | glass | counter | *table2) lut=$((-lut)) ff=$((-ff)) ;; esac
  read -r least_lut least_ff < <(implied "$name")
  echo "cells.sh: $name: $lut LUTs, at least $least_lut; $ff flip-flops, at least $least_ff" >&2
  [ "$least_lut" = 0 ] || [ "$lut" -ge "$least_lut" ] || bad=1
  [ "$ff" -ge "$least_ff" ] || bad=1
done
exit $bad
