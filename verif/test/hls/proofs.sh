#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves that kernels out of hls/tool are the hand-written RTL: pixel_next the function of kage_pixel_next.svh, for every
# named configuration whose pixels differ, and compare_cell the choice of the compare tree's cell. Then each proof is
# shown to fail where the generated module has a defect.
#
# usage: verif/test/hls/proofs.sh [MODULE...]           default: all of hls/generated that have a proof
#        verif/test/hls/proofs.sh --script MODULE FILE  prints yosys' commands that read the module in FILE and its proof
# Needs yosys. Exit 0: all is proved, and every defect is found; 1: not so; 2: a tool or a file is not as it should be.
set -euo pipefail
[ "${1:-}" != --help ] || { sed -n '3,9s/^# \{0,1\}//p' "$0"; exit 0; }
cd "$(dirname "$0")/../../.."
command -v yosys >/dev/null || { echo "proofs.sh: yosys is missing (tools/deps test)" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=verif/test/hls
bad=0

parameters_of() { # CONFIG: chparam's options for its pixel parameters
  /usr/bin/python3 - "$1" <<'PY'
import sys

import yaml

pixel = {p["name"]: p["default"] for p in yaml.safe_load(open("rtl/defs/kage.yaml"))["pixel_params"]}
given = yaml.safe_load(open("rtl/defs/configs.yaml"))[sys.argv[1]] or {}
print(*(f"-set {name} {given.get(name, value)}" for name, value in pixel.items()))
PY
}

script() { # MODULE FILE: yosys' commands that make the module in FILE and the RTL to the design `proof`
  local module=$1 file=$2 top rtl=() sets=''
  case $module in
    hls_compare_cell) top=compare_cell_proof rtl=(rtl/compare_cell.sv) ;;
    *) top=pixel_next_proof sets="chparam $(parameters_of "${module#hls_pixel_next_}") pixel_next_proof;" ;;
  esac
  echo "read_verilog -sv -Irtl/include $file ${rtl[*]}; read_verilog -sv -formal -DKERNEL=$module -Irtl/include $here/$top.sv;
    $sets hierarchy -check -top $top; rename -top proof; proc; flatten; opt -full; async2sync"
}

prove() { # MODULE FILE: whether the module in FILE is the RTL's; its proof in $work/said
  # A step of induction from any state that keeps the assertions, which for what has no state is a proof at once.
  yosys -q -p "$(script "$@"); sat -verify -tempinduct -prove-asserts proof" >"$work/said" 2>&1
}
refuted() { grep -q "proof did fail" "$work/said"; }

if [ "${1:-}" = --script ]; then
  script "$2" "$3"
  exit
fi
modules=("$@")
if [ $# = 0 ]; then
  modules=(hls_compare_cell)
  for file in hls/generated/hls_pixel_next_*.sv; do modules+=("$(basename "$file" .sv)"); done
fi
for module in "${modules[@]}"; do
  file=hls/generated/$module.sv
  [ -f "$file" ] || { echo "proofs.sh: $file: no such module" >&2; exit 2; }
  start=$SECONDS
  if prove "$module" "$file"; then
    echo "$module: proved ($((SECONDS - start)) s)"
  else
    echo "$module: NOT proved" >&2
    tail -5 "$work/said" >&2
    bad=1
  fi
  # Defects: comparisons, choices and constants, each alone, in the first line that has one.
  tried=0
  for change in 's/ < / <= /' 's/ ? \(.*\) : \(.*\);/ ? \2 : \1;/' 's/ & / | /' "s/ == 4'd7/ == 4'd9/" 's/ + / - /'; do
    line=$(grep -n -m1 -e "$(sed 's#^s/\(.*\)/[^/]*/$#\1#' <<<"$change")" <(sed -n 's/^  wire //p' "$file") | cut -d: -f1) || continue
    awk -v at="$line" '/^  wire /{ if (++n == at) { print "//CHANGE" $0; next } } { print }' "$file" |
      sed "s#^//CHANGE##;t changed;b;:changed;$change" >"$work/$module.sv"
    cmp -s "$work/$module.sv" "$file" && continue
    tried=$((tried + 1))
    if prove "$module" "$work/$module.sv" || ! refuted; then
      echo "$module: the defect $change in line $line is NOT found" >&2
      bad=1
    fi
  done
  [ $tried -ge 2 ] || { echo "proofs.sh: $module: $tried defects could be made" >&2; bad=1; }
  echo "$module: $tried defects found"
done
exit $bad
