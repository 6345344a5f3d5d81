#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage stream, info and render: the way through a file draws what the direct way draws, and bad streams are refused.
. "$(dirname "$0")/common.bash"

small=(--size 96x64 --frames 2)
expect 0 "$kage" stream courtyard "${small[@]}" --out c.kage
expect 0 "$kage" info c.kage --json info.json
json info.json 'j["frames"]==2 and j["lines"]==128 and j["checksum_ok"] is True and j["tokens"]["EOL"]==128 and j["tokens"]["END"]==2'
json info.json 'j["config"]["Z_BITS"]>=4 and j["bytes"]>0 and j["version"]==1'
# Token by token: as many lines as --json counts tokens, each with its index, from header to END.
expect 0 "$kage" info c.kage --json - && cp stdout counts.json
expect 0 "$kage" info c.kage --tokens 0 && cp stdout first
expect 0 "$kage" info c.kage --tokens 1
cat first stdout | grep -c '^ *[1-9][0-9]*  [A-Z]' >lines
json counts.json "sum(j['tokens'].values())==$(cat lines)"
grep -q '^       0  header: 96x64, ' stdout && [ "$(tail -n 2 stdout | tr -s ' ' | cut -d ' ' -f 3- | paste -sd,)" = "EOL 63,END" ] || fail "--tokens prints no frame: $(tail -n 2 stdout)"
trouble "the stream has frames 0 to 1" "$kage" info c.kage --tokens 2
expect 0 "$kage" render courtyard "${small[@]}" --out direct --json -
cp stdout r.json
json r.json 'j["frames"]==2 and j["width"]==96 and j["height"]==64 and len(j["files"])==2'
expect 0 "$kage" render c.kage --out through
for frame in 0000 0001; do
  expect 0 "$kage" diff direct/courtyard_$frame.png through/c_$frame.png
done
expect 1 "$kage" diff direct/courtyard_0000.png direct/courtyard_0001.png

# Threads do not change a byte.
expect 0 "$kage" stream courtyard "${small[@]}" --threads 1 --out one.kage
cmp -s c.kage one.kage || fail "one thread writes another stream"

# EXR, another configuration.
expect 0 "$kage" render courtyard --size 48x32 --frames 1 --config full --exr --out exr
[ -s exr/courtyard_0000.exr ] || fail "no EXR"

# Features that a configuration lacks are named; --degrade draws without them.
trouble "lacks" "$kage" render courtyard --size 48x32 --frames 1 --config tiny --out lacking
[ ! -e lacking ] || fail "a refused render leaves a folder"
expect 0 "$kage" render courtyard --size 48x32 --frames 1 --config tiny --degrade --out degraded --json d.json
json d.json 'len(j["degraded"])>0'
trouble "MAX_WIDTH" "$kage" render courtyard --size 300x32 --frames 1 --config tiny --degrade --out lacking

# As wide as a picture may be: widest draws it.
for size in 3841x4 32766x1; do
  expect 0 "$kage" render courtyard --size $size --frames 1 --out wide --json w.json
  json w.json "'%dx%d' % (j['width'], j['height']) == '$size' and j['config']['MAX_WIDTH'] == 32767"
done
grep -qx 'courtyard: configuration: widest' stdout || fail "another configuration draws the widest picture: $(cat stdout)"

# Wider than all of a list: the message shows the file to write, and that file does.
list_without_widest narrower
for size in 3841x4 32766x1; do
  KAGE_DATA_DIR=$PWD/narrower trouble "--config FILE can, with this line in it: {" "$kage" render courtyard --size $size --frames 1 --out lacking
  sed 's/.*in it: //' stderr >wide.yaml
  expect 0 "$kage" render courtyard --size $size --frames 1 --config wide.yaml --out wide --json w.json
  json w.json "'%dx%d' % (j['width'], j['height']) == '$size' and j['config']['DSF_BITS'] == 1"
done
KAGE_DATA_DIR=$PWD/narrower trouble "{X_BITS: 13, Z_FRAC: 12, LANES: 8, MAX_WIDTH: 4096}" "$kage" render courtyard --size 4096x4 --out lacking

