#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kage plan from outside: its file runs, its reasons are there, impossible requests are refused in one line. The choice without
# --config depends on nothing but scene and look. Also --config plan and kage model --plan.
. "$(dirname "$0")/common.bash"

# A plan's lines are of 120 characters at most. The tests read them put together.
joined() {
  [ -z "$(awk 'length($0) > 120' "$1")" ] || fail "longer than 120: $(awk 'length($0) > 120' "$1")"
  unwrapped "$1" >unwrapped.yaml
  cp unwrapped.yaml "$1"
}
# planned RC ARGUMENT...: expect RC kage plan ARGUMENT..., and the text put together.
planned() {
  local want=$1
  shift
  expect "$want" "$kage" plan "$@"
  [ "$(head -c 1 stdout)" != "#" ] || joined stdout
}

# The plan's file is a configuration, and the RTL draws what the golden core draws by it.
"$kage" plan courtyard --size 64x48 --frames 2 >plan.yaml || fail "no plan"
cp plan.yaml mine.yaml
joined mine.yaml
grep -q '^# kage plan courtyard: 2 frames of up to 64x48, --prefer area$' mine.yaml || fail "$(head -1 mine.yaml)"
[ "$(grep -cE '^[A-Z_]+: [0-9]+ +# .' mine.yaml)" = "$(grep -cE '^[A-Z_]+:' mine.yaml)" ] || fail "a parameter without a reason"
grep -qE '^Z_FRAC: 8 +# longest span [0-9]+ pixels in frame [01], line [0-9]+: [0-9]+ keep .* of the range, [0-9]+ give ' mine.yaml || fail "$(grep Z_FRAC mine.yaml)"
grep -q '^# instead, parity' mine.yaml || fail "no other way: $(cat mine.yaml)"
expect 0 "$kage" cosim courtyard --size 64x48 --frames 2 --config plan.yaml --no-report --out out
grep -q '^same: 2 frames' stdout || fail "$(cat stdout)"
# An inequality's figures show that it is broken, and with which other width.
grep -qE '^Z_BITS: 24 +# with Z_FRAC 16, 24 keep [0-9.e-]+ of the range, 23 give [0-9.e-]+, more than --max-z [0-9.e-]+$' mine.yaml || fail "$(grep Z_BITS mine.yaml)"
python3 - mine.yaml <<'PY' || fail "figures that are equal to their limits: $(cat mine.yaml)"
import re, sys
pairs = re.findall(r"(?:give|by|within) ([0-9.e-]+), more than --max-[a-z]+ ([0-9.e-]+)", open(sys.argv[1]).read())
sys.exit(not (len(pairs) >= 3 and all(float(value) > float(limit) for value, limit in pairs)))
PY

# Twice the same words; and the same as --config plan, whose model is there by now.
"$kage" plan courtyard --size 64x48 --frames 2 >again.yaml
cmp plan.yaml again.yaml || fail "a plan differs from run to run"
expect 0 "$kage" stream courtyard --size 64x48 --frames 2 --config plan.yaml --out a.kage
expect 0 "$kage" stream courtyard --size 64x48 --frames 2 --config plan --out b.kage
grep -q 'configuration: plan (LANES 1)$' stdout || fail "$(cat stdout)"
expect 0 "$kage" diff a.kage b.kage
expect 0 "$kage" model --plan courtyard --size 64x48 --frames 2
grep -q '^plan of courtyard: .*(was there)$' stdout || fail "$(cat stdout)"
expect 0 "$kage" cosim courtyard --size 64x48 --frames 2 --config plan --no-report --out out
grep -q '^kage: the RTL model of .* is there$' stderr || fail "$(cat stderr)"
# With no models kept, that one is to be built is told first.
expect 0 env XDG_CACHE_HOME="$PWD/no-models" "$kage" cosim courtyard --size 64x48 --frames 1 --config plan --no-report --out out
grep -q '^kage: the RTL model of .* is not there, and is built first$' stderr || fail "$(cat stderr)"

