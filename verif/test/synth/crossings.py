#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every path of a board's netlist from a flip-flop or RAM of one clock to one of another is one that a board may have.
The board's README lists exactly the modules that have some. Besides, a PLL of ECP5 has its analogue settings. A board
may have:

  synchronizer  to meta_q from a flip-flop with no logic between, because logic may glitch; of several bits only in an async_fifo,
                because no more than one bit may change at a time
  async_fifo    from its mem to its out_q, and what its synchronizers have
  tmds_shifter  to seen_q from its phase_q, and to the registers of the three words from flip-flops with no logic between; from
                pix_clk_i to bit_clk_i alone, which one PLL must make

usage: crossings.py BOARD [--show]
       crossings.py --self-test

  BOARD        in constraints/boards/boards.yaml
  --show       print the rows that README.md must have
  --self-test  show that wrong crossings of each sort, and a list that is not the netlist's, are found

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
PLLS = {"EHXPLLL": "CLKO", "SB_PLL40_CORE": "PLLOUT"}  # and what the names of their clocks begin with


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
        self.nets = {name: net["bits"] for name, net in module["netnames"].items()}
        self.names = {}  # bit: the shortest name that a person gave it
        for name, net in sorted(
            module["netnames"].items(), key=lambda n: (n[1]["hide_name"], n[0].count("."), len(n[0]), n[0])
        ):
            for bit in net["bits"]:
                self.names.setdefault(bit, name)
        self.driver = {}  # bit: (cell's name, cell)
        self.storage = []  # (register's name, instance, clock, bits that go in, bits that come out)
        self.pll = {}  # bit that is a PLL's clock: the PLL
        self.memory_bits = set()  # that RAMs give
        self.of_clock = {}  # bit that a flip-flop or RAM gives: (register's name, its clock)
        for name, cell in module["cells"].items():
            connections = cell["connections"]
            directions = cell.get("port_directions") or {p: "output" if p == "Q" else "input" for p in connections}
            outs = [b for p, bits in connections.items() if directions[p] == "output" for b in bits]
            ins = [b for p, bits in connections.items() if directions[p] == "input" for b in bits]
            if re.match(r"\$(a|s)?dff", cell["type"]) or cell["type"].startswith("$sdff"):
                clock = connections["CLK"][0]
                register = f"{instance_of(name)}.{self.names.get(outs[0], name).rpartition('.')[2]}".lstrip(".")
                self.storage.append(
                    (
                        register,
                        instance_of(name),
                        clock,
                        [b for p, bits in connections.items() if directions[p] == "input" and p != "CLK" for b in bits],
                        outs,
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
                goes_in = [b for p in ("WR_EN", "WR_ADDR", "WR_DATA") for b in connections[p]]
                self.storage.append((memory, memory.rpartition(".")[0], clock, goes_in, []))
                self.memory_bits.update(connections["RD_DATA"])
                self.of_clock.update((b, (memory, clock)) for b in connections["RD_DATA"])
            elif cell["type"] in PLLS:  # its other output is its lock, of no clock
                clocks = [bits for p, bits in connections.items() if p.startswith(PLLS[cell["type"]])]
                self.pll.update((b, name) for bits in clocks for b in bits)
            elif "SCLK" in connections or cell["type"] == "TRELLIS_FF":  # a register at a pad
                clock = connections["SCLK" if "SCLK" in connections else "CLK"][0]
                self.storage.append((name, name.rpartition(".")[0], clock, [b for b in ins if b != clock], []))
                self.of_clock.update((b, (name, clock)) for b in outs)
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


def is_direct(net, bits, foreign):
    """Whether the registers that `foreign` has, as (name, clock), give these bits with no logic between, where they have a part
    in one."""
    return all(
        net.of_clock.get(b) in foreign and b not in net.memory_bits for b in bits if net.sources([b]) & set(foreign)
    )


def why_wrong(net, instances, path, register, clock, outs, foreign):
    """The faults of paths from `foreign`, {(register, clock)}, to a register in the instance `path`; or nothing."""

    def of(name):
        return net.nets.get(f"{path}.{name}", [])

    def goes_into(*names):
        return bool(outs) and set(outs) <= {b for name in names for b in of(name)}

    def gives(bits):
        return {net.of_clock.get(b) for b in bits}

    outer = path.rpartition(".")[0]
    match instances.get(path):
        case "synchronizer":
            if not goes_into("meta_q"):
                return "which is not the synchronizer's meta_q"
            if not foreign <= gives(of("in_i")):
                return "not by in_i, or by logic"
            if not is_direct(net, of("in_i"), foreign):
                return "by logic"
            if len(of("in_i")) > 1 and instances.get(outer) != "async_fifo":
                return "of several bits, in no async_fifo"
            return None
        case "async_fifo":
            if goes_into("out_q") and {name for name, _ in foreign} == {f"{path}.mem"}:
                return None
            return "which in an async_fifo is right from mem to out_q alone"
        case "tmds_shifter":
            if of("bit_clk_i") != [clock] or {c for _, c in foreign} != set(of("pix_clk_i")):
                return "not from pix_clk_i to bit_clk_i"
            if not net.pll.get(clock) or net.pll.get(clock) != net.pll.get(of("pix_clk_i")[0]):
                return "with clocks that one PLL does not make"
            if goes_into("seen_q") and foreign == gives(of("phase_q")):
                return None
            if goes_into("blue_q", "green_q", "red_q") and foreign <= gives(of("words_i")):
                return None if is_direct(net, of("words_i"), foreign) else "by logic"
            return "which is neither seen_q behind phase_q nor a word's register behind a flip-flop"
    return "in no async_fifo, synchronizer or tmds_shifter"


def crossings(module, instances):
    """{(instance, its module, clock from, clock to)}, and [text] of what is wrong."""
    net = Netlist(module)
    found, wrong = set(), []
    for register, path, clock, bits, outs in net.storage:
        foreign = {s for s in net.sources(bits) if s[1] != clock}
        if not foreign:
            continue
        why = why_wrong(net, instances, path, register, clock, outs, foreign)
        for source, other in foreign:
            between = (net.names.get(other, "?"), net.names.get(clock, "?"))
            if why:
                wrong.append(f"{source} of {between[0]} reaches {register} of {between[1]}, {why}")
                continue
            # A synchronizer of an async_fifo is a part of it.
            outer = path.rpartition(".")[0]
            at = outer if instances.get(outer) == "async_fifo" else path
            found.add((at, instances[at], *between))
    return found, sorted(set(wrong))


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


def dead_plls(module):
    """ECP5's PLLs without current in the charge pump: where an analogue setting is left out nextpnr writes 0."""
    return [
        f"{cell} lacks {attribute}"
        for cell, what in module["cells"].items()
        if what["type"] == "EHXPLLL"
        for attribute in ("ICP_CURRENT", "LPF_RESISTOR", "MFG_ENABLE_FILTEROPAMP", "MFG_GMCREF_SEL")
        if what["attributes"].get(attribute, "0").strip() in ("", "0")
    ]


def check(name, extra=(), listed=None, show=False):
    """The faults of a board, with `extra` mutants, a sentence each."""
    board = yaml.safe_load((BOARDS / "boards.yaml").read_text())[name]
    family = yaml.safe_load((TOP / "constraints/devices.yaml").read_text())[board["device"]]["family"]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        modules, top = netlist(board, family, changed(extra, folder), folder)
    found, bad = crossings(top, places(modules, board["top"]))
    want = rows(found)
    if show:
        print("\n".join(want))
        return []
    readme = BOARDS / board["top"] / "README.md"
    have = listed if listed is not None else rows_of(readme.read_text(), name)
    wrong = [f"{name}: {text}" for text in [*bad, *dead_plls(top)]]
    wrong += [f"{name}: {readme.relative_to(TOP)} lacks {row}" for row in want if row not in have]
    wrong += [
        f"{name}: {readme.relative_to(TOP)} lists what the netlist has not: {row}" for row in have if row not in want
    ]
    if not want:
        wrong.append(f"{name}: no crossing found: this script sees nothing")
    return wrong


# (file, its text, the text in its place, what must be told): a board with all of these has each mistake once.
MUTANTS = (
    (
        "constraints/boards/ulx3s/ulx3s.sv",
        "  assign wifi_gpio0 = 1'b1;\n",
        """  // In no place at all.
  logic looks_q;
  always_ff @(posedge pix_clk) looks_q <= dq_oe;
  // A number in binary, of which several bits change at a time.
  logic [3:0] count_q, counted;
  always_ff @(posedge pix_clk) count_q <= count_q + 1'b1;
  synchronizer #(.BITS(4)) u_count (.clk_i(mem_clk), .rst_ni(mem_rst_n), .in_i(count_q), .out_o(counted));
  // By another clock's reset.
  logic flag_q, flagged;
  always_ff @(posedge pix_clk) flag_q <= count_q[0];
  synchronizer u_flag (.clk_i(mem_clk), .rst_ni(rst_n), .in_i(flag_q), .out_o(flagged));
  // Two clocks that are not pix_clk and bit_clk of one PLL, and words by logic.
  logic [7:0] pairs_of_crystal, pairs_of_logic;
  tmds_shifter u_crystal (.pix_clk_i(clk_25mhz), .pix_rst_ni(uart_rst_n), .words_i(30'd0), .bit_clk_i(bit_clk), .pairs_o(pairs_of_crystal));
  tmds_shifter u_logic (.pix_clk_i(pix_clk), .pix_rst_ni(pix_rst_n), .words_i({30{&count_q}}), .bit_clk_i(bit_clk), .pairs_o(pairs_of_logic));
  assign wifi_gpio0 = ^{looks_q, counted, flagged, pairs_of_crystal, pairs_of_logic};
""",
        "of mem_clk reaches looks_q of pix_clk, in no async_fifo, synchronizer or tmds_shifter",
    ),
    ("", "count_q", "", "of mem_clk, of several bits, in no async_fifo"),
    ("", "rst_n", "", "of clk reaches u_flag.meta_q of mem_clk, not by in_i, or by logic"),
    ("", "u_crystal", "", "reaches u_crystal.seen_q of bit_clk, with clocks that one PLL does not make"),
    ("", "u_logic", "", "count_q of pix_clk reaches u_logic.pairs_of_logic of bit_clk, which is neither"),
    ("constraints/boards/ulx3s/ulx3s.sv", 'ICP_CURRENT = "12", ', "", "u_pll lacks ICP_CURRENT"),
    (
        "rtl/board/board_core.sv",
        ".in_i (mem_ready_q)",
        ".in_i (mem_ready_q && sdram_dq_oe_o)",
        "reaches u_board.gen_sdram.u_ready.meta_q of clk, not by in_i, or by logic",
    ),
    (
        "rtl/board/sdram_memory.sv",
        ".in_valid_i(mem_rd_valid)",
        ".in_valid_i(mem_rd_valid && room_q[0])",
        "room_q of clk reaches u_board.gen_sdram.u_memory.u_words.wr_q of mem_clk, which in an async_fifo is right from",
    ),
)


def changed(mutants, folder):
    """The files that the mutants change, as yosys reads them."""
    texts = {}
    for file, old, new, _ in mutants:
        if file:
            text = texts.get(file) or (TOP / file).read_text()
            assert text.count(old) == 1, f"{file}: {old}: {text.count(old)} times there, and must be once"
            texts[file] = text.replace(old, new)
    for file, text in texts.items():
        (folder / pathlib.Path(file).name).write_text(text)
    return " ".join(str(folder / pathlib.Path(file).name) for file in texts)


def main():
    if "--help" in sys.argv or len(sys.argv) < 2:
        print(__doc__)
        return 2
    if sys.argv[1] == "--self-test":
        board = "ulx3s_25f"
        told = check(board, listed=["| `u_nowhere` | `async_fifo` | clk and clk |"])
        text = "# Two\n## `one`\n| `u_a` |\n| clk |\n## `one_more`\n| `u_b` |\n"
        assert rows_of(text, "one_more") == ["| `u_b` |"] and rows_of(text, "none") == ["| `u_a` |", "| `u_b` |"]
        assert not any("reaches" in t for t in told), told
        assert any("lists what the netlist has not" in t for t in told) and any("lacks" in t for t in told), told
        told = check(board, extra=MUTANTS)
        for file, old, _, text in MUTANTS:
            assert any(text in t for t in told), f"{file}: {old}: not told: {text}: {told}"
        return 0
    wrong = check(sys.argv[1], show="--show" in sys.argv)
    print("\n".join(wrong), end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
