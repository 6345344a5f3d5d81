#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage_extremes: a injected error is found, made small, kept whole, and fails when it is run again, as long as it is there;
# exit codes, messages, JSON, and what is left after Ctrl-C.
#
# usage: program.sh KAGE_EXTREMES SOURCE_DIR
set -euo pipefail
extremes=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "program.sh: $*" >&2
  exit 1
}
# gives CODE COMMAND...: it ends with this code. Its output is in $work/out.
gives() {
  local code=$1 rc=0
  shift
  "$@" >"$work/out" 2>&1 || rc=$?
  [ $rc = "$code" ] || { cat "$work/out" >&2; fail "exit code $rc, not $code: $*"; }
}
said() { grep -qF -- "$1" "$work/out" || { cat "$work/out" >&2; fail "does not say: $1"; }; }

# inject ERROR FAMILY LINES: the error is found in the family, and its case has no more than so many lines.
inject() {
  local folder=$work/$1-$2
  mkdir "$folder"
  gives 1 "$extremes" --inject "$1" --family "$2" --starts 200 --found "$folder"
  said FAILED
  local files=("$folder"/*)
  [ ${#files[@]} = 1 ] || fail "$1: ${#files[@]} files, not one"
  grep -q "^family $2" "${files[0]}" || fail "$1: the file names no family $2"
  local lines
  lines=$(grep -vc '^#' "${files[0]}")
  [ "$lines" -le "$3" ] || { cat "${files[0]}" >&2; fail "$1: $lines lines are not small"; }
  gives 1 "$extremes" --inject "$1" --check "${files[0]}"  # the error is there: it fails
  gives 0 "$extremes" --check "${files[0]}"               # and without it it holds
  said "1 cases, 0 of them wrong"
  gives 0 "$extremes" --check "$folder"
}
inject wide_span 6 7
inject wide_span 13 3
inject steep_step "15 long" 10
inject lost_layer "20 deep" 7
inject lost_face 25 22
inject swapped_pair 35 8
for error in moved_corner tilted_plane; do
  inject $error "plane unsnapped" 18
  inject $error "plane side" 22
done

# Each family sees an error that is injected into it; docs/extremes.md has which.
gives 0 "$extremes" --inject-all
python3 - "$work/out" "$source/docs/extremes.md" <<'PY' || fail "docs/extremes.md has other injected errors than kage_extremes --inject-all"
import pathlib, re, sys
said = {row[1]: row[2] for row in map(re.compile(r"\| (.+) \| (\w+) \| \d+ \|").fullmatch, open(sys.argv[1]).read().splitlines()) if row}
assert len(said) >= 50, said
told = {}
for row in re.finditer(r"^\| `(\w+)` \| [^|]+ \| ([^|]+) \|$", pathlib.Path(sys.argv[2]).read_text(), re.M):
    told |= {family.strip(): row[1] for family in row[2].split(",")}
missing = {family: injection for family, injection in said.items() if told.get(family) != injection}
assert not missing, missing
PY

# A start has a name by which it runs again.
gives 0 "$extremes" --case 15:3:1
said "# 15:3:1: 41 cases"
cp "$work/out" "$work/case.txt"
gives 0 "$extremes" --check "$work/case.txt" # and what it prints is a case
gives 0 "$extremes" --case "14 line:1:0"

# The same seed gives the same table, whatever the threads.
for jobs in 1 3; do
  gives 0 "$extremes" --family 2,15,20 --starts 5 --seed 9 --jobs $jobs --json "$work/$jobs.json"
done
python3 - "$work" <<'PY'
import json, sys
one, three = (json.load(open(f"{sys.argv[1]}/{jobs}.json")) for jobs in (1, 3))
keys = ["family", "cases", "pixels", "items", "worst", "bound", "share", "nearest", "holds"]
rows = [[[row.get(k) for k in keys] for row in all_["families"]] for all_ in (one, three)]
assert rows[0] == rows[1], rows
assert one["pixels"] > 0 and all(row["holds"] for row in one["families"])
PY

# JSON is what docs/schema says, of a failure and of families without a case too.
mkdir "$work/json"
cp "$work/1.json" "$work/json/extremes.1.json"
gives 1 "$extremes" --inject wide_span --family 2 --starts 50 --found "$work" --json "$work/json/extremes.2.json"
# A time too short for a case of each family: those without one neither hold nor fail, and the campaign is none.
gives 2 "$extremes" --minutes 0.001 --jobs 1 --found "$work" --json "$work/json/extremes.3.json"
said "families had no case: --minutes 0.001 is too short for them"
python3 - "$work/json/extremes.3.json" "$work/out" <<'PY'
import json, re, sys
rows = json.load(open(sys.argv[1]))["families"]
text = open(sys.argv[2]).read()
none = [row for row in rows if row["cases"] == 0]
assert none and all(row["holds"] is None for row in none), none
assert all(row["holds"] is True for row in rows if row["cases"] > 0)
assert text.count("| no case") == len(none), text
assert f"{len(rows) - len(none)} of {len(rows)} families hold, {len(none)} had no case; " in text, text
PY

/usr/bin/python3 "$source/verif/test/cli/schema.py" "$source/docs/schema" "$work/json" || fail "JSON is not what its schema says"

# Bad input gets one line and exit code 2.
refused() {
  local says=$1
  shift
  gives 2 "$extremes" "$@"
  said "$says"
  [ "$(wc -l <"$work/out")" = 1 ] || fail "more than one line: $*"
}
refused "unknown option: --what" --what
refused "--family 42: there is no such family" --family 42
refused "--minutes 0: it must be" --minutes 0
refused "--seed needs a value" --seed
refused "no such folder" --family 1 --found "$work/nowhere"
refused "no such folder" --family 1 --starts 1 --json "$work/nowhere/a.json"
refused "--inject nothing: there is no such error" --inject nothing
refused "it must be FAMILY:SEED:INDEX" --case 15
mkdir "$work/bad"
bad() { # TEXT CAUSE
  printf '%b' "$1" >"$work/bad/a.txt"
  refused "$2" --check "$work/bad"
}
bad '# nothing\n' 'a.txt: no line says "family NAME"'
bad 'family 77\n' 'a.txt:1: there is no family "77"'
bad '#\nfamily 13\nspan pixels 81\n' 'a.txt:3: pixels is 81: it must be 0 .. 80'
bad 'family 13\nspan pixels x\n' 'a.txt:2: pixels: "x" is no whole number'
bad 'family 13\nspan width 3\n' 'a.txt:2: "width" stands where "pixels" is wanted'
bad 'family 13\nspan pixels 3\nmore 1\n' 'a.txt:3: "more" is no field of this family'
bad 'family 13\n' 'a.txt:1: fewer than 1 times "span"'

# Ctrl-C ends it with the table so far.
set -m
"$extremes" --family 2,15 --minutes 5 --found "$work" >"$work/out" 2>&1 &
pid=$!
set +m
sleep 1
kill -INT $pid
rc=0
wait $pid || rc=$?
[ $rc = 130 ] || fail "Ctrl-C: exit code $rc"
said "families hold; "
