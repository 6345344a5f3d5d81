#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every named configuration is elaborated by each tool that reads SystemVerilog here: Verilator, Icarus Verilog, yosys, slang.
The top is rtl/kage_axi.v, with kage_top in it. A warning is a failure.

usage: elaborate.py SOURCE_DIR READER... [--pyslang FOLDER]

  READER     verilator, iverilog, yosys or slang; one that is missing is a failure
  --pyslang  the folder of the Python package of slang

Each tool must also refuse an illegal parameter, by its message: else "accepted" would say nothing. Icarus Verilog refuses
when the simulation starts (rtl/include/kage_illegal.svh).
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

import yaml

TOP = "kage_axi"
ILLEGAL = {"LANES": 3}
# What Icarus Verilog tells of itself. Neither changes what it simulates: no two cases of a `unique case` overlap, as Verilator's
# assertions check, and an always_comb that wakes more often comes to the same values.
ICARUS_LACKS = [
    "sorry: Case unique/unique0 qualities are ignored",
    "sorry: constant selects in always_* processes are not currently supported (all bits will be included)",
]
REASON = "LANES must be one of"


def output_of(command, cwd):
    done = subprocess.run(
        [str(c) for c in command],
        cwd=cwd,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        stdin=subprocess.DEVNULL,
        text=True,
    )
    return done.returncode, done.stdout


class Readers:
    """A method a tool: what it says of `values`, and whether it accepts them."""

    def __init__(self, source, work):
        self.rtl, self.work = source / "rtl", work
        self.files = [*sorted(self.rtl.glob("*.sv")), self.rtl / "kage_axi.v"]
        self.include = self.rtl / "include"

    def verilator(self, values):
        status, text = output_of(
            [
                "verilator",
                "--lint-only",
                "-Wall",
                f"-I{self.include}",
                "--top-module",
                TOP,
                *(f"-G{k}={v}" for k, v in values.items()),
                *self.files,
            ],
            self.work,
        )
        return status == 0, text

    def iverilog(self, values):
        status, text = output_of(
            [
                "iverilog",
                "-g2012",
                f"-I{self.include}",
                "-s",
                TOP,
                "-o",
                "kage.vvp",
                *(f"-P{TOP}.{k}={v}" for k, v in values.items()),
                *self.files,
            ],
            self.work,
        )
        rest = [line for line in text.splitlines() if not any(known in line for known in ICARUS_LACKS)]
        if status != 0 or any(rest):
            return False, "\n".join(rest)
        status, text = output_of(["vvp", "-N", "kage.vvp", "-none"], self.work)  # no stimulus: it ends at time 0
        return status == 0, text

    def yosys(self, values):
        sets = " ".join(f"-chparam {k} {v}" for k, v in values.items())
        # -defer: each module with the parameters that it is given alone, for defaults may be illegal (compare_tree without units).
        script = f"read_verilog -sv -defer -I{self.include} {' '.join(map(str, self.files))}; hierarchy -check -top {TOP} {sets}"
        status, text = output_of(["yosys", "-q", "-p", script], self.work)
        # yosys 0.23 names the line, but leaves out what it says.
        place = re.search(r"^(\S+):(\d+): ERROR", text, re.M)
        line = pathlib.Path(place[1]).read_text().splitlines()[int(place[2]) - 1] if place else ""
        return status == 0 and "Warning" not in text, text + line

    def slang(self, values):
        import pyslang

        driver = pyslang.driver.Driver()
        driver.addStandardArgs()
        words = [
            "slang",
            f"-I{self.include}",
            "--top",
            TOP,
            "--single-unit",
            "-Werror",
            *(f"-G{k}={v}" for k, v in values.items()),
            *map(str, self.files),
        ]
        if not driver.parseCommandLine(" ".join(words)) or not driver.processOptions() or not driver.parseAllSources():
            return False, "slang does not read the sources"
        compilation = driver.createCompilation()
        driver.reportCompilation(compilation, True)
        good = driver.reportDiagnostics(True)
        return good, pyslang.DiagnosticEngine.reportAll(driver.sourceManager, compilation.getAllDiagnostics())


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("readers", nargs="+", choices=["verilator", "iverilog", "yosys", "slang"])
    parser.add_argument("--pyslang", default="")
    args = parser.parse_intermixed_args()
    sys.path.insert(0, args.pyslang)
    configurations = {
        name: values or {}
        for name, values in yaml.safe_load((args.source / "rtl/defs/configs.yaml").read_text()).items()
    }
    bad = 0
    with tempfile.TemporaryDirectory() as work:
        for reader in args.readers:
            read = getattr(Readers(args.source, pathlib.Path(work)), reader)
            good = 0
            for name, values in configurations.items():
                accepted, text = read(values)
                good += accepted
                if not accepted:
                    bad += 1
                    print(f"{reader}: {name}: refused: {text}", flush=True)
            accepted, text = read({**configurations["default"], **ILLEGAL})
            if accepted or REASON not in text:
                bad += 1
                print(f"{reader}: LANES=3: {'accepted' if accepted else 'refused, but not because ' + REASON}: {text}")
            print(f"{reader}: {good} configurations of {len(configurations)}")
    sys.exit(bad != 0)


if __name__ == "__main__":
    main()
