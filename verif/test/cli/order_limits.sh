#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Faces through one another, which are cut into more and more: the build of their order says how far it is, ends at
# Ctrl-C, and is refused past --max-fragments, in every command that makes frames.
. "$(dirname "$0")/common.bash"

soup() { # N: so many triangles through one another
  python3 - "$1" <<'PY'
import random, sys
random.seed(1)
n = int(sys.argv[1])
for i in range(n):
    p, q, m = ([random.uniform(-1, 1) for _ in range(3)] for _ in range(3))
    for c in (p, q, [-a - b for a, b in zip(p, q)]):
        length = sum(x * x for x in c) ** 0.5
        print("v", *(f"{0.1 * m[k] + 2 * c[k] / length:.4f}" for k in range(3)))
for i in range(n):
    print("f", 3 * i + 1, 3 * i + 2, 3 * i + 3)
PY
}
soup 20 >few.obj
soup 100 >some.obj
soup 500 >many.obj

# Past the limit: one line with file, frame, cause and option, and nothing is written.
run=(few.obj --alpha 0.3 --size 64x48 --frames 2)
for command in "render" "cosim" "stream" "explain --pixel 3,3"; do
  out=(--out none)
  [[ $command != explain* ]] || out=()
  # shellcheck disable=SC2086
  trouble "few.obj: frame 0: to be put in order, polygons would be cut into more than 900 fragments (--max-fragments)" \
    "$kage" $command "${run[@]}" --max-fragments 900 "${out[@]}"
  [ ! -e none ] || { fail "$command leaves something"; rm -rf none; }
  trouble "--max-fragments" "$kage" ${command%% *} "${run[@]}" --max-fragments -1 "${out[@]}"
done
trouble "few.obj: to be put in order, polygons would be cut into more than 900 fragments (--max-fragments)" \
  "$kage" order few.obj --max-fragments 900
# The limit is the number that order tells.
expect 0 "$kage" order few.obj --eyes 2 --repeats 1 --json few.json
fragments=$(python3 -c 'import json; print(json.load(open("few.json"))[0]["fragments"])')
[ "$fragments" -gt 900 ] || fail "few.obj has only $fragments fragments"
expect 0 "$kage" stream "${run[@]}" --max-fragments "$fragments" --out few.kage
trouble "more than $((fragments - 1)) fragments" "$kage" stream "${run[@]}" --max-fragments $((fragments - 1)) --out none
expect 0 "$kage" explain "${run[@]}" --max-fragments "$fragments" --pixel 30,20
trouble "few.kage: --max-fragments: a stream has its fragments already" "$kage" render few.kage --max-fragments 5
# A run that needs no order needs no limit.
expect 0 "$kage" stream "${run[@]}" --max-fragments 5 --order centroid --out whole.kage

# Progress, once for a tree that is kept: percentages that never get less, and lines in no more than the asked-for pace.
for command in render stream "explain --pixel 30,20" cosim; do
  out=(--out "out-${command%% *}")
  [[ $command != explain* ]] || out=()
  # shellcheck disable=SC2086
  expect 0 env KAGE_PROGRESS=0.000001 "$kage" $command some.obj --alpha 0.3 --size 64x48 --frames 1 "${out[@]}"
  grep -o 'some: order of translucent faces: [0-9]* %' stderr | grep -o '[0-9]*' >percent
  [ "$(sort -nu percent | wc -l)" -ge 5 ] || { fail "$command: no progress of the order"; cat stderr; }
  sort -nc percent || fail "$command: the progress goes back"
  [ "$(tail -1 percent)" = 100 ] || fail "$command: the progress ends at $(tail -1 percent) %"
done
expect 0 env KAGE_PROGRESS=0.000001 "$kage" order some.obj --eyes 2 --repeats 1
grep -q 'some.obj: visibility order: [0-9]* %' stderr || fail "order: no progress of its build"

# Ctrl-C while the order is built, which would take minutes: soon over, 130, nothing left.
for command in "render --out gone" "cosim --out gone" "stream --out gone.kage" "explain --pixel 3,3" order; do
  options=(--alpha 0.3 --size 64x48 --frames 1)
  [ "$command" != order ] || options=()
  python3 - "$kage" "$command" "${options[@]}" <<'PY' || fail "$command: Ctrl-C while the order is built"
import os, signal, subprocess, sys, time
kage, command, *options = sys.argv[1:]
name, *rest = command.split()
p = subprocess.Popen([kage, name, "many.obj", *options, *rest], stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                     env={**os.environ, "KAGE_PROGRESS": "0.1"})
line = ""
while "order" not in line or "%" not in line:
    line = p.stderr.readline()
    if not line:
        sys.exit("no progress line; exit code %s" % p.wait())
p.send_signal(signal.SIGINT)
start = time.monotonic()
out, err = p.communicate(timeout=60)
took = time.monotonic() - start
if p.returncode != 130 or "interrupted" not in err or out or took > 20:
    sys.exit("exit code %d after %.1f s: %s%s" % (p.returncode, took, out, err))
PY
done
[ -z "$(find . -name 'gone*')" ] || fail "something is left: $(find . -name 'gone*')"
no_leftovers
done_testing
