#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage vectors: a pack is written and verified, a pack that was changed is refused by name, and captures are judged. Packs are
# played by simulators in cli/vectors_played.
. "$(dirname "$0")/common.bash"
. "$source/verif/test/cli/packs.bash"
make p courtyard --size 16x12 --frames 2 --config default
json pack.json 'j["frames"]==20 and j["malformed"]==18 and j["pixels"]>=2*16*12 and 0<j["clocks"]<20*2000'
# A refused header has no clocks; those of other frames are without the clocks that the driver waits for.
json p/manifest.json '(f:=[x for x in j["frames"] if x["height"]==0]) and all(x["clocks"] is None for x in f)'
json p/manifest.json 'all(0<x["clocks"]<2000 for x in j["frames"] if x["height"]>0)'
no_leftovers

# ---- sizes are said before, exactly ----
expect 0 "$kage" vectors courtyard --size 16x12 --frames 2 --config default --sizes --json sizes.json
python3 - <<'PY' || fail "--sizes says other sizes than the files have"
import json, os, sys
sizes = {f["name"]: f["bytes"] for f in json.load(open("sizes.json"))["files"]}
sys.exit(any(os.path.getsize(f"p/{n}") != b for n, b in sizes.items()) or len(sizes) != 7)
PY

# ---- each error, and each register behind it ----
python3 - <<'PY' || fail "not every error has its frame and its registers"
import json, sys
m = json.load(open("p/manifest.json"))
errors = {f["error"] for f in m["frames"]} - {"NONE"}
read = {(r["frame"], r["name"]) for r in m["registers"]}
told = all((i, "ERROR") in read for i, f in enumerate(m["frames"]) if f["error"] != "NONE" and f["registers_are_read"])
told = told and sum(f["registers_are_read"] for f in m["frames"]) == 10
broken = [f for f in m["frames"] if f["error"] != "NONE"]
within = [f["error"] for f in broken if 0 < f["error_line"] < f["height"]]
if not {"KIND", "ORDER", "RANGE", "LINE"} <= set(within) or m["rtl_agrees"] is not True:
    sys.exit("no error within a frame's lines, or the RTL was not asked")
sys.exit(errors != {"HEADER", "SIZE", "PARAMS", "KIND", "ORDER", "RANGE", "LINE", "LAST_EARLY", "LAST_LATE"} or not told)
PY
# The signatures are what zlib says of the pixels.
python3 - <<'PY' || fail "a signature is not the CRC-32 of its line"
import json, zlib
m = json.load(open("p/manifest.json"))
pixels, lines = open("p/pixels.bin", "rb").read(), open("p/signatures.hex").read().split()
at = number = 0
for f in m["frames"]:
    for y in range(f["height"]):
        crc = 0
        for x in range(f["width"]):
            flags = 2 * (x == 0 and y == 0) + (x == f["width"] - 1)
            crc = zlib.crc32(pixels[at : at + 3] + bytes([flags]), crc)
            at += 3
        assert int(lines[number], 16) == crc, (number, crc)
        number += 1
assert at == len(pixels) and number == len(lines)
PY

# ---- other configurations, a stream file, random frames ----
make u polyhedra --size 32x24 --frames 1 --config polyhedra
json pack.json 'j["malformed"]==24'
make r random:mixed --frames 6 --config tiny --seed 5
expect 0 "$kage" stream courtyard --size 16x12 --frames 1 --config default --out s.kage
make s s.kage --no-rtl
json pack.json 'j["clocks"] is None'

# ---- the hardest lines that fit ----
for bytes in 4000 20000; do
  expect 0 pack courtyard --size 64x48 --frames 2 --config default --budget $bytes --out b
  told=$(sed -n "s/^b: .* frames, \([0-9]*\) of $bytes bytes for a board, files of .*/\1/p" stdout)
  [ "$told" = "$(($(stat -c %s b/stimulus.bin) + 4 * $(wc -l <b/signatures.hex)))" ] || fail "--budget $bytes: says $told bytes for a board: $(cat stdout)"
  expect 0 "$kage" vectors --check b
  python3 - $bytes <<'PY' || fail "--budget $bytes: too many bytes, or lines that are not the frame's"
