#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage diff of two streams: the first difference is the one that kage info --tokens shows there, thresholds are refused,
# and what is no sound stream is trouble.
. "$(dirname "$0")/common.bash"

for way in exact centroid; do
  "$kage" stream glass --order $way --size 64x48 --frames 3 --out $way.kage >/dev/null || fail "no stream"
done
expect 0 "$kage" diff exact.kage exact.kage --json r.json
grep -q '^same: 3 frames$' stdout || fail "the line does not say same: $(cat stdout)"
json r.json 'j["same"] is True and j["first"] is None and j["different_tokens"]==0 and j["width"] is None and j["max_lsb"] is None'
expect 1 "$kage" diff exact.kage centroid.kage --json r.json --junit j.xml
cp stdout said
json r.json 'j["same"] is False and j["different_frames"]>=1 and j["different_lines"]>=1 and j["different_tokens"]>=j["different_lines"]'
token=$(python3 -c 'import json; f=json.load(open("r.json"))["first"]; print(f["frame"], f["token"])')
read -r frame number <<<"$token"
grep -q "^first difference: frame $frame, line [0-9]*, token $number, field " said || fail "the place is not named: $(cat said)"
for side in A:exact B:centroid; do
  expect 0 "$kage" info ${side#*:}.kage --tokens "$frame"
  shown=$(awk -v n="$number" '$1 == n { $1 = ""; print substr($0, 2) }' stdout)
  grep -qF "  ${side%%:*}: $shown" said || fail "token $number of ${side#*:} is '$shown', not as said: $(cat said)"
done
expect 1 "$kage" diff centroid.kage exact.kage --json s.json
python3 - <<'PY' || fail "not symmetric, or JUnit is not as it should be"
import json, xml.etree.ElementTree as et
r, s = json.load(open("r.json")), json.load(open("s.json"))
for key in ("different_frames", "different_lines", "different_tokens"):
    assert r[key] == s[key]
assert (r["first"]["a"], r["first"]["token"]) == (s["first"]["b"], s["first"]["token"])
suite = et.parse("j.xml").getroot()[0]
assert [c.get("name") for c in suite] == ["frame 0", "frame 1", "frame 2", "configuration", "sections"]
assert sum(len(c) for c in suite) == r["different_frames"] == int(suite.get("failures"))
PY

# A frame less; another configuration; another origin; other kinds of sections.
"$kage" stream glass --size 64x48 --frames 1 --out one.kage >/dev/null
expect 1 "$kage" diff exact.kage one.kage
grep -q '^different: A has 3 frames and B 1, ' stdout || fail "the missing frames are not named: $(cat stdout)"
expect 1 "$kage" diff one.kage centroid.kage
grep -q '^different: A has 1 frame and B 3; 1 of 1 frames that both have differs, ' stdout || fail "the frames are not told apart: $(cat stdout)"
"$kage" stream edges --size 64x48 --frames 1 --config default --out default.kage >/dev/null
"$kage" stream edges --size 64x48 --frames 1 --config wide --out wide.kage >/dev/null
expect 1 "$kage" diff default.kage wide.kage --json r.json --junit w.xml
grep -q 'tests="[0-9]*" failures="1".* skipped="1"' w.xml && grep -A1 'name="frame 0"' w.xml | grep -q '<skipped' ||
  fail "JUnit tells of a frame that was not compared: $(cat w.xml)"
grep -q '^tokens are not compared' stdout || fail "tokens of unlike configurations are compared: $(cat stdout)"
json r.json 'j["different_tokens"] is None and "X_BITS" in [p["parameter"] for p in j["config"]]'
python3 - <<'PY'
import struct, zlib
data = open("default.kage", "rb").read()
done = data.rindex(b"DONE")
def finish(name, tag, payload):
    section = struct.pack("<4sIQ", tag, zlib.crc32(payload), len(payload))
    headers, at = 0, 8
    body = data[:done] + section + payload + bytes(-len(payload) % 8)
    while at < len(body):
        size, = struct.unpack_from("<Q", body, at + 8)
        headers = zlib.crc32(body[at:at + 16], headers)
        at += 16 + (size + 7) // 8 * 8
    end = struct.pack("<QI", 1, headers)
    open(name, "wb").write(body + struct.pack("<4sIQ", b"DONE", zlib.crc32(end), 12) + end + bytes(4))
finish("x.kage", b"XTRA", b"one")
finish("y.kage", b"XTRA", b"two")
finish("z.kage", b"ORIG", b"{}")
PY
for pair in "x y contents XTRA" "x default only XTRA" "z default only ORIG"; do
  read -r a b how tag <<<"$pair"
  expect 1 "$kage" diff $a.kage $b.kage
  grep -q "section $tag differs: $how" stdout || fail "$a and $b: $(cat stdout)"
done
expect 0 "$kage" diff x.kage x.kage

for option in "--lsb 1" "--abs 1" "--ulp 1" "--max-pixels 1" "--max-percent 1" "--region 1x1+0+0" "--mask m.png" --ignore-alpha --perceptual "--out o.png" "--blink o.png" "--part 0" --prune; do
  # shellcheck disable=SC2086
  trouble "${option%% *} is not for" "$kage" diff exact.kage centroid.kage $option
done
python3 -c 'd=bytearray(open("exact.kage","rb").read()); d[d.rindex(b"FRAM")+60]^=1; open("bad.kage","wb").write(d)'
trouble bad.kage "$kage" diff exact.kage bad.kage --junit k.xml
trouble bad.kage "$kage" diff bad.kage one.kage
head -c 4000 exact.kage >cut.kage
trouble cut.kage "$kage" diff exact.kage cut.kage
trouble missing.kage "$kage" diff exact.kage missing.kage
# A stream that is cut while --bless reads it ends in one line, whenever that is. Later and later, until it was caught.
expect 0 "$kage" stream courtyard --size 640x480 --frames 24 --out whole.kage
mkdir -p kept
cp whole.kage kept/s.kage
caught=
for ((i = 0; i < 100 && ${#caught} == 0; ++i)); do
  mkdir -p fresh
  cp whole.kage fresh/s.kage
  "$kage" diff --bless fresh kept >stdout 2>stderr </dev/null &
  pid=$!
  sleep "$(printf '%d.%02d' $((i / 50)) $((i % 50 * 2)))"
  truncate -s 8192 fresh/s.kage
  rc=0
  wait $pid || rc=$?
  [ $rc -le 2 ] || fail "bless of a stream that is cut: exit $rc"
  caught=$(grep -x "kage: fresh/s.kage: became shorter, or could not be read, while it was open" stderr || true)
  # Cut before it was opened it is a bad stream, cut after it was read what is there is taken over.
  [ $rc = 0 ] || cmp -s whole.kage kept/s.kage || fail "bless of a stream that is cut: exit $rc, and the reference is another"
  cp whole.kage kept/s.kage
done
[ -n "$caught" ] || fail "bless of a stream that is cut: never while it was read"
mkfifo pipe.kage
trouble "pipe.kage: is not a regular file" timeout 20 "$kage" diff exact.kage pipe.kage
trouble "pipe.kage: is not a regular file" timeout 20 "$kage" info pipe.kage
trouble "is a stream" "$kage" diff exact.kage "$source/docs/images/penumbra.png"
trouble "no folder" "$kage" diff --bless exact.kage one.kage
[ ! -e k.xml ] || fail "trouble left files"
done_testing
