#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# One thread and three give the same: a tree of an order, the words of frames at both levels, rows of a sweep, frames of a
# co-simulation and of a regression. In a build with the thread sanitizer (tools/test --threads) the same commands are searched
# for data races.
. "$(dirname "$0")/common.bash"

echo '{MAX_WIDTH: 64, LANES: 4}' >small.yaml
own_verdicts

for threads in 1 3; do
  frames=(--size 96x72 --frames 2 --threads "$threads")
  expect 0 "$kage" stream courtyard "${frames[@]}" --out spans$threads.kage
  expect 0 "$kage" stream courtyard "${frames[@]}" --level polygons --out polygons$threads.kage
  expect 0 "$kage" stream glass "${frames[@]}" --out glass$threads.kage
  expect 0 "$kage" order "$source/verif/test/meshes/sixteen_faces.obj" --eyes 2 --repeats 1 --threads $threads --save order$threads.bsp
  expect 0 "$kage" sweep courtyard --size 32x24 --frames 1 --no-area --no-cosim --no-flip --axes Z_BITS=8,12,16,20 --jobs $threads \
    --store $threads.sqlite --json sweep$threads.json
  # The second run takes verdicts that the first has kept.
  expect 0 "$kage" cosim courtyard inside --size 64x48 --frames 6 --config small.yaml --jobs $threads --cache-verdicts --no-report \
    --out cosim --json cosim$threads.json
  expect 0 "$kage" cosim courtyard inside --size 64x48 --frames 6 --config small.yaml --jobs $threads --cache-verdicts --no-report \
    --out cosim --json again$threads.json
  expect 0 "$kage" regress --rounds 1 --config small.yaml --jobs $threads --out regress --json regress$threads.json
done
for file in spans{}.kage polygons{}.kage glass{}.kage order{}.bsp; do
  cmp "${file/\{\}/1}" "${file/\{\}/3}" || fail "$file: threads differ"
done
python3 - <<'PY' || fail "results depend on the number of threads"
import json
def both(stem): return [json.load(open(f"{stem}{n}.json")) for n in (1, 3)]
one, three = ([(r["value"], r["accuracy"], r["speed"]["words_per_frame"]) for r in j] for j in both("sweep"))
assert one == three and len(one) == 5, (one, three)
for stem in "cosim", "again", "regress":
    one, three = ([(r["scene"], r["frames"], r["same"], r["pixels_compared"]) for r in j["scenes"]] for j in both(stem))
    assert one == three and len(one) >= 2 and all(row[2] for row in one), (stem, one, three)
for j in both("again"):
    assert [r["verdicts"]["taken"] for r in j["scenes"]] == [6, 6], j["scenes"]
PY
done_testing
