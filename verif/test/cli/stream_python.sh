#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Streams in Python (python/kage/stream.py): read, told and written as the program does, in named configurations that
# between them have all kinds of tokens.
. "$(dirname "$0")/common.bash"

files=()
stream() { # CONFIG SCENE OPTIONS...
  expect 0 "$kage" stream "$2" --config "$1" --frames 2 --out "$1.kage" "${@:3}"
  files+=("$1.kage")
}
stream tiny courtyard --size 48x32 --degrade
stream default inside --size 64x48
stream full knot --size 64x48
stream polyhedra polyhedra --size 64x48
stream soft penumbra --size 32x24
stream lights three-lights --size 48x32
stream counting courtyard --size 48x32
stream glasslights glass --size 48x32
KAGE_GOLDEN=$(dirname "$kage")/../lib/libkage_golden.so
export KAGE_GOLDEN
expect 0 python3 "$source/verif/test/cli/polygons.py" "$source"
files+=(polygons.kage)
expect 0 "$kage" stream knot --config full --level polygons --size 48x32 --frames 2 --out smooth.kage
files+=(smooth.kage)
expect 0 python3 "$source/verif/test/cli/stream_python.py" "$kage" "$source" "${files[@]}"
grep -qx 'AT EDGE END EOL ES EV FACE GRADIENT IF NC OP POLYGON RESOLVE SEG SHADE SP TABLE TP TREE' stdout || fail "kinds: $(cat stdout)"
done_testing
