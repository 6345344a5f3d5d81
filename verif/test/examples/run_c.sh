#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the C example as docs/testbenches.md says and runs it: sound, with each defect, and on what it must refuse.
# usage: run_c.sh KAGE SOURCE LIBRARY_FOLDER [COMPILER_FLAG...]
. "$(dirname "$0")/../cli/common.bash"
library=$3
flags=("${@:4}")

cc -std=c99 -O2 -Wall -Wextra -Wpedantic -Werror "${flags[@]}" -I"$source/ref/include" "$source"/examples/c/*.c \
  -L"$library" -lkage_golden -Wl,-rpath,"$library" -o pixel_check || { fail "the example does not build"; done_testing; }
expect 0 "$kage" stream courtyard --size 64x48 --frames 2 --config default --out courtyard.kage
expect 0 ./pixel_check courtyard.kage
grep -qE '^same: 2 frames, [0-9]{4,} tokens, [0-9]{6,} values checked$' stdout || fail "does not say same: $(cat stdout)"
grep -qxF "$(cat stdout)" "$source/docs/testbenches.md" || fail "docs/testbenches.md shows another line"
cat stdout
expect 0 "$kage" stream inside --size 64x48 --frames 2 --config default --out inside.kage # the eye in a shadow: NC and IF
expect 0 ./pixel_check inside.kage
expect 0 "$kage" info inside.kage --tokens 0
grep -q ' IF ' stdout || fail "no IF in the stream"

# told PATTERN DEFECT: exit 1, and one line with token, pixel and field.
told() {
  expect 1 ./pixel_check courtyard.kage "$2"
  grep -qE "^different: frame 0, line [0-9]+, token [0-9]+ \($1, expected" <(sed 's/: expected/, expected/' stdout) ||
    fail "$2: $(cat stdout)"
  grep -qxF "$(cat stdout)" "$source/docs/testbenches.md" || [ "$2" = flag ] || fail "docs/testbenches.md shows another line"
  cat stdout
}
told 'OP \[.*\), pixel [0-9]*[13579], field z' depth
told 'EV \[.*\), pixel [0-9]+, field dsf' flag

expect 2 ./pixel_check nowhere.kage
grep -q 'nowhere.kage' stderr || fail "does not name the file: $(cat stderr)"
expect 0 "$kage" stream glass --size 64x48 --frames 1 --config glass --out glass.kage
expect 2 ./pixel_check glass.kage
grep -q 'TRANSLUCENCY is not 0' stderr || fail "does not say why: $(cat stderr)"
# Nothing but the interface can be seen of the library.
[ "$(nm -D --defined-only "$library/libkage_golden.so" | grep -vc ' kage_golden_')" = 0 ] || fail "the library shows more than its interface"
done_testing
