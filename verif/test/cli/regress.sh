#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage regress: the runs of a round, its verdict, what it tells of a difference, and what a signal leaves.
. "$(dirname "$0")/common.bash"

echo '{MAX_WIDTH: 64, LANES: 4}' >small.yaml
echo '{MAX_WIDTH: 64, LANES: 4, LIGHTS: 2, COUNT_BITS: 2, CLASS_BITS: 4}' >lights.yaml
mkdir other
cp lights.yaml other/small.yaml

# Sound RTL, two rounds of two configurations, by one job and by three: the same runs, whatever the time.
for jobs in 1 3; do
  expect 0 "$kage" regress --rounds 2 --config small.yaml --config tiny --seed 5 --jobs $jobs --out regress --json $jobs.json --junit $jobs.xml
  grep -q '^same: 16 runs of 2 rounds, ' "$temp/stdout" || fail "two rounds are not 16 runs: $(cat "$temp/stdout")"
  grep -Eq '^  small.yaml +8 runs +.* same$' "$temp/stdout" || fail "no line for small.yaml: $(cat "$temp/stdout")"
  [ -s regress/report.html ] || fail "no page"
done
python3 - <<'PY' || fail "what is run depends on the jobs, or JSON and JUnit do not tell of it"
import json, xml.etree.ElementTree as xml
one, three = (json.load(open(f"{n}.json")) for n in (1, 3))
rows = lambda j: [(r["scene"], r["frames"], r["cycles"], r["pixels_compared"], r["again"]) for r in j["scenes"]]
assert rows(one) == rows(three)
assert one["runs"] == 16 and one["same"] and not one["interrupted"] and one["first_difference"] is None
names = [r["scene"] for r in one["scenes"]]
assert len(set(names)) == 16 and names[:2] == ["random.small.0", "random.tiny.0"], names
assert {r["seed"] for r in one["scenes"]} == {5, 6}
cases = [c for c in xml.parse("1.xml").iter("testcase")]
assert [c.get("name") for c in cases] == names
assert cases[0].get("classname") == "kage.regress.small_yaml" and cases[1].get("classname") == "kage.regress.tiny"
PY

# --list tells these runs, makes none, and leaves nothing.
expect 0 "$kage" regress --list --rounds 2 --config small.yaml --config tiny --seed 5
python3 - <<'PY' || fail "--list tells other runs: $(cat "$temp/stdout")"
import json
lines = open("stdout").read().splitlines()
scenes = json.load(open("1.json"))["scenes"]
assert [line.split(": ")[0] for line in lines] == [r["scene"] for r in scenes]
words = lambda command: sorted(command.split())  # their order is the help's in one and the plan's in the other
assert [words(line.split(": ")[1]) for line in lines] == [words(r["again"]) for r in scenes], (lines[2], scenes[2]["again"])
PY
[ ! -e out ] || fail "--list made the folder"

# Configurations with a front end get polygons, others if they are asked to; and some of the named ones have a front end.
echo '{MAX_WIDTH: 40, LANES: 2, ACTIVE: 5}' >front.yaml
lists_polygons() {
  expect 0 "$kage" regress --list "${@:2}"
  [ "$(grep -c -- ' --front-end rtl' "$temp/stdout")" = "$1" ] || fail "${*:2}: not $1 runs with polygons: $(cat "$temp/stdout")"
}
lists_polygons 4 --config front.yaml --config small.yaml
lists_polygons 8 --config front.yaml --config small.yaml --front-end rtl
lists_polygons 0 --config front.yaml --config small.yaml --front-end host
expect 0 "$kage" regress --list
grep -q '^mixed.polygons.0: .* --front-end rtl' "$temp/stdout" || fail "no named configuration gets polygons"
expect 1 "$kage" regress --rounds 1 --config front.yaml --fault front_end_edge --no-divergence --out front
grep -q '^random.front.0: different: ' "$temp/stdout" || fail "a wrong front end is not found: $(cat "$temp/stdout")"
expect 0 "$kage" regress --rounds 1 --config front.yaml --front-end host --fault front_end_edge --out front

