#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the DPI-C example with Verilator as docs/testbenches.md says and runs it: sound, with each defect, and on what it must refuse.
# usage: run_dpi.sh KAGE SOURCE LIBRARY_FOLDER [LINKER_FLAG...]
. "$(dirname "$0")/../cli/common.bash"
library=$3
flags="-L$library -lkage_golden -Wl,-rpath,$library ${*:4}"
ulimit -c 0 # $fatal aborts

verilator --binary --timing -Wall --top-module pixel_bench -I"$source/ref/include" "$source"/examples/dpi/*.sv -LDFLAGS "$flags" >build.log 2>&1 ||
  { fail "the example does not build"; tail -n 20 build.log; done_testing; }
bench=obj_dir/Vpixel_bench
expect 0 "$kage" stream courtyard --size 64x48 --frames 2 --config default --out courtyard.kage
expect 0 $bench +stream=courtyard.kage
grep -qE '^same: 2 frames, [0-9]{4,} tokens, [0-9]{6,} values checked$' stdout || fail "does not say same: $(cat stdout)"
cat stdout
expect 0 "$kage" stream inside --size 64x48 --frames 2 --config default --out inside.kage # the eye in a shadow: NC and IF
expect 0 $bench +stream=inside.kage

# refused PATTERN ARGUMENT...: an exit code that is not 0, and the pattern on either output.
refused() {
  local pattern=$1
  shift
  if $bench "$@" >said 2>&1; then fail "$*: exit 0"; fi
  grep -qE "$pattern" said || fail "$*: $(cat said)"
  grep -E "$pattern" said
}
refused 'different: frame 0, line [0-9]+, token [0-9]+ \(OP .*\), pixel [0-9]*[13579], field z: expected' +stream=courtyard.kage +defect=depth
refused 'different: frame 0, line [0-9]+, token [0-9]+ \(EV .*\), pixel [0-9]+, field dsf: expected' +stream=courtyard.kage +defect=flag
grep -qxF "$(grep -o 'different: .*' said)" "$source/docs/testbenches.md" || fail "docs/testbenches.md shows another line"
refused 'defect=nonsense: not depth or flag' +stream=courtyard.kage +defect=nonsense
refused 'nowhere.kage: no such file' +stream=nowhere.kage
expect 0 "$kage" stream courtyard --size 65x8 --frames 1 --config default --out wide.kage
refused 'frame 0 is wider than 64 pixels' +stream=wide.kage
expect 0 "$kage" stream courtyard --size 64x8 --frames 1 --config full --out full.kage
refused 'SMOOTH is not 0' +stream=full.kage
done_testing
