#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage cosim can say no: the RTL is built with each defect of verif/cosim/model/faults.yaml, and each must be found, with its place and its pictures.
# One whose description begins with "Not a fault" must change nothing. verif/test/unit/cosim/faults.cpp knows the places beforehand.
. "$(dirname "$0")/common.bash"

expect 0 "$kage" stream courtyard --size 160x120 --frames 2 --all-spans --out courtyard.kage
expect 0 "$kage" stream glass --config glass --size 160x120 --frames 2 --all-spans --out glass.kage
expect 0 "$kage" stream courtyard --size 160x120 --frames 2 --level polygons --all-spans --out polygons.kage
echo '{SMOOTH: 1, COLOR_FRAC: 8, COUNT_BITS: 2, LIGHTS: 3, CLASS_BITS: 8, SHADE_FRAC: 12, MAX_WIDTH: 160}' >three.yaml
expect 0 "$kage" stream three-lights --size 160x120 --frames 2 --samples 3 --config three.yaml --all-spans --out lights.kage
count=0
expect 0 "$kage" list --json list.json
faults() { # CONDITION: the names of the faults f for which the condition of Python holds
  python3 -c 'import json; print(*(f["name"] for f in json.load(open("list.json"))["faults"] if '"$1"'))'
}
none=" $(faults 'f["about"].startswith("Not a fault")') "
for name in $(faults True); do
  # Defects of the tree need ties, or a line ahead of time, which this scene has not: ctest rtl/fault_NAME finds those.
  # No scene has more samples than a counter holds, and a table comes early only where the way out is slow: ctest rtl/fault_NAME.
  # Every scene says its shade: ctest unit/cosim/faults. Registers are read at the end of frames: ctest cli/register_answers.
  case $name in tree_tie | early_refill | count_wraps | early_table | unreset_shade | silent_registers) continue ;; esac
  frames=courtyard.kage
  case $name in
    blend_* | resolve_*) frames=glass.kage ;;
    sample_* | *_light) frames=lights.kage ;;
    front_end_*) frames=polygons.kage ;;
  esac
  if [[ $none == *" $name "* ]]; then
    expect 0 "$kage" cosim "$frames" --fault "$name" --idle 30 --backpressure 30 --out "$name"
    continue
  fi
  count=$((count + 1))
  expect 1 "$kage" cosim "$frames" --fault "$name" --no-divergence --idle 30 --backpressure 30 --out "$name" --json "$name.json"
  echo "$name: $(grep '^first difference' stdout)"
  # Cores that are silent are known by their silence: no assertion tells of it first.
  case $name in
    stub_silent) grep -q ': only 0 of 19200 pixels came: the core went idle$' stdout || fail "$name: $(cat stdout)" ;;
    stub_hang) grep -q ': only 160 of 19200 pixels came: the core went idle$' stdout || fail "$name: $(cat stdout)" ;;
  esac
  json "$name.json" 'j["same"] is False and j["first_difference"]["frame"] is not None and j["first_difference"]["field"]'
  [ -n "$(find "$name" -name '*_expected.png')" ] && [ -n "$(find "$name" -name '*_difference.png')" ] || fail "$name: no pictures of the difference"
  expect 1 "$kage" diff "$name"/*_expected.png "$name"/*_actual.png --json d.json
  json d.json 'j["first"]["y"]=='"$(python3 -c "import json; d=json.load(open('$name.json'))['first_difference']; print(d['line'], 'and j[\"first\"][\"x\"]==', d['x'])")"
done
[ $count -ge 4 ] || fail "only $count faults to try"

# README shows what the first of them looks like, as a change of the very line of RTL.
expect 1 "$kage" cosim courtyard --config default --all-spans --fault wrong_compare --json w.json
json w.json '(d:=j["first_difference"]) and d["stage"]=="pixel_banked" and d["divergence"]["file"]=="rtl/pixel_banked.sv" and d["cycle"]>0'
json w.json '"obelisk" in j["first_difference"]["divergence"]["source"]'
[ -s out/courtyard_0000.fst ] && [ -s out/courtyard_0000.gtkw ] || fail "no waveform of the first divergence"
for line in "$(cut -d, -f1-3 stdout | grep '^different')" "$(grep '^first difference' stdout)" "$(grep '^first divergence' stdout)" "$(grep '^pictures' stdout)"; do
  grep -qF -- "$line" "$source/README.md" || fail "README.md does not show '$line'"
done
grep -qF 'in_front = z < ' "$source/rtl/include/kage_pixel_next.svh" || fail "README.md changes a line that is not there"
done_testing
