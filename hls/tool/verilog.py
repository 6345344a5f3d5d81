# SPDX-License-Identifier: Apache-2.0
"""A scheduled graph as SystemVerilog."""

from __future__ import annotations

import re

from .graph import Graph, Node, live
from .llvm_ir import Port
from .schedule import Schedule

# Words of SystemVerilog that a C++ variable may be called by.
RESERVED = frozenset(
    "alias always and assert assign assume automatic before begin bind bit buf byte case cell chandle class clocking config"
    " const constraint context continue cover cross deassign design disable dist edge else end enum event expect extends"
    " extern final first_match force forever fork function generate genvar global highz0 highz1 if iff ifnone include"
    " initial inout input inside int integer interface intersect join large let library local localparam logic longint"
    " macromodule matches medium modport module nand negedge new nor not null or output package packed parameter posedge"
    " primitive priority program property protected pull0 pull1 pulldown pullup pure rand randc randcase ref reg reject_on"
    " release repeat restrict return scalared sequence shortint shortreal signed small soft solve specify static string"
    " strong struct super supply0 supply1 sync_accept_on table tagged task this throughout time timeprecision timeunit tran"
    " tri tri0 tri1 type typedef union unique unsigned until untyped use uwire var vectored virtual void wait wand weak"
    " while wildcard wire with within wor xnor xor".split()
)


def _range(width: int) -> str:
    return "" if width == 1 else f"[{width - 1}:0] "


