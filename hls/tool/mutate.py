# SPDX-License-Identifier: Apache-2.0
"""Mutants of the generated modules: which of them do the vectors, or the proofs, notice? tools/hls mutate.

A mutant is one change of one line of a generated module. All mutants of a module stand in one copy of it, behind the input
`mutant_i`, so that one Verilator model, or one reading by yosys, serves them all. A pipeline's mutants are tried by the
vectors of rtl/hls_kernels; those of a module that has a proof, by that proof. A mutant that lives is equivalent where a
proof says so, else it is a gap of the vectors.
"""

from __future__ import annotations

import pathlib
import re
from dataclasses import dataclass, field

SELECT_BITS = 16

_WIRE = re.compile(r"^  wire (?:\[(\d+):0\] )?(\w+) = (.*);$")
_OUTPUT = re.compile(r"^  assign (\w+_o) = (.*);$")
_DECLARED = re.compile(r"^  logic (?:\[(\d+):0\] )?(\w+);")
_PORT = re.compile(r"^    (?:input  wire|output) logic (?:\[(\d+):0\] )?(\w+)")
_REGISTER = re.compile(r"^      (\w+) <= (.*);$")
_CONSTANT = re.compile(r"\b(\d+)'([dh])([0-9a-f]+)\b")
_RANGE = re.compile(r"\b(\w+)\[(\d+)(?::(\d+))?\]")
_SIGNS = re.compile(r"\{(\d+)\{([^{}]+)\}\}")
_CHOICE = re.compile(r"^(.*) \? (.*) : (.*)$")

# Operators that take an operator's place.
_OPERATORS = {
    " + ": (" - ", " | "),
    " - ": (" + ",),
    " * ": (" + ",),
    " & ": (" | ", " ^ "),
    " | ": (" & ", " ^ "),
    " ^ ": (" & ", " | "),
    " < ": (" <= ", " == "),
    " == ": (" != ",),
}


@dataclass
class Mutant:
    module: str
    line: int  # of the module's file, from 0
    kind: str
    text: str  # what stands in the place of the right side, or of a register's way
    terms: (
        tuple[str, str] | None
    )  # equivalent where these two are always the same; None: not to be seen by values alone
    number: int

    def __str__(self) -> str:
        return f"{self.module}.sv:{self.line + 1}: {self.kind}: {self.text}"


