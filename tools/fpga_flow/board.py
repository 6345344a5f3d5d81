# SPDX-License-Identifier: Apache-2.0
"""A board of constraints/boards/boards.yaml: what is placed, and what yosys reads of its clocks and its memory."""

import dataclasses
import json
import re

import core
import flow
from trouble import Trouble

BOARDS = "constraints/boards"


@dataclasses.dataclass(frozen=True)
class Board:
    name: str
    top: str
    device: core.Device
    core: core.Core
    values: dict  # parameters of the top beside the core's
    load: str  # the command that the bitstream's name follows
    synth: tuple  # options of yosys' synth_FAMILY
    nextpnr: tuple  # options of nextpnr beside the device's

    @property
    def pins(self):
        return f"{BOARDS}/{self.top}/{self.top}.{'lpf' if self.device.family == 'ecp5' else 'pcf'}"

    @property
    def design(self):
        return flow.Design(
            self.name,
            self.top,
            self.core.values | self.values,
            sources=f"rtl/*.sv rtl/board/*.sv {BOARDS}/{self.top}/*.sv",
            includes=("rtl/include", "rtl/board/include"),
            pins=self.pins,
            synth=self.synth,
            nextpnr=self.nextpnr,
        )


def names(top):
    return list(core.read_yaml(top / BOARDS / "boards.yaml"))


def find(top, name):
    b = core.read_yaml(top / BOARDS / "boards.yaml")[name]
    return Board(
        name,
        b["top"],
        core.find_device(top, b["device"]),
        core.checked(top, name, dict(b["core"])),
        dict(b["board"]),
        b["load"],
        tuple(map(str, b.get("synth", ()))),
        tuple(map(str, b.get("nextpnr", ()))),
    )


def plain(name):
    """$paramod$hash\\board_core is board_core."""
    return next(part for part in name.split("\\")[1:] if part) if name.startswith("$paramod") else name


def number(bits):
    return int(bits, 2) if isinstance(bits, str) else bits


def clocks(module, pins):
    """MHz of each clock net of a top, by its bit: the pin's, as the file of pins has it, and what PLLs make of it. So nextpnr's
    own reckoning of the PLLs is not the only one."""
    of_pin = re.findall(r'FREQUENCY PORT "(\w+)" ([\d.]+) MHZ|set_frequency (\w+) ([\d.]+)', pins)
    mhz = {module["netnames"][a or c]["bits"][0]: float(b or d) for a, b, c, d in of_pin}
    for cell in module["cells"].values():
        p = {k: number(v) for k, v in cell["parameters"].items() if set(str(v)) <= {"0", "1"}}
        nets = {k: v[0] for k, v in cell["connections"].items() if v}
        if cell["type"] == "EHXPLLL":  # fed back from CLKOP
            fed_back = mhz[nets["CLKI"]] / p["CLKI_DIV"] * p["CLKFB_DIV"] * p["CLKOP_DIV"]
            for out in ("CLKOP", "CLKOS", "CLKOS2", "CLKOS3"):
                if out in nets:
                    mhz[nets[out]] = fed_back / p[f"{out}_DIV"]
        elif cell["type"] == "SB_GB":
            mhz[nets["GLOBAL_BUFFER_OUTPUT"]] = mhz[nets["USER_SIGNAL_TO_GLOBAL_BUFFER"]]
        elif cell["type"] == "SB_PLL40_CORE":  # FEEDBACK_PATH SIMPLE
            mhz[nets["PLLOUTGLOBAL"]] = mhz[nets["REFERENCECLK"]] * (p["DIVF"] + 1) / (p["DIVR"] + 1) / 2 ** p["DIVQ"]
    return mhz


def needs(modules, board, folder):
    """MHz that each clock of the board's top runs at, by the clock's name there."""
    module = next(m for n, m in modules.items() if plain(n) == board.top)
    mhz = clocks(module, (folder / board.pins).read_text())
    named = {}
    for name, net in sorted(module["netnames"].items(), key=lambda n: (n[1]["hide_name"], "." in n[0], n[0])):
        for bit in net["bits"]:
            if bit in mhz and bit not in named.values() and len(net["bits"]) == 1:
                named[name] = bit
    return {name: mhz[bit] for name, bit in named.items()}


@dataclasses.dataclass(frozen=True)
class Facts:
    """Properties of a board that decide which frames it can be fed with."""

    sdram: bool
    words: int  # of 32 bits
    lines: int  # whose signatures it keeps
    baud: int
    core_mhz: float
    memory_mhz: float  # 0: the core's
    screen_hz: float  # 0: no screen


def facts(tools, top, board):
    """By yosys, from the top's files alone: nothing is synthesized."""
    out = top / "build/fpga"
    out.mkdir(parents=True, exist_ok=True)
    file = out / f"{board.name}-facts.json"
    sets = "".join(f" -chparam {k} {v}" for k, v in board.design.values.items())
    includes = " ".join(f"-I{i}" for i in board.design.includes)
    script = (
        f"read_verilog -defer -sv {includes} {BOARDS}/{board.top}/*.sv rtl/board/board_core.sv; "
        f"hierarchy -top {board.top}{sets}; proc; write_json {file.relative_to(top)}"
    )
    tools.run(tools.find("yosys"), ["-q", "-p", script], top, f"build/fpga/{board.name}-facts.log")
    modules = json.loads(file.read_text())["modules"]
    module = next(m for n, m in modules.items() if plain(n) == board.top)
    mhz = clocks(module, (top / board.pins).read_text())
    cells = [c for c in module["cells"].values() if plain(c["type"]) == "board_core"]
    if len(cells) != 1:
        raise Trouble(f"{BOARDS}/{board.top}: has {len(cells)} board_cores, and must have one")
    p = {k: number(v) for k, v in modules[cells[0]["type"]]["parameter_default_values"].items() if set(v) <= {"0", "1"}}
    nets = {k: v[0] for k, v in cells[0]["connections"].items() if v}
    total = [sum(p[f"{d}_{part}"] for part in ("ACTIVE", "FRONT", "SYNC", "BACK")) for d in "HV"]
    sdram = p["MEMORY"] == 1
    return Facts(
        sdram,
        2 ** (p["ROW_BITS"] + p["COLUMN_BITS"] + p["BANK_BITS"] - 1) if sdram else p["MEMORY_WORDS"],
        p["LINES"],
        p["BAUD"],
        mhz[nets["clk_i"]],
        mhz[nets["mem_clk_i"]] if sdram else 0,
        1e6 * mhz[nets["pix_clk_i"]] / total[0] / total[1] if p["SCREEN"] == 1 else 0,
    )
