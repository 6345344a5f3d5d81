# SPDX-License-Identifier: Apache-2.0
"""Cells and clock of each kernel at several numbers of stages, as yosys and nextpnr find them: tools/hls figures."""

from __future__ import annotations

import argparse
import json
import pathlib
import sys
import tempfile

import yaml

from .llvm_ir import Port

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools/fpga_flow"))

import flow  # noqa: E402
import programs  # noqa: E402

STAGES = (1, 4, 8, 16, 24)


def wrapped(name: str, ports: list[Port], stages: int) -> str:
    """The module between registers, whose values come and go bit by bit: ports to pins would be what limits the clock."""
    inputs = [p for p in ports if p.is_input]
    outputs = [p for p in ports if not p.is_input]
    wide_in, wide_out = sum(p.width for p in inputs), sum(p.width for p in outputs)
    lines = [
        "module placed (input wire clk, input wire in, output wire out);",
        f"  reg [{wide_in + 3}:0] line, held;",
        f"  reg [{wide_out}:0] got, shift;",
        f"  wire [{wide_out}:0] now;",
        "  reg take;",
        "  assign out = shift[0];",
        "  always @(posedge clk) begin",
        "    line <= {line, in}; held <= line; take <= held[2]; got <= now;",
        "    shift <= take ? got : shift >> 1;",
        "  end",
        f"  {name} dut (",
    ]
    connected = []
    if stages:
        connected += [
            ".clk_i(clk)",
            ".rst_ni(held[0])",
            ".in_valid_i(held[1])",
            ".out_ready_i(held[3])",
            ".in_ready_o()",
        ]
        connected += [f".out_valid_o(now[{wide_out}])"]
    at = 4
    for p in inputs:
        connected.append(f".{p.name}(held[{at}+:{p.width}])")
        at += p.width
    at = 0
    for p in outputs:
        connected.append(f".{p.name}(now[{at}+:{p.width}])")
        at += p.width
    return "\n".join([*lines, "    " + ",\n    ".join(connected), "  );", "endmodule", ""])


def cells_alone(folder: pathlib.Path, tools, device, name: str) -> dict[str, int]:
    """LUTs, flip-flops and multipliers of the module without the wrapper. A carry cell of ECP5 is two LUTs."""
    design = flow.Design(name, name, {}, sources="design.sv", includes=())
    flow.synthesize(tools, device, design, folder)
    kinds = [c["type"] for c in json.loads((folder / f"{name}.json").read_text())["modules"][name]["cells"].values()]
    if device.family == "ecp5":
        lut = kinds.count("LUT4") + 2 * kinds.count("CCU2C")
        return {"lut": lut, "ff": kinds.count("TRELLIS_FF"), "dsp": kinds.count("MULT18X18D")}
    # A carry and its LUT share a cell.
    return {
        "lut": kinds.count("SB_LUT4"),
        "ff": sum(k.startswith("SB_DFF") for k in kinds),
        "dsp": kinds.count("SB_MAC16"),
    }


class Placer:
    def __init__(self, name: str, wheels: pathlib.Path):
        entry = yaml.safe_load((TOP / "constraints/devices.yaml").read_text())[name]
        self.device = argparse.Namespace(name=name, **entry)
        self.tools = programs.Programs("any", wheels, TOP)
        found = json.loads((TOP / "constraints/figures.json").read_text())
        rows = found if isinstance(found, list) else found["rows"]
        self.least_loop = next(
            r["least_loop_mhz"] for r in rows if r["device"] == name and r["core"] in ("default", "tiny")
        )

    def place(self, text: str, name: str, ports: list[Port], stages: int, seeds: int) -> dict:
        (TOP / "build").mkdir(exist_ok=True)
        with tempfile.TemporaryDirectory(dir=TOP / "build") as folder:
            folder = pathlib.Path(folder)
            # An unnamed port is left open.
            (folder / "design.sv").write_text(text + wrapped(name, ports, stages))
            design = flow.Design("placed", "placed", {}, sources="design.sv", includes=())
            flow.synthesize(self.tools, self.device, design, folder)
            cells = cells_alone(folder, self.tools, self.device, name)
            try:
                reports = [flow.place(self.tools, self.device, design, folder, seed) for seed in range(1, seeds + 1)]
            except flow.NotPlaced as e:
                return cells | {"mhz": None, "why": e.why}
        return cells | {"mhz": flow.spread([flow.clock_of(r) for r in reports])["median"]}


def table(rows: list[dict], device: str, least_loop: float) -> str:
    lines = [
        "| kernel | stages | LUT | FF | DSP | MHz | of the least loop | foretold |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for r in rows:
        placed = f"{r['mhz']:.0f} | {100 * r['mhz'] / least_loop:.0f} %" if r["mhz"] else "does not fit | "
        lines.append(
            f"| `{r['kernel']}` | {r['stages']} | {r['lut']} | {r['ff']} | {r['dsp']} | {placed} | {r['foretold']:.0f} |"
        )
    return f"{device}, whose least loop has {least_loop:.1f} MHz\n\n" + "\n".join(lines)