import json, os, sys
m, budget = json.load(open("b/manifest.json")), int(sys.argv[1])
used = os.path.getsize("b/stimulus.bin") + 4 * m["lines"]
scene = [f for f in m["frames"] if f["error"] == "NONE"]
sound = all(len(f["source_lines"]) == f["height"] and f["source_lines"] == sorted(set(f["source_lines"])) for f in scene)
sys.exit(used > budget or used < 0.8 * budget or not sound or not scene or sum(f["error"] != "NONE" for f in m["frames"]) != 18)
PY
done
# A line's pixels are those of the whole frame.
expect 0 pack courtyard --size 64x48 --frames 2 --config default --sound-only --no-rtl --out whole
python3 - <<'PY' || fail "a chosen line has other pixels than in its frame"
import json, sys
m, at = json.load(open("b/manifest.json")), 0
part, whole = open("b/pixels.bin", "rb").read(), open("whole/pixels.bin", "rb").read()
for f in m["frames"]:
    frame = int(f["what"].split()[-1]) if f["error"] == "NONE" else None
    for y in f["source_lines"] or [None] * f["height"]:
        line = part[at : at + 3 * f["width"]]
        at += len(line)
        if y is not None and line != whole[3 * 64 * (48 * frame + y) :][: 3 * 64]:
            sys.exit(f"frame {frame}, line {y}")
PY
# Few bytes reach as much as the whole frame does, as far as lines alone can.
expect 0 pack polyhedra --size 64x48 --frames 1 --config polyhedra --sound-only --budget 30000 --out few
expect 0 "$kage" vectors --check few
trouble '--budget 100: no line of courtyard fits beside malformed frames of' "$kage" vectors courtyard --size 64x48 --config default --budget 100 --out none
trouble "--budget 20: no line of courtyard fits" "$kage" vectors courtyard --size 64x48 --config default --budget 20 --sound-only --out none
trouble 'frames that may break rules have no lines to choose' "$kage" vectors random:damaged --config default --budget 9000 --out none
[ ! -e none ] || fail "a pack that cannot be leaves a folder"

# ---- captures ----
sed '3s/..$/xx/' p/pixels.hex >unknown.hex
expect 1 "$kage" vectors --compare p unknown.hex --json unknown.json
json unknown.json 'j["wrong"]==1 and j["first_difference"]["actual"] is None and j["first_difference"]["x"]==2'
(echo @0; cat p/pixels.hex) >at.hex
expect 0 "$kage" vectors --compare p at.hex
trouble "nowhere.hex: no file" "$kage" vectors --compare p nowhere.hex
trouble "p: no file" "$kage" vectors --compare p p
cp p/pixels.hex capture
trouble "capture: a capture ends with .hex, .bin, .raw, or as a picture does: a name without a dot is none" "$kage" vectors --compare p capture
: >empty.raw
trouble "empty.raw: is empty: no capture" "$kage" vectors --compare p empty.raw
trouble "p/kage_pack.vh: a capture ends with .hex, .bin, .raw, or as a picture does" "$kage" vectors --compare p p/kage_pack.vh
# A capture is not judged by files of a pack that a board's people change.
cp -r p mine && echo >>mine/README.md && echo >>mine/kage_pack_tb.v
expect 0 "$kage" vectors --compare mine p/pixels.hex
expect 0 "$kage" vectors --compare p p/pixels.hex
cp p/pixels.bin good.raw
expect 0 "$kage" vectors --compare p good.raw
sed 's/^.//' p/pixels.hex >plain.hex
expect 0 "$kage" vectors --compare p plain.hex --json same.json
json same.json 'j["same"] and j["first_difference"] is None and j["compared"]>0'
cp p/signatures.hex sums.hex
expect 0 "$kage" vectors --compare p sums.hex
sed '14s/.$/x/; 14y/x0123456789abcdef/0123456789abcdef0/' p/signatures.hex >sums1.hex
expect 1 "$kage" vectors --compare p sums1.hex --json sum.json
json sum.json 'j["signatures"] and j["first_difference"]["frame"]==1 and j["first_difference"]["line"]==1 and j["first_difference"]["x"] is None'
python3 - <<'PY'
b = bytearray(open("p/pixels.bin", "rb").read())
b[3 * (16 * 12 + 16 * 5 + 7) + 1] ^= 4
open("wrong.raw", "wb").write(b)
open("short.raw", "wb").write(b[: 3 * 16 * 3])
open("long.raw", "wb").write(open("p/pixels.bin", "rb").read() + b"abc")
open("torn.raw", "wb").write(b[:100])
PY
expect 1 "$kage" vectors --compare p wrong.raw --json wrong.json
grep -q '^first difference: frame 1 (courtyard, frame 1), line 5, x 7, channel 1: expected ' stdout || fail "the place is not told: $(cat stdout)"
grep -q "^the pixel's history: " stdout || fail "the pixel's history is not told"
json wrong.json 'not j["same"] and j["wrong"]==1 and j["first_difference"]["field"]=="channel 1" and j["first_difference"]["x"]==7'
expect 1 "$kage" vectors --compare p short.raw
grep -q '^incomplete: 48 pixels, all of them the same$' stdout || fail "a capture that is short is not told: $(cat stdout)"
grep -q '^the capture ends before frame 0, line 3, x 0$' stdout || fail "an early end is not told: $(cat stdout)"
expect 1 "$kage" vectors --compare p long.raw
grep -q '^the capture goes on behind the last frame: 1 more$' stdout || fail "a late end is not told: $(cat stdout)"
trouble 'torn.raw: ends within a pixel of 3 bytes' "$kage" vectors --compare p torn.raw
echo 12g456 >bad.hex
trouble "bad.hex:1: '12g456' is no pixel of 6 hexadecimal digits" "$kage" vectors --compare p bad.hex
expect 0 "$kage" render courtyard --size 16x12 --frames 2 --config default --out pictures
expect 0 "$kage" vectors --compare p pictures/courtyard_0001.png --frame 1
expect 1 "$kage" vectors --compare p pictures/courtyard_0001.png --frame 0
trouble 'a picture is one frame, and the pack has several' "$kage" vectors --compare p pictures/courtyard_0001.png
trouble '--frame 99: the pack has frames 0 to 19' "$kage" vectors --compare p good.raw --frame 99

