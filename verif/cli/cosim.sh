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
expect 0 "$kage" stream courtyard --size 160x120 --frames 3 --out c.kage
expect 0 "$kage" cosim c.kage --out through --json -
cp stdout s.json
json s.json 'j["same"] is True and j["build_seconds"]==0 and j["pixels_compared"]==57600'

# Stalls, seeds and threads change no pixel; stalls are counted.
expect 0 "$kage" cosim c.kage --idle 40 --backpressure 60 --seed 7 --threads 1 --out stalled --json s.json
json s.json 'j["same"] is True and j["seed"]==7 and j["stalled"]["input_starved"]>0 and j["stalled"]["output_blocked"]>0'

# Every named configuration.
expect 0 "$kage" cosim courtyard --config tiny --degrade --size 150x40 --frames 1 --out tiny
expect 0 "$kage" cosim courtyard --config full --size 160x120 --frames 1 --out full
expect 0 "$kage" cosim knot --config full --size 64x48 --frames 1 --out full
expect 0 "$kage" cosim knot --size 3840x32 --frames 1 --idle 20 --backpressure 20 --out wide --json wide.json # no other is as wide
json wide.json 'j["config"]["MAX_WIDTH"]==3840 and j["pixels_compared"]==3840*32'
expect 0 "$kage" cosim courtyard --config systolic64 --size 64x48 --frames 2 --out systolic
expect 0 "$kage" cosim inside --config systolic64 --size 64x48 --frames 2 --out systolic
# Counters with one sample of one light: default's pixels, but for SHADE's rounding. A table says what a face really loses.
expect 0 "$kage" render courtyard --config default --size 64x48 --frames 1 --out one
for name in soft lights; do
  expect 0 "$kage" cosim courtyard --config $name --size 64x48 --frames 1 --out $name --idle 20 --backpressure 20
done
expect 0 "$kage" diff soft/courtyard_0000.png one/courtyard_0000.png --lsb 1
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
expect 0 "$kage" stream edges --size 64x48 --frames 1 --out edges.kage
printf 'MAX_WIDTH: 32\n' >narrow.yaml
trouble SIZE "$kage" cosim edges.kage --config narrow.yaml --out narrow
[ ! -e none ] || fail "a refused run leaves a folder"
done_testing