@dataclass
class Module:
    """A generated module's lines, and what each of them gives to mutants."""

    name: str
    lines: list[str]
    widths: dict[str, int] = field(default_factory=dict)

    @staticmethod
    def read(path: pathlib.Path) -> Module:
        module = Module(path.stem, path.read_text().splitlines())
        for line in module.lines:
            if m := _WIRE.match(line) or _DECLARED.match(line) or _PORT.match(line):
                module.widths[m[2]] = int(m[1] or 0) + 1
        return module

    def mutants(self) -> list[Mutant]:
        found: list[Mutant] = []

        def add(line: int, kind: str, text: str, terms: tuple[str, str] | None = None) -> None:
            if not any(m.line == line and (m.kind, m.text) == (kind, text) for m in found):
                found.append(Mutant(self.name, line, kind, text, terms, len(found) + 1))

        for i, line in enumerate(self.lines):
            if m := _WIRE.match(line):
                for change in self._expressions(m[3]):
                    add(i, *change)
            elif m := _REGISTER.match(line):
                add(i, "register left out", m[2])
                add(i, "register twice", m[1])
                add(i, "register that never stands", m[2])
                for change in self._expressions(m[2]):
                    add(i, *change)
            elif line == "  assign advance = out_ready_i || !out_valid_o;":
                for text in ("out_ready_i", "1'b1", "!out_valid_o"):
                    add(i, "handshake", text)
            elif line == "  assign in_ready_o = advance;":
                for text in ("1'b1", "out_ready_i"):
                    add(i, "handshake", text)
            elif m := re.match(r"^  assign out_valid_o = valid\[(\d+)\];$", line):
                for text in (f"valid[{int(m[1]) - 1}]" if m[1] != "0" else "in_valid_i", "1'b1"):
                    add(i, "handshake", text)
            elif line == "    if (!rst_ni) valid <= '0;":
                add(i, "no reset", "rst_ni")
            elif m := re.match(r"^    else if \(advance\) valid <= (.*);$", line):
                for text in ("'1", "in_valid_i ? '1 : '0" if "{" in m[1] else "!in_valid_i"):
                    add(i, "handshake", text)
            elif m := _OUTPUT.match(line):
                for change in self._expressions(m[2]):
                    add(i, *change)
        return found

    def _expressions(self, text: str) -> list[tuple[str, str, tuple[str, str]]]:
        """Right sides that differ from `text` in one thing: kind, the right side, and the terms that differ."""
        found = []

        def whole(kind: str, new: str) -> None:
            found.append((kind, new, (text, new)))

        def part(kind: str, m: re.Match, new: str, old_term: str, new_term: str) -> None:
            found.append((kind, text[: m.start()] + new + text[m.end() :], (old_term, new_term)))

        for old, news in _OPERATORS.items():
            for at in (m.start() for m in re.finditer(re.escape(old), text)):
                for new in news:
                    whole("operator", text[:at] + new + text[at + len(old) :])
                if old in (" + ", " - ", " * ", " & ", " | ", " ^ ") and "?" not in text:
                    whole("operand left out", text[:at])
                    whole("operand left out", text[at + len(old) :])
        if m := _CHOICE.match(text):
            choose, one, zero = m.groups()
            whole("choice swapped", f"{choose} ? {zero} : {one}")
            whole("no choice", one)
            whole("no choice", zero)
        if text.startswith("~"):
            whole("operator", text[1:])
        for m in _CONSTANT.finditer(text):
            width, base, value = int(m[1]), m[2], int(m[3], 10 if m[2] == "d" else 16)
            for bit in sorted({0, width - 1}):
                new = value ^ 1 << bit
                digits = f"{new:d}" if base == "d" else f"{new:x}"
                whole("constant", f"{text[: m.start()]}{width}'{base}{digits}{text[m.end() :]}")
        for m in _RANGE.finditer(text):
            high, low = int(m[2]), int(m[3] or m[2])
            for by in (-1, 1):
                if low + by >= 0 and high + by < self.widths[m[1]]:
                    bits = f"{high + by}:{low + by}" if m[3] else f"{high + by}"
                    part("bits off by one", m, f"{m[1]}[{bits}]", m[0], f"{m[1]}[{bits}]")
        for m in _SIGNS.finditer(text):
            part("sign left out", m, f"{{{m[1]}{{1'b0}}}}", m[2], "1'b0")
        return found

    def values_alone(self, pairs: list[tuple[str, str]]) -> str:
        """The module without registers, whose values go through as if each stage took no time, with an assertion that the
        two of each pair are the same."""
        out = []
        for line in self.lines:
            if m := _REGISTER.match(line):
                out.append(f"  assign {m[1]} = {m[2]};")
            elif line == "endmodule":
                out += [f"  always_comb assert (({a}) == ({b}));" for a, b in pairs]
                out.append(line)
            elif not re.match(r"^  always_ff|^    if \(|^    else if|^ +end$", line):
                out.append(line)
        return "\n".join(out) + "\n"

    # ---- all mutants in one module ----

    def with_mutants(self, mutants: list[Mutant], has_port: bool) -> str:
        """The module with these mutants behind mutant_i; 0 is the module as it is. Without a port mutant_i is a wire that
        nothing drives, which a proof sets."""
        by_line: dict[int, list[Mutant]] = {}
        for m in mutants:
            by_line.setdefault(m.line, []).append(m)
        out = []
        extra: list[str] = []  # registers of lines within an always block that is still open
        for i, line in enumerate(self.lines):
            some = by_line.get(i, [])
            if line == f"module {self.name} (":
                out.append(
                    f"module {self.name} (" + (f"input wire logic [{SELECT_BITS - 1}:0] mutant_i," if has_port else "")
                )
            elif line == ");" and not has_port:
                out += [line, f"  wire [{SELECT_BITS - 1}:0] mutant_i;"]
            elif m := some and _REGISTER.match(line):
                extra += self._register(m[1], m[2], some)
            elif some:
                left, right, end = re.match(r"^(.*? <?= )(.*)(;)$", line).groups()
                if some[0].kind == "no reset":
                    out.append(line.replace("!rst_ni", f"!rst_ni && {self._none(some)}"))
                else:
                    out.append(left + self._chosen(some, right) + end)
            elif (m := _DECLARED.match(line)) and self._is_mutated(m[2], by_line):
                pass  # _register declares it as a wire
            else:
                out.append(line)
                if line == "  end":
                    out += extra
                    extra = []
        return "\n".join(out) + "\n"

    def _is_mutated(self, name: str, by_line: dict[int, list[Mutant]]) -> bool:
        return any((m := _REGISTER.match(self.lines[i])) and m[1] == name for i in by_line)

    @staticmethod
    def _is(m: Mutant) -> str:
        return f"mutant_i == {SELECT_BITS}'d{m.number}"

    def _none(self, some: list[Mutant]) -> str:
        return " && ".join(f"!({self._is(m)})" for m in some)

    def _chosen(self, some: list[Mutant], right: str) -> str:
        return "".join(f"{self._is(m)} ? ({m.text}) : " for m in some) + f"({right})"

    def _register(self, name: str, before: str, some: list[Mutant]) -> list[str]:
        width = self.widths[name]
        bits = f"[{width - 1}:0] "
        ways = {"register left out": before, "register twice": f"{name}_twice"}
        value = "".join(f"{self._is(m)} ? {ways[m.kind]} : " for m in some if m.kind in ways) + f"{name}_once"
        free = [self._is(m) for m in some if m.kind == "register that never stands"]
        others = [m for m in some if m.kind not in ways and m.kind != "register that never stands"]
        return [
            f"  wire {bits}{name};",
            f"  logic {bits}{name}_once;",
            f"  logic {bits}{name}_twice;",
            "  always_ff @(posedge clk_i) begin",
            f"    if (advance) {name}_twice <= {name}_once;",
            f"    if ({' || '.join(['advance', *free])}) {name}_once <= {self._chosen(others, before)};",
            "  end",
            f"  assign {name} = {value};",
        ]
