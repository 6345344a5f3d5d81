#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Random frames as a source: kage cosim random, random:damaged, random:mixed; what they reach; what is kept of one that differs.
. "$(dirname "$0")/common.bash"

echo '{MAX_WIDTH: 64, LANES: 4, TRANSLUCENCY: 1}' >small.yaml
for kind in random random:damaged random:mixed; do
  expect 0 "$kage" cosim $kind --frames 60 --config small.yaml --idle 20 --backpressure 20 --out sound --json $kind.json
  json $kind.json 'j["same"] is True and j["frames"] == 60 and j["kept"] is None and j["pictures"] == []'
done
[ -s sound/report.html ] && [ -z "$(find sound -name "*.png")" ] || fail "pictures of random frames that are the same"
expect 0 "$kage" cosim random:mixed --frames 60 --config small.yaml --idle 20 --backpressure 20 --jobs 3 --out sound --json again.json
json again.json 'j["cycles"] == json.load(open("random:mixed.json"))["cycles"]'
expect 0 "$kage" cosim random --frames 60 --config small.yaml --seed 2 --out sound --json other.json
json other.json 'j["pixels_compared"] != json.load(open("random.json"))["pixels_compared"]'
expect 0 "$kage" cosim random:damaged --frames 60 --config small.yaml --frame 59 --out sound --json alone.json
json alone.json 'j["frames"] == 1 and j["first_frame"] == 59'

# The coverage that is reached.
expect 0 "$kage" cosim random:mixed --frames 300 --config small.yaml --coverage --out sound --json c.json
json c.json 'j["coverage"]["frames"] == 300 and all(p["frames"] > 0 for p in j["coverage"]["points"] if p["group"] == "token")'
grep -q 'OP as deep as what it meets .* of 300 frames' stdout || fail "no coverage told: $(cat stdout)"

# A defect: it is found, named, kept small, and the kept frame shows it again.
expect 1 "$kage" cosim random --frames 60 --config small.yaml --fault wrong_compare --out broken --json b.json --junit b.xml
json b.json 'j["first_difference"]["divergence"]["module"] == "pixel_banked"'
json b.json 'j["kept"]["alone"] and j["kept"]["lines"] == 1 and j["kept"]["tokens"] <= 4 and j["kept"]["width"] == 1'
file=$(python3 -c 'import json; print(json.load(open("b.json"))["kept"]["file"])')
grep -qF "that frame again: kage cosim $file --seed 1 --fault wrong_compare --out ${file%/*}/again" stdout || fail "not told how to run it again: $(cat stdout)"
expect 1 "$kage" cosim "$file" --fault wrong_compare --out kept
expect 0 "$kage" cosim "$file" --out kept
expect 0 "$kage" info "$file"
expect 1 "$kage" cosim random --frames 60 --config small.yaml --fault wrong_compare --no-shrink --out broken --json n.json
json n.json 'j["kept"]["words"] == j["kept"]["words_before"] and j["kept"]["words"] > 12'
frame=$(python3 -c 'import json; print(json.load(open("b.json"))["first_difference"]["frame"])')
expect 1 "$kage" cosim random --frames 60 --config small.yaml --fault wrong_compare --frame "$frame" --out one
expect 0 "$kage" explain random --frames 60 --config small.yaml --frame "$frame" --pixel 0,0

# A core that loses tokens under stalls: frames that break rules are kept as they are.
expect 1 "$kage" cosim random:damaged --frames 200 --config small.yaml --fault lost_token --idle 30 --backpressure 30 --no-divergence --out lost --json l.json
json l.json 'j["kept"]["words"] <= j["kept"]["words_before"]'
expect 0 "$kage" info "$(python3 -c 'import json; print(json.load(open("l.json"))["kept"]["file"])')"

# Shards, each with its own largest frame: joined they are the whole run, coverage too.
expect 0 "$kage" cosim random --config tiny --frames 41 --coverage --no-report --out whole --json whole.json
for i in 1 2 3; do
  expect 0 "$kage" cosim random --config tiny --frames 41 --coverage --no-report --out whole --shard $i/3 --json part$i.json
done
json part1.json '[j["width"], j["height"]] != (lambda k: [k["width"], k["height"]])(json.load(open("part2.json")))'
expect 0 "$kage" merge part2.json part3.json part1.json --json joined.json
grep -q '^same: 41 frames of 41 in 3 shards, up to ' stdout && grep -q '^token:$' stdout || fail "joined: $(cat stdout)"
json joined.json 'all(j[k] == json.load(open("whole.json"))[k] for k in ("width", "height", "pixels_compared", "spans", "coverage"))'

