#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# RTL of which an assertion fails is "different", with all that is told of a difference.
. "$(dirname "$0")/common.bash"

data_copy data
echo '{MAX_WIDTH: 64, LANES: 2, BEAT_WORDS: 1}' >small.yaml
export KAGE_DATA_DIR=$PWD/data XDG_CACHE_HOME=$PWD/cache
# Without the defect below the same frames are the same, so it is the defect that the rest of this test sees.
expect 0 "$kage" cosim courtyard --size 64x48 --config small.yaml --no-report
# A span has a pixel more, and one that ends with the line is past its end.
grep -q 'cmd.xr - 1' data/rtl/pixel_banked.sv || fail "no defect to put in"
sed -i "s/cmd\.xr - 1'b1/cmd.xr/" data/rtl/pixel_banked.sv

expect 1 "$kage" cosim courtyard --size 64x48 --config small.yaml --out out --json v.json --junit v.xml --annotate github
cp stdout said
grep -q 'pixel_banked.sv.*Assertion' stderr || fail "the assertion's own message is lost"
at=$(grep -o 'an assertion failed: rtl/pixel_banked.sv:[0-9]*' said | head -n1)
[ -n "$at" ] || fail "the verdict does not name the assertion: $(cat said)"
at=${at##*: }
grep -q '^first divergence: .*(rtl/pixel_banked.sv)' said || fail "the stage was not looked for: $(cat said)"
grep -q '^::error file=rtl/pixel_banked.sv,title=' said || fail "no annotation: $(cat said)"
json v.json "not j['same'] and j['first_difference']['assertion']=='$at' and j['first_difference']['divergence']['module']=='pixel_banked'"
grep -q '<failure .*an assertion failed' v.xml || fail "JUnit does not tell it: $(cat v.xml)"
for file in out/report.html out/courtyard_0000_actual.png out/courtyard_0000.gtkw; do
  [ -s $file ] || fail "no $file"
done
grep -qF "$at" out/report.html || fail "the page does not name the assertion"
# Pixels that the RTL drew no more are no difference: they are black, and the page counts them.
PYTHONPATH=$source/verif/test/cli python3 - <<'PY' || fail "pixels that never came are shown as if they had"
import re, sys
from png import pixels
missing = int(re.search(r'"missing":(\d+)', open("out/report.html").read())[1])
came = 3 * (64 * 48 - missing)
actual, difference = (pixels(f"out/courtyard_0000_{name}.png") for name in ("actual", "difference"))
sys.exit(not 0 < missing < 64 * 48 or any(actual[came:]) or any(difference[came:]) or not any(difference[:came]))
PY
# A shard's report with one can be joined, and what the RTL says gets into no result.
expect 1 "$kage" cosim courtyard --size 64x48 --config small.yaml --out out --shard 1/1 --json - --no-divergence
cp stdout 1.json
expect 1 "$kage" merge 1.json --json m.json
json m.json "j['first_difference']['assertion']=='$at'"

# The RTL's messages are those of one job: of the first frame that fails, not of those behind it.
for jobs in 1 4; do
  expect 1 "$kage" cosim courtyard --frames 4 --size 64x48 --config small.yaml --no-divergence --no-report --jobs $jobs
  [ "$(grep -c 'Assertion failed' stderr)" = 1 ] || fail "--jobs $jobs: not one assertion's message: $(cat stderr)"
  grep -v ' s, RTL ' stdout >"stdout$jobs"
  tr '\r' '\n' <stderr | grep 'Assertion failed' >"stderr$jobs"
done
diff stdout1 stdout4 && diff stderr1 stderr4 || fail "four jobs tell something else than one"

# The search beside it does not stop at the assertion.
x=$(python3 -c 'import json; d = json.load(open("v.json"))["first_difference"]["divergence"]; print(d["x"], d["line"], sep=",")')
expect 0 "$kage" explain courtyard --size 64x48 --config small.yaml --pixel "$x" --rtl
grep -q 'differs' stdout || fail "pixel $x: the difference is not marked"

# Where no stage is looked for, it is the assertion's file that is named, and its line.
expect 1 "$kage" cosim courtyard --size 64x48 --config small.yaml --out out --annotate github --no-divergence --no-report
grep -q "^::error file=rtl/pixel_banked.sv,line=${at##*:},title=" stdout || fail "no annotation: $(cat stdout)"
done_testing