# ---- a pack that is not what was written ----
rm -rf b
broken() { # TEXT COMMAND...: the pack, changed by the command in its folder, is refused
  local text=$1
  shift
  rm -rf b && cp -r p b && (cd b && "$@")
  trouble "$text" "$kage" vectors --check b
}
broken 'b/pixels.hex: is not the file that was written' sed -i '5s/0/1/' pixels.hex
broken 'b/kage_pack_tb.v: the manifest names it, and it is not there' rm kage_pack_tb.v
broken "b/stimulus.bin: has $(($(stat -c %s p/stimulus.bin) + 1)) bytes, the manifest says $(stat -c %s p/stimulus.bin)" bash -c 'echo >>stimulus.bin'
broken 'b/manifest.json: its format is kage.pack/2, this kage reads kage.pack/1' sed -i 's,kage.pack/1,kage.pack/2,' manifest.json
broken 'b/manifest.json: is not there: no pack' rm manifest.json
broken 'not JSON, or cut off' truncate -s 100 manifest.json
broken 'beats is missing' sed -i '0,/      "beats"/s//      "beets"/' manifest.json
broken 'is a file outside the pack' sed -i 's,"name": "README.md","name": "../README.md",' manifest.json
# Files and hashes are as the manifest says, but not what the frames come to.
again() { # FILE SED-EXPRESSION: changed, and its hash with it
  sed -i "$2" "$1" && python3 - "$1" <<'PY'
import hashlib, json, sys
m = json.load(open("manifest.json"))
for f in m["files"]:
    if f["name"] == sys.argv[1]:
        f["sha256"] = hashlib.sha256(open(f["name"], "rb").read()).hexdigest()
json.dump(m, open("manifest.json", "w"))
PY
}
broken "b/signatures.hex: is not what the pack's frames come to" again signatures.hex '2s/./5/'
broken "b/registers.hex: is not what the pack's frames come to" again registers.hex '2s/.$/9/'
broken "b/pixels.hex: is not what the pack's frames come to" again pixels.hex '2s/.$/9/'
broken 'beats is 999999999999, and the frames come to' sed -i '0,/"beats": [0-9]*,/s//"beats": 999999999999,/; 0,/      "beats": [0-9]*,/s//      "beats": 99999999999,/' manifest.json
# said EXPRESSION: the manifest with its content as m changed.
said() { python3 -c "import json; m=json.load(open('manifest.json')); $1; json.dump(m, open('manifest.json', 'w'))"; }
broken 'its frames have' said "m['frames'][0]['beats']+=1000; m['beats']+=1000"
while IFS='|' read -r change text; do broken "b/manifest.json: $text" said "$change"; done <<'CASES'
m['config']['UNITS']=2**32|config: UNITS is 4294967296, not a whole number of 0 ..
m['config']['LANES']=2**32+1|config: LANES is 4294967297, not a whole number of 0 ..
m['config']['LANES']=1.5|config: LANES is 1.5, not a whole number
m['config']['Z_BITS']=16.9|config: Z_BITS is 16.9, not a whole number
m['config']['Z_BITS']=True|config: Z_BITS is true, not a whole number
m['config']['Z_BITS']=99|config: Z_BITS is 99, legal are
m['beats']=-7|beats is -7, not a whole number
m['pixels']='many'|pixels is "many", not a whole number
m['pixels']+=1|pixels is
m['lines']=[]|lines is [], not a whole number
m['lines']=None|lines is null, not a whole number
m['clocks']={}|clocks is {}, not a whole number
m['clocks']=1|clocks is 1, and the frames come to
m['frames'][0]['source_lines']=[-1]|frames[0]: source_lines is -1, not a whole number
CASES
broken 'the golden core ends it with' sed -i '0,/"error": "ORDER"/s//"error": "RANGE"/' manifest.json

