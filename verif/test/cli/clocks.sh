#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage info STREAM --clocks: clocks by design are those that the RTL takes, for the core that --config names; what else
# the options may not say.
. "$(dirname "$0")/common.bash"

expect 0 "$kage" stream courtyard --frames 2 --size 64x48 --config default --out c.kage
printf 'LANES: 1\nMAX_WIDTH: 64\nBEAT_WORDS: 1\n' >narrow.yaml
printf 'LANES: 1\nMAX_WIDTH: 32\n' >short.yaml

# The clocks by design are the most that the RTL takes, header and last pixels aside (docs/rtl.md: 12 clocks at most).
# Where tokens and pixels take about as long, the words of a token come while the pixels of another one are at work:
# then the RTL is quicker, here by up to 15 %.
for core in "" "--config narrow.yaml"; do
  # shellcheck disable=SC2086 # one option or none
  expect 0 "$kage" info c.kage --clocks $core --json info.json
  # shellcheck disable=SC2086
  expect 0 "$kage" cosim c.kage $core --no-report --json run.json
  python3 - "$core" <<'PYTHON' || fail "$core: clocks by design and clocks of the RTL"
import json, sys
design = json.load(open("info.json"))["clocks"]["worst_frame"]
rtl = max(f["cycles"] for f in json.load(open("run.json"))["each"])
print(f"{sys.argv[1] or 'default'}: {design} by design, RTL {rtl}")
sys.exit(not 0.85 * design <= rtl <= design + 12)
PYTHON
done
json info.json 'j["clocks"]["config"]["LANES"]==1 and j["clocks"]["frames"]==2 and j["clocks"]["height"]==48'
json info.json 'j["clocks"]["mean_line"]<=j["clocks"]["worst_window"]["clocks_each"]<=j["clocks"]["worst_line"]["clocks"]<=j["clocks"]["worst_frame"]'
expect 0 "$kage" info c.kage --clocks
grep -q '^clocks of a line (LANES 8, BEAT_WORDS 4): mean [0-9]*, worst [0-9]* (line [0-9]* of frame [01]), worst 16 neighbours [0-9]* each$' stdout ||
  fail "no clocks in: $(cat stdout)"

trouble "c.kage: frame 0 is 64 pixels wide; the configuration's MAX_WIDTH is 32" "$kage" info c.kage --clocks --config short.yaml
trouble "c.kage: full: SMOOTH is 1, the stream's is 0" "$kage" info c.kage --clocks --config full
trouble "--config: kage info takes it with --clocks" "$kage" info c.kage --config full
trouble "courtyard: --clocks: only a stream file has tokens that take clocks" "$kage" info courtyard --clocks
done_testing
