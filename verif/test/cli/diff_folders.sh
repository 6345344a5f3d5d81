#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage diff of two folders of pictures, and --bless: what is missing is a difference, what is written appears whole or
# not at all, and a reference folder changes only as told.
. "$(dirname "$0")/common.bash"

for way in exact centroid; do
  "$kage" render glass --order $way --size 64x48 --frames 3 --out $way >/dev/null || fail "no pictures"
done
cp -r exact copy
expect 0 "$kage" diff exact copy --json r.json --junit j.xml --out none
grep -q '^same: 3 pictures compared$' stdout || fail "the line does not say same: $(cat stdout)"
json r.json 'j["same"] is True and (j["width"],j["height"],j["channels"])==(64,48,3) and j["different_pixels"]==0 and j["max_lsb"]==0 and j["first"] is None'
json r.json '[f["name"] for f in j["frames"]]==["glass_000%d.png"%i for i in range(3)] and all(f["same"] for f in j["frames"])'
[ ! -e none ] || fail "a folder for pictures that there are not"

cp exact/glass_0000.png centroid
expect 1 "$kage" diff exact centroid --json r.json --junit j.xml --out views
json r.json 'j["same"] is False and j["pictures"]==3 and j["different_pictures"]==2 and j["only_in_a"]==0'
json r.json 'j["different_pixels"]==sum(f["different_pixels"] for f in j["frames"]) and j["max_lsb"]==max(f["max_lsb"] for f in j["frames"])'
json r.json 'j["first"]=={**j["frames"][1]["first"], "frame": "glass_0001.png"}'
[ "$(grep -c '^glass_000[12].png: different: ' stdout)" = 2 ] || fail "not a line for each that differs: $(cat stdout)"
[ "$(echo views/*)" = "$(echo views/glass_000{1,2}.png.{blink,heat}.png)" ] || fail "views: $(echo views/*)"
python3 - <<'PY' || fail "JUnit is not as it should be"
import xml.etree.ElementTree as et
suite = et.parse("j.xml").getroot()[0]
assert (suite.get("tests"), suite.get("failures")) == ("3", "2")
assert [(c.get("name"), len(c)) for c in suite] == [("glass_000%d.png" % i, min(i, 1)) for i in range(3)]
PY
expect 0 "$kage" diff exact centroid --lsb 255
expect 1 "$kage" diff exact centroid --lsb 0
expect 1 "$kage" diff exact centroid --json -
cp stdout s.json
json s.json 'j["different_pictures"]==2'

# Missing on either side, in a subfolder too; every file counts, and what is left out is named.
mkdir copy/more
mv copy/glass_0001.png copy/more
echo text >copy/notes.txt
echo text >copy/.hidden
expect 1 "$kage" diff exact copy --max-percent 100 --json r.json --junit j.xml
json r.json 'j["only_in_a"]==1 and j["only_in_b"]==2 and j["different_pictures"]==2 and j["different_files"]==1 and j["not_compared"]==[".hidden"]'
json r.json 'j["files"]==[{"name":"notes.txt","stream":False,"missing":"A","same":False,"reason":"only in B"}]'
json r.json '[(f["name"], f["missing"]) for f in j["frames"] if not f["same"]]==[("glass_0001.png","B"),("more/glass_0001.png","A")]'
grep -q '^glass_0001.png: different: only in exact$' stdout || fail "the missing picture is not named"
grep -q '^notes.txt: different: only in copy$' stdout || fail "the file that is no picture is not named"
grep -q '^not compared: .hidden$' stdout || fail "the hidden file is not named"
python3 -c 'import xml.etree.ElementTree as et; assert et.parse("j.xml").getroot()[0].get("failures")=="3"' || fail "JUnit passes what is missing"
# Files that are no pictures: streams by their tokens, others by their bytes; --exclude leaves out, and says so.
mkdir f g
for folder in f g; do
  cp exact/glass_0000.png $folder
  "$kage" stream glass --size 64x48 --frames 1 --out $folder/s.kage >/dev/null || fail "no stream"
  head -c 100000 /dev/zero >$folder/wave.fst
