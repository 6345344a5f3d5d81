#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Stream files with frames that break rules (sections PORT): every command ends on them, reads nothing past them, and says what
# they are.
. "$(dirname "$0")/common.bash"

echo '{MAX_WIDTH: 64, LANES: 4, TRANSLUCENCY: 1}' >small.yaml
expect 0 "$kage" stream edges --size 2x1 --frames 1 --config small.yaml --degrade --out sound.kage

# port NAME CHANGE...: NAME.kage has a frame for each change, which is Python: it changes f, the words of sound.kage's frame.
# The frame is a PORT section, or FRAM where the change sets `sound`.
port() {
  python3 - "$@" <<'PY' || fail "$1.kage cannot be made"
import struct, sys, zlib
data, at, sections = open("sound.kage", "rb").read(), 8, []
while at < len(data):
    tag, _, size = struct.unpack_from("<4sIQ", data, at)
    sections.append((tag, data[at + 16:at + 16 + size]))
    at += 16 + (size + 7) // 8 * 8
words = next(p for t, p in sections if t == b"FRAM")
frames = []
for change in sys.argv[2:]:
    f = list(struct.unpack(f"<{len(words) // 4}I", words))
    scope = {"f": f}
    exec(change, scope)
    frames.append((b"FRAM" if scope.get("sound") else b"PORT", struct.pack(f"<{len(scope['f'])}I", *scope["f"])))
out, headers = data[:8], b""
def add(tag, payload):
    global out, headers
    header = struct.pack("<4sIQ", tag, zlib.crc32(payload), len(payload))
    out, headers = out + header + payload + bytes(-len(payload) % 8), headers + header
add(*sections[0])
for frame in frames: add(*frame)
add(b"DONE", struct.pack("<QI", len(frames), zlib.crc32(headers)))
open(sys.argv[1] + ".kage", "wb").write(out)
PY
}

# says TEXT: a line of standard output.
says() { grep -qxF -- "$1" stdout || fail "not said: '$1', but: $(head -c 600 stdout)"; }

port one 'f = f[:1]'
port short 'f = f[:2]'
port header 'f = f[:5]'
port cut 'f = f[:7]'
port kind 'f = f[:5] + [0, 0x10, 0xABCDEF0F]'
port behind 'f += [0, 1, 2]'
port line 'f = f[:5] + f[-1:]'
port other 'f[0] ^= 1; f[2] ^= 1'
port same 'pass'
port mixed 'sound = True' 'f = f[:6]' 'sound = True'
all=(one short header cut kind behind line other same mixed)

# info: the tokens that are there, what the rest is, and the rest.
while IFS='|' read -r name line; do
  expect 0 timeout 10 "$kage" info $name.kage --tokens 0
  says "$line"
done <<'CASES'
one|frame 0, unchecked (PORT):
one|       0  header of 5 words, cut after 1: 0x4b470001
short|       0  header of 5 words, cut after 2: 0x4b470001 0x00010002
cut|       2  OP of 4 words, cut after 1; the words from here on:
kind|       1  kind 0, which is no token here; the words from here on:
kind|          0x00000000 0x00000010 0xabcdef0f
behind|          0x00000000 0x00000001 0x00000002
line|       1  END
CASES
expect 0 timeout 10 "$kage" info header.kage --tokens 0
[ "$(tail -n 1 stdout | awk '{print $1, $2}')" = "0 header:" ] || fail "something behind the header: $(tail -n 2 stdout)"
expect 0 "$kage" info other.kage --tokens 0
grep -qE '^ *0  header: 2x1, .*, magic_version 0x4b470000 and not 0x4b470001, param_hash 0x' stdout || fail "a header of another core: $(cat stdout)"
expect 0 "$kage" info mixed.kage --json i.json
grep -q '^mixed.kage: 3 frames (1 in sections PORT: these may break rules, and are not checked), ' stdout || fail "unchecked frames are not told: $(cat stdout)"
json i.json 'j["frames"] == 3 and j["unchecked_frames"] == 1'
expect 0 "$kage" info sound.kage --json i.json
json i.json 'j["unchecked_frames"] == 0'
grep -q 'PORT\|unchecked' stdout && fail "a sound stream has unchecked frames: $(cat stdout)"

# diff: every pair, in bounded time and memory; and a copy is the same.
for a in "${all[@]}" sound; do
  for b in "${all[@]}" sound; do
    expect "$([ $a = $b ] && echo 0 || echo 1)" timeout 20 "$kage" diff $a.kage $b.kage --json d.json --junit d.xml
  done
  expect 0 "$kage" stream $a.kage --out copy.kage
  expect 0 "$kage" diff $a.kage copy.kage
  expect 0 "$kage" info copy.kage
done
expect 1 "$kage" diff same.kage sound.kage
says "first difference: frame 0, token 0, field section"
says "  A: PORT: a frame that is not checked"
expect 1 "$kage" diff short.kage one.kage
says "first difference: frame 0, token 0, field header"
expect 1 "$kage" diff behind.kage same.kage
says "  A: 3 words that are no token: 0x00000000 0x00000001 0x00000002"
says "  B: nothing"

# A port brings a beat at least.
port empty 'f = []'
for command in info cosim render "explain --pixel 0,0" "diff sound.kage"; do
  # shellcheck disable=SC2086
  trouble "empty.kage: byte " "$kage" $command empty.kage
done

# A note that there are no faces is for sound frames.
for name in one short cut kind; do
  expect 0 "$kage" cosim $name.kage --out out
  grep -q "nothing is to be seen" stdout && fail "$name.kage: a note of faces: $(cat stdout)"
done
# The same of a sound frame of several lines: what is said above is of its frames, not of the core.
expect 0 "$kage" cosim edges --size 16x12 --frames 1 --config small.yaml --degrade --out out
port bare 'sound = True; f = f[:5] + [14, 15]'
expect 0 "$kage" cosim bare.kage --out out
grep -q "nothing is to be seen" stdout || fail "bare.kage: no note of faces: $(cat stdout)"
expect 2 "$kage" render cut.kage --out out

no_leftovers
done_testing
