#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage cosim --jobs: what is found, drawn and written does not depend on how many models work at a time.
. "$(dirname "$0")/common.bash"

echo '{MAX_WIDTH: 64, LANES: 4}' >small.yaml
common=(--size 64x48 --config small.yaml --idle 20 --backpressure 30 --threads 2)

# plain FILE: a report without seconds and without the number of jobs that it was made with.
plain() {
  python3 - "$1" <<'PY'
import json, re, sys
text = open(sys.argv[1]).read()
if sys.argv[1].endswith(".json"):
    def without(j):
        if isinstance(j, dict):
            return {k: without(v) for k, v in j.items() if not k.endswith("seconds") and k not in ("again", "report_crc32")}
        return [without(v) for v in j] if isinstance(j, list) else j
    print(json.dumps(without(json.loads(text)), indent=1))
else:
    text = re.sub(r'(time|timestamp)="[^"]*"', "", text)
    text = re.sub(r'"(golden|rtl|build)?_?seconds": ?[^,}]*|--jobs \d+|(golden|RTL) \d+\.\d+ s|\d+\.\d+ s', "", text)
    print(text)
PY
}

# alike FOLDER: what a run left is what one job left.
alike() {
  diff <(cd one && find . -type f | sort) <(cd "$1" && find . -type f | sort) || fail "$1: other files than with one job"
  for file in $(cd one && find . -name '*.png' | sort); do
    cmp -s "one/$file" "$1/$file" || fail "$1/$file: not that of one job"
  done
  for file in r.json r.xml report.html; do
    diff <(plain "one/$file") <(plain "$1/$file") >difference || fail "$1/$file: not that of one job: $(head -c 600 difference)"
  done
}

# told: what the run said, without seconds and the number of jobs.
told() { sed 's/ --jobs [0-9]*//; / s, RTL /d' stdout; }

# runs EXIT COMMAND...: with 1, 2, 3 and more jobs than frames, into the same folder, so that names are the same.
runs() {
  local want=$1
  shift
  rm -rf one out
  expect "$want" "$@" --jobs 1 --out out --json out/r.json --junit out/r.xml
  cp -r out one
  told >said
  for jobs in 2 3 20; do
    rm -rf out "out$jobs"
    expect "$want" "$@" --jobs $jobs --out out --json out/r.json --junit out/r.xml
    mv out "out$jobs"
    diff said <(told) || fail "--jobs $jobs says otherwise"
    alike "out$jobs"
  done
}

runs 0 "$kage" cosim courtyard --frames 7 "${common[@]}"
runs 1 "$kage" cosim courtyard --frames 7 --all-spans --fault wrong_compare "${common[@]}"
runs 0 "$kage" cosim courtyard --frames 7 --shard 2/3 "${common[@]}"

# Registers are checked once, behind the frames of all jobs. A mutant that frames do not show is the same then for every N.
mutant=$(python3 -c 'import sys, yaml; print([m["name"] for m in yaml.safe_load(open(sys.argv[1]))].index("registers_shape") + 1)' "$source/verif/mutants/mutants.yaml")
runs 0 "$kage" cosim random:mixed --frames 7 --config small.yaml
runs 1 "$kage" cosim random:mixed --frames 7 --config small.yaml --mutant "$mutant"
json out20/r.json 'j["frames"] == 7 and j["first_difference"]["frame"] is None'

# A difference in frame 4 only, which is in the second of three ranges: it is told with what one job knows, and nothing of
# frames behind it.
rtl_with later "assign m_axis_tvalid_o = sending;
  assign m_axis_tdata_o = u_control.frame_q == 32'd4 ? ~sent : sent;"
runs 1 "$kage" cosim courtyard --frames 7 "${common[@]}" --no-divergence
json out20/r.json 'j["first_difference"]["frame"] == 4 and j["frames"] == 5'
# A core that hangs in its first frame unless that has number 0: only frames run ahead of a range show it, and in their place
# they are the same.
rtl_with ahead "assign m_axis_tvalid_o = sending && !(frames_q == 8'd0 && u_control.frame_q != 32'd0);
  assign m_axis_tdata_o = sent;"
runs 0 "$kage" cosim courtyard --frames 7 "${common[@]}" --no-divergence
# It is wrong in frame 6, and hangs in its fifth frame, so in frame 4 of one job alone. Two jobs see frame 6, run all frames
# before it, and can then not say that frames 0 to 3 are the same.
rtl_with behind "assign m_axis_tvalid_o = sending && !(frames_q == 8'd4 && u_control.frame_q == 32'd4);
  assign m_axis_tdata_o = u_control.frame_q == 32'd6 ? ~sent : sent;"
expect 1 "$kage" cosim courtyard --frames 7 "${common[@]}" --no-divergence --jobs 1 --out out --json b.json
json b.json 'j["first_difference"]["frame"] == 4'
trouble "--jobs 1" "$kage" cosim courtyard --frames 7 "${common[@]}" --no-divergence --jobs 3
unset KAGE_DATA_DIR

# Several scenes: their ranges are run beside each other, and told in order.
rm -rf out
expect 0 "$kage" cosim courtyard edges --frames 3 --jobs 4 "${common[@]}" --out out --json s.json
json s.json '[s["scene"] for s in j["scenes"]] == ["courtyard", "edges"] and all(s["same"] for s in j["scenes"])'
trouble "--jobs" "$kage" cosim courtyard --jobs 0
no_leftovers
done_testing
