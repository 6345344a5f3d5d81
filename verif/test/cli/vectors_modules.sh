#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage vectors --module: what passes at a module's ports is recorded, Icarus Verilog plays it against the module alone, and a
# defect in the module fails its pack.
. "$(dirname "$0")/common.bash"
played() { # FOLDER RTL TEXT
  local last
  sed -n '/^iverilog /p' "$1/README.md" | sed "s,RTL/,$2/,g" >lines
  (cd "$1" && bash ../lines >said 2>build)
  last=$(grep '^kage_module_tb: ' "$1/said" | tail -n1)
  [[ $last == "kage_module_tb: $3"* ]] || { fail "$1: not '$3': $last"; tail -n5 "$1/build" "$1/said"; }
}
# recorded MODULE SCENE CONFIG FILE SED-EXPRESSION [ARGUMENT...]: its pack passes, and fails with rtl/FILE changed.
recorded() {
  local module=$1
  expect 0 "$kage" vectors "$2" --config "$3" --size 16x12 --frames 1 --module "$module" --out "$module" --json module.json "${@:6}"
  json module.json 'j["module"]=="'"$module"'" and j["clocks"]>500'
  played "$module" "$source/rtl" "passed: "
  rm -rf wrong && cp -r "$source/rtl" wrong
  sed -i "$5" "wrong/$4"
  ! cmp -s "wrong/$4" "$source/rtl/$4" || fail "$module: no defect was put in"
  played "$module" "$PWD/wrong" "FAILED: clock "
}
recorded token_reader courtyard default token_reader.sv "s/== OffBits'(o)) front/== OffBits'(o-1)) front/"
recorded pixel_banked courtyard default pixel_banked.sv "s/valid\[Last-1\] && addr_ahead2 == addr_ahead/1'b0/" --sound-only --all-spans
grep -q '^  exit_data_o: expected [0-9a-f]*, got [0-9a-f]*$' pixel_banked/said || fail "the port is not told: $(cat pixel_banked/said)"
recorded pixel_systolic courtyard systolic64 pixel_systolic.sv "s/z + dz_q\[i/z - dz_q[i/" --sound-only --all-spans
recorded line_out courtyard default line_out.sv "s/first_q <= line\.first;/first_q <= 1;/" --sound-only --all-spans
recorded expansion_unit polyhedra polyhedra expansion_unit.sv "s/assign line_read = .*/assign line_read = read;/" --sound-only
recorded compare_tree polyhedra polyhedra compare_cell.sv "s/right_wins ? right_data_i : left_data_i/right_wins ? left_data_i : right_data_i/" --sound-only
no_leftovers
# The hashes are those of the files.
(cd line_out && python3 -c '
import hashlib, json, sys
m = json.load(open("manifest.json"))
sys.exit(any(hashlib.sha256(open(f["name"], "rb").read()).hexdigest() != f["sha256"] for f in m["files"]))') || fail "a hash of a module's pack is wrong"

trouble '--module frame_control: not one of token_reader, pixel_banked, ' "$kage" vectors courtyard --config default --module frame_control --out none
trouble '--module compare_tree: a core has one with UNITS > 1' "$kage" vectors courtyard --config default --module compare_tree --out none
trouble '--module: the RTL must run' "$kage" vectors courtyard --config default --module line_out --no-rtl --out none
[ ! -e none ] || fail "a pack that cannot be leaves a folder"

done_testing
