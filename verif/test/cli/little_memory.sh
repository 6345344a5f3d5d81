#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Programs that get little memory or little stack end with their work done, or with one line and exit code 2; none hangs.
# Prints the least memory with which each command did its work (docs/building.md).
. "$(dirname "$0")/common.bash"

# Faces through one another, so that the order takes some 100 MB.
python3 - <<'PY'
import random
random.seed(5)
with open("soup.obj", "w") as f:
    for _ in range(230):
        for _ in range(3):
            f.write("v %.2f %.2f %.2f\n" % tuple(random.gauss(0, 3) for _ in range(3)))
        f.write("f -3 -2 -1\n")
PY
expect 0 "$kage" cosim courtyard --size 64x48 --frames 1 --out r # the RTL model is there from now on

# with_limit OPTION KIB COMMAND...: under that ulimit; the exit code lands in $rc. The file for the output belongs to the
# shell, so that its size is no matter.
with_limit() {
  local option=$1 kib=$2
  shift 2
  rc=0
  (ulimit -c 0 && ulimit "$option" "$kib" && exec timeout -s KILL 60 "$@") >stdout 2>stderr </dev/null || rc=$?
  case $rc in
    0) ;;
    2) [ "$(wc -l <stderr)" = 1 ] && grep -q '^kage: ' stderr || fail "ulimit $option $kib, $* : $(cat stderr)" ;;
    127) grep -q 'cannot allocate\|failed to map' stderr || fail "ulimit $option $kib, $* : $(cat stderr)" ;; # the loader's own words
    *) fail "ulimit $option $kib, $* : exit $rc, $(cat stderr)" ;;
  esac
}

work() { # NAME COMMAND...
  local name=$1 least=
  shift
  for mib in 6 12 20 24 30 36 42 48 60 80 120 200 400 420 430 440 480 500 600; do
    with_limit -v $((mib * 1024)) "$@"
    if [ $rc = 0 ]; then least=${least:-$mib}; else least=; fi
  done
  for kib in 32 64 512 1023 1024; do with_limit -s $kib "$@"; done
  [ "$rc" = 0 ] || fail "$name: a stack of 1 MiB is not enough: $(cat stderr)"
  [ -n "$least" ] || { fail "$name: 600 MiB are not enough: $(cat stderr)"; return; }
  echo "$name: $least MiB are enough"
}
work "kage --version" "$kage" --version
work "kage stream" "$kage" stream courtyard --size 64x48 --frames 2 --out s.kage
work "kage render" "$kage" render glass --size 64x48 --frames 2 --out r
work "kage diff" "$kage" diff r r
work "kage cosim" "$kage" cosim courtyard --size 64x48 --frames 2 --out r
work "kage order" "$kage" order soup.obj --eyes 2 --threads 2
with_limit -s 64 "$kage" --version
grep -q 'the stack may have 64 KiB only (ulimit -s), and 1024 are needed' stderr || fail "the stack: $(cat stderr)"
done_testing
