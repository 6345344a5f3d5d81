#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every named configuration is elaborated by each tool that reads SystemVerilog here: Verilator, Icarus Verilog, yosys, slang.
The top is rtl/kage_axi.v, with kage_top in it. So is rtl/board/board_core.sv in some shapes. A warning is a failure.
Behind the named configurations come legal ones by chance, with a front end and without: a hundred pairs for slang, which is
quick, and a few for each of the others. KAGE_SEED=N takes others.

usage: elaborate.py SOURCE_DIR READER... [--pyslang FOLDER]

  READER     verilator, iverilog, yosys or slang; one that is missing is a failure
  --pyslang  the folder of the Python package of slang

Each tool must also refuse an illegal parameter, by its message: else "accepted" would say nothing. Icarus Verilog refuses
when the simulation starts (rtl/include/kage_illegal.svh).

slang also reports where a cast shortens a value within a longer expression, as in a - 4'(five_bits) == b. Both yosys
0.23 and 0.70 take such a value at its full width there, without a word, so that their netlist is another core than the
one that simulates. All tools read a signal of its own alike.
"""

import argparse
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

import yaml

# Top, and a parameter that it must refuse, with the beginning of the reason.
CORE = ("kage_axi", {"LANES": 3}, "LANES must be one of")
BOARD = ("board_core", {"BAUD": 9600}, "BAUD must be of")
BOARDS = {
    "board without a screen": {"MEMORY": 0, "SCREEN": 0},
    "board with an SDRAM": {"MEMORY": 1, "SCREEN": 1, "LIGHTS": 2, "COUNT_BITS": 4, "CLASS_BITS": 3},
    "small board": {
        "MEMORY": 0,
        "SCREEN": 1,
        "CHANNELS": 1,
        "BEAT_WORDS": 1,
        "LANES": 1,
        "ARRANGEMENT": 0,
        "MAX_WIDTH": 64,  # a processor a pixel
        "LINES": 20,
    },
}
# Pairs of random configurations, with a front end and without.
RANDOM_PAIRS = {"verilator": 3, "iverilog": 3, "yosys": 3, "slang": 100}
# Messages of Icarus Verilog about itself. Neither changes what it simulates: no two cases of a `unique case` overlap,
# as Verilator's assertions check, and an always_comb that wakes more often comes to the same values.
ICARUS_LACKS = [
    "sorry: Case unique/unique0 qualities are ignored",
    "sorry: constant selects in always_* processes are not currently supported (all bits will be included)",
]


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


# Each may be read wrongly by yosys, so the rule must find it; a, b have 4 bits, n has 5, y has 1 and z has 9.
SHORTENS = [
    "y = a - 4'(n) == 4'd4",
    "y = a - (b[0] ? 4'(n) : b) == 4'd4",
    "y = $signed(4'(n)) - $signed(a) < 0",
    "y = a - 4'(3'(n)) == 4'd4",
    "z = {~4'(n)}",
    "z = {2{-4'(n)}}",
    "z = {b[0] ? 4'(n) : b, 1'b0}",
    "y = &4'(n)",
    "y = !(~4'(n))",
    "y = 4'(n) inside {4'd1, 4'd2}",
    "z = 9'(~4'(n))",
    "case (~4'(n)) 4'd1: y = 1'b1; default: y = 1'b0; endcase",
]
# These are read alike by all: the cast goes straight to what has its width, or is of a constant.
ALONE = ["w = 4'(n)", "w = b[0] ? 4'(n) : b", "w = b[3'(n)] ? a : b", "y = a - 4'(Five) == b", "w = f(4'(n))"]


def shortened(compilation, places):
    """Where a cast of a wider value, which is no constant, is an operand: file:line and its text."""
    from pyslang import ast

    found = set()
    operators = (ast.BinaryExpression, ast.UnaryExpression, ast.ConcatenationExpression, ast.ReplicationExpression)
    operators += (ast.InsideExpression, ast.CallExpression, ast.ConversionExpression)

    def is_constant(node):
        """A parameter, or a loop's variable, which is one once the loop is unrolled."""
        symbol = getattr(node, "symbol", None)
        return str(node.type) == "int" or (symbol is not None and symbol.kind == ast.SymbolKind.Parameter)

    def parts(node):
        """The operands of an expression."""
        if isinstance(node, ast.BinaryExpression):
            return [node.left, node.right]
        if isinstance(node, ast.ConditionalExpression):
            return [node.left, node.right]
        if isinstance(node, ast.ConcatenationExpression):
            return list(node.operands)
        if isinstance(node, ast.ReplicationExpression):
            return [node.concat]
        if isinstance(node, ast.InsideExpression):
            return [node.left, *node.rangeList]
        if isinstance(node, ast.CallExpression):
            return list(node.arguments) if node.isSystemCall else []
        return [node.operand] if isinstance(node, (ast.UnaryExpression, ast.ConversionExpression)) else []

    def operand(node):
        """Whether a cast is that of a wider value; what only passes a value on is looked through."""
        if isinstance(node, ast.ConversionExpression) and not node.isImplicit:
            wide = node.operand
            if wide.type.bitWidth > node.type.bitWidth and not is_constant(wide):
                at = node.sourceRange.start
                text = str(node.syntax).strip()
                found.add(f"{places.getFileName(at)}:{places.getLineNumber(at)}: {text} shortens within an expression")
            return
        through = (ast.ConditionalExpression, ast.UnaryExpression, ast.ConversionExpression)
        for part in parts(node) if isinstance(node, through) else []:
            operand(part)

    def look(node):
        if isinstance(node, operators) and not (isinstance(node, ast.ConversionExpression) and node.isImplicit):
            for part in parts(node):
                operand(part)
        if isinstance(node, ast.CaseStatement):
            operand(node.expr)
        return True

    compilation.getRoot().visit(look)
    return sorted(found)


