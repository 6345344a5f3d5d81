# SPDX-License-Identifier: Apache-2.0
"""Measures how long operations take on a device, and writes hls/tool/delays/DEVICE.json. hls/tool/characterise runs it.

A design has registers, a chain of one to three equal operations of a width, and registers again; yosys and nextpnr say
how fast its clock may be. Between the operations of a chain bits change places, so that the last bit of one is the
first that the next one waits for, as the quotient's bit of a divider is. The table is a fit by least squares:

    period = register + operations (first + each * width)
"""

from __future__ import annotations

import argparse
import json
import pathlib
import statistics
import sys
import tempfile

import yaml

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tools/fpga_flow"))

import flow  # noqa: E402
import programs  # noqa: E402

# For each operation: widths, and how many follow each other.
OPERATIONS = {
    "add": ((8, 16, 24, 32, 48), (1, 2, 3)),
    "mux": ((8, 16, 24, 32, 48), (1, 2, 3)),
    "eq": ((4, 8, 16, 32), (1, 2, 3)),
    "logic": ((8, 24), (1, 2, 3)),
    "mul": ((9, 18), (1, 2)),
}
COPIES = 4  # of a chain in a design, so that wires cross as they do in one
TILES = {
    "ecp5": 18,
    "ice40": 16,
}  # bits of a factor that one multiplier takes, or that are one operation where there is none


def reversed_bits(name: str, width: int) -> str:
    return "{" + ", ".join(f"{name}[{i}]" for i in range(width)) + "}"


def design_text(operation: str, width: int, chain: int) -> str:
    """Values come in and go out bit by bit, through registers alone."""
    lines = [
        "module measured (input wire clk, input wire in, output reg out);",
        f"  reg [{2 * COPIES * width - 1}:0] line;",
        f"  reg [{COPIES - 1}:0] ends;",
        "  always @(posedge clk) begin line <= {line, in}; out <= ends[0]; end",
    ]
    for i in range(COPIES):
        lines += [f"  reg [{width - 1}:0] x{i}_0, b{i}, y{i}, z{i};", f"  reg take{i};"]
        for k in range(chain):
            x = f"x{i}_{k}"
            match operation:
                case "add":
                    lines.append(f"  wire [{width - 1}:0] s{i}_{k} = {x} + b{i};")
                    value = reversed_bits(f"s{i}_{k}", width)
                case "mux":
                    value = f"{x}[0] ? b{i} : {{{x}[{width - 2}:0], {x}[{width - 1}]}}"
                case "eq":
                    value = f"{{{x}[{width - 2}:0], {x} == b{i}}}"
                case "logic":
                    value = f"{reversed_bits(x, width)} ^ (b{i} & {{{x}[0], {x}[{width - 1}:1]}})"
                case _:
                    value = f"{x} * b{i}"
            lines.append(f"  wire [{width - 1}:0] x{i}_{k + 1} = {value};")
        lines += [
            "  always @(posedge clk) begin",
            f"    {{x{i}_0, b{i}}} <= line[{2 * i * width}+:{2 * width}];",
            f"    take{i} <= line[{i}];",
            f"    y{i} <= x{i}_{chain};",
            f"    z{i} <= take{i} ? y{i} : z{i} << 1;",
            f"    ends[{i}] <= z{i}[{width - 1}]" + (f" ^ ends[{i + 1}];" if i + 1 < COPIES else ";"),
            "  end",
        ]
    return "\n".join([*lines, "endmodule", ""])


def solved(rows: list[list[float]], values: list[float]) -> list[float]:
    """Least squares by the normal equations."""
    n = len(rows[0])
    a = [[sum(r[i] * r[k] for r in rows) for k in range(n)] for i in range(n)]
    y = [sum(r[i] * v for r, v in zip(rows, values, strict=True)) for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(a[k][i]))
        a[i], a[pivot], y[i], y[pivot] = a[pivot], a[i], y[pivot], y[i]
        for k in range(i + 1, n):
            f = a[k][i] / a[i][i]
            a[k] = [p - f * q for p, q in zip(a[k], a[i], strict=True)]
            y[k] -= f * y[i]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (y[i] - sum(a[i][k] * x[k] for k in range(i + 1, n))) / a[i][i]
    return x


def main() -> int:
    parser = argparse.ArgumentParser(prog="hls/tool/characterise", description=__doc__.splitlines()[0])
    parser.add_argument("device", help="of constraints/devices.yaml")
    parser.add_argument("--seeds", type=int, default=2, help="placements of each design, of which the median counts")
    parser.add_argument("--wheels", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    entry = yaml.safe_load((TOP / "constraints/devices.yaml").read_text())[arguments.device]
    device = argparse.Namespace(name=arguments.device, **entry)
    tools = programs.Programs("any", arguments.wheels, TOP)
    measured = []
    with tempfile.TemporaryDirectory(dir=TOP / "build") as folder:
        folder = pathlib.Path(folder)
        design = flow.Design("measured", "measured", {}, sources="measured.sv", includes=())
        for operation, (widths, chains) in OPERATIONS.items():
            for width in widths:
                for chain in chains:
                    (folder / "measured.sv").write_text(design_text(operation, width, chain))
                    flow.synthesize(tools, device, design, folder)
                    clocks = [
                        flow.clock_of(flow.place(tools, device, design, folder, s))
                        for s in range(1, arguments.seeds + 1)
                    ]
                    ns = 1000 / statistics.median(clocks)
                    measured.append({"operation": operation, "width": width, "chain": chain, "ns": round(ns, 3)})
                    print(f"{operation} {width} x {chain}: {ns:.2f} ns", file=sys.stderr, flush=True)
    kinds = list(OPERATIONS)
    rows = []
    for m in measured:
        row = [1.0] + [0.0] * (2 * len(kinds))
        at = 1 + 2 * kinds.index(m["operation"])
        row[at], row[at + 1] = m["chain"], m["chain"] * m["width"]
        rows.append(row)
    fit = solved(rows, [m["ns"] for m in measured])
    off = [sum(f * r for f, r in zip(fit, row, strict=True)) - m["ns"] for row, m in zip(rows, measured, strict=True)]
    table = {
        "device": arguments.device,
        "tools": {p.name: p.version for p in (tools.find("yosys"), tools.find(f"nextpnr-{device.family}"))},
        "tile": TILES[device.family],
        "register_ns": round(fit[0], 3),
        "operations": {k: [round(fit[1 + 2 * i], 3), round(fit[2 + 2 * i], 4)] for i, k in enumerate(kinds)},
        "off_ns": {"rms": round(statistics.fmean(o * o for o in off) ** 0.5, 2), "most": round(max(map(abs, off)), 2)},
        "measured": measured,
    }
    path = TOP / "hls/tool/delays" / f"{arguments.device}.json"
    lines = [f'"{k}": {json.dumps(v)}' for k, v in table.items() if k != "measured"]
    lines.append('"measured": [\n' + ",\n".join("  " + json.dumps(m) for m in measured) + "\n]")
    path.write_text("{\n" + ",\n".join(lines) + "\n}\n")
    print(f"{path}: off by {table['off_ns']['rms']} ns rms, {table['off_ns']['most']} ns at most")
    return 0


if __name__ == "__main__":
    sys.exit(main())
