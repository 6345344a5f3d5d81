#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage area: counts by yosys, kept, near the estimate; and the fit is what tools/area writes of constraints/cells.json.
. "$(dirname "$0")/common.bash"
command -v yosys >/dev/null || exit 77

export XDG_CACHE_HOME=$PWD/cache
expect 0 "$kage" area tiny --json tiny.json
grep -qE '^tiny: [0-9]+ LUTs \(estimated [+-][0-9]+ %\), [0-9]+ flip-flops \([+-][0-9]+ %\), 2 block RAMs, 0 multipliers; [0-9]+ bits of RAM, 24 bits a pixel$' stdout || fail "$(cat stdout)"
json tiny.json 'j[0]["counted"]["seconds"] > 0 and abs(j[0]["estimated"]["luts"] / j[0]["counted"]["luts"] - 1) < 0.25'
expect 0 "$kage" area tiny --json kept.json
json kept.json 'j[0]["counted"]["seconds"] == 0'
for file in cache/kage/cells/*.json; do echo '{' >"$file"; done # damaged: counted again
expect 0 "$kage" area tiny --json again.json
python3 -c 'import json; a, b = (json.load(open(f))[0]["counted"] for f in ("tiny.json", "again.json")); assert a["luts"] == b["luts"] and b["seconds"] > 0' || fail "a damaged count"
YOSYS=/nonexistent trouble "/nonexistent: not found, or \`/nonexistent -V\` fails" "$kage" area tiny
printf '#!/bin/sh\n[ "$1" = -V ] && { echo Yosys 9; exit 0; }\necho "ERROR: no such thing"\nexit 1\n' >broken
chmod +x broken
YOSYS=$PWD/broken trouble "yosys fails: ERROR: no such thing" "$kage" area tiny
expect 0 "$kage" area --estimate
[ "$(wc -l <stdout)" = "$("$kage" list configs | wc -l)" ] || fail "$(cat stdout)"
KAGE=$kage expect 0 python3 "$source/tools/area" --check
done_testing