done
expect 0 "$kage" diff f g --json r.json
grep -q '^same: 1 picture, 1 stream, 1 other file compared$' stdout || fail "the counts are not there: $(cat stdout)"
printf '\1' | dd of=g/wave.fst bs=1 seek=70000 conv=notrunc status=none
expect 1 "$kage" diff f g --lsb 255
grep -q '^wave.fst: different: byte 70000 differs$' stdout || fail "the byte is not named: $(cat stdout)"
expect 0 "$kage" diff f g --exclude '*.fst' --json r.json
grep -q '^not compared: wave.fst$' stdout || fail "what is excluded is not named: $(cat stdout)"
json r.json 'j["same"] and j["not_compared"]==["wave.fst"] and [f["name"] for f in j["files"]]==["s.kage"]'
head -c 99999 /dev/zero >g/wave.fst
expect 1 "$kage" diff f g
grep -q '^wave.fst: different: B ends at byte 99999$' stdout || fail "the end is not named: $(cat stdout)"
"$kage" stream glass --order centroid --size 64x48 --frames 1 --out g/s.kage >/dev/null || fail "no stream"
expect 1 "$kage" diff f g --exclude '*.fst' --json r.json
grep -q '^s.kage: different: 1 of 1 frames differs, ' stdout || fail "the stream is not compared: $(cat stdout)"
json r.json 'not j["same"] and j["different_pictures"]==0 and j["different_files"]==1 and j["files"][0]["stream"]'
mkfifo g/pipe
trouble "g/pipe: is not a regular file" timeout 20 "$kage" diff g g
rm g/pipe && echo text >g/s.kage
trouble "g/s.kage" "$kage" diff f g
trouble "--exclude" "$kage" diff f/s.kage f/s.kage --exclude x
trouble "--exclude" "$kage" diff f/glass_0000.png f/glass_0000.png --exclude x
trouble "neither folder" "$kage" diff f g --exclude '*'
# --bless takes the same files: afterwards the folders are the same.
"$kage" stream glass --size 64x48 --frames 1 --out f/s.kage >/dev/null && rm g/s.kage && cp f/s.kage g/old.kage
echo text >g/README
expect 1 "$kage" diff --bless --prune f g --json r.json
json r.json 'j["removed"]==["old.kage"] and j["missing"]==["README"] and j["added"]==["s.kage"] and j["changed"]==["wave.fst"]'
[ -e g/README ] && [ ! -e g/old.kage ] || fail "--prune: README is gone, or old.kage is there"
expect 0 "$kage" diff --bless f g --exclude README
mkdir -p nested/sub astray && cp f/glass_0000.png nested/sub && ln -s nowhere/x astray/sub
trouble "astray/sub: a link to nowhere" "$kage" diff --bless nested astray
expect 0 "$kage" diff f g --exclude README
mkdir empty
expect 1 "$kage" diff exact empty
trouble empty "$kage" diff empty empty
trouble missing "$kage" diff exact missing
trouble "is a directory" "$kage" diff exact/glass_0000.png exact
trouble blink "$kage" diff exact centroid --blink f.png
trouble exact/sub "$kage" diff exact centroid --out exact/sub
trouble centroid "$kage" diff exact centroid --out centroid
mkdir broken && cp exact/* broken && head -c 90 exact/glass_0002.png >broken/glass_0002.png
trouble broken/glass_0002.png "$kage" diff centroid broken --out views2 --junit k.xml
[ ! -e views2 ] && [ ! -e k.xml ] || fail "trouble left files"

mkdir pipes && mkfifo pipes/glass_0000.png
trouble "pipes/glass_0000.png: is not a regular file" timeout 20 "$kage" diff exact pipes
trouble "pipes/glass_0000.png: is not a regular file" timeout 20 "$kage" diff --bless pipes exact

# --bless. A dry run changes nothing; NaN changes nothing; what is the same stays untouched.
cp -r exact reference
cp -r centroid fresh
mkdir fresh/new && cp exact/glass_0000.png fresh/new
own=(--exclude README)
cp reference/glass_0000.png reference/old.png
echo text >reference/README
state() { (cd reference && find . -type f -exec sha256sum {} + | sort -k2; find . -type f -printf '%p %T@\n' | sort); }
state >before
expect 1 "$kage" diff --bless --dry-run fresh reference "${own[@]}" --json r.json
json r.json 'j["dry_run"] and not j["same"] and j["unchanged"]==1 and j["changed"]==["glass_0001.png","glass_0002.png"] and j["added"]==["new/glass_0000.png"] and j["missing"]==["old.png"] and j["removed"]==[]'
state >after
cmp before after || fail "a dry run changes something"
printf 'PF\n1 1\n-1\n\0\0\300\177\0\0\0\0\0\0\0\0' >fresh/z.pfm
trouble fresh/z.pfm "$kage" diff --bless fresh reference "${own[@]}"
state >after
cmp before after || fail "a NaN is blessed, or what came before it"
rm fresh/z.pfm
expect 1 "$kage" diff --bless fresh reference "${own[@]}"
grep -q '^changed: glass_0001.png: ' stdout || fail "no word of what changed: $(cat stdout)"
grep -q '^reference: 1 the same, 2 changed, 1 added, 1 missing$' stdout || fail "no summary: $(cat stdout)"
state >after
for name in glass_0000.png old.png README; do
  [ "$(grep -F "./$name" before)" = "$(grep -F "./$name" after)" ] || fail "$name is touched"
done
expect 0 "$kage" diff --bless --prune fresh reference "${own[@]}" --json r.json
json r.json 'j["same"] and j["removed"]==["old.png"] and j["missing"]==[] and j["unchanged"]==4'
[ ! -e reference/old.png ] && [ -e reference/README ] || fail "--prune removes something else"
expect 0 "$kage" diff fresh reference "${own[@]}"
expect 0 "$kage" diff --bless --dry-run fresh reference "${own[@]}"
trouble "is exact" "$kage" diff --bless --lsb 1 fresh reference
trouble missing "$kage" diff --bless fresh missing
[ ! -e missing ] || fail "a mistyped reference is made"
trouble "one folder" "$kage" diff --bless fresh ./fresh
trouble empty "$kage" diff --bless --prune empty reference

# Neither folder in the other, by whatever name; nothing is written through links.
mkdir -p nest/new && cp fresh/glass_0001.png nest/new/a.png && cp fresh/glass_0002.png nest && ln -s nest alias
for pair in "nest/new nest" "nest nest/new" "alias/new nest" "nest/new alias/" "nest nest/./new/../new"; do
  # shellcheck disable=SC2086
  trouble "lies in" "$kage" diff --bless --prune $pair
done
[ "$(find nest -type f | sort | xargs)" = "nest/glass_0002.png nest/new/a.png" ] || fail "nested folders were changed: $(find nest)"
mkdir linked taken && cp fresh/glass_0001.png outside.png && cp outside.png taken/y.png && cp outside.png taken/x.png
cp fresh/glass_0002.png linked/y.png
sha256sum outside.png linked/y.png >before
for target in y.png ../outside.png nowhere.png; do
  ln -sf $target linked/x.png
  trouble linked/x.png "$kage" diff --bless taken linked
  trouble linked/x.png "$kage" diff --bless --prune --dry-run taken linked
  sha256sum -c --quiet before || fail "a picture was written by way of a link"
done
rm linked/x.png taken/x.png && ln -s ../linked/y.png taken/x.png
trouble "leads into" "$kage" diff --bless taken linked
[ -e reference/glass_0000.png ] || fail "an empty folder pruned the reference"
# Standard output fails when all is in place: the reference is as it was, and so are other files.
for json in "--json -" "" "--json s2.json"; do
  rm -rf full && cp -r reference full && cp fresh/glass_0002.png full/glass_0001.png && cp fresh/glass_0001.png full/more.png
  find full -type f -exec sha256sum {} + | sort >before
  # shellcheck disable=SC2016,SC2086
  trouble "standard output" sh -c 'exec "$@" >/dev/full' sh "$kage" diff --bless --prune fresh full $json
  find full -type f -exec sha256sum {} + | sort >after
  cmp before after || fail "the reference has changed although standard output failed ($json)"
done
[ ! -e s2.json ] || fail "trouble left --json's file"
# shellcheck disable=SC2016
trouble "standard output" sh -c 'exec "$@" >/dev/full' sh "$kage" diff exact centroid --out views3 --junit j3.xml
[ ! -e views3 ] && [ ! -e j3.xml ] || fail "trouble left files"
no_leftovers
done_testing
