#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every path of a board's netlist from a flip-flop or RAM of one clock to one of another is where a board may have one: in an
async_fifo, in a synchronizer, in tmds_shifter; and the board's README lists exactly these.

usage: crossings.py BOARD [--show]
       crossings.py --self-test

  BOARD        in constraints/boards/boards.yaml
  --show       print the rows that README.md must have
  --self-test  show that a crossing elsewhere, and a list that is not the netlist's, are found

Needs yosys, which reads the RTL as it is synthesized, up to flip-flops and RAMs. Exit status 0: all is as listed; 1: not so.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

import yaml

TOP = pathlib.Path(__file__).resolve().parent.parent.parent.parent
BOARDS = TOP / "constraints/boards"
FAMILIES = {"ecp5": ["+/ecp5/cells_sim.v", "+/ecp5/cells_bb.v"], "ice40": ["+/ice40/cells_sim.v"]}
# Where a path from clock to clock may be, by the module that the path ends in.
PLACES = {"async_fifo", "synchronizer", "tmds_shifter"}


def netlist(board, family, extra, folder):
    """The modules of the design, and its top as one module of flip-flops, RAMs and logic."""
    values = board["core"] | board["board"]
    sets = " ".join(f"-chparam {k} {v}" for k, v in values.items())
    sources = f"rtl/*.sv rtl/board/*.sv constraints/boards/{board['top']}/*.sv"
    read = "read_verilog -defer -sv -Irtl/include -Irtl/board/include"
    script = (
        f"read_verilog -lib {' '.join(FAMILIES[family])}; "
        f"{read} {sources}; {f'{read} -overwrite {extra}; ' if extra else ''}hierarchy -top {board['top']} {sets}; delete =A:whitebox; proc; "
        f"write_json {folder}/modules.json; flatten; opt_clean; memory_collect; write_json {folder}/flat.json"
    )
    done = subprocess.run(["yosys", "-q", "-p", script], cwd=TOP, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"yosys: {(done.stderr.strip() or done.stdout.strip()).splitlines()[-1]}")
    modules = json.loads((folder / "modules.json").read_text())["modules"]
    flat = json.loads((folder / "flat.json").read_text())["modules"]
    return modules, flat[next(n for n in flat if plain(n) == board["top"])]


def plain(name):
    return next(part for part in name.split("\\")[1:] if part) if name.startswith("$paramod") else name


def places(modules, top):
    """The module of each instance, by its path."""
    out = {}

    def walk(name, path):
        for cell, what in modules[name]["cells"].items():
            if what["type"] in modules and modules[what["type"]]["cells"]:
                out[path + cell] = plain(what["type"])
                walk(what["type"], f"{path}{cell}.")

    walk(next(n for n in modules if plain(n) == top), "")
    return out


def instance_of(cell):
    """The path of the instance that a flip-flop was in before all became one module: $flatten\\u_a.\\u_b.$procdff$7."""
    if not cell.startswith("$flatten"):
        return ""
    return ".".join(part.lstrip("\\") for part in cell[len("$flatten") :].split(".$")[0].split(".") if part)


class Netlist:
    def __init__(self, module):
        self.names = {}  # bit: the shortest name that a person gave it
        for name, net in sorted(
            module["netnames"].items(), key=lambda n: (n[1]["hide_name"], n[0].count("."), len(n[0]), n[0])
        ):
            for bit in net["bits"]:
                self.names.setdefault(bit, name)
        self.driver = {}  # bit: (cell's name, cell)
        self.storage = []  # (register's name, clock, bits that go in)
        self.of_clock = {}  # bit that a flip-flop or RAM gives: (register's name, its clock)
        for name, cell in module["cells"].items():
            connections, directions = cell["connections"], cell["port_directions"]
            outs = [b for p, bits in connections.items() if directions[p] == "output" for b in bits]
            ins = [b for p, bits in connections.items() if directions[p] == "input" for b in bits]
            if re.match(r"\$(a|s)?dff", cell["type"]) or cell["type"].startswith("$sdff"):
                clock = connections["CLK"][0]
                register = f"{instance_of(name)}.{self.names.get(outs[0], name).rpartition('.')[2]}".lstrip(".")
                self.storage.append(
                    (
                        register,
                        clock,
                        [b for p, bits in connections.items() if directions[p] == "input" and p != "CLK" for b in bits],
                    )
                )
                self.of_clock.update((b, (register, clock)) for b in outs)
            elif cell["type"].startswith("$mem"):
                # A word is written by one clock and, as logic, read at once by whoever has the address.
                self.driver.update((b, connections["RD_ADDR"]) for b in connections["RD_DATA"])
                if not connections["WR_CLK"]:
                    continue  # a table
                clock = connections["WR_CLK"][0]
                memory = cell["parameters"]["MEMID"].lstrip("\\")
                self.storage.append(
                    (memory, clock, [b for p in ("WR_EN", "WR_ADDR", "WR_DATA") for b in connections[p]])
                )
                self.of_clock.update((b, (memory, clock)) for b in connections["RD_DATA"])
            elif cell["type"] in ("EHXPLLL", "SB_PLL40_CORE"):
                pass  # its outputs are clocks, and its lock, of no clock
            elif cell["type"] == "ODDRX1F":
                self.storage.append((name, connections["SCLK"][0], connections["D0"] + connections["D1"]))
            else:
                self.driver.update((b, ins) for b in outs)

    def sources(self, bits):
        """The flip-flops and RAMs that logic brings these bits from."""
        seen, found, waiting = set(), set(), [b for b in bits if isinstance(b, int)]
        while waiting:
            bit = waiting.pop()
            if bit in seen:
                continue
            seen.add(bit)
            if bit in self.of_clock:
                found.add(self.of_clock[bit])
            if bit in self.driver:
                waiting += [b for b in self.driver[bit] if isinstance(b, int)]
        return found