# A front end has room for all polygons at once, and one less has not; nothing else is planned otherwise but the way of shadows,
# whose clocks are others behind it.
grep -q '^ACTIVE: 0 ' mine.yaml || fail "$(grep ACTIVE mine.yaml)"
planned 0 courtyard --size 64x48 --frames 2 --front-end rtl --json front.json
cp stdout front.yaml
values() { grep '^[A-Z]' "$1" | grep -vE '^(ACTIVE|DSF_BITS|FSF):' | sed 's/ *#.*//'; }
diff <(values mine.yaml) <(values front.yaml) || fail "a front end changes other parameters"
active=$(sed -n 's/^ACTIVE: \([0-9]*\) .*/\1/p' front.yaml)
for less in 0 1; do
  sed "s/^ACTIVE:.*/ACTIVE: $((active - less))/" front.yaml >less.yaml
  expect 0 "$kage" stream courtyard --size 64x48 --frames 2 --config less.yaml --level polygons --out less.kage --json less.json
  [ "$(grep -c 'more at once than ACTIVE' stdout)" = $less ] || fail "ACTIVE $active - $less: $(cat stdout)"
  [ $less = 1 ] || json less.json "j['words'] == $(python3 -c 'import json; print(json.load(open("front.json"))["polygon_words"])')"
done

# Without --config: never by --frames, and what is looked for in the list.
for frames in 1 2 8; do
  expect 0 "$kage" render canopy --size 640x480 --frames $frames --out out
  grep -q '^canopy: configuration: meshes$' stdout || fail "$(cat stdout)"
done
expect 0 "$kage" render courtyard --frames 1 --out out
grep -q '^courtyard: configuration: meshes$' stdout || fail "$(cat stdout)"
expect 0 "$kage" info canopy
grep -qE '^  meshes takes [0-9]+ clocks for the first frame at 640x480, and some [0-9]+ look-up tables$' stdout || fail "$(cat stdout)"
for case in "three-lights --samples 64" "courtyard --size 4096x16" "glass --size 8192x8" "penumbra --size 32766x4"; do
  # shellcheck disable=SC2086
  expect 0 "$kage" render $case --frames 1 --out out
  grep -q 'configuration: widest$' stdout || fail "$case: $(cat stdout)"
done

# The smallest pictures.
for size in 1x1 2x3 7x1; do
  "$kage" plan courtyard --size $size --frames 1 >least.yaml || fail "no plan for $size"
  expect 0 "$kage" render courtyard --size $size --frames 1 --config least.yaml --out out
done

# Smooth colour is kept whatever --max-color allows, since no core without it draws the scene.
"$kage" plan penumbra --size 64x48 --frames 1 --max-color 60 >rough.yaml || fail "no plan"
expect 0 "$kage" render penumbra --size 64x48 --frames 1 --config rough.yaml --out out

# A display: what is enough, what is not.
planned 0 courtyard --size 64x48 --frames 1 --clock 50
grep -q '^# a display of 60 frames a second and 51 lines each, blanking included, at 50 MHz: the core keeps up$' stdout || fail "$(cat stdout)"
planned 0 courtyard --size 640x480 --frames 1 --device ecp5-25f --fps 30
grep -q ' and 525 lines each' stdout || fail "$(cat stdout)"
grep -qE '^# [0-9.]+ MHz is what the slowest core placed on ecp5-25f reached, [a-z0-9-]+; ' stdout || fail "$(cat stdout)"
# Translucent layers over counted samples: the way out evens nothing out.
planned 0 penumbra glass --size 64x48 --frames 1 --samples 3 --clock 500 --json loads.json
grep -q ': the core keeps up if a FIFO of two lines follows$' stdout || fail "$(cat stdout)"
json loads.json 'j["cost"]["needs_fifo"] is True and j["meets_clock"] is True'
planned 0 courtyard --size 64x48 --frames 1 --clock 0.01
grep -q 'no core keeps up, this one comes nearest$' stdout || fail "$(cat stdout)"
grep -qE '^# costs .*; does not keep up: needs [0-9]+ clocks a line, the display has 3$' stdout || fail "$(cat stdout)"

