#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# docs/broken-frame.md: its commands print what it shows, and it names what there is.
. "$(dirname "$0")/common.bash"

mkdir bin && ln -s "$kage" bin/kage
python3 "$source/verif/test/cli/shown.py" "$source/docs/broken-frame.md" 1 0 0 || fail "docs/broken-frame.md shows something else than its commands print"
# The last of them, of sound RTL, has taken away what the first one left.
[ ! -e out/courtyard_0000.gtkw ] && [ ! -e out/courtyard_0000_actual.png ] || fail "evidence of a difference that is no more"
expect 1 "$kage" cosim courtyard --fault wrong_compare
for file in out/report.html out/courtyard_0000.gtkw out/courtyard_0000.fst; do
  [ -s $file ] || fail "no $file"
done
python3 "$source/verif/test/cli/waveform_nets.py" out/courtyard_0000.gtkw || fail "GTKWave would not find the nets"
expect 1 "$kage" cosim polyhedra --config polyhedra --fault wrong_compare --frames 1 --size 160x120 --out tree
python3 "$source/verif/test/cli/waveform_nets.py" tree/polyhedra_0000.gtkw || fail "GTKWave would not find the tree's nets"
grep -q 'in_front = z <' "$source/rtl/include/kage_pixel_next.svh" || fail "docs/broken-frame.md names a line that is not there"
# What is red there was lit: of the pixels that differ none is background.
python3 - <<'PY' || fail "docs/broken-frame.md: pixels of the background differ"
import struct, sys, zlib
def pixels(name):  # of a PNG of 8 bits, red, green, blue
    data, at, packed = open(name, "rb").read(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
            assert body[8:13] == bytes([8, 2, 0, 0, 0])
        packed += body if kind == b"IDAT" else b""
        at += size + 12
    raw, line, out = zlib.decompress(packed), bytearray(3 * width), bytearray()
    for y in range(height):
        row = raw[y * (3 * width + 1):(y + 1) * (3 * width + 1)]
        above, line = line, bytearray(row[1:])
        for i in range(3 * width):
            left, up, corner = (line[i - 3] if i > 2 else 0), above[i], (above[i - 3] if i > 2 else 0)
            guess = left + up - corner
            paeth = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[row[0]]) & 255
        out += line
    return bytes(out)
a, b = pixels("out/courtyard_0000_expected.png"), pixels("out/courtyard_0000_actual.png")
sky = a[:3]
differ = [a[i:i + 3] for i in range(0, len(a), 3) if a[i:i + 3] != b[i:i + 3]]
sys.exit(not (differ and sky not in differ))
PY
done_testing
