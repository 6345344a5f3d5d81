#!/usr/bin/env -S python3 -B
# SPDX-License-Identifier: Apache-2.0
"""Synthesize kage_top to the cells of an FPGA family: the netlist that `kage cosim --netlist` draws frames with.

usage: netlist.py FAMILY OUT.v [PARAM=VALUE...]

  FAMILY       ice40 or ecp5
  OUT.v        the netlist: kage_top of the family's cells, without parameters
  PARAM=VALUE  a parameter of rtl/defs/kage.yaml; those left out have their default there

The RTL is that of this source tree or of $KAGE_RTL_DIR; $YOSYS names another yosys than that in PATH. Models of the cells
are in verif/cosim/model/cells. On failure: one line, exit status 2.
"""

import argparse
import os
import pathlib
import shlex
import tempfile

import sources
from parameters import parameters
from steps import Log, fail, run

FAMILIES = ("ice40", "ecp5")


def yosys():
    return shlex.split(os.environ.get("YOSYS") or "yosys")


def synthesize(family, out, values, rtl, log, name="kage_top"):
    """OUT.v holds module `name`. Its nets are one bit wide, since a simulator takes a vector whose bits follow from each other,
    like a chain of carries, for a loop."""
    includes = " ".join(f"-I{folder}" for folder in sources.places("includes", rtl))
    modules = " ".join(str(f) for f in sources.files("modules", rtl))
    sets = "".join(f" -chparam {k} {v}" for k, v in values.items())
    script = (
        # Deferred, because a part that the top leaves out may be illegal with the defaults (tree_core of no units).
        f"read_verilog -defer -sv {includes} {modules}; hierarchy -top kage_top{sets}; synth_{family} -top kage_top; "
        f"splitnets; rename kage_top {name}; write_verilog -noattr {out}"
    )
    run(f"yosys (synth_{family})", [*yosys(), "-q", "-p", script], log)


def wrapper(out, rtl, inner):
    """OUT.sv: a kage_top of the RTL's own parameters and ports, which holds the netlist `inner` and nothing else."""
    text = (rtl / "kage_top.sv").read_text()
    end = text.find("\n);\n")
    if end < 0:
        fail(f"{rtl / 'kage_top.sv'}: the end of its ports is not found")
    out.write_text(f"{text[:end]}\n);\n  {inner} u_netlist (.*);\nendmodule\n`default_nettype wire\n")


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n")[0])
    parser.add_argument("family", choices=FAMILIES)
    parser.add_argument("out")
    parser.add_argument("params", nargs="*")
    args = parser.parse_args()
    out = pathlib.Path(args.out).resolve()
    log = Log(pathlib.Path(tempfile.gettempdir()) / f"kage-netlist-{os.getpid()}.log")  # it outlives a failure
    partial = out.with_name(f".{out.name}.{os.getpid()}.v")
    try:
        synthesize(args.family, partial, parameters(args.params), sources.RTL, log)
        os.replace(partial, out)
    finally:
        partial.unlink(missing_ok=True)
    log.path.unlink(missing_ok=True)


if __name__ == "__main__":
    try:
        main()
    except OSError as e:
        fail(f"{e.filename}: {e.strerror}" if e.filename else e.strerror)
