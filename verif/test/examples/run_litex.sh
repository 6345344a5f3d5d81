#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs examples/litex with the pinned LiteX (tools/deps litex): sound, and with defects of core and wrapper, each of which it must
# tell.
# usage: run_litex.sh KAGE SOURCE
# Exit code 0: as it should be. 1: not. 77: LiteX, or what its simulator is built with, is not installed.
. "$(dirname "$0")/../cli/common.bash"
. "$source/tools/pypi.sh"
litex=$(pypi_folder litex)
[ -d "$litex" ] || { echo "run_litex.sh: LiteX is not installed: tools/deps litex does that"; exit 77; }
printf '#include <event2/event.h>\n#include <json-c/json.h>\n' | cc -E - >/dev/null 2>&1 ||
  { echo "run_litex.sh: libevent or json-c is not installed: tools/deps litex does that"; exit 77; }
export PYTHONPATH=$litex:$source/python PYTHONDONTWRITEBYTECODE=1 KAGE=$kage
# Code that is the same in each simulation, Verilator's own library above all, is compiled once.
if command -v ccache >/dev/null; then export OBJCACHE=ccache CCACHE_DIR=$temp/ccache; fi

expect 0 /usr/bin/python3 "$source/examples/litex/sim.py" --work sound
cat stdout
grep -qxF "$(tail -n 1 stdout)" "$source/examples/litex/README.md" || fail "the README shows another line"
expect 2 /usr/bin/python3 "$source/examples/litex/sim.py" --work nothing --pack nowhere
grep -q '^sim.py: nowhere/manifest.json: ' stderr || fail "does not name the file: $(cat stderr)"
# Parameters by a name, a YAML file and a mapping; what no core can have is refused.
printf 'LANES: 8\nMAX_WIDTH: 320\n' >mine.yaml
PYTHONPATH=$PYTHONPATH:$source/examples/litex /usr/bin/python3 - "$source/rtl" <<'PY' || fail "parameters are not read as they are said"
import pathlib, sys
from kage_litex import parameters_of
rtl = pathlib.Path(sys.argv[1])
assert parameters_of("default", rtl).MAX_WIDTH == 1280
assert parameters_of("mine.yaml", rtl) == parameters_of({"LANES": 8, "MAX_WIDTH": 320}, rtl)
try:
    parameters_of({"LANES": 3}, rtl)
except ValueError as e:
    print(e)
else:
    sys.exit(1)
PY

defective() { # NAME: the example of this folder, with the RTL beside it
  expect 1 /usr/bin/python3 "$1/examples/litex/sim.py" --work "build_$1" --rtl "$1/rtl" --pack sound/pack
}
each_defect litex defective
done_testing
