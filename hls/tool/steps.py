# SPDX-License-Identifier: Apache-2.0
"""A kernel on its way from C++ to SystemVerilog, as text at each step: tools/hls steps (docs/hls/four-steps.md)."""

from __future__ import annotations

import re

from .delays import Delays
from .graph import WIRING, Graph, Node, live
from .schedule import Schedule, begins_and_ends

STEPS = ("ir", "graph", "small", "schedule", "verilog")


def ir_of(text: str, function: str) -> str:
    """The function in LLVM's IR, without what is for debuggers and for alias analysis."""
    lines = text.splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("define ") and f"@{function}(" in line)
    found = []
    for line in lines[at:]:
        if "call void @llvm.dbg." not in line:
            found.append(re.sub(r"(,? ![a-z.]+ !\d+)+( \{)?$", r"\2", line))
        if line == "}":
            return "\n".join(found)
    raise AssertionError(function)


def _operand(n: Node) -> str:
    """An operand: wiring of constants and inputs is written where it is read."""
    match n.op:
        case "const":
            return f"{n.value}:{n.width}"
        case "in":
            return n.value
        case "slice":
            base, low = _operand(n.args[0]), n.value
            return f"{base}[{low}]" if n.width == 1 else f"{base}[{low + n.width - 1}:{low}]"
        case "cat":
            return "{" + ", ".join(_operand(p) for p in reversed(n.args)) + "}"
        case "sext":
            return f"sext({_operand(n.args[0])}, {n.width})"
    return f"%{n.number}"


def _operation(n: Node) -> str:
    return f"{n.op}({', '.join(_operand(a) for a in n.args)})"


def graph_of(graph: Graph) -> str:
    """A line for each operation: its bits, what it does with what, and the C++ variable that has its value."""
    lines = [f"{name}:{n.width} is an input" for name, n in graph.inputs.items()]
    for n in live(graph.outputs.values()):
        if n.op not in WIRING:
            lines.append(f"%{n.number}:{n.width} = {_operation(n)}" + (f"  {n.name}" if n.name else ""))
    lines += [f"{name}:{n.width} = {_operand(n)}" for name, n in graph.outputs.items()]
    return "\n".join(lines)


def schedule_of(graph: Graph, schedule: Schedule, delays: Delays) -> str:
    """A table of the operations, by their stages: when each begins and ends, in ns from the clock's edge."""
    lines = [
        f"{schedule.stages} stages of {schedule.period:.2f} ns or less, {1000 / schedule.period:.0f} MHz, by the delays of"
        f" {delays.device}; a register takes {delays.register:.2f} ns",
        "stage  from ns  to ns  operation",
    ]
    times = begins_and_ends(graph, schedule, delays)
    nodes = [n for n in live(graph.outputs.values()) if n.op not in WIRING]
    for n in sorted(nodes, key=lambda n: (schedule.end(n), n.number)):
        begin, end = times[n.number]
        name = f"  {n.name}" if n.name else ""
        lines.append(f"{schedule.end(n):5}  {begin:7.2f}  {end:5.2f}  %{n.number}:{n.width} = {_operation(n)}{name}")
    return "\n".join(lines)
