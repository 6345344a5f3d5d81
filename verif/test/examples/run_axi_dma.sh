#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs examples/axi_dma as its README says: sound, and with defects of core, DMA, driver and pack, each of which it
# must tell.
# usage: run_axi_dma.sh KAGE SOURCE
. "$(dirname "$0")/../cli/common.bash"

# example FOLDER [MAKE_ARGUMENT...]: of this folder's copy of the example, with output in stdout and stderr.
example() {
  local folder=$1
  shift
  make -s -C "$folder" KAGE="$kage" RTL="$source/rtl" INCLUDE="$source/ref/include" "$@" >stdout 2>stderr
}
cp -r "$source/examples/axi_dma" sound
example sound WORK="$temp/build" || { fail "the example does not pass"; tail -n 20 stdout stderr; done_testing; }
cat stdout
grep -q '^kage_dma: same: ' stdout || fail "does not say same"
! grep -hE '(kage_driver\.[ch]|sim\.cpp):.*warning' stdout stderr || fail "does not compile without a warning"
# The README shows lines that were printed, but for clocks and the line of a standstill, which change with the RTL's latency.
clocks='s/, [0-9]* clocks$//; s/ at line [0-9]*$//'
shown=$(awk '/^```/ { inside = !inside; shown = inside && $0 == "```"; next } shown' "$source/examples/axi_dma/README.md" | sed "$clocks")
[ -n "$shown" ] || fail "the README shows nothing"
while IFS= read -r line; do
  [ "$line" = ... ] || sed "$clocks" stdout | grep -qxF -- "$line" || fail "the README shows another line: $line"
done <<<"$shown"
for seed in 2 3 4; do
  expect 0 build/Vkage_dma build/pack $seed
done
expect 2 build/Vkage_dma nowhere
grep -q '^sim: nowhere/stimulus.bin: cannot be read$' stderr || fail "does not name the file: $(cat stderr)"

# Without make clean: a pack of one's own, however old, and another configuration are another program; the same is not.
expect 0 "$kage" vectors courtyard --degrade --size 16x12 --frames 1 --config default --no-rtl --out mine
touch -d 2000-01-01 mine/*
# made [MAKE_ARGUMENT...]: passes.
made() {
  example sound WORK="$temp/other" "$@" || { fail "$*: does not pass"; tail -n 5 stdout stderr; }
  tail -n 1 stdout | grep -q '^kage_dma: same: ' || fail "$*: says $(tail -n 1 stdout)"
}
made SIZE=24x16
pixels=$(grep -o '[0-9]* pixels compared' stdout)
made PACK="$temp/mine"
cp -p other/Vkage_dma before
made PACK="$temp/mine"
[ ! other/Vkage_dma -nt before ] || fail "the same pack is compiled again"
made CONFIG=default SIZE=24x16
[ "$(grep -o '[0-9]* pixels compared' stdout)" != "$pixels" ] || fail "CONFIG=default: the core of tiny ran"
rm -rf other

# A flipped bit of one pixel that the pack expects.
cp -r build/pack flipped
python3 - flipped/pixels.bin <<'PY'
import sys
data = bytearray(open(sys.argv[1], "rb").read())
data[20 * 64 + 7] ^= 1
open(sys.argv[1], "wb").write(data)
PY
expect 1 build/Vkage_dma flipped
grep -q '^different: frame 0, line 20, x 7, byte 0: expected ' stdout || fail "a flipped pixel is not told: $(tail -3 stdout)"
grep '^different: frame 0' stdout

defective() { # NAME: the example of this folder, with the RTL beside it
  ! example "$1/examples/axi_dma" WORK="$temp/build_$1" PACK="$temp/build/pack" RTL="$temp/$1/rtl" || fail "$1: passes"
}
each_defect axi_dma defective
done_testing
