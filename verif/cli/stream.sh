#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage stream, info and render: the way through a file draws what the direct way draws, and bad streams are refused.
. "$(dirname "$0")/common.bash"

small=(--size 96x64 --frames 2)
expect 0 "$kage" stream courtyard "${small[@]}" --out c.kage
expect 0 "$kage" info c.kage --json info.json
json info.json 'j["frames"]==2 and j["lines"]==128 and j["checksum_ok"] is True and j["tokens"]["EOL"]==128 and j["tokens"]["END"]==2'
json info.json 'j["config"]["Z_BITS"]>=4 and j["bytes"]>0 and j["version"]==1'
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

# What a configuration lacks is named; --degrade draws without it.
trouble "lacks" "$kage" render courtyard --size 48x32 --frames 1 --config tiny --out lacking
[ ! -e lacking ] || fail "a refused render leaves a folder"
expect 0 "$kage" render courtyard --size 48x32 --frames 1 --config tiny --degrade --out degraded --json d.json
json d.json 'len(j["degraded"])>0'
trouble "MAX_WIDTH" "$kage" render courtyard --size 300x32 --frames 1 --config tiny --degrade --out lacking

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
printf 'v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n' >nan.obj
trouble nan.obj "$kage" render nan.obj --frames 1
: >empty.obj
trouble empty.obj "$kage" render empty.obj --frames 1

# Interruption leaves no file behind.
"$kage" stream courtyard --size 1280x960 --frames 200 --out long.kage >/dev/null 2>err &
pid=$!
sleep 1
kill -INT $pid
rc=0
wait $pid || rc=$?
[ $rc = 130 ] || fail "interrupted: exit $rc"
[ "$(grep -c . err)" -le 3 ] && grep -q interrupted err || fail "interrupted: no line says so"
[ -z "$(find . -name '*long*')" ] || fail "interrupted: a file is left: $(find . -name '*long*')"
done_testing