class Readers:
    """A method a tool: what it says of `values`, and whether it accepts them."""

    def __init__(self, source, work, top):
        rtl = source / "rtl"
        self.work, self.top = work, top
        self.files = [*sorted(rtl.glob("*.sv")), rtl / "kage_axi.v"]
        self.include = [f"-I{rtl / 'include'}"]
        if top == BOARD[0]:
            self.files = [*sorted(rtl.glob("*.sv")), *sorted(rtl.glob("board/*.sv"))]
            self.include.append(f"-I{rtl / 'board/include'}")

    def verilator(self, values):
        status, text = output_of(
            [
                "verilator",
                "--lint-only",
                "-Wall",
                *self.include,
                "--top-module",
                self.top,
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
                *self.include,
                "-s",
                self.top,
                "-o",
                "kage.vvp",
                *(f"-P{self.top}.{k}={v}" for k, v in values.items()),
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
        read = f"read_verilog -sv -defer {' '.join(self.include)} {' '.join(map(str, self.files))}"
        script = f"{read}; hierarchy -check -top {self.top} {sets}"
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
            *self.include,
            "--top",
            self.top,
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
        """Each statement that shortened() does not judge as it must."""
        import pyslang

        wrong = []
        for statement, short in [*((s, True) for s in SHORTENS), *((s, False) for s in ALONE)]:
            tree = pyslang.syntax.SyntaxTree.fromText(
                f"""
              module m (input logic [3:0] a, b, input logic [4:0] n, output logic y, output logic [3:0] w, output logic [8:0] z);
                localparam int Five = 5;
                function automatic logic [3:0] f(input logic [3:0] of); f = of; endfunction
                always_comb begin {{y, w, z}} = '0; {statement}; end
              endmodule""".replace("endcase;", "endcase")
            )
            compilation = pyslang.ast.Compilation()
            compilation.addSyntaxTree(tree)
            errors = [d for d in compilation.getAllDiagnostics() if d.isError()]
            if errors or bool(shortened(compilation, tree.sourceManager)) != short:
                wrong.append(statement)
        return wrong


def holds(rule, values):
    """Whether parameters keep a rule of rtl/defs/kage.yaml."""
    return eval(rule["legal"].replace("||", " or ").replace("&&", " and "), {}, dict(values))


def random_configuration(chance, defs):
    """Any legal configuration without a front end, as verif/test/support/configs.hpp draws it."""
    values = {}
    for p in defs["pixel_params"] + defs["impl_params"]:
        values[p["name"]] = chance.choice(p["allowed"]) if "allowed" in p else chance.randint(p["min"], p["max"])
    for name, least in (("COUNT_BITS", 0), ("CLASS_BITS", 1), ("UNITS", 0), ("CLASSIC", 0)):
        if chance.random() < 0.4:
            values[name] = least
    values["MAX_WIDTH"] = chance.randint(1, 64 if values["ARRANGEMENT"] == 0 else (1 << values["X_BITS"]) - 1)
    values["ACTIVE"] = 0
    for rule in defs["rules"]:
        if not holds(rule, values):
            values |= {name: v if isinstance(v, int) else eval(v, {}, values) for name, v in rule["repair"].items()}
    assert all(holds(rule, values) for rule in defs["rules"]), values
    return values


def random_pairs(source, count):
    """Configurations by their text: so many random ones, each without a front end and, where it may have one, with one."""
    defs = yaml.safe_load((source / "rtl/defs/kage.yaml").read_text())
    most = next(p["max"] for p in defs["impl_params"] if p["name"] == "ACTIVE")
    chance = random.Random(int(os.environ.get("KAGE_SEED", "1")))
    for _ in range(count):
        values = random_configuration(chance, defs)
        for active in (0, chance.choice((1, 2, chance.randint(1, most)))):
            given = {**values, "ACTIVE": active}
            if not all(holds(rule, given) for rule in defs["rules"]):
                continue
            yield " ".join(f"{name}={value}" for name, value in given.items()), given


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
    for name in ("default", "glass", "lights", "smoothmeshes"):
        configurations[f"{name} with a front end"] = {**configurations[name], "ACTIVE": 64}
    bad = 0
    with tempfile.TemporaryDirectory() as work:
        for reader in args.readers:
            cores = configurations | dict(random_pairs(args.source, RANDOM_PAIRS[reader]))
            for (top, illegal, reason), named in ((CORE, cores), (BOARD, BOARDS)):
                read = getattr(Readers(args.source, pathlib.Path(work), top), reader)
                good = 0
                for name, values in named.items():
                    accepted, text = read(values)
                    good += accepted
                    if not accepted:
                        bad += 1
                        print(f"{reader}: {name}: refused: {text}", flush=True)
                accepted, text = read(illegal)
                if accepted or reason not in text:
                    bad += 1
                    print(
                        f"{reader}: {illegal}: {'accepted' if accepted else 'refused, but not because ' + reason}: {text}"
                    )
                print(f"{reader}: {top}: {good} configurations of {len(named)}")
        if "slang" in args.readers:
            for statement in Readers(args.source, pathlib.Path(work), CORE[0]).rule_of_slang():
                bad += 1
                print(f"slang: {statement}: not judged as it must be")
    sys.exit(bad != 0)


if __name__ == "__main__":
    main()