# A difference that takes two frames in the core at once is not located, and the output says so, whichever of them has wrong
# pixels.
mixed=("$kage" cosim random:mixed --config small.yaml --fault lost_token --idle 30 --backpressure 30)
expect 1 "${mixed[@]}" --seed 189 --out mixed --json behind.json
json behind.json 'j["first_difference"]["frame"] == 0 and j["first_difference"]["line"] == 0'
grep -q '^no stage differs where the frame ahead has ended before: ' stdout || fail "where to look: $(cat stdout)"

# It takes a frame right before it: --frame repeats it.
json behind.json 'not j["kept"]["alone"] and j["kept"]["in_place"] and j["kept"]["takes"] == "a reset or another frame right before it"'
grep -q '^alone, on a new core, it comes out the same: it takes a reset or another frame right before it$' stdout || fail "what it takes: $(cat stdout)"
again=$(sed -n 's/^that frame again: kage \(.* --frame 0\)$/\1/p' stdout)
[ -n "$again" ] || fail "no line that repeats it: $(cat stdout)"
expect 1 "$kage" $again --no-divergence
grep -q '^first difference: frame 0, line 0, ' stdout || fail "another difference: $(cat stdout)"

# Where the pixels of the frame ahead are wrong, that one is kept, and no picture of the frame behind it, which is right.
expect 1 "${mixed[@]}" --seed 3 --out mixed --json ahead.json
json ahead.json 'j["first_difference"]["text"].endswith(": the frame right ahead of this one has wrong pixels") and j["pictures"] == []'
json ahead.json 'j["kept"]["ahead"] and j["kept"]["alone"] and j["kept"]["file"].endswith("_ahead.kage")'
grep -q "^the frame right ahead of it: mixed/random_mixed_[0-9]*_ahead.kage: " stdout || fail "what was kept: $(cat stdout)"
[ -z "$(find mixed -name '*.png' -not -path '*/again/*')" ] || fail "pictures that show nothing"
again=$(sed -n 's/^that frame again: kage //p' stdout)
expect 1 "$kage" $again

# A signal while the frame is made smaller: what there is by then is kept. A core that hangs, on long lines with
# stalls, makes it last.
echo '{MAX_WIDTH: 2047, LANES: 4, ARRANGEMENT: 1}' >wide.yaml
silent=(--fault stub_silent --idle 95 --backpressure 95 --no-divergence)
: >ended.err
KAGE_PROGRESS=0.05 "$kage" cosim random --config wide.yaml "${silent[@]}" --no-report --out ended >ended.out 2>ended.err &
pid=$!
until grep -q "making the frame smaller" ended.err || ! kill -0 $pid 2>/dev/null; do sleep 0.02; done
kill -INT $pid
rc=0
wait $pid || rc=$?
[ $rc = 130 ] || fail "after a signal the code is $rc: $(cat ended.out)"
grep -q '^random: interrupted after the verdict$\|^interrupted after the verdict$' ended.out || fail "not said to be interrupted: $(cat ended.out)"
again=$(sed -n 's/^that frame again: kage \([^ ]* [^ ]*\) .*/\1/p' ended.out)
[ -n "$again" ] || fail "the frame is lost: $(cat ended.out)"
expect 1 "$kage" $again "${silent[@]}" --out again

for option in "--size 32x24" --degrade --units-only "--order centroid" "--max-fragments 9" "--samples 3" "--classes 3" "--max-shading 3" "--sub-bits 5" --cull "--alpha 0.5" --allow-outside; do
  # shellcheck disable=SC2086
  trouble "random: ${option%% *}: random frames " "$kage" cosim random $option
done
for command in render "stream --out r.kage" info "info --tokens 0" order; do
  for kind in random random:damaged random:mixed; do
    # shellcheck disable=SC2086
    trouble "$kind: random frames are for kage cosim, kage explain and kage vectors" "$kage" $command $kind
  done
done
trouble "random:foo: no such random frames (there are random, random:damaged, random:mixed)" "$kage" cosim random:foo
trouble "--frame 60: there are 60 frames, from 0 on" "$kage" cosim random --frames 60 --frame 60
trouble "--frame and --shard" "$kage" cosim random --frame 1 --shard 1/2
# Registers are read while the rest of a frame is dropped, once all its lines are out: with this seed that takes more clocks
# than a bound without the picture's size allowed.
expect 0 "$kage" cosim random:mixed --frames 60 --config default --seed 7 --no-report --out registers