class Emitter:
    def __init__(self, name: str, graph: Graph, schedule: Schedule, ports: list[Port], head: list[str]):
        self._module = name
        self._graph = graph
        self._schedule = schedule
        self._ports = ports
        self._head = head
        self._nodes = live(graph.outputs.values())
        self._names: dict[int, str] = {}
        self._registers: dict[tuple[int, int], str] = {}
        self._by_stage: dict[int, list[str]] = {}
        self._register_lines: dict[int, list[tuple[str, str, int]]] = {}
        self._taken = (
            {p.name for p in ports}
            | RESERVED
            | {
                "clk_i",
                "rst_ni",
                "in_valid_i",
                "in_ready_o",
                "out_valid_o",
                "out_ready_i",
                "valid",
                "advance",
            }
        )

    # ---- names ----

    def _unique(self, wish: str) -> str:
        name, k = wish, 2
        while name in self._taken:
            name, k = f"{wish}_{k}", k + 1
        self._taken.add(name)
        return name

    def _give_names(self) -> None:
        for n in self._nodes:
            if n.op == "in":
                self._names[n.number] = n.value
            elif n.op not in ("const", "slice", "cat", "sext"):
                self._names[n.number] = self._unique(n.name or f"{n.op}_{n.number}")

    # ---- expressions ----

    def _at(self, n: Node, stage: int) -> str:
        """A value as it is in a stage, through registers from the stage that made it."""
        made = self._schedule.end(n)
        name = self._names[n.number]
        assert stage >= made, n
        if stage == made:
            return name
        key = (n.number, stage)
        if key not in self._registers:
            before = self._at(n, stage - 1)
            self._registers[key] = self._unique(f"{name}_s{stage}")
            self._register_lines.setdefault(stage, []).append((self._registers[key], before, n.width))
        return self._registers[key]

    def _wire(self, n: Node, stage: int) -> str:
        """An operand: a name, a part of one, or wiring of several."""
        match n.op:
            case "const":
                return f"{n.width}'d{n.value}" if n.width < 32 or n.value < 1 << 31 else f"{n.width}'h{n.value:x}"
            case "slice":
                base = self._wire(n.args[0], stage)
                low, high = n.value, n.value + n.width - 1
                if n.args[0].width == 1:
                    return base
                return f"{base}[{low}]" if n.width == 1 else f"{base}[{high}:{low}]"
            case "cat":
                return "{" + ", ".join(self._wire(p, stage) for p in reversed(n.args)) + "}"
            case "sext":
                inner = n.args[0]
                top = self._wire(self._graph.slice(inner, inner.width - 1, 1), stage)
                return f"{{{{{n.width - inner.width}{{{top}}}}}, {self._wire(inner, stage)}}}"
        return self._at(n, stage)

    def _expression(self, n: Node) -> str:
        stage = self._schedule.end(n)
        a = [self._wire(x, stage) for x in n.args]
        match n.op:
            case "and":
                return f"{a[0]} & {a[1]}"
            case "or":
                return f"{a[0]} | {a[1]}"
            case "xor":
                if n.args[1].op == "const" and n.args[1].value == (1 << n.width) - 1:
                    return f"~{a[0]}"
                return f"{a[0]} ^ {a[1]}"
            case "mux":
                return f"{a[0]} ? {a[1]} : {a[2]}"
            case "add":
                return f"{a[0]} + {a[1]}"
            case "sub":
                return f"{a[0]} - {a[1]}"
            case "eq":
                return f"{a[0]} == {a[1]}"
            case "ult":
                return f"{a[0]} < {a[1]}"
            case "slt":
                return f"$signed({a[0]}) < $signed({a[1]})"
            case "mul":
                return " * ".join(
                    self._factor(x, t, s, n.width, stage) for x, t, s in zip(n.args, a, n.value, strict=True)
                )
        raise AssertionError(n.op)

    def _factor(self, a: Node, text: str, is_signed: bool, width: int, stage: int) -> str:
        if a.width >= width:
            return text
        if not is_signed:
            return f"{{{width - a.width}'d0, {text}}}"
        top = self._wire(self._graph.slice(a, a.width - 1, 1), stage)
        return f"{{{{{width - a.width}{{{top}}}}}, {text}}}"

    # ---- the module ----

    def _stage_lines(self, stage: int) -> list[str]:
        lines = []
        for n in self._nodes:
            if n.op in ("const", "in", "slice", "cat", "sext") or self._schedule.end(n) != stage:
                continue
            lines.append(f"  wire {_range(n.width)}{self._names[n.number]} = {self._expression(n)};")
        return lines

    def _port_lines(self) -> list[str]:
        lines = []
        if self._schedule.stages:
            lines += [
                "input  wire logic clk_i",
                "input  wire logic rst_ni",
                "input  wire logic in_valid_i",
                "output logic in_ready_o",
                "output logic out_valid_o",
                "input  wire logic out_ready_i",
            ]
        for p in self._ports:
            way = "input  wire logic" if p.is_input else "output logic"
            note = "  // signed" if p.is_signed else ""
            lines.append(f"{way} {_range(p.width)}{p.name}{note}")
        # A comma stands before the comment of its line.
        return [
            "    " + (line if i == len(lines) - 1 else re.sub(r"(  //.*)?$", r",\1", line, count=1))
            for i, line in enumerate(lines)
        ]

    def _control_lines(self) -> list[str]:
        stages = self._schedule.stages
        shifted = f"{{valid[{stages - 2}:0], in_valid_i}}" if stages > 1 else "in_valid_i"
        return [
            f"  logic [{stages - 1}:0] valid;  // of the registers behind each stage",
            "  logic advance;",
            f"  assign out_valid_o = valid[{stages - 1}];",
            "  assign advance = out_ready_i || !out_valid_o;",
            "  assign in_ready_o = advance;",
            "  always_ff @(posedge clk_i) begin",
            "    if (!rst_ni) valid <= '0;",
            f"    else if (advance) valid <= {shifted};",
            "  end",
        ]

    def text(self) -> str:
        self._give_names()
        stages = self._schedule.stages
        body = [self._stage_lines(s) for s in range(max(1, stages))]
        outputs = [
            f"  assign {p.name} = {self._wire(self._graph.outputs[p.name], stages)};"
            for p in self._ports
            if not p.is_input
        ]
        # Carry chains have bits between those that are used, and a configuration has ports that it does not read.
        lines = [*self._head, "/* verilator lint_off UNUSEDSIGNAL */", "`default_nettype none", ""]
        lines += [f"module {self._module} (", *self._port_lines(), ");", ""]
        if stages:
            lines += self._control_lines()
        for s, wires in enumerate(body):
            lines += ["", f"  // stage {s}"] if stages else []
            lines += wires
            if stages and (registers := self._register_lines.get(s + 1)):
                lines += [f"  logic {_range(width)}{name};" for name, _, width in registers]
                lines += ["  always_ff @(posedge clk_i) begin", "    if (advance) begin"]
                lines += [f"      {name} <= {before};" for name, before, _ in registers]
                lines += ["    end", "  end"]
        return "\n".join([*lines, "", *outputs, "endmodule", "", "`default_nettype wire", ""])