# The line that a run stands for gives the same.
again=$(python3 -c 'import json; print(json.load(open("1.json"))["scenes"][2]["again"])')
expect 0 ${again/#kage /$kage } --out again --json again.json
python3 - <<'PY' || fail "a run by its own line is another: $again"
import json
a, b = json.load(open("again.json")), json.load(open("1.json"))["scenes"][2]
assert all(a[k] == b[k] for k in ("frames", "cycles", "pixels_compared", "spans", "config")), (a["cycles"], b["cycles"])
PY

# A core that is wrong behind 50 frames: two jobs would give none of them so many. The line that repeats the run says so,
# and what it writes leaves the evidence alone.
rtl_with tired "assign m_axis_tvalid_o = sending;
  assign m_axis_tdata_o = frames_q >= 8'd50 ? ~sent : sent;"
expect 1 "$kage" regress --rounds 2 --config tiny --no-divergence --out tired-out --json tired.json --junit tired.xml
grep -q '^random.tiny.1: different: ' "$temp/stdout" || fail "50 frames do not tire it: $(cat "$temp/stdout")"
again=$(sed -n 's/^that run again: \(kage cosim .*\)/\1/p' "$temp/stdout")
[[ "$again" == *" --out tired-out/random.tiny.1/again "* && "$again" == *" --jobs 1"* ]] || fail "that run again: $again"
json tired.json "j['scenes'][-1]['again'] == '$again'"
grep -qF "again: $again" tired.xml || fail "JUnit has another line: $(cat tired.xml)"
before=$(find tired-out/random.tiny.1 -type f | sort)
[ "$(wc -l <<<"$before")" -ge 5 ] || fail "no evidence: $before"
expect 1 ${again/#kage /$kage }
[ "$(find tired-out/random.tiny.1 -type f -not -path '*/again/*' | sort)" = "$before" ] || fail "the run by its line touches the evidence"
expect 0 "$kage" regress --list --rounds 2 --config tiny
[ "$(grep -c -- ' --jobs 1\b' "$temp/stdout")" = 8 ] || fail "--list leaves --jobs 1 out: $(cat "$temp/stdout")"
unset KAGE_DATA_DIR

# A run that comes to no verdict: it is named, and the runs before it are told, whatever the number of jobs.
data_copy ended
rm ended/scenes/knot.gltf # the scene of the second round
for jobs in 1 8; do
  expect 2 env KAGE_DATA_DIR="$PWD/ended" "$kage" regress --rounds 2 --config tiny --jobs $jobs --out ended-out --json ended$jobs.json --junit ended.xml
  [ "$(wc -l <"$temp/stderr")" = 1 ] && grep -q '^kage: knot.tiny.1 (configuration tiny): .*knot.gltf' "$temp/stderr" ||
    fail "the run is not named: $(cat "$temp/stderr")"
  grep -q '^same: ended by trouble after 7 runs of 2 rounds, ' "$temp/stdout" || fail "the runs before it are lost: $(cat "$temp/stdout")"
  json ended$jobs.json 'j["runs"] == 7 and j["rounds"] == 2 and j["trouble"].startswith("knot.tiny.1 (configuration tiny): ")'
  [ -s ended-out/report.html ] || fail "no page of the runs before it"
done
python3 - <<'PY' || fail "JUnit of trouble: $(cat ended.xml)"
import xml.etree.ElementTree as xml
suite = xml.parse("ended.xml").getroot()[0]
assert suite.get("tests") == "8" and suite.get("errors") == "1" and suite.get("failures") == "0"
case = suite[-1]
assert case.get("name") == "knot.tiny.1" and case.get("classname") == "kage.regress.tiny" and case[0].tag == "error"
PY

# A defect that only shows where a frame comes while the one before it still leaves: random:mixed alone sends such.
expect 0 "$kage" cosim random --config lights.yaml --frames 60 --fault early_table --no-report --out plain
expect 1 "$kage" regress --rounds 3 --config lights.yaml --fault early_table --out broken --json broken.json --junit broken.xml
grep -q '^different: ' "$temp/stdout" || fail "no verdict: $(cat "$temp/stdout")"
grep -q '^mixed.lights.[0-2]: different: ' "$temp/stdout" || fail "not found by random:mixed: $(cat "$temp/stdout")"
again=$(sed -n 's/^that run again: \(kage cosim random:mixed .*\)/\1/p' "$temp/stdout")
[ -n "$again" ] || fail "no line that repeats it: $(cat "$temp/stdout")"
expect 1 ${again/#kage /$kage }
python3 - <<'PY' || fail "JSON or JUnit of a difference"
import json, os, xml.etree.ElementTree as xml
j = json.load(open("broken.json"))
last = j["scenes"][-1]
assert not j["same"] and not last["same"] and all(r["same"] for r in j["scenes"][:-1])
assert j["first_difference"]["scene"] == last["scene"] and os.path.exists(last["report"]), last["report"]
assert len(list(xml.parse("broken.xml").iter("failure"))) == 1
PY

# The line that runs the frame again leaves what the regression found as it is.
expect 1 "$kage" regress --rounds 1 --config tiny --fault wrong_compare --no-divergence --out evidence
again=$(sed -n 's/^that frame again: \(kage cosim .*\)/\1/p' "$temp/stdout")
[ -n "$again" ] || fail "no line that runs the frame again: $(cat "$temp/stdout")"
sums() { find evidence -type f -not -path '*/again/*' -exec sha256sum {} + | sort; }
before=$(sums)
expect 1 ${again/#kage /$kage } --no-divergence
[ "$(sums)" = "$before" ] || fail "the frame by its line touches the evidence: $again"

# An input is not written over, and nothing takes the name of a file that the run writes.
for option in --json --junit; do
  trouble "small.yaml: this output would overwrite an input" "$kage" regress --rounds 1 --config small.yaml --config tiny $option ./small.yaml
done
mkdir -p taken/random.tiny.0
expect 2 "$kage" regress --rounds 1 --config tiny --fault wrong_compare --no-divergence --out taken --json taken/random.tiny.0/random_0000.kage
grep -q 'taken/random.tiny.0/random_0000.kage: two outputs have this name$' "$temp/stderr" || fail "a report in place of the frame: $(cat "$temp/stderr")"
for option in "--json -" "--junit x.xml" "--jobs 2" "--minutes 1"; do
  trouble "--list" "$kage" regress --list $option
done

# The report on a difference covers the runs up to it: more jobs begin more runs, and rounds, behind it.
for jobs in 1 16; do
  expect 1 "$kage" regress --rounds 5 --config tiny --fault stub_garbage --no-divergence --jobs $jobs --out dead --json dead$jobs.json
  grep -q '^different: 1 run of 1 round, ' "$temp/stdout" || fail "--jobs $jobs: $(cat "$temp/stdout")"
  json dead$jobs.json 'j["rounds"] == 1 and j["runs"] == 1'
done

# Registers: a mutant that pixels do not show.
number=$(python3 -c 'import sys, yaml; print([m["name"] for m in yaml.safe_load(open(sys.argv[1]))].index("reader_moving") + 1)' "$source/verif/mutants/mutants.yaml")
expect 1 "$kage" regress --rounds 1 --config tiny --mutant "$number" --out mutant --no-divergence
grep -q '^first difference: register check behind the frames: .*' "$temp/stdout" || fail "no difference: $(cat "$temp/stdout")"
grep -q '^mixed.tiny.0: different' "$temp/stdout" || fail "a mutant of the watchdog is found by another run: $(cat "$temp/stdout")"

# The time ends it, and a signal does, with what was done.
expect 0 "$kage" regress --minutes 0.05 --config tiny --out timed --json timed.json
python3 -c 'import json; j = json.load(open("timed.json")); assert j["seconds"] > 2.9 and j["runs"] > 0 and not j["interrupted"], j["seconds"]' ||
  fail "three seconds are not three seconds: $(cat "$temp/stdout")"
KAGE_PROGRESS=0.2 "$kage" regress --minutes 60 --config tiny --out signalled --json signalled.json >"$temp/stdout" 2>"$temp/stderr" &
pid=$!
until grep -q "^[1-9][0-9]* run" "$temp/stderr" || ! kill -0 $pid; do sleep 0.1; done  # some have ended
kill -INT $pid
rc=0
wait $pid || rc=$?
[ $rc = 130 ] || fail "after a signal the code is $rc: $(cat "$temp/stderr")"
grep -q '^same: interrupted after ' "$temp/stdout" || fail "a signal leaves no verdict of what was done: $(cat "$temp/stdout" "$temp/stderr")"
python3 -c 'import json; j = json.load(open("signalled.json")); assert j["interrupted"] and j["runs"] > 0' || fail "JSON after a signal"

# Where files cannot be written: what can be known at the start is said at the start, and a difference that was found is
# told however little of it can be written.
trouble "no/x.xml" timeout 60 "$kage" regress --minutes 60 --config tiny --out nowhere --junit no/x.xml
for option in --junit --json; do
  expect 2 "$kage" regress --rounds 1 --config tiny --fault stub_garbage --no-divergence --out full "$option" /dev/full
  [ "$(wc -l <"$temp/stderr")" = 1 ] && grep -q '^kage: /dev/full: ' "$temp/stderr" || fail "$option /dev/full: $(cat "$temp/stderr")"
  grep -q '^different: ' "$temp/stdout" && grep -q '^first difference: frame 0, ' "$temp/stdout" && grep -q '^that run again: ' "$temp/stdout" ||
    fail "$option /dev/full: the difference is lost: $(cat "$temp/stdout")"
  ! grep -q '^pictures: \|^report: \|^the frame: ' "$temp/stdout" || fail "files are told that did not appear: $(cat "$temp/stdout")"
done
mkdir -p paged/report.html
expect 1 "$kage" regress --rounds 1 --config tiny --fault stub_garbage --no-divergence --out paged --json paged.json --junit paged.xml
grep -q '^no report over all runs was written: ' "$temp/stdout" && grep -q '^first difference: ' "$temp/stdout" ||
  fail "without the page: $(cat "$temp/stdout")"
json paged.json 'j["report"] is None and not j["same"]'
[ -s paged.xml ] || fail "without the page there is no JUnit"
mkdir blocked
touch blocked/random.tiny.0
expect 1 "$kage" regress --rounds 1 --config tiny --fault stub_garbage --no-divergence --out blocked
grep -q '^random.tiny.0 was not repeated: ' "$temp/stdout" && grep -q '^first difference: ' "$temp/stdout" ||
  fail "without a folder for the evidence: $(cat "$temp/stdout")"

# Refusals, in one line.
trouble "--config: two configurations are called small" "$kage" regress --config small.yaml --config other/small.yaml --rounds 1
trouble "nosuch" "$kage" regress --config nosuch --rounds 1
trouble "--minutes" "$kage" regress --minutes 0
done_testing
