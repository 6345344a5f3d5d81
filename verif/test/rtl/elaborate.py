#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every named configuration is elaborated by each tool that reads SystemVerilog here: Verilator, Icarus Verilog, yosys, slang.
The top is rtl/kage_axi.v, with kage_top in it. A warning is a failure.

usage: elaborate.py SOURCE_DIR READER... [--pyslang FOLDER]

  READER     verilator, iverilog, yosys or slang; one that is missing is a failure
  --pyslang  the folder of the Python package of slang

Each tool must also refuse an illegal parameter, by its message: else "accepted" would say nothing. Icarus Verilog refuses
when the simulation starts (rtl/include/kage_illegal.svh).

slang also tells where a cast shortens a value within a longer expression, as in a - 4'(five_bits) == b. yosys, 0.23 as well
as 0.70, takes such a value at its full width there, without a word, so that its netlist is another core than the one that
simulates. A signal of its own is read alike by all.
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


# Read wrongly by yosys; the rule must find it.
SHORTENS = """module shortens (input logic [3:0] a, input logic [4:0] n, output logic y);
  assign y = a - 4'(n) == 4'd4;
endmodule
"""


def shortened(compilation, places):
    """Where an operand of an operator is a cast of a wider value that is not constant: file:line and its text."""
    from pyslang import ast

    found = set()

    def operands(node):
        if isinstance(node, ast.BinaryExpression):
            yield from operands(node.left)
            yield from operands(node.right)
        elif isinstance(node, ast.UnaryExpression) or (isinstance(node, ast.ConversionExpression) and node.isImplicit):
            yield from operands(node.operand)
        elif isinstance(node, ast.ConditionalExpression):
            yield from operands(node.left)
            yield from operands(node.right)
        else:
            yield node

    def look(node):
        if isinstance(node, ast.BinaryExpression):
            for operand in operands(node):
                if isinstance(operand, ast.ConversionExpression) and not operand.isImplicit:
                    wide = operand.operand
                    if wide.type.bitWidth > operand.type.bitWidth and not is_constant(wide):
                        at = operand.sourceRange.start
                        text = str(operand.syntax).strip()
                        found.add(
                            f"{places.getFileName(at)}:{places.getLineNumber(at)}: {text} shortens within an expression"
                        )
        return True

    def is_constant(node):
        """A parameter, or a loop's variable, which is one once the loop is unrolled."""
        symbol = getattr(node, "symbol", None)
        return str(node.type) == "int" or (symbol is not None and symbol.kind == ast.SymbolKind.Parameter)

    compilation.getRoot().visit(look)
    return sorted(found)


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
        text = pyslang.DiagnosticEngine.reportAll(driver.sourceManager, compilation.getAllDiagnostics())
        short = shortened(compilation, driver.sourceManager)
        return good and not short, "\n".join([text, *short])

    def rule_of_slang(self):
        """Whether shortened() finds what it is for."""
        import pyslang

        compilation = pyslang.ast.Compilation()
        tree = pyslang.syntax.SyntaxTree.fromText(SHORTENS)
        compilation.addSyntaxTree(tree)
        return len(shortened(compilation, tree.sourceManager)) == 1


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
        if "slang" in args.readers and not Readers(args.source, pathlib.Path(work)).rule_of_slang():
            bad += 1
            print("slang: a cast that shortens within an expression is not found")
    sys.exit(bad != 0)


if __name__ == "__main__":
    main()