# ---- bad requests ----
trouble 'give a SCENE, or --check PACK, or --compare PACK CAPTURE' "$kage" vectors
trouble '--out: needed' "$kage" vectors courtyard
trouble '--cover: the RTL must run' "$kage" vectors random --cover --no-rtl --out none
trouble 'no --budget' "$kage" vectors courtyard --cover --budget 5000 --out none
trouble '--budget: a line at the polygon level' "$kage" vectors courtyard --front-end rtl --budget 5000 --out none
trouble '--check takes no option of writing a pack' "$kage" vectors --check p --front-end rtl

trouble 'give a SCENE, or --check PACK' "$kage" vectors courtyard --check p
trouble '--frame: only a capture is of one frame' "$kage" vectors courtyard --frame 3 --out none
trouble '--check takes no option of writing a pack' "$kage" vectors --check p --out none
trouble '--compare takes no option of writing a pack' "$kage" vectors --compare p good.raw --sizes
mkdir mine2 && echo mine >mine2/README.md
trouble 'mine2: is not empty and no pack' "$kage" vectors courtyard --out mine2
# A run that was killed in a new folder leaves its own one alone there, under a number that no process has: it hinders nobody.
dead=$(sh -c 'echo $$')
for left in whole unmarked; do # it is killed while it writes, or right after its folder was made
  mkdir -p "killed-$left/.kage-$dead"
  [ $left = unmarked ] || { printf '*\n# files that kage has not finished\n' >"killed-$left/.kage-$dead/.gitignore" && echo half >"killed-$left/.kage-$dead/1"; }
  expect 0 "$kage" vectors courtyard --size 8x6 --frames 1 --config tiny --degrade --no-rtl --out "killed-$left"
  [ -z "$(find "killed-$left" -name '.kage-*')" ] || fail "killed-$left: $(find "killed-$left")"
done
# Somebody's own folder of such a name is kept, and so is the folder that has it.
mkdir -p "own/.kage-$dead" && echo own >"own/.kage-$dead/file"
trouble 'own: is not empty and no pack' "$kage" vectors courtyard --size 8x6 --frames 1 --config tiny --degrade --no-rtl --out own
[ "$(cat "own/.kage-$dead/file")" = own ] || fail "somebody's file is gone"
rm -r own
[ "$(cat mine2/README.md)" = mine ] || fail "a file of another's is replaced"
make p courtyard --size 16x12 --frames 1 --config default --no-rtl  # over an older one
json p/manifest.json 'j["rtl_agrees"] is None'
touch file
trouble 'file' "$kage" vectors courtyard --out file
trouble 'nowhere/manifest.json: is not there: no pack' "$kage" vectors --check nowhere
no_leftovers

# ---- names that are not UTF-8 ----
bytes=$'\xff\xfe'
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"a$bytes.obj"
echo 'Z_BITS: 24' >"c$bytes.yaml"
expect 0 "$kage" vectors "a$bytes.obj" --size 8x6 --frames 1 --config "c$bytes.yaml" --no-rtl --out bytes
expect 0 "$kage" vectors --check bytes --json bytes.json
json bytes/manifest.json 'j["config_name"] == "c\ufffd\ufffd.yaml"'

done_testing
