#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage diff of two pictures: exit codes, JSON, thresholds, region and mask, heat map and blink picture, JUnit, bad input.
. "$(dirname "$0")/common.bash"

python3 - <<'PY'
import struct, zlib
def chunk(tag, content):
    return struct.pack(">I", len(content)) + tag + content + struct.pack(">I", zlib.crc32(tag + content))
def png(name, w, h, pixels, more=b""):
    """Red, green and blue of 8 bits."""
    raw = b"".join(b"\0" + bytes(pixels[y * w * 3:(y + 1) * w * 3]) for y in range(h))
    write(name, w, h, 8, 2, raw, more)
def grey(name, w, h, bits):
    write(name, w, h, bits, 0, (b"\0" + bytes(w * bits // 8)) * h, b"")
def write(name, w, h, bits, colours, raw, more):
    open(name, "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", w, h, bits, colours, 0, 0, 0)) +
                           more + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))
base = [(i * 5) % 250 for i in range(8 * 6 * 3)]
png("a.png", 8, 6, base)
other = list(base)
other[(2 * 8 + 3) * 3 + 1] += 4
other[(4 * 8 + 1) * 3] += 1
png("b.png", 8, 6, other)
png("c.png", 6, 8, base)
png("mask.png", 8, 6, [255 if i // (8 * 3) == 4 else 0 for i in range(8 * 6 * 3)])
png("black.png", 8, 6, [0] * (8 * 6 * 3))
png("gamma.png", 8, 6, base, chunk(b"gAMA", struct.pack(">I", 100000)))
for bits in (4, 8, 16):
    grey("grey%d.png" % bits, 8, 6, bits)
# PNG's chunks about its numbers, one by one: two files that differ in it, and one without.
for tag, one, other in ((b"cICP", bytes([9, 16, 0, 1]), bytes([9, 18, 0, 1])), (b"sRGB", b"\0", b"\1"),
                        (b"gAMA", struct.pack(">I", 45455), struct.pack(">I", 45454)), (b"sBIT", b"\5\6\5", b"\5\5\5"),
                        (b"mDCV", bytes(range(24)), bytes(24)), (b"cLLI", struct.pack(">II", 1000, 400), bytes(8)),
                        (b"cHRM", bytes(range(32)), bytes(range(1, 33)))):
    png("one_%s.png" % tag.decode(), 8, 6, base, chunk(tag, one))
    png("other_%s.png" % tag.decode(), 8, 6, base, chunk(tag, other))
def tif(name, interpretation, channels, pixel):
    """8 x 8 pixels of one colour, not compressed."""
    data = bytes(pixel) * 64
    bits = struct.pack("<%dH" % channels, *[8] * channels)
    at = 8 + len(data) + len(bits)
    tags = [(256, 3, 1, 8), (257, 3, 1, 8), (258, 3, channels, 8 + len(data) if channels > 2 else 8), (259, 3, 1, 1),
            (262, 3, 1, interpretation), (273, 4, 1, 8), (277, 3, 1, channels), (278, 3, 1, 8), (279, 4, 1, len(data))]
    directory = struct.pack("<H", len(tags)) + b"".join(struct.pack("<HHII", *tag) for tag in tags) + bytes(4)
    open(name, "wb").write(b"II*\0" + struct.pack("<I", at + at % 2) + data + bits + bytes(at % 2) + directory)
tif("black.tif", 5, 4, [0, 0, 0, 255])  # cyan, magenta, yellow, black: one red, green and blue for many of them
tif("inks.tif", 5, 4, [255, 255, 255, 255])
tif("white0.tif", 0, 1, [0])
tif("black0.tif", 1, 1, [255])
tif("lab.tif", 8, 3, [100, 128, 0])
def jpeg(name, values):
    """8 x 8 pixels of one CMYK colour."""
    bits = ""
    for v in values:
        d = 8 * (v - 128)
        n = abs(d).bit_length()
        bits += format(n, "04b") + (format(d if d > 0 else d + (1 << n) - 1, "0%db" % n) if n else "") + "0"
    bits += "1" * (-len(bits) % 8)
    scan = bytes(int(bits[i:i + 8], 2) for i in range(0, len(bits), 8)).replace(b"\xff", b"\xff\0")
    part = lambda mark, content: bytes([0xFF, mark]) + struct.pack(">H", len(content) + 2) + content
    open(name, "wb").write(
        b"\xff\xd8" + part(0xEE, b"Adobe" + struct.pack(">HHHB", 100, 0, 0, 0)) + part(0xDB, b"\0" + b"\1" * 64) +
        part(0xC0, struct.pack(">BHHB", 8, 8, 8, 4) + b"".join(bytes([i, 0x11, 0]) for i in range(1, 5))) +
        part(0xC4, b"\0" + bytes([0, 0, 0, 12] + [0] * 12) + bytes(range(12))) +
        part(0xC4, b"\x10" + bytes([1] + [0] * 15) + b"\0") +
        part(0xDA, b"\4" + b"".join(bytes([i, 0]) for i in range(1, 5)) + b"\0\x3f\0") + scan + b"\xff\xd9")
jpeg("inks.jpg", [255, 3, 77, 0])
open("nan.pfm", "wb").write(b"Pf\n2 1\n-1\n" + struct.pack("<ff", float("nan"), 1))
open("cut.png", "wb").write(open("a.png", "rb").read()[:60])
open("empty.png", "wb")
PY

expect 0 "$kage" diff a.png a.png
grep -q '^same: 8x6' stdout || fail "the line does not say same"
expect 1 "$kage" diff a.png b.png --json r.json --out heat.png
json r.json 'j["same"] is False and (j["width"],j["height"],j["channels"])==(8,6,3) and j["different_pixels"]==2 and j["max_lsb"]==4'
json r.json 'j["first"]=={"x":3,"y":2,"channel":1}'
[ -s heat.png ] || fail "no heat map"
expect 1 "$kage" diff b.png a.png --json -
cp stdout s.json
json s.json 'j["different_pixels"]==2 and j["max_lsb"]==4'
expect 0 "$kage" diff a.png b.png --lsb 4
grep -q "all within the threshold, by up to 4 LSB" stdout || fail "the threshold is not told: $(cat stdout)"
expect 1 "$kage" diff a.png b.png --lsb 3
expect 0 "$kage" diff a.png b.png --max-pixels 2
grep -q "2 differ, no more than allowed, by up to 4 LSB" stdout || fail "what is allowed is not told: $(cat stdout)"
trouble "010 begins with 0" "$kage" diff a.png b.png --lsb 010
expect 1 "$kage" diff a.png b.png --max-pixels 1
expect 0 "$kage" diff a.png b.png --max-percent 4.2
expect 1 "$kage" diff a.png b.png --max-percent 4.1
expect 1 "$kage" diff a.png c.png --max-percent 100 --json -
cp stdout s.json
json s.json 'j["same"] is False and j["width"] is None and j["different_pixels"] is None and "8x6" in j["reason"]'

# Where: a region, a mask, and the boxes of what changed.
expect 1 "$kage" diff a.png b.png --region 4x3+0+0 --json r.json
json r.json 'j["compared_pixels"]==12 and j["different_pixels"]==1 and j["first"]=={"x":3,"y":2,"channel":1}'
json r.json 'j["regions"]==[{"x":3,"y":2,"width":1,"height":1,"pixels":1}] and j["region_count"]==1'
expect 0 "$kage" diff a.png b.png --region 3x4+0+0
grep -q '12 of 48 pixels compared' stdout || fail "the line does not say how much was compared: $(cat stdout)"
expect 1 "$kage" diff a.png b.png --mask mask.png --json r.json
json r.json 'j["compared_pixels"]==8 and j["different_pixels"]==1 and j["first"]["y"]==4'
for bad in 9x1+0+0 1x1+8+0 0x1+0+0 1x1 1x1+0 axb+0+0 1x1+0+0+0 1x1+0+99999999999; do
  trouble "$bad" "$kage" diff a.png b.png --region $bad
done
trouble black.png "$kage" diff a.png b.png --mask black.png
trouble "the mask is 6x8" "$kage" diff a.png b.png --mask c.png
trouble "nothing is compared" "$kage" diff a.png b.png --mask mask.png --region 8x1+0+5

# Thresholds of the other sort of values.
for t in --abs --ulp; do trouble "take lsb" "$kage" diff a.png b.png $t 1; done
oiiotool a.png -d float -o a.exr && oiiotool a.png --addc 0.25 -d float -o b.exr || fail "no EXR"
trouble "threshold lsb is for integers" "$kage" diff a.exr b.exr --lsb 0
trouble --abs "$kage" diff a.exr b.exr --abs 1 --ulp 1
for bad in -1 nan inf 1e999 0x1p3 x; do trouble "$bad" "$kage" diff a.exr b.exr --abs $bad; done
expect 1 "$kage" diff a.exr b.exr --abs 0.24 --json r.json
json r.json 'j["max_lsb"] is None and 0.2499 < j["max_abs"] < 0.2501 and j["max_ulp"] > 1000 and j["different_pixels"]==48'
json r.json 'j["psnr"] is None and j["perceptual"] is None' # some are beyond 1: there is no largest value
expect 1 "$kage" diff a.exr b.exr --region 2x1+0+0 --json r.json
json r.json '12.03 < j["psnr"] < 12.05'
python3 - <<'PY'
import struct
for name, value in (("plus", 0.0), ("minus", -0.0), ("large", 3e38), ("infinity", float("inf"))):
    open(name + ".pfm", "wb").write(b"Pf\n2 1\n-1\n" + struct.pack("<ff", value, 0.5))
PY
expect 1 "$kage" diff plus.pfm minus.pfm
grep -q ', 1 differs, only in the sign of 0, the first' stdout || fail "the sign is not named: $(cat stdout)"
expect 1 "$kage" diff plus.pfm large.pfm --json r.json
json r.json 'j["psnr"] is None and 2.9e38 < j["max_abs"] < 3.1e38'
expect 1 "$kage" diff plus.pfm infinity.pfm --json r.json
json r.json 'j["psnr"] is None and j["max_abs"]=="infinite"'
expect 0 "$kage" diff a.exr b.exr --abs 0.2501 --perceptual --json r.json
json r.json 'j["same"] is True and j["different_pixels"]==0 and j["reason"] is None and j["perceptual"] is not None'
expect 1 "$kage" diff nan.pfm nan.pfm --abs 1 --max-percent 100 --json r.json
json r.json 'j["same"] is False and j["nan_pixels"]==1 and j["max_abs"]==0'
grep -q '1 holds a NaN' stdout || fail "the line does not name the NaN: $(cat stdout)"

# Types, colour space and depth are compared whatever the thresholds.
for other in a.exr grey8.png gamma.png; do
  expect 1 "$kage" diff a.png $other --max-percent 100
  grep -q unlike stdout || fail "$other: not unlike: $(cat stdout)"
done
expect 1 "$kage" diff grey16.png grey8.png
expect 1 "$kage" diff grey4.png grey8.png
grep -q 'number of bits is unlike: 4 and 8' stdout || fail "4 bits are taken for 8: $(cat stdout)"
for tag in cICP sRGB gAMA sBIT mDCV cLLI cHRM; do
  expect 0 "$kage" diff one_$tag.png one_$tag.png
  for other in other_$tag.png a.png; do
    expect 1 "$kage" diff one_$tag.png $other --max-percent 100
    grep -q unlike stdout || fail "$tag of $other: not unlike: $(cat stdout)"
  done
done

# Values as they are stored: OpenImageIO would make the same black of these inks, and the same white of 0 and 255.
expect 0 "$kage" diff inks.tif inks.tif
expect 1 "$kage" diff black.tif inks.tif --json r.json
json r.json 'j["channels"]==4 and j["different_pixels"]==64 and j["max_lsb"]==255'
expect 1 "$kage" diff white0.tif black0.tif
grep -q 'photometric interpretation is unlike: white is 0 and black is 0' stdout || fail "not unlike: $(cat stdout)"
trouble "lab.tif: has the photometric interpretation 8" "$kage" diff lab.tif lab.tif
trouble "inks.jpg: is CMYK" "$kage" diff inks.jpg inks.jpg
oiiotool a.exr -otex mip.exr || fail "no mipmap"
trouble "mip.exr: holds several sizes" "$kage" diff mip.exr mip.exr

# A file of several pictures is compared part by part.
oiiotool a.exr b.exr --siappend -o parts.exr || fail "no multi-part EXR"
trouble "parts.exr: holds 2 pictures: choose one by its number, 0 to 1" "$kage" diff parts.exr parts.exr
expect 0 "$kage" diff parts.exr parts.exr --part 1
oiiotool a.exr a.exr --siappend -o twice.exr || fail "no multi-part EXR"
expect 0 "$kage" diff parts.exr twice.exr --part 0
expect 1 "$kage" diff parts.exr twice.exr --part 1
trouble "parts.exr: holds 2 pictures, and there is no number 2" "$kage" diff parts.exr parts.exr --part 2
expect 0 "$kage" diff a.png a.png --part 0
trouble "a.png: holds 1 picture, and there is no number 1" "$kage" diff a.png a.png --part 1

# How people see it, beside the verdict and never part of it.
expect 1 "$kage" diff a.png b.png --perceptual --json p.json
json p.json '0 < j["flip"]["mean"] < j["flip"]["max"] < 1 and j["perceptual"] is not None'
expect 0 "$kage" diff a.png a.png --perceptual --json p.json
json p.json 'j["flip"] == {"mean": 0, "max": 0}'

# Files written: all of them or none.
expect 1 "$kage" diff a.png b.png --out h.png --blink f.png --junit j.xml --json j.json
for f in h.png f.png j.xml j.json; do [ -s $f ] || fail "no $f"; done
trouble animated "$kage" diff f.png f.png
python3 - <<'PY' || fail "blink picture or JUnit are not as they should be"
import struct, xml.etree.ElementTree as et, zlib
data, at, chunks = open("f.png", "rb").read(), 8, []
while at < len(data):
    size, tag = struct.unpack_from(">I4s", data, at)
    content = data[at + 8:at + 8 + size]
    assert struct.unpack_from(">I", data, at + 8 + size)[0] == zlib.crc32(tag + content)
    chunks.append((tag, content))
    at += size + 12
assert [t for t, _ in chunks] == [b"IHDR", b"acTL", b"fcTL", b"IDAT", b"fcTL", b"fdAT", b"IEND"]
for tag, content in chunks:
    if tag in (b"IDAT", b"fdAT"):
        raw = zlib.decompress(content[4 if tag == b"fdAT" else 0:])
        assert len(raw) == 6 * (8 * 3 + 1)
        line = raw[2 * 25 + 1:3 * 25]  # differences to the pixel on the left
        green = sum(line[1:3 * 3 + 2:3]) % 256
        assert green == ((2 * 8 + 3) * 3 + 1) * 5 % 250 + (4 if tag == b"fdAT" else 0)
suite = et.parse("j.xml").getroot()[0]
assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("1", "1", "0")
assert suite[0].get("name") == "a.png b.png" and "2 differ" in suite[0][0].get("message") and "regions: " in suite[0][0].text
PY
expect 0 "$kage" diff a.png a.png --junit j.xml
junit() { python3 -c "import xml.etree.ElementTree as et; s=et.parse('j.xml').getroot()[0]; assert $1" || fail "JUnit: not so: $1"; }
junit 's.get("failures")=="0" and len(s)==1 and len(s[0])==0'
odd='a<&"'$'\x01\xff''.png'
cp a.png "$odd"
expect 1 "$kage" diff "$odd" b.png --junit j.xml
junit 's[0].get("name")=="a<&\"\ufffd\ufffd.png b.png"'
expect 1 "$kage" diff a.png c.png --out none.png --flip flip.png  # the option's old name
[ ! -e none.png ] && [ -s flip.png ] || fail "unlike pictures: a heat map, or no blink picture"

cp a.png keep.png
trouble missing.png "$kage" diff a.png missing.png
trouble missing.png "$kage" diff missing.png a.png
trouble cut.png "$kage" diff a.png cut.png
trouble empty.png "$kage" diff a.png empty.png
trouble "is a directory" "$kage" diff a.png .
trouble missing.png "$kage" diff a.png b.png --mask missing.png
trouble nowhere "$kage" diff a.png b.png --out nowhere/heat.png
trouble nowhere "$kage" diff a.png b.png --blink nowhere/f.png
trouble nowhere "$kage" diff a.png b.png --junit nowhere/j.xml
trouble nowhere/r.json "$kage" diff a.png b.png --json nowhere/r.json --lsb 9
for option in --out --blink --junit --json; do trouble a.png "$kage" diff a.png b.png $option ./a.png; done
trouble mask.png "$kage" diff a.png b.png --mask mask.png --out mask.png
trouble "two outputs have this name" "$kage" diff a.png b.png --out x.png --blink ./x.png
cmp a.png keep.png || fail "an input was written over"
rm -f h.png j.xml
trouble cut.png "$kage" diff a.png cut.png --out h.png --junit j.xml
[ ! -e h.png ] && [ ! -e j.xml ] || fail "trouble left files"
trouble -1 "$kage" diff a.png b.png --lsb -1
trouble -1 "$kage" diff a.png b.png --max-pixels -1
trouble 99999999999999999999 "$kage" diff a.png b.png --lsb 99999999999999999999
trouble nan "$kage" diff a.png b.png --max-percent nan
for option in --prune --dry-run; do trouble $option "$kage" diff a.png b.png $option; done
trouble "no folder" "$kage" diff --bless a.png b.png
mkfifo pipe.png
# A pipe gets the picture, which a file would get; what reads it has it whole.
cat pipe.png >piped.png &
expect 1 timeout 60 "$kage" diff a.png b.png --out pipe.png
wait $!
"$kage" diff a.png b.png --out beside.png >/dev/null
cmp piped.png beside.png || fail "a pipe got another picture than a file"
[ -p pipe.png ] || fail "a pipe was replaced by a file"
expect 1 "$kage" diff a.png b.png --json /dev/null --junit /dev/null --blink flip.png
[ -c /dev/null ] || fail "/dev/null was replaced"
# A device that takes nothing is a full disk without a disk.
trouble "/dev/full: cannot be written: No space left on device" "$kage" diff a.png b.png --json /dev/full --blink none.png
[ ! -e none.png ] || fail "a file appeared though a device took nothing"
for bad in pipe.png /dev/zero /dev/null; do
  trouble "$bad: is not a regular file" timeout 20 "$kage" diff $bad a.png
  trouble "$bad: is not a regular file" timeout 20 "$kage" diff a.png $bad
  trouble "$bad: is not a regular file" timeout 20 "$kage" diff a.png b.png --mask $bad
done
no_leftovers

# High pictures: a PNG takes memory for some lines, whatever its height, and what takes more than there may be is refused before it
# is read. Two of these as a whole take 1 GiB.
python3 - <<'PY'
import struct, zlib
def png(name, width, height, interlaced, last):
    chunk = lambda tag, data: struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))
    line, packer = bytes(1 + width // 8), zlib.compressobj(1)
    data = b"".join([packer.compress(line * 255) for _ in range(height // 255)]) + packer.compress(last) + packer.flush()
    head = struct.pack(">IIBBBBB", width, height // 255 * 255 + 1, 1, 0, 0, 0, interlaced)
    open(name, "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b""))
last = bytes(1 + 1024)
png("high.png", 8192, 65535, 0, last)
png("high2.png", 8192, 65535, 0, last)
png("other.png", 8192, 65535, 0, last[:-1] + b"\1")
png("parts.png", 8192, 65535, 1, last)
PY
within() { (ulimit -v 900000 && exec "$@"); }
expect 0 within "$kage" diff high.png high2.png
grep -qF 'same: 8192x65536, 536870912 pixels compared' stdout || fail "$(cat stdout)"
expect 1 within "$kage" diff high.png other.png
grep -qF '1 differs, by up to 255 LSB, the first at x 8191, y 65535, channel 0' stdout || fail "$(cat stdout)"
trouble 'parts.png: to compare them takes 1026 MiB' within "$kage" diff parts.png parts.png
trouble 'are half of what there is (kage diff --max-memory MIB sets another limit)' within "$kage" diff high.png high2.png --out high_heat.png
trouble 'high2.png: to compare them takes 2 MiB of memory, and 1 MiB are what --max-memory allows' "$kage" diff high.png high2.png --max-memory 1
[ ! -e high_heat.png ] || fail "a heat map of pictures that were refused"
done_testing
