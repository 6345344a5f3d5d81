# SPDX-License-Identifier: Apache-2.0
# Shared by the tests of the command line: bash TEST.sh KAGE SOURCE. Sets $kage, $source and a temporary $temp, where the test runs.
# shellcheck shell=bash
set -uo pipefail
# shellcheck disable=SC2034 # tests use it
kage=$1 source=$2
temp=$(mktemp -d)
trap 'rm -rf "$temp"' EXIT
cd "$temp" || exit 1
failures=0
# No lines of progress: their number depends on how slow the machine is.
export KAGE_PROGRESS=0

# Debian's, whatever the person at the machine has in front of it: a chooser of versions takes longer than what it starts.
python3() { /usr/bin/python3 "$@"; }

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# expect RC COMMAND...: the exit code; output lands in $temp/stdout and $temp/stderr.
expect() {
  local want=$1 rc=0
  shift
  "$@" >"$temp/stdout" 2>"$temp/stderr" </dev/null || rc=$?
  [ $rc = "$want" ] || { fail "$* : exit $rc, expected $want"; sed 's/^/    /' "$temp/stderr"; }
}

# trouble TEXT COMMAND...: exit 2, nothing on standard output, exactly one line "kage: ... TEXT ..." on standard error.
trouble() {
  local text=$1
  shift
  expect 2 "$@"
  [ ! -s "$temp/stdout" ] || fail "$* : says something on standard output"
  [ "$(wc -l <"$temp/stderr")" = 1 ] || { fail "$* : not one line on standard error"; sed 's/^/    /' "$temp/stderr"; }
  grep -q '^kage: ' "$temp/stderr" || fail "$* : the line does not begin with 'kage: '"
  grep -qF -- "$text" "$temp/stderr" || { fail "$* : the line does not name '$text'"; sed 's/^/    /' "$temp/stderr"; }
}

# unwrapped FILE: a plan's text, the rest of its longer lines, which stands in comments of their own, put back.
unwrapped() {
  sed -E ':a;N;$!ba;s/\n *#   / /g' "$1"
}

# json FILE EXPRESSION: true in Python, with the file's content as j.
json() {
  python3 -c "import json,sys; j=json.load(open(sys.argv[1])); sys.exit(0 if ($2) else 1)" "$1" || { fail "$1: not so: $2"; head -c 600 "$1"; }
}

# no_leftovers [FOLDER]: no file is there that a run had not finished.
no_leftovers() {
  local left
  left=$(find "${1:-.}" -name '.kage-*')
  [ -z "$left" ] || fail "unfinished files are left: $left"
}

# own_verdicts: models of the common cache, verdicts of this test's own.
own_verdicts() {
  local models=${XDG_CACHE_HOME:-$HOME/.cache}/kage
  expect 0 "$kage" cache
  mkdir -p cache/kage && ln -s "$models"/{models,verilator} cache/kage/
  export XDG_CACHE_HOME=$PWD/cache
}

# data_copy FOLDER: a copy of the data that kage builds RTL models and pages from: RTL, scenes, drivers, monitors, faults, pages.
data_copy() {
  local part
  for part in rtl scenes verif/cosim/model/driver verif/cosim/model/faults.yaml verif/cosim/diverge/monitors verif/cosim/report/page verif/explore/page; do
    mkdir -p "$(dirname "$1/$part")"
    cp -r "$source/$part" "$1/$part"
  done
}

# put_fault NAME FOLDER: puts a fault of verif/cosim/model/faults.yaml into a copy of the data.
put_fault() { /usr/bin/python3 -B "$source/verif/cosim/model/driver/defects.py" "$source/verif/cosim/model/faults.yaml" put "$1" "$2" || fail "no fault $1 to put in"; }

# each_defect EXAMPLE COMMAND: COMMAND NAME for each defect of the example, in a copy NAME of example and RTL. It must fail, and its
# output tell the defect as verif/test/examples/defects.yaml has it.
each_defect() {
  local defects=(/usr/bin/python3 -B "$source/verif/cosim/model/driver/defects.py" "$source/verif/test/examples/defects.yaml")
  local listed name pattern tried=0
  listed=$("${defects[@]}" list) || fail "no list of defects"
  while IFS=$'\t' read -r name pattern _ <&3; do
    [[ $name == "$1"_* ]] || continue
    tried=$((tried + 1))
    mkdir -p "$name/examples"
    cp -r "$source/examples/$1" "$name/examples"
    cp -r "$source/rtl" "$name"
    "${defects[@]}" put "$name" "$name" || fail "$name: is no change of the example"
    "$2" "$name"
    grep -hm 1 -E "$pattern" stdout stderr | sed "s/^/$name: /" | grep . || { fail "$name: is not told"; tail -n 5 stdout stderr; }
  done 3<<<"$listed"
  [ $tried -gt 0 ] || fail "no defect was tried"
}

# list_without_widest FOLDER: a copy of the data whose list of configurations lacks widest. That one draws all that any core
# can, so only without it there are scenes that no named configuration draws.
list_without_widest() {
  data_copy "$1"
  sed -i '/^widest:/,/^$/d' "$1/rtl/defs/configs.yaml"
}

# rtl_with FOLDER STATEMENT: from now on the data are a copy whose kage_top has the statement, which gives the core's output.
# The names for it: `sent` and `sending` are the pixels and their valid. The counter frames_q has the frames that the core has
# begun to send since its reset (255: or more). The frame at hand has the number u_control.frame_q.
rtl_with() {
  data_copy "$1"
  python3 - "$1/rtl/kage_top.sv" "$2" <<'PY' || fail "the RTL is not what this test edits"
import re, sys
path, statement = sys.argv[1:]
text, ports = re.subn(r"\.\*  // m_axis_\*", ".m_axis_tdata_o(sent), .m_axis_tvalid_o(sending), .*", open(path).read())
logic = f"""  logic [8*CHANNELS-1:0] sent;
  logic sending;
  logic [7:0] frames_q;
  always_ff @(posedge clk_i)
    if (!rst_ni) frames_q <= '0;
    else if (m_axis_tvalid_o && m_axis_tready_i && m_axis_tuser_o && frames_q != '1) frames_q <= frames_q + 8'd1;
  {statement}
"""
text, places = re.subn(r"(?m)^(  logic line_gone, )", lambda m: logic + m[1], text)
assert ports == places == 1, (ports, places)
open(path, "w").write(text)
PY
  export KAGE_DATA_DIR=$PWD/$1
}

done_testing() {
  [ $failures = 0 ] && echo "all passed"
  exit $((failures != 0))
}
