#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage cosim of the scenes of polyhedra: golden model and RTL agree in every arrangement, and the pictures are those of a core
# without units. Small lines, since Verilator takes longest over wide ones.
. "$(dirname "$0")/common.bash"

# arrangement NAME PARAMETERS: both scenes through a configuration of 4 units.
arrangement() {
  local name=$1 parameters=$2 scene
  printf '{%s}\n' "$parameters" >"$name.yaml"
  for scene in polyhedra fifteen; do
    expect 0 "$kage" cosim $scene --size 48x36 --frames 2 --config "$name.yaml" --idle 30 --backpressure 30 --seed 3 --out "$name" --json "$name.json"
    json "$name.json" 'j["same"] is True and j["pixels_compared"]==2*48*36 and j["first_difference"] is None'
    # Segments on every line, by all units (three hold what w0 leaves whole of fifteen); and every polyhedron has gone a way, with a reason where it was not by segments.
    json "$name.json" 'j["segments"]>4*36 and j["config"]["UNITS"]==4 and j["units"]=='"$([ $scene = fifteen ] && echo 3 || echo 4)"
    json "$name.json" 'len(j["polyhedra"])>='"$([ $scene = fifteen ] && echo 5 || echo 40)"
    json "$name.json" 'all(p["unit_frames"]+p["span_frames"]<=2 and (p["why"] is not None)==(p["span_frames"]>0) for p in j["polyhedra"])'
    json "$name.json" 'sum(p["unit_frames"] for p in j["polyhedra"])>=8'
    for frame in 0 1; do
      expect 0 "$kage" diff "$name/${scene}_000$frame.png" "spans/${scene}_000$frame.png"
    done
  done
  cycles+=("$name $(python3 -c "import json; print(json.load(open('$name.json'))['cycles'])")")
}

small="X_BITS: 6, MAX_WIDTH: 48"
printf '{%s}\n' "$small" >spans.yaml
for scene in polyhedra fifteen; do
  expect 0 "$kage" render $scene --size 48x36 --frames 2 --config spans.yaml --out spans
done
cycles=()
arrangement lanes1 "$small, UNITS: 4, LANES: 1, BEAT_WORDS: 1"
arrangement lanes4 "$small, UNITS: 4, LANES: 4, BEAT_WORDS: 2"
arrangement lanes8 "$small, UNITS: 4, LANES: 8, BEAT_WORDS: 4"
arrangement systolic "$small, UNITS: 4, ARRANGEMENT: 0, BEAT_WORDS: 2"
printf 'clocks of fifteen: %s\n' "${cycles[*]}"

# The report on a stream file is that on its scene.
expect 0 "$kage" stream fifteen --size 48x36 --frames 2 --config lanes4.yaml --out fifteen.kage
expect 0 "$kage" cosim fifteen.kage --json of_stream.json --out of_stream
json of_stream.json 'j["same"] is True and j["units"]==3 and all(j[k]==json.load(open("lanes4.json"))[k] for k in ("segments", "polyhedra", "spans"))'

# The paper's format has other depths, so its pictures are those of its own golden model; it agrees with the RTL all the same.
printf '{%s, UNITS: 3, CLASSIC: 1, Z_BITS: 15, Z_FRAC: 0, LANES: 4}\n' "$small" >classic.yaml
for scene in polyhedra fifteen; do
  expect 0 "$kage" cosim $scene --size 48x36 --frames 2 --config classic.yaml --out classic --json classic.json
  json classic.json 'j["same"] is True and j["segments"]>3*36 and j["units"]==3'
done

# A polyhedron that finds no unit is refused by name, if asked for.
trouble "--units-only" "$kage" cosim polyhedra --units-only --size 48x36 --frames 1 --config lanes4.yaml --out none
[ ! -e none ] || fail "a refused run leaves a folder"
done_testing