# One per cent more decides nothing: neither look-up tables by area nor clocks by speed; and what decided is told.
planned 0 knot --size 96x72 --frames 1 --json area.json
grep -qE '^# LUTs within 1 % of the fewest count as equal: [0-9.]+ LUTs more than parity \(LANES 1, BEAT_WORDS 1\) buy [0-9]+ % fewer clocks$' stdout || fail "$(cat stdout)"
grep -q '^DSF_BITS: [2-9] ' stdout || fail "$(grep DSF_BITS stdout)"
json area.json 'j["least"]["way"] == "parity" and j["least"]["cost"]["luts"] < j["cost"]["luts"] <= 1.01 * j["least"]["cost"]["luts"] and j["cost"]["clocks_per_pixel"] < j["least"]["cost"]["clocks_per_pixel"]'
planned 0 canopy --size 96x72 --frames 1 --prefer speed
grep -qE '^# clocks within 1 % of the fewest count as equal: 0\.[0-9] % more than .* save [0-9]+ LUTs$' stdout || fail "$(cat stdout)"
planned 0 depths --size 64x48 --frames 1 --json -
json stdout 'j["least"] is None'
# A reason says by words what goes up and what down.
planned 0 courtyard --size 160x120 --frames 1 --prefer speed --json speed.json
grep -qE '^# speed against the smallest: [0-9]+ % fewer clocks \([0-9.]+ a pixel, not [0-9.]+\) for \+[0-9]+ LUTs, [+-][0-9]+ flip-flops, [+-][0-9]+ bits of RAM, [+-][0-9]+ bits a pixel$' stdout || fail "$(cat stdout)"
luts=$(sed -n 's/^# speed against the smallest: .* for +\([0-9]*\) LUTs, .*/\1/p' stdout)
json speed.json "abs(j['cost']['luts'] - j['smallest']['cost']['luts'] - $luts) <= 0.5"
grep -qE '^LANES: .*; [0-9]+ would take [0-9]+ % more clocks and [0-9]+ LUTs fewer$' stdout || fail "$(grep LANES stdout)"
for case in "courtyard --size 160x120" "courtyard --size 1x1" "knot --size 1x1 --max-color 3" "three-lights --size 2x2 --samples 1"; do
  # shellcheck disable=SC2086
  planned 0 $case --frames 1
  ! grep -qE '(^|[^0-9.])1 (lines|lights|steps|bits hold|pixels|samples|classes|volumes)' stdout || fail "$case: $(cat stdout)"
done

# Notes that render gives on a mesh stand in the plan as well, in comments.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >mesh.obj
planned 0 mesh.obj --size 64x48 --frames 1 --json notes.json
grep -q '^# mesh: no light: a directional one is added$' stdout || fail "$(cat stdout)"
json notes.json '"mesh: no camera: an orbit round the scene is added" in j["notes"]'
expect 0 "$kage" render mesh.obj --size 64x48 --frames 1 --out out
for note in "mesh: no light" "mesh: no camera"; do grep -q "^$note" stdout || fail "render does not say: $note"; done
# Its caster is open, so parity may have several volumes for it, though this frame has one: commands take the plan's file.
planned 0 mesh.obj --size 64x48 --frames 1
cp stdout mesh.yaml
grep -q '^DSF_BITS: 1 ' mesh.yaml && grep -q '^FSF: 1 ' mesh.yaml || fail "$(cat mesh.yaml)"
expect 0 "$kage" render mesh.obj --size 64x48 --frames 1 --config mesh.yaml --out out

