#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# docs/broken-frame.md: its commands print what it shows, and it names what there is.
. "$(dirname "$0")/common.bash"

mkdir bin && ln -s "$kage" bin/kage
python3 "$source/verif/test/cli/shown.py" "$source/docs/broken-frame.md" 1 0 0 || fail "docs/broken-frame.md shows something else than its commands print"
# The last of them, of sound RTL, has taken away what the first one left.
[ ! -e out/courtyard_0000.gtkw ] && [ ! -e out/courtyard_0000_actual.png ] || fail "evidence of a difference that is no more"
expect 1 "$kage" cosim courtyard --all-spans --fault wrong_compare
for file in out/report.html out/courtyard_0000.gtkw out/courtyard_0000.fst; do
  [ -s $file ] || fail "no $file"
done
python3 "$source/verif/test/cli/waveform_nets.py" out/courtyard_0000.gtkw || fail "GTKWave would not find the nets"
expect 1 "$kage" cosim polyhedra --config polyhedra --all-spans --fault wrong_compare --frames 1 --size 160x120 --out tree
python3 "$source/verif/test/cli/waveform_nets.py" tree/polyhedra_0000.gtkw || fail "GTKWave would not find the tree's nets"
grep -q 'in_front = z <' "$source/rtl/include/kage_pixel_next.svh" || fail "docs/broken-frame.md names a line that is not there"
# The red pixels there were lit: no pixel that differs is background.
PYTHONPATH=$source/verif/test/cli python3 - <<'PY' || fail "docs/broken-frame.md: pixels of the background differ"
import sys
from png import pixels
a, b = pixels("out/courtyard_0000_expected.png"), pixels("out/courtyard_0000_actual.png")
sky = a[:3]
differ = [a[i:i + 3] for i in range(0, len(a), 3) if a[i:i + 3] != b[i:i + 3]]
sys.exit(not (differ and sky not in differ))
PY
done_testing