no_leftovers
# The registers are right whatever the frames of a seed are: short ones, refused ones.
for seed in {1..25}; do
  expect 0 "$kage" cosim random:mixed --frames 3 --config small.yaml --seed "$seed" --no-report --out mixed
done

# The frames that the register check sends of its own fit into lines of any length, segments of any length and beats of any width
# (unit/cosim/register_frames has all corners). Sound RTL passes them.
for corner in 'MAX_WIDTH: 7, X_BITS: 4, LANES: 4' 'MAX_WIDTH: 1, X_BITS: 4, LANES: 4' \
  'MAX_WIDTH: 1, X_BITS: 4, ARRANGEMENT: 0, UNITS: 2, FACE_BITS: 2, DX_BITS: 2, SEG_BITS: 2, BEAT_WORDS: 8' \
  'MAX_WIDTH: 40, X_BITS: 6, LANES: 8, UNITS: 3, FACE_BITS: 2, DX_BITS: 2, SEG_BITS: 2' \
  'MAX_WIDTH: 40, X_BITS: 6, LANES: 8, UNITS: 2, DX_BITS: 3'; do
  echo "{$corner}" >corner.yaml
  expect 0 "$kage" cosim random:mixed --frames 20 --config corner.yaml --no-report --out corner
done

# Handshakes of AXI4-Lite that work with a master of one habit only, and what registers say of a core that stands still.
for mutant in registers_write_{data,strobes,answered,behind} registers_read_answered registers_waiting_output \
  registers_irq_{error_alone,watchdog_kept} registers_stall_{unit,line,behind,output} registers_starved_thrice top_open; do
  number=$(python3 -c 'import sys, yaml; print([m["name"] for m in yaml.safe_load(open(sys.argv[1]))].index(sys.argv[2]) + 1)' "$source/verif/mutants/mutants.yaml" "$mutant")
  for seed in 1 2 3; do
    expect 1 "$kage" cosim random:mixed --frames 6 --config small.yaml --mutant "$number" --seed $seed --no-report --out registers
    grep -q '^first difference: register check behind the frames: ' stdout || fail "$mutant: found otherwise: $(cat stdout)"
  done
done

# A difference of the register check is of no frame: no stage is looked for, no frame is kept, and the run repeats it.
number=$(python3 -c 'import sys, yaml; print([m["name"] for m in yaml.safe_load(open(sys.argv[1]))].index("registers_shape") + 1)' "$source/verif/mutants/mutants.yaml")
check=(random:mixed --frames 6 --config small.yaml --mutant "$number")
expect 1 "$kage" cosim "${check[@]}" --out check --json check.json --junit check.xml --annotate github
cp stdout said
grep -q '^different: 6 frames, ' said || fail "not all frames: $(cat said)"
grep -q '^first difference: register check behind the frames: SHAPE: expected 0x[0-9a-f]*, got 0x' said || fail "not told: $(cat said)"
grep -q '^::error title=kage cosim random_mixed%3A registers are different::register check' said || fail "no annotation: $(cat said)"
again=$(sed -n 's/^that run again: kage //p' said)
# shellcheck disable=SC2086
[ -n "$again" ] && expect 1 "$kage" $again
json check.json 'j["frames"] == 6 and all(f["same"] for f in j["each"]) and j["kept"] is None and j["pictures"] == []'
json check.json '(d := j["first_difference"])["frame"] is None and d["field"] == "register" and not d["searched"] and d["divergence"] is None'
python3 - <<'PY' || fail "JUnit of the register check"
import xml.etree.ElementTree as xml
cases = [(c.get("name"), c.find("failure") is not None) for c in xml.parse("check.xml").iter("testcase")]
assert cases == [(f"frame {i}", False) for i in range(6)] + [("registers", True)], cases
PY
grep -q 'register check behind the frames: SHAPE' check/report.html || fail "the page does not tell it"
[ -z "$(find check -name '*.kage')" ] || fail "a frame is kept that is not to blame"
expect 1 "$kage" cosim "${check[@]}" --shard 1/1 --no-report --out shards --json shard.json
expect 1 "$kage" merge shard.json --json merged.json --junit merged.xml
json merged.json 'not j["same"] and j["frames"] == 6 and j["first_difference"]["frame"] is None'
grep -q 'name="frame 5" time="[0-9.]*"/>' merged.xml && grep -q 'name="registers"' merged.xml || fail "JUnit of a joined shard"
# Its frames must be all of the shard's.
python3 -c 'import json; j = json.load(open("shard.json")); j["total_frames"] = 7; json.dump(j, open("less.json", "w"))'
trouble "cannot have the 6 that it" "$kage" merge less.json

done_testing
