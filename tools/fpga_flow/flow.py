# SPDX-License-Identifier: Apache-2.0
"""Synthesis, placement and packing of one design on one device."""

import dataclasses
import json
import statistics

from trouble import Trouble

SOURCES = "rtl/*.sv constraints/*.sv"


@dataclasses.dataclass
class Design:
    """What is placed: a top module with its parameters, and what its files are called."""

    name: str
    top: str
    values: dict


def synthesize(programs, device, design, folder):
    """folder/NAME.json, the netlist, and folder/NAME-modules.json, the modules before they are made one."""
    sets = "".join(f" -chparam {k} {v}" for k, v in design.values.items())
    script = (
        # Deferred, because a part that the top leaves out may be illegal with the defaults (tree_core of no units).
        f"read_verilog -defer -sv -Irtl/include {SOURCES}; hierarchy -top {design.top}{sets}; "
        f"design -save read; proc; write_json {design.name}-modules.json; design -load read; "
        f"synth_{device.family} -top {design.top} -json {design.name}.json"
    )
    programs.run(programs.find("yosys"), ["-q", "-p", script], folder, f"{design.name}-yosys.log")


def place(programs, device, design, folder, seed):
    """Places and routes; gives nextpnr's report. Files are NAME-SEED.*"""
    name = f"{design.name}-{seed}"
    out = ["--textcfg", f"{name}.config"] if device.family == "ecp5" else ["--asc", f"{name}.asc"]
    programs.run(
        programs.find(f"nextpnr-{device.family}"),
        ["--quiet", *device.nextpnr, "--json", f"{design.name}.json", "--seed", seed, "--timing-allow-fail"]
        + ["--report", f"{name}-timing.json", "--detailed-timing-report", *out],
        folder,
        f"{name}-nextpnr.log",
    )
    try:
        return json.loads((folder / f"{name}-timing.json").read_text())
    except (OSError, ValueError) as e:
        raise Trouble(f"nextpnr-{device.family}: no timing report of {name}: {e}") from e


def pack(programs, device, design, folder, seed):
    """The bitstream; gives its file's name."""
    name = f"{design.name}-{seed}"
    if device.family == "ecp5":
        programs.run(programs.find("ecppack"), [f"{name}.config", f"{name}.bit"], folder, f"{name}-pack.log")
        return f"{name}.bit"
    programs.run(programs.find("icepack"), [f"{name}.asc", f"{name}.bin"], folder, f"{name}-pack.log")
    return f"{name}.bin"


def clock_of(report):
    """MHz of the only clock."""
    (clock,) = report["fmax"].values()
    return clock["achieved"]


CELLS = {
    "ecp5": {"lut": "TRELLIS_COMB", "ff": "TRELLIS_FF", "ram": "DP16KD", "dsp": "MULT18X18D"},
    "ice40": {"lut": "ICESTORM_LC", "ff": None, "ram": "ICESTORM_RAM", "dsp": "ICESTORM_DSP"},
}


def cells_of(device, report, netlist):
    """Used and available cells. A logic cell of iCE40 is a LUT with its flip-flop, so flip-flops come from the netlist."""
    out = {}
    for key, cell in CELLS[device.family].items():
        if cell is None:
            used = sum(c["type"].startswith("SB_DFF") for c in netlist["cells"].values())
            out[key] = {"used": used, "available": report["utilization"]["ICESTORM_LC"]["available"]}
        elif cell in report["utilization"]:
            out[key] = {k: report["utilization"][cell][k] for k in ("used", "available")}
    return out


def spread(clocks):
    """Of the clocks by several seeds: the median, which is what counts, and the ends."""
    return {"median": statistics.median(clocks), "worst": min(clocks), "best": max(clocks), "all": clocks}
