#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage render draws scenes without words, and with --through-words by words and the golden core: the same pictures.
. "$(dirname "$0")/common.bash"

same() { # OPTION...: both ways
  rm -rf direct words
  expect 0 "$kage" render "$@" --size 97x60 --out direct --json direct.json
  expect 0 "$kage" render "$@" --size 97x60 --out words --json words.json --through-words
  json direct.json 'j["through_words"] is False and j["spans"] is None and j["span_pixels"] is None'
  json words.json 'j["through_words"] is True and j["spans"] > 0 and j["span_pixels"] > 0'
  expect 0 "$kage" diff direct words
}

for scene in courtyard knot inside edges polyhedra fifteen glass penumbra three-lights canopy cutaway depths; do
  same "$scene" --frames 2
done
# Cores of every kind, with what a scene has that they lack left out.
for config in default tiny counting smoothmeshes lights linear glass glasslights full; do
  same glass --frames 1 --config "$config" --degrade
  same three-lights --frames 1 --config "$config" --degrade --threads 1
done

# A core with units, and a stream, are drawn by words.
expect 0 "$kage" render polyhedra --config polyhedra --frames 1 --size 97x60 --out units --json units.json
json units.json 'j["through_words"] is True'
expect 0 "$kage" stream courtyard --frames 1 --size 97x60 --out courtyard.kage
expect 0 "$kage" render courtyard.kage --out stream --json stream.json
json stream.json 'j["through_words"] is True'
expect 0 "$kage" render courtyard --frames 1 --size 97x60 --out scene
expect 0 "$kage" diff scene stream

# A frame is refused alike either way.
for way in "" --through-words; do
  # shellcheck disable=SC2086
  expect 2 "$kage" render polyhedra --config default --units-only --frames 1 --size 97x60 --out none $way
  grep -q '^kage: polyhedra: frame 0: --units-only: configuration default has no units$' stderr || fail "units-only$way: $(cat stderr)"
done
done_testing