# Pictures in which nothing is to be seen are said to be so.
printf 'v 0 0 0\nv 1 2 3\nv 2 4 6\nf 1 2 3\n' >flat.obj
trouble "flat.obj: no faces: no triangle has an area" "$kage" render flat.obj --out lacking
printf 'v 0 0 0\nv 1e-6 0 0\nv 0 1e-6 0\nv 1 1 1\nv 1 1.000001 1\nv 1 1 1.000001\nf 1 2 3\nf 4 5 6\n' >specks.obj
expect 0 "$kage" render specks.obj --size 32x24 --frames 2 --out specks --json f.json
grep -q '^specks: nothing is to be seen: no face covers the centre of a pixel$' stdout || fail "an empty picture without a word: $(cat stdout)"
json f.json 'any("nothing is to be seen" in n for n in j["notes"])'
expect 0 "$kage" stream specks.obj --size 32x24 --frames 2 --out specks.kage
expect 0 "$kage" render specks.kage --out specks
grep -q '^specks: nothing is to be seen' stdout || fail "an empty stream without a word"
# Far from the file's origin a triangle is seen, with a word about the file's numbers.
printf 'v 1e17 0 0\nv 1e17 1 0\nv 1e17 0 1\nf 1 2 3\n' >far.obj
expect 0 "$kage" render far.obj --size 32x24 --frames 2 --out far --json f.json
grep -q '^far: the scene is so far from the origin' stdout || fail "no word about rounded numbers: $(cat stdout)"
json f.json 'not any("nothing is to be seen" in n for n in j["notes"])'
expect 0 "$kage" render courtyard --size 32x24 --frames 1 --out seen
! grep -q 'nothing is to be seen' stdout || fail "the courtyard is not seen"

# A stream file may be what a stream file is made of: its first frames, checked.
expect 0 "$kage" stream c.kage --out again.kage
cmp -s c.kage again.kage || fail "a copy of a stream differs"
grep -qx 'c: copied from a stream file' stdout || fail "a copy is not called so: $(cat stdout)"
expect 0 "$kage" stream c.kage --frames 1 --out first.kage
expect 0 "$kage" info first.kage --json first.json
json first.json 'j["frames"]==1 and j["lines"]==64'
trouble "SMOOTH is 1, the stream's is 0" "$kage" stream c.kage --config full --out other.kage

# Bad streams: one line that names the file, exit 2. Any byte cut or changed.
bytes=$(stat -c %s c.kage)
for cut in 0 1 7 40 $((bytes / 2)) $((bytes - 1)); do
  head -c "$cut" c.kage >cut.kage
  trouble cut.kage "$kage" info cut.kage
done
for at in 0 5 9 33 60 $((bytes / 3)) $((bytes - 2)); do
  python3 -c "import sys; d=bytearray(open('c.kage','rb').read()); d[int(sys.argv[1])]^=0x10; open('bad.kage','wb').write(d)" "$at"
  trouble bad.kage "$kage" info bad.kage
done
trouble missing.kage "$kage" info missing.kage
trouble "--frames" "$kage" render c.kage --frames 3
trouble "--size" "$kage" render c.kage --size 10x10
trouble "X_BITS" "$kage" render c.kage --config tiny
trouble nowhere "$kage" stream courtyard "${small[@]}" --out nowhere/c.kage
trouble nowhere.obj "$kage" render nowhere.obj
scenes=$("$kage" list scenes | paste -sd, | sed 's/,/, /g')
trouble "courtyrad: no such file, and no built-in scene of that name (did you mean courtyard?) (there are $scenes)" "$kage" render courtyrad
printf 'v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n' >nan.obj
trouble nan.obj "$kage" render nan.obj --frames 1
: >empty.obj
trouble empty.obj "$kage" render empty.obj --frames 1

