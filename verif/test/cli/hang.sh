#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# RTL that stands still, or sends pixels for ever and never asks for the next token: "different", soon and in little
# memory, however much of the frame was to come.
. "$(dirname "$0")/common.bash"

data_copy data
echo '{MAX_WIDTH: 1024, LANES: 2, COUNT_BITS: 5, SMOOTH: 1, COLOR_FRAC: 8}' >small.yaml
export KAGE_DATA_DIR=$PWD/data XDG_CACHE_HOME=$PWD/cache
# A large frame: what the golden core expects of it takes gigabytes.
scene=(penumbra --size 1024x1500 --frames 1 --samples 16 --config small.yaml)

# Without a defect it ends: what is told below is of the defects.
expect 0 timeout 300 "$kage" cosim penumbra --size 64x48 --frames 1 --samples 4 --config small.yaml --out sound

# defect TEXT WITH: a change of line_out, which the divergence must name.
defect() {
  rm -rf data/rtl
  cp -r "$source/rtl" data/
  grep -qF "$1" data/rtl/line_out.sv || fail "no '$1' to change"
  python3 - "$@" <<'PY'
import pathlib, sys
path = pathlib.Path("data/rtl/line_out.sv")
path.write_text(path.read_text().replace(sys.argv[1], sys.argv[2], 1))
PY
  # Its models are built first: a compiler takes more memory than the search does.
  "$kage" cosim "${scene[@]}" --out out --no-report >/dev/null 2>&1 && fail "$1, now $2: the same"
  kib=$(python3 - "$kage" cosim "${scene[@]}" --out out --json v.json --junit v.xml <<'PY'
import resource, subprocess, sys
with open("said", "w") as said:
    rc = subprocess.run(sys.argv[1:], stdin=subprocess.DEVNULL, stdout=said, timeout=300).returncode
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss if rc == 1 else 0)
PY
  )
  json v.json "not j['same'] and j['first_difference']['divergence']['module']=='line_out'"
  grep -q '<failure' v.xml && [ -s out/report.html ] || fail "no JUnit or page"
  echo "$1, now $2: $kib KiB; $(grep '^first d' said)"
  [ "$kib" -gt 0 ] && [ "$kib" -lt 400000 ] || fail "the search takes $kib KiB"
}

defect "taken_q + 2'(exit_take_i) - 2'(line_left)" "taken_q + 2'(exit_take_i)"
grep -q "pixel_banked's line waits for line_out" said || fail "not told who waits: $(cat said)"
defect "issue_last_q <= left_q == X_BITS'(2);" "issue_last_q <= left_q == '0 && issue_last_q;"
done_testing
