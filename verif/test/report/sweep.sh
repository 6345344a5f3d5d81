#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The page of kage sweep in headless Chromium: bash sweep.sh KAGE SOURCE CHROMIUM PICTURES. Screenshots are left in PICTURES.
chromium=$3 pictures=$4
. "$2/verif/test/cli/common.bash"
mkdir -p "$pictures"
quick=(--config default --frames 2 --no-area --no-cosim)
expect 0 "$kage" sweep courtyard --size 96x72 "${quick[@]}" --axes Z_BITS=6,7,8,10,12,14 --axes SUB_BITS=4,5,6,7 --axes LANES=1,2,4,16,32 \
  --axes SHADE_FRAC=3,6,12 --axes BEAT_WORDS=1,2 --axes SIZE=64x48 --out made/page --json rows.json
expect 0 "$kage" sweep courtyard --size 32x24 --config default --frames 1 --no-area --no-cosim --no-flip --axes Z_BITS=8,12 \
  --store flipless.sqlite --out flipless
# It is read where it was not made.
mkdir elsewhere && mv made/page elsewhere/page && rmdir made
python3 "$source/verif/test/report/sweep.py" "$kage" "$chromium" "$pictures" || fail "the page"
done_testing