# Measured: fewer bits for whom wrong pixels do not matter.
"$kage" plan courtyard --size 64x48 --frames 1 --guarantee measured --max-wrong 3000 >few.yaml || fail "no measured plan"
joined few.yaml
[ "$(sed -n 's/^Z_BITS: \([0-9]*\).*/\1/p' few.yaml)" -lt 24 ] || fail "$(grep Z_BITS few.yaml)"
grep -qE '^Z_BITS: .*# measured: [0-9]+ give [0-9.e+-]+ ppm wrong, .*; [0-9]+ give [0-9.e+-]+ ppm wrong \(over --max-wrong 3000\)' few.yaml || fail "$(grep Z_BITS few.yaml)"
# The head tells of the widths that are printed, and what the reasons tell of where that is another.
planned 0 courtyard --size 64x48 --frames 1 --guarantee measured --json measured.json
grep -qE '^Z_BITS: .*; [0-9]+ give .* \(over --max-z 5.9[0-9.e-]+\)' stdout || fail "$(grep Z_BITS stdout)"
grep -qE '^# measured in these frames: 0 ppm wrong, depth off by [0-9.e-]+, colour by [01] steps?, light by 0\.[0-9]+; allowed: --max-z 5.96e-08, --max-color 1$' stdout || fail "$(cat stdout)"
grep -qE '^# measured before the next steps were taken, with Z_BITS [0-9]+, Z_FRAC [0-9]+, SHADE_FRAC [0-9]+, CLASS_BITS [0-9]+: ' stdout || fail "$(cat stdout)"
json measured.json 'j["measured"]["z_error"] <= j["limits"]["max_z"] and j["measured"]["color_steps"] <= 1 and 0 < j["measured"]["light_rms"] <= 1 and j["measured"]["before_steps"]["config"]["Z_FRAC"] < j["config"]["Z_FRAC"]'
z=$(sed -n 's/^# measured in these frames: .*depth off by \([0-9.e-]*\),.*/\1/p' stdout)
json measured.json "abs(j['measured']['z_error'] / $z - 1) < 0.01"

# Where the bound ends, pictures go on: finer widths are tried, and what fails is named with what was measured.
planned 0 penumbra --size 64x48 --frames 1 --samples 3 --guarantee measured --json wider.json
grep -qE '^# measured in these frames: .*, colour by [01] steps?, light by 0\.[0-9]+; allowed: --max-z 5.96e-08, --max-color 1$' stdout || fail "$(cat stdout)"
grep -qE '^SHADE_FRAC: .*; [0-9]+ give .* \(over --max-color 1\)' stdout || fail "$(grep SHADE_FRAC stdout)"
json wider.json 'j["limits"]["max_color"] == 1 and j["measured"]["color_steps"] <= 1'

# A way that keeps the limit is planned, whatever another way is sure of; and the progress ends at the whole.
planned 0 three-lights --size 160x48 --frames 1 --samples 255 --max-shading 0 --max-color 3
grep -q '^LINEAR_BITS: 0 ' stdout || fail "$(cat stdout)"
planned 0 three-lights --size 160x48 --frames 1 --samples 255 --max-shading 0
grep -q '^LINEAR_BITS: 0 ' stdout || fail "$(cat stdout)"

# Light after light: where no table keeps the limit, by its own figure or by pictures, and where there are more lights than it has.
planned 0 three-lights --size 48x36 --frames 2 --samples 31 --guarantee measured --json linear.json
grep -qE '^CLASS_BITS: 1 .*; with a table light is [0-9.]+ steps off, root mean square, more than --max-color 1$' stdout || fail "$(cat stdout)"
json linear.json 'j["config"]["LINEAR_BITS"] >= 10 and j["config"]["COUNT_BITS"] == 5 and 0 < j["measured"]["light_rms"] <= 1'
planned 0 inside --size 64x48 --frames 1 --guarantee measured --json linear.json
grep -qE '^CLASS_BITS: 1 .*; with a table light is [0-9.]+ steps off, root mean square, more than --max-color 1$' stdout || fail "$(cat stdout)"
json linear.json 'j["config"]["LINEAR_BITS"] >= 10 and 0 < j["measured"]["light_rms"] <= 1'
planned 0 three-lights --size 48x36 --frames 1 --max-color 8 --json table.json
json table.json 'j["config"]["LINEAR_BITS"] == 0 and any("light after light" in c["way"] for c in j["others"])'
planned 0 three-lights --size 48x36 --frames 1 --max-color 1
grep -q '^CLASS_BITS: 1 .*; with a table no widths keep --max-color 1$' stdout || fail "$(cat stdout)"
planned 0 three-lights --size 48x36 --frames 1
grep -qE '^CLASS_BITS: 1 .*; 2047 classes leave shadows [0-9.]+ steps off, root mean square, in frame 0, more than --max-color 1$' stdout || fail "$(cat stdout)"
python3 - "$source/scenes/three-lights.gltf" >twelve.gltf <<'PY'
import json, sys
scene = json.load(open(sys.argv[1]))
for i in range(9):
    scene["scenes"][0]["nodes"].append(len(scene["nodes"]))
    scene["nodes"].append({"rotation": [-0.4, 0.01 * i, 0, 0.9], "extensions": {"KHR_lights_punctual": {"light": 1}}})
