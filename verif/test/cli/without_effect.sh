#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# docs/shadows.md, "Without effect": its table is what kage stream and kage info print, and both streams draw one picture.
. "$(dirname "$0")/common.bash"

rows=$(sed -n '/^## Without effect/,/^## Kept/s/^| \([a-z-]*\) | \([0-9].*\) |$/\1 \2/p' "$source/docs/shadows.md" | tr -d '|')
[ "$(wc -l <<<"$rows")" = "$("$kage" list scenes --json - | python3 -c 'import json, sys; print(len(json.load(sys.stdin)["scenes"]))')" ] || fail "not a row for each scene: $rows"
while read -r scene shown; do
  printed=()
  for all in --all-spans ""; do
    # shellcheck disable=SC2086 # no option is no word
    expect 0 "$kage" stream "$scene" --size 640x480 --frames 1 $all --out "of${all}.kage" --json words.json
    expect 0 "$kage" info "of${all}.kage" --clocks --json clocks.json
    expect 0 "$kage" render "of${all}.kage" --out "drawn${all}"
    printed+=("$(python3 -c 'import json; print(json.load(open("words.json"))["words"], json.load(open("clocks.json"))["clocks"]["worst_frame"])')")
  done
  said=$(awk '{printf "%d %d %.1f %d %d", $1 / 1000 + .5, $3 / 1000 + .5, $1 / $3, $2 / 1000 + .5, $4 / 1000 + .5}' <<<"${printed[*]}")
  [ "$said" = "$(tr -s ' ' <<<"$shown" | sed 's/ *$//')" ] || fail "$scene: docs/shadows.md shows $shown, and it is $said"
  expect 0 "$kage" diff "drawn--all-spans/of--all-spans_0000.png" drawn/of_0000.png
done <<<"$rows"
done_testing
