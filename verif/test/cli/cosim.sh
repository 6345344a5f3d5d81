#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage cosim: golden model and RTL agree in every named configuration, whatever stalls; the JSON says what it should.
. "$(dirname "$0")/common.bash"

expect 0 "$kage" cosim courtyard --size 160x120 --frames 3 --out out --json r.json
grep -q '^same: 3 frames, 160x120, 57600 pixels compared' stdout || fail "does not say same: $(cat stdout)"
[ "$(tail -n 2 stdout)" = "pictures: out
report: out/report.html" ] || fail "the last lines do not say where pictures and report are: $(tail -n 2 stdout)"
json r.json 'j["same"] is True and j["frames"]==3 and (j["width"],j["height"])==(160,120) and j["pixels_compared"]==57600'
json r.json 'j["first_difference"] is None and j["cycles"]>0 and j["spans"]>0 and j["span_pixels"]>=j["spans"]//2 and j["seed"]==1'
json r.json 'all(k in j for k in ("golden_seconds","rtl_seconds","build_seconds")) and set(j["stalled"])=={"input_starved","output_blocked"}'
json r.json 'j["config"]["LANES"]>=1 and j["config"]["ARRANGEMENT"]==1'
for frame in 0 1 2; do [ -s out/courtyard_000$frame.png ] || fail "no picture of frame $frame"; done
[ "$(find out -name '*_actual.png' | wc -l)" = 0 ] || fail "pictures of a difference where there is none"

# The pictures are those of kage render; the second run needs no build; a stream goes the same way; --json - has nothing else.
expect 0 "$kage" render courtyard --size 160x120 --frames 3 --out direct
expect 0 "$kage" diff out/courtyard_0002.png direct/courtyard_0002.png
expect 0 "$kage" stream courtyard --size 160x120 --frames 3 --all-spans --out c.kage
expect 0 "$kage" cosim c.kage --out through --json -
cp stdout s.json
json s.json 'j["same"] is True and j["build_seconds"]==0 and j["pixels_compared"]==57600'

# Stalls, seeds and threads change no pixel; stalls are counted.
expect 0 "$kage" cosim c.kage --idle 40 --backpressure 60 --seed 7 --threads 1 --out stalled --json s.json
json s.json 'j["same"] is True and j["seed"]==7 and j["stalled"]["input_starved"]>0 and j["stalled"]["output_blocked"]>0'
# The page's first line says how the RTL was run, where that was not the plain way.
grep -q '<title>same: 3 frames, 160x120, 57600 pixels compared, with --idle 40 --backpressure 60 - c</title>' stalled/report.html ||
  fail "the head of the report does not name the stalls: $(grep '<title>' stalled/report.html)"
grep -q '<title>same: 3 frames, 160x120, 57600 pixels compared - c</title>' through/report.html || fail "the head of the report: $(grep '<title>' through/report.html)"
# Each belongs to a phase: those of the frame's kinds of token, and what is behind the last.
json s.json 'all(sum(p[k] for p in f["stalled_by_phase"].values())==n for f in j["each"] for k, n in f["stalled"].items())'
json s.json '{"state","opaque","volumes","ends of volumes","line out","behind the last token"}==set(j["each"][0]["stalled_by_phase"])'

# Every named configuration.
expect 0 "$kage" cosim courtyard --config tiny --degrade --size 150x40 --frames 1 --out tiny
expect 0 "$kage" cosim courtyard --config full --size 160x120 --frames 1 --out full
expect 0 "$kage" cosim knot --config full --size 64x48 --frames 1 --out full
expect 0 "$kage" cosim knot --size 3840x32 --frames 1 --idle 20 --backpressure 20 --out wide --json wide.json # no other is as wide
json wide.json 'j["config"]["MAX_WIDTH"]==3840 and j["pixels_compared"]==3840*32'
expect 0 "$kage" cosim courtyard --config systolic64 --size 64x48 --frames 2 --out systolic
expect 0 "$kage" cosim inside --config systolic64 --size 64x48 --frames 2 --out systolic
for name in soft lights; do
  expect 0 "$kage" cosim courtyard --config $name --size 64x48 --frames 1 --out $name --idle 20 --backpressure 20
done
# Counters with one sample of one light: default's pixels, but for SHADE's rounding. A table says what each face loses.
printf '{COUNT_BITS: 8, SHADE_FRAC: 16}\n' >counters.yaml
for name in default counters.yaml; do
  expect 0 "$kage" render courtyard --config $name --size 64x48 --frames 1 --out "one-$name"
done
expect 0 "$kage" diff one-default/courtyard_0000.png one-counters.yaml/courtyard_0000.png --lsb 1
expect 1 "$kage" diff one-default/courtyard_0000.png soft/courtyard_0000.png --lsb 1
# Wider than any of them, by a file of one's own (the line that docs/stream.md shows).
printf '{X_BITS: 13, Z_FRAC: 12, LANES: 8, MAX_WIDTH: 4096}\n' >wide.yaml
grep -qF "$(cat wide.yaml)" "$source/docs/stream.md" || fail "docs/stream.md shows another line"
expect 0 "$kage" cosim courtyard --size 4096x8 --frames 1 --config wide.yaml --out wide --json w.json
json w.json 'j["same"] is True and j["pixels_compared"]==32768 and j["span_pixels"]>0'
# The arrangement changes no pixel.
expect 0 "$kage" render courtyard --config default --size 64x48 --frames 2 --out banked
expect 0 "$kage" diff systolic/courtyard_0001.png banked/courtyard_0001.png

# Bad input leaves nothing.
trouble nowhere.obj "$kage" cosim nowhere.obj --out none
trouble "lacks" "$kage" cosim courtyard --config tiny --size 64x48 --out none
trouble "no such fault (there are blend_rounding, " "$kage" cosim courtyard --size 64x48 --fault nonsense --out none
printf 'LANES: 3\n' >three.yaml
trouble three.yaml "$kage" cosim courtyard --config three.yaml --out none
# No pixel compared is no verdict.
expect 0 "$kage" stream edges --config default --size 64x48 --frames 1 --out edges.kage
printf 'MAX_WIDTH: 32\n' >narrow.yaml
trouble SIZE "$kage" cosim edges.kage --config narrow.yaml --out narrow
[ ! -e none ] || fail "a refused run leaves a folder"

# The verdict stands whatever becomes of what is said about it: a waveform or a page that cannot be written is a note.
mkdir -p blocked/courtyard_0000.fst blocked/report.html
touch blocked/courtyard_0000.fst/x blocked/report.html/x
expect 1 "$kage" cosim courtyard --size 64x48 --frames 1 --all-spans --fault wrong_compare --out blocked --json blocked.json --junit blocked.xml
json blocked.json 'j["same"] is False and j["report"] is None and j["first_difference"]["waveform"] is None'
json blocked.json 'j["first_difference"]["stage"]=="pixel_banked" and [n for n in j["notes"] if "no waveform" in n] and [n for n in j["notes"] if "no report" in n]'
grep -q '<failure' blocked.xml || fail "no JUnit where waveform and page could not be written"
# Nor is the room for the page's tokens a matter of the verdict: no file here may have more than 24 KiB.
expect 0 bash -c 'trap "" XFSZ; ulimit -f 24; exec "$@"' - "$kage" cosim courtyard --size 160x120 --out narrow --json narrow.json
json narrow.json 'j["same"] and j["frames"]==8 and j["report"] is None and any("no report was written: the report: its temporary file" in n for n in j["notes"])'
# So it does for who has waited long enough.
for ((i = 0; i < 50; ++i)); do
  rm -rf cut cut.json
  "$kage" cosim courtyard --size 64x48 --frames 1 --all-spans --fault wrong_compare --out cut --json cut.json >stdout 2>stderr &
  # The frame's picture and the three of its difference wait for the end of the run: there is a verdict.
  until [ "$(find cut -path '*/.kage-*' -name '*.png' 2>/dev/null | wc -l)" -ge 4 ] || ! kill -0 $! 2>/dev/null; do sleep 0.01; done
  kill -INT $! 2>/dev/null
  rc=0
  wait $! || rc=$?
  [ $rc = 130 ] || [ $rc = 1 ] || fail "interrupted after the verdict: exit $rc"
  grep -q '^different: ' stdout || fail "interrupted after the verdict: it is not told"
  json cut.json 'j["same"] is False'
  [ $rc = 1 ] || break  # else it was done before
done
[ $rc = 130 ] || fail "never interrupted after the verdict"

# Evidence of an earlier run is gone once a run finds nothing wrong.
expect 1 "$kage" cosim courtyard --size 64x48 --frames 2 --all-spans --fault wrong_compare --out again
grep -q '<title>different: .* pixels compared, with --fault wrong_compare - courtyard</title>' again/report.html || fail "the head of the report does not name the fault"
[ -s again/courtyard_0000.fst ] && [ -s again/courtyard_0000_actual.png ] || fail "no evidence of a difference"
touch again/courtyard_0007_actual.png
expect 0 "$kage" cosim courtyard --size 64x48 --frames 2 --out again
[ "$(cd again && echo *)" = "courtyard_0000.png courtyard_0001.png courtyard_0007_actual.png report.html" ] ||
  fail "left of an earlier difference: $(ls again)"

# So it does if the page over all scenes cannot be written; of an option given twice the last one counts, here too.
mkdir -p over/report.html
touch over/report.html/x
expect 0 "$kage" cosim courtyard inside --size 64x48 --frames 2 --frames 1 --out over --json over.json --junit over.xml
json over.json 'j["same"] and j["report"] is None and j["frames"]==2 and all(s["report"] for s in j["scenes"])'
json over.json 'j["scenes"][0]["again"]=="kage cosim courtyard inside --out over --size 64x48 --frames 1 --json over.json --junit over.xml"'
grep -q '^no report over all scenes was written: ' stdout || fail "not said that the page over all is missing: $(cat stdout)"
grep -q '<testcase' over.xml || fail "no JUnit where the page over all could not be written"

# Two runs at once do not mix their reports in one folder.
mkdir held
trouble "held: another run writes its report there" flock held "$kage" cosim courtyard --size 64x48 --frames 1 --out held
[ -z "$(ls held)" ] || fail "a refused run leaves $(ls held)"
expect 0 flock held "$kage" cosim courtyard --size 64x48 --frames 1 --no-report --out held
expect 0 "$kage" cosim courtyard --size 64x48 --frames 1 --out held

# Two outputs are two files, by whatever name; a name makes no line of its own.
trouble "two outputs have this name" "$kage" cosim courtyard --size 64x48 --frames 1 --json x.json --junit ./x.json
expect 0 "$kage" stream courtyard --size 64x48 --frames 1 --out read.kage
cp read.kage kept.kage
for option in --json --junit; do trouble "read.kage: this output would overwrite an input" "$kage" cosim read.kage $option ./read.kage; done
trouble "read.kage: this output would overwrite an input" "$kage" stream read.kage --out ./read.kage
trouble "read.kage: this output would overwrite an input" "$kage" info read.kage --json read.kage
cmp read.kage kept.kage || fail "an input was written over"
trouble "two outputs have this name" "$kage" cosim courtyard --size 64x48 --frames 1 --out o --junit o/../o/report.html
expect 0 "$kage" stream courtyard --size 64x48 --frames 1 --all-spans --out plain.kage
mv plain.kage $'two\n::error::lines.kage'
expect 1 "$kage" cosim $'two\n::error::lines.kage' --fault wrong_compare --annotate github --out lines
[ "$(grep -c '^::error' stdout)" = 1 ] || fail "a file's name makes annotations: $(cat stdout)"
done_testing
