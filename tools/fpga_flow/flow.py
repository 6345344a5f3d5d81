# SPDX-License-Identifier: Apache-2.0
"""Synthesis, placement and packing of one design on one device."""

import dataclasses
import json
import statistics

import programs as runs
from trouble import Trouble


class NotPlaced(Trouble):
    """nextpnr found no place or no wires for a design; `why` is its own line."""

    def __init__(self, failed):
        super().__init__(str(failed))
        self.why = failed.error.removeprefix("ERROR: ")


@dataclasses.dataclass
class Design:
    """A design to be placed: a top module with its parameters, and the names of its files. Paths are within a run's folder."""

    name: str
    top: str
    values: dict
    sources: str = "rtl/*.sv constraints/*.sv"
    includes: tuple = ("rtl/include",)
    pins: str = ""  # the file that places them; none: nextpnr chooses
    synth: tuple = ()  # options of synth_FAMILY
    nextpnr: tuple = ()  # options beside the device's


def synthesize(programs, device, design, folder):
    """folder/NAME.json, the netlist, and folder/NAME-modules.json, the modules before they are made one."""
    sets = "".join(f" -chparam {k} {v}" for k, v in design.values.items())
    includes = " ".join(f"-I{i}" for i in design.includes)
    options = "".join(f" {o}" for o in design.synth)
    script = (
        # Deferred, because a part that the top leaves out may be illegal with the defaults (tree_core of no units).
        f"read_verilog -defer -sv {includes} {design.sources}; hierarchy -top {design.top}{sets}; "
        f"design -save read; proc; write_json {design.name}-modules.json; design -load read; "
        f"synth_{device.family} -top {design.top}{options} -json {design.name}.json"
    )
    programs.run(programs.find("yosys"), ["-q", "-p", script], folder, f"{design.name}-yosys.log")


def place(programs, device, design, folder, seed):
    """Places and routes; gives nextpnr's report. Files are NAME-SEED.* Raises NotPlaced where the design does not fit."""
    name = f"{design.name}-{seed}"
    out = ["--textcfg", f"{name}.config"] if device.family == "ecp5" else ["--asc", f"{name}.asc"]
    pins = ["--lpf" if device.family == "ecp5" else "--pcf", design.pins] if design.pins else []
    arguments = ["--quiet", *device.nextpnr, *pins, *design.nextpnr, "--json", f"{design.name}.json", "--seed", seed]
    arguments += ["--timing-allow-fail", "--report", f"{name}-timing.json", "--detailed-timing-report", *out]
    try:
        programs.run(programs.find(f"nextpnr-{device.family}"), arguments, folder, f"{name}-nextpnr.log")
    except runs.Failed as failed:
        # nextpnr's message on a design; a nextpnr that was killed, or broke, writes no such line.
        if failed.code > 0 and failed.error.startswith("ERROR: "):
            raise NotPlaced(failed) from failed
        raise
    try:
        return json.loads((folder / f"{name}-timing.json").read_text())
    except (OSError, ValueError) as e:
        raise Trouble(f"nextpnr-{device.family}: no timing report of {name}: {e}") from e


def pack(programs, device, design, folder, seed, bitstream=None):
    """The bitstream, called after the design and the seed, or `bitstream`; gives its file's name."""
    name = f"{design.name}-{seed}"
    bitstream = bitstream or name
    if device.family == "ecp5":
        programs.run(programs.find("ecppack"), [f"{name}.config", f"{bitstream}.bit"], folder, f"{name}-pack.log")
        return f"{bitstream}.bit"
    programs.run(programs.find("icepack"), [f"{name}.asc", f"{bitstream}.bin"], folder, f"{name}-pack.log")
    return f"{bitstream}.bin"


def clock_of(report):
    """MHz of the only clock."""
    (clock,) = report["fmax"].values()
    return clock["achieved"]


def clocks_of(report):
    """{net: (MHz reached, MHz that nextpnr held it against)} of all clocks."""
    return {net: (c["achieved"], c["constraint"]) for net, c in report["fmax"].items()}


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
    """The median of the clocks by several seeds, which is the figure that counts, and the ends."""
    return {"median": statistics.median(clocks), "worst": min(clocks), "best": max(clocks), "all": clocks}