print(json.dumps(scene))
PY
planned 0 twelve.gltf --size 48x36 --frames 1 --alpha 0.5
grep -q '^LINEAR_BITS: 0 .*# no shadows$' stdout || fail "$(cat stdout)"
for guarantee in bound measured; do
  planned 0 twelve.gltf --size 48x36 --frames 1 --samples 3 --guarantee $guarantee
  grep -q '^LIGHTS: 1 .*one counter for 12 lights, one after the other; a table tells 8 apart at most$' stdout || fail "$(cat stdout)"
  cp stdout twelve.yaml
  expect 0 "$kage" render twelve.gltf --size 48x36 --frames 1 --samples 3 --config twelve.yaml --out out
done
planned 0 three-lights --size 64x48 --frames 1 --guarantee measured
grep -v '^# kage' stdout >default_color
planned 0 three-lights --size 64x48 --frames 1 --guarantee measured --max-color 1
grep -v '^# kage' stdout | cmp - default_color || fail "--max-color 1 is not the default"
trouble "the finest widths (Z_BITS 28, Z_FRAC 16, SHADE_FRAC 16, CLASS_BITS 11) give 0 ppm wrong, depth off by " \
  "$kage" plan courtyard --size 64x48 --frames 1 --guarantee measured --max-z 1e-9
grep -qE ' \(over --max-z 1e-09\), colour by [01] steps?, light by 0\.[0-9]+$' stderr || fail "$(cat stderr)"

trouble "--max-wrong: how many pixels a bit moves is a property of the scene: it needs --guarantee measured" \
  "$kage" plan courtyard --max-wrong 3
trouble "--max-z 1e-09: with 28 bits of depth the bound is " "$kage" plan courtyard --size 64x48 --frames 1 --max-z 1e-9
trouble "--fps, --total-lines: of a display that the core keeps up with; --clock MHZ or --device NAME says how fast the core is" \
  "$kage" plan courtyard --fps 30
trouble "--total-lines 48: a frame's time holds the picture's 48 lines and a blank one at least" \
  "$kage" plan courtyard --size 64x48 --frames 1 --clock 50 --total-lines 48
planned 0 courtyard --size 64x48 --frames 1 --clock 50 --total-lines 49
trouble "courtyard: given twice" "$kage" plan courtyard glass courtyard
trouble "--device up9k: no core was placed there; there are ecp5-25f" "$kage" plan courtyard --device up9k
trouble "nowhere.obj" "$kage" plan nowhere.obj
trouble "random: random frames are for" "$kage" plan random
mkdir pack && echo "{}" >pack/manifest.json
trouble "pack: a folder of kage vectors is no scene: kage board plays it, kage vectors --check reads it" "$kage" plan pack
trouble "a.kage: a stream has its configuration already" "$kage" plan a.kage
trouble "--max-color 1: no widths keep it, because shares of 16 bits fraction are off by more; --max-color 2 can be kept" "$kage" plan three-lights --frames 1 --max-color 1
done_testing