# A bad frame after good ones: no picture of the good ones stays, pictures of an earlier run do, and so do other files.
python3 -c "d=bytearray(open('c.kage','rb').read()); d[-100]^=1; open('late.kage','wb').write(d)"
trouble "checksum" "$kage" render late.kage --out made/here
[ ! -e made ] || fail "a failed render leaves $(find made)"
mkdir kept && echo earlier >kept/late_0000.png && echo other >kept/notes.txt
trouble late.kage "$kage" render late.kage --out kept --json kept/r.json
trouble late.kage "$kage" cosim late.kage --out kept --json kept/r.json
[ "$(cat kept/late_0000.png kept/notes.txt)" = "$(printf 'earlier\nother')" ] || fail "a failed render changes what was there"
[ "$(find kept -type f | wc -l)" = 2 ] || fail "a failed render leaves files: $(find kept)"

# An output that cannot be written is found before the work: nothing is read, so even a missing scene is not reached.
mkdir folder
ln -s nowhere/x dangling
for command in render cosim; do
  trouble "folder: exists and is not a file" "$kage" $command nowhere.obj --json folder --out unmade
  trouble "no/r.json: cannot be written: no such folder" "$kage" $command nowhere.obj --json no/r.json --out unmade
  trouble "c.kage/x: the folder cannot be made" "$kage" $command nowhere.obj --out c.kage/x
  for out in dangling dangling/x; do trouble "kage: dangling: a link to nowhere" "$kage" $command nowhere.obj --out $out; done
  [ ! -e unmade ] || fail "a run that cannot write leaves its folder"
done
trouble "folder: exists and is not a file" "$kage" info nowhere.kage --json folder
trouble "folder: exists and is not a file" "$kage" model nowhere.yaml --json folder
trouble "folder: exists and is not a file" "$kage" diff a.png b.png --json folder
if [ "$(id -u)" != 0 ]; then
  chmod 500 folder
  trouble "folder/r.json: cannot be written: Permission denied" "$kage" render nowhere.obj --json folder/r.json --out unmade
  trouble "folder: cannot be written to: Permission denied" "$kage" render nowhere.obj --out folder
fi
# JSON into the folder that the run makes; one of a thing is called so.
expect 0 "$kage" render c.kage --frames 1 --out made/here --json made/here/r.json
grep -q '^1 frame, ' stdout || fail "one frame: $(cat stdout)"
[ -s made/here/r.json ] && [ -s made/here/c_0000.png ] || fail "no picture or JSON in a folder just made"

# A file that is cut while it is read: an error like any other, not a signal. First more than was read yet is cut, then
# all of it.
expect 0 "$kage" stream courtyard --size 320x240 --frames 80 --out whole.kage
for size in $(($(stat -c %s whole.kage) / 2)) 0; do
  for command in render cosim; do
    cp whole.kage cut.kage
    "$kage" $command cut.kage --out cutting >stdout 2>stderr </dev/null &
    pid=$!
    for _ in $(seq 1000); do [ -n "$(find cutting -path '*/.kage-*' -type f -size +0 2>/dev/null)" ] && break || sleep 0.01; done
    truncate -s "$size" cut.kage
    rc=0
    wait $pid || rc=$?
    [ $rc = 2 ] || fail "$command of a file cut to $size: exit $rc"
    [ "$(cat stderr)" = "kage: cut.kage: became shorter, or could not be read, while it was open" ] ||
      fail "$command of a file cut to $size: $(cat stderr)"
    [ ! -s stdout ] && [ ! -e cutting ] || fail "$command of a file cut to $size leaves $(find cutting) and says $(cat stdout)"
  done
done

# Interruption leaves no file behind.
"$kage" stream courtyard --size 1280x960 --frames 200 --out long.kage >/dev/null 2>err &
pid=$!
# A shell's background job ignores SIGINT until the program says otherwise, which it has when its file is there.
for ((i = 0; i < 600; ++i)); do [ -z "$(find . -name '.kage-*')" ] || break; sleep 0.1; done
kill -INT $pid
rc=0
wait $pid || rc=$?
[ $rc = 130 ] || fail "interrupted: exit $rc"
[ "$(grep -c . err)" -le 3 ] && grep -q interrupted err || fail "interrupted: no line says so"
[ ! -e long.kage ] || fail "interrupted: a file is left"
no_leftovers
done_testing