def crossings(module, instances):
    """{(instance, its module, clock from, clock to)}, and [text] of those that lie elsewhere."""
    net = Netlist(module)
    found, elsewhere = set(), []
    for register, clock, bits in net.storage:
        for source, other in net.sources(bits):
            if other == clock:
                continue
            between = (net.names.get(other, "?"), net.names.get(clock, "?"))
            path = register
            while path and instances.get(path) not in PLACES:
                path = path.rpartition(".")[0]
            # A synchronizer of an async_fifo is a part of it.
            if path and instances.get(path.rpartition(".")[0]) == "async_fifo":
                path = path.rpartition(".")[0]
            if path:
                found.add((path, instances[path], *between))
            else:
                elsewhere.append(f"{source} of {between[0]} reaches {register} of {between[1]}")
    return found, sorted(set(elsewhere))


def rows(found):
    """An async_fifo has paths both ways; a row has the way of its words, which leave with its output's clock."""
    out = {}
    for path, module, a, b in sorted(found):
        out.setdefault((path, module), set()).add((a, b))
    return [
        f"| `{p}` | `{m}` | {' and '.join(sorted({c for pair in pairs for c in pair}))} |"
        for (p, m), pairs in sorted(out.items())
    ]


def rows_of(text, name):
    """The rows that a README lists: below the heading with the board's name, where boards of one top have headings."""
    sections = [s for s in re.split(r"^#+ ", text, flags=re.M) if f"`{name}`" in s.split("\n", 1)[0]]
    return [line for line in "".join(sections or [text]).splitlines() if line.startswith("| `u_")]


def check(name, extra="", listed=None, show=False):
    """What is wrong with a board, a sentence each."""
    board = yaml.safe_load((BOARDS / "boards.yaml").read_text())[name]
    family = yaml.safe_load((TOP / "constraints/devices.yaml").read_text())[board["device"]]["family"]
    with tempfile.TemporaryDirectory() as folder:
        modules, top = netlist(board, family, extra, pathlib.Path(folder))
    found, elsewhere = crossings(top, places(modules, board["top"]))
    want = rows(found)
    if show:
        print("\n".join(want))
        return []
    readme = BOARDS / board["top"] / "README.md"
    have = listed if listed is not None else rows_of(readme.read_text(), name)
    wrong = [f"{name}: {text}, in no async_fifo, synchronizer or tmds_shifter" for text in elsewhere]
    wrong += [f"{name}: {readme.relative_to(TOP)} lacks {row}" for row in want if row not in have]
    wrong += [
        f"{name}: {readme.relative_to(TOP)} lists what the netlist has not: {row}" for row in have if row not in want
    ]
    if not want:
        wrong.append(f"{name}: no crossing found: this script sees nothing")
    return wrong


def main():
    if "--help" in sys.argv or len(sys.argv) < 2:
        print(__doc__)
        return 2
    if sys.argv[1] == "--self-test":
        board = "ulx3s_25f"
        told = check(board, listed=["| `u_nowhere` | `async_fifo` | clk and clk |"])
        text = "# Two\n## `one`\n| `u_a` |\n| clk |\n## `one_more`\n| `u_b` |\n"
        assert rows_of(text, "one_more") == ["| `u_b` |"] and rows_of(text, "none") == ["| `u_a` |", "| `u_b` |"]
        assert any("lists what the netlist has not" in t for t in told) and any("lacks" in t for t in told), told
        source = (TOP / "constraints/boards/ulx3s/ulx3s.sv").read_text()
        with tempfile.TemporaryDirectory() as folder:
            # The same board with a flip-flop of the pixels' clock that looks at one of the memory's.
            changed = pathlib.Path(folder) / "ulx3s.sv"
            changed.write_text(
                source.replace(
                    "  logic unused;\n",
                    "  logic looks_q;\n  always_ff @(posedge pix_clk) looks_q <= dq_oe;\n  assign wifi_gpio0 = looks_q;\n  logic unused;\n",
                ).replace("  assign wifi_gpio0 = 1'b1;\n", "")
            )
            told = check(board, extra=changed)
        assert any("reaches" in t and "looks_q" in t for t in told), told
        return 0
    wrong = check(sys.argv[1], show="--show" in sys.argv)
    print("\n".join(wrong), end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
