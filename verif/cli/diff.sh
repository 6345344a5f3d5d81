#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage diff: exit codes, JSON, tolerances, bad input.
. "$(dirname "$0")/common.bash"

python3 - <<'PY'
import struct, zlib
def png(name, w, h, pixels):
    raw = b"".join(b"\0" + bytes(pixels[y * w * 3:(y + 1) * w * 3]) for y in range(h))
    chunk = lambda t, d: struct.pack(">I", len(d)) + t + d + struct.pack(">I", zlib.crc32(t + d))
    open(name, "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", w, h, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))
base = [(i * 5) % 250 for i in range(8 * 6 * 3)]
png("a.png", 8, 6, base)
other = list(base)
other[(2 * 8 + 3) * 3 + 1] += 4
other[(4 * 8 + 1) * 3] += 1
png("b.png", 8, 6, other)
png("c.png", 6, 8, base)
open("cut.png", "wb").write(open("a.png", "rb").read()[:60])
open("empty.png", "wb")
PY

expect 0 "$kage" diff a.png a.png
grep -q '^same: 8x6' stdout || fail "the line does not say same"
expect 1 "$kage" diff a.png b.png --json r.json --out heat.png
json r.json 'j["same"] is False and (j["width"],j["height"],j["channels"])==(8,6,3) and j["different_pixels"]==2 and j["max_lsb"]==4'
json r.json 'j["first"]=={"x":3,"y":2,"channel":1}'
[ -s heat.png ] || fail "no difference picture"
expect 1 "$kage" diff b.png a.png --json -
cp stdout s.json
json s.json 'j["different_pixels"]==2 and j["max_lsb"]==4'
expect 0 "$kage" diff a.png b.png --lsb 4
expect 1 "$kage" diff a.png b.png --lsb 3
expect 0 "$kage" diff a.png b.png --max-pixels 2
expect 1 "$kage" diff a.png b.png --max-pixels 1
expect 0 "$kage" diff a.png b.png --max-percent 4.2
expect 1 "$kage" diff a.png b.png --max-percent 4.1
expect 1 "$kage" diff a.png c.png --max-percent 100 --json -
cp stdout s.json
json s.json 'j["same"] is False and j["width"] is None and j["different_pixels"] is None and "8x6" in j["reason"]'

trouble missing.png "$kage" diff a.png missing.png
trouble cut.png "$kage" diff a.png cut.png
trouble empty.png "$kage" diff a.png empty.png
trouble "is a directory" "$kage" diff a.png .
trouble nowhere "$kage" diff a.png b.png --out nowhere/heat.png
trouble nowhere/r.json "$kage" diff a.png b.png --json nowhere/r.json --lsb 9 >/dev/null
trouble -1 "$kage" diff a.png b.png --lsb -1
trouble -1 "$kage" diff a.png b.png --max-pixels -1
trouble 99999999999999999999 "$kage" diff a.png b.png --lsb 99999999999999999999
trouble nan "$kage" diff a.png b.png --max-percent nan
mkfifo pipe.png
trouble "not a file" "$kage" diff a.png b.png --out pipe.png
[ -z "$(find . -name '.*.png' -o -name '.*.json')" ] || fail "temporary files are left"
done_testing
