# SPDX-License-Identifier: Apache-2.0
"""LLVM's textual IR of one function, as clang 14 writes it for a kernel, to a graph.

A kernel is `void f(const In& in, Out& out)` with structs of integers, without loops, calls and memory of its own: what
is left of one once it is inlined and unrolled. All else is refused by name.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from .debug_names import DebugNames
from .graph import Graph, Node, always, give_name
from .trouble import Trouble

CLANG_MAJOR = 14


@dataclass
class Port:
    """An integer of a struct that a kernel takes or gives."""

    name: str
    width: int
    is_signed: bool
    is_input: bool


@dataclass(frozen=True)
class Place:
    """An integer within a port."""

    port: str
    low: int
    width: int
    is_input: bool


@dataclass
class Type:
    """A struct, an array or an integer of the IR."""

    width: int = 0
    parts: list[Type] = field(default_factory=list)
    is_array: bool = False


@dataclass
class Block:
    label: str
    lines: list[str] = field(default_factory=list)


_VALUE = r"(?:%[\w.\"$:-]+|-?\d+|true|false|undef|poison)"
_BINARY = re.compile(rf"(\w+)((?: (?:nuw|nsw|exact))*) i(\d+) ({_VALUE}), ({_VALUE})$")
_ICMP = re.compile(rf"icmp (\w+) i(\d+) ({_VALUE}), ({_VALUE})$")
_SELECT = re.compile(rf"select i1 ({_VALUE}), i(\d+) ({_VALUE}), i\d+ ({_VALUE})$")
_CAST = re.compile(rf"(zext|sext|trunc) i(\d+) ({_VALUE}) to i(\d+)$")
_PHI = re.compile(r"phi i(\d+) (.*)$")
_PHI_POINTER = re.compile(r"phi i\d+\* (.*)$")
_SELECT_POINTER = re.compile(rf"select i1 ({_VALUE}), i\d+\* (%[\w.]+), i\d+\* (%[\w.]+)$")
_PHI_WAY = re.compile(rf"\[ ({_VALUE}), %([\w.]+) \]")
_GEP = re.compile(r"getelementptr (?:inbounds )?.*?\* (%[\w.]+)((?:, i\d+ \d+)+)$")
_BITCAST = re.compile(r"bitcast .*?\* (%[\w.]+) to i(\d+)\*$")
_LOAD = re.compile(r"load i(\d+), i\d+\* (%[\w.]+)")
_STORE = re.compile(rf"store i(\d+) ({_VALUE}), i\d+\* (%[\w.]+)")
_CALL = re.compile(r"(?:tail )?call (?:[a-z]+ )*(?:i(\d+)|void) @([\w.]+)\((.*)\)")
_FREEZE = re.compile(rf"freeze i(\d+) ({_VALUE})$")
_BR = re.compile(r"br label %([\w.]+)$")
_BR_IF = re.compile(rf"br i1 ({_VALUE}), label %([\w.]+), label %([\w.]+)$")
_SWITCH = re.compile(rf"switch i(\d+) ({_VALUE}), label %([\w.]+) \[(.*)\]$")
_SWITCH_WAY = re.compile(r"i\d+ (-?\d+), label %([\w.]+)")
_DEBUG_VALUE = re.compile(rf"metadata i(\d+) ({_VALUE}), metadata (!\d+), metadata !DIExpression\(\)")
_STRUCT = re.compile(r'^(%(?:"[^"]+"|[\w.:]+)) = type (?:<)?\{ (.*) \}')


class Reader:
    def __init__(self, text: str, function: str):
        self._text = text
        self._function = function
        self._names = DebugNames(text)
        self.graph = Graph()
        self.ports: list[Port] = []
        self._structs: dict[str, str] = {}
        self._value: dict[str, Node] = {}
        self._pointers: dict[str, tuple[int, tuple[int, ...]]] = {}
        self._choices: dict[str, tuple[Node, str, str]] = {}  # a pointer that is one or the other of two
        self._place_of: dict[tuple[int, tuple[int, ...]], Place] = {}
        self._conditions: dict[str, Node] = {}
        self._edges: dict[tuple[str, str], Node] = {}
        self._stores: dict[Place, tuple[Node, Node]] = {}  # value, and where it is stored
        self._always: set[str] = set()  # blocks that run whatever the inputs are

    # ---- text to blocks ----

    def _refuse(self, what: str) -> Trouble:
        return Trouble(f"{self._function}: {what}")

    def _type(self, text: str) -> Type:
        text = text.strip()
        if m := re.fullmatch(r"i(\d+)", text):
            return Type(width=int(m[1]))
        if m := re.fullmatch(r"\[(\d+) x (.*)\]", text):
            return Type(parts=[self._type(m[2])] * int(m[1]), is_array=True)
        if text in self._structs:
            return Type(parts=[self._type(t) for t in self._split(self._structs[text])])
        raise self._refuse(f"a port of type {text}: ports are structs of hw::u, hw::s and arrays of them")

    @staticmethod
    def _split(text: str) -> list[str]:
        parts, depth, current = [], 0, ""
        quoted = False
        for c in text:
            quoted ^= c == '"'
            depth += not quoted and c in "[{(<"
            depth -= not quoted and c in "]})>"
            if c == "," and depth == 0 and not quoted:
                parts.append(current.strip())
                current = ""
            else:
                current += c
        return [*parts, current.strip()] if current.strip() else parts

    def _blocks(self) -> tuple[list[str], str, list[Block]]:
        """The function's arguments, the key of its debug information, and its blocks."""
        lines = self._text.splitlines()
        head = re.compile(rf"^define .*@{re.escape(self._function)}\((.*)\) .*\{{$")
        at = next((i for i, line in enumerate(lines) if head.match(line)), None)
        if at is None:
            raise self._refuse("no such function in the IR")
        match = head.match(lines[at])
        debug = re.search(r"!dbg (!\d+)", lines[at])
        blocks = [Block("")]
        joined = ""
        for line in lines[at + 1 :]:
            if line == "}":
                break
            line = line.split(";")[0].rstrip() if not line.lstrip().startswith("call") else line
            if label := re.match(r"^([\w.]+):", line):
                blocks.append(Block(label[1]))
            elif line.strip():
                joined += line.strip() + " "
                if joined.count("[") == joined.count("]"):  # a switch has a line for each way
                    blocks[-1].lines.append(re.sub(r"(, ![a-z.]+ !\d+)+$", "", joined.strip()))
                    joined = ""
        arguments = self._split(match[1])
        if blocks[0].label == "":
            blocks[0].label = str(len(arguments))  # what clang calls a first block without a name
        return arguments, debug[1] if debug else "", blocks

    # ---- ports ----

    def _add_ports(
        self, argument: int, place: tuple[int, ...], type_: Type, name: str, key: str, is_input: bool
    ) -> None:
        if type_.width > 0 or type_.is_array:
            # An array is one port, its first element lowest.
            count = len(type_.parts) if type_.is_array else 1
            width = type_.parts[0].width if type_.is_array else type_.width
            if width == 0:
                raise self._refuse(f"{name} is an array of something else than integers")
            name = name.partition("_")[2] + ("_i" if is_input else "_o")  # the argument's own name says no more
            is_signed = self._names.is_signed(self._names.element(key) if type_.is_array else key)
            self.ports.append(Port(name, count * width, is_signed and count == 1, is_input))
            for i in range(count):
                where = (*place, i) if type_.is_array else place
                self._place_of[argument, where] = Place(name, i * width, width, is_input)
            if is_input:
                self.graph.input(name, count * width)
            return
        members = self._names.members(key)
        for i, part in enumerate(type_.parts):
            if members is None or i >= len(members):
                raise self._refuse(f"no names of the members of {name}: compile with -g")
            self._add_ports(argument, (*place, i), part, f"{name}_{members[i][0]}", members[i][1], is_input)

    def _read_ports(self, arguments: list[str], debug: str) -> None:
        named = self._names.arguments(debug)
        ways = ["readonly" in a.split() or "readnone" in a.split() for a in arguments]
        if ways != [True, False]:
            raise self._refuse("it is no void f(const In& __restrict, Out& __restrict)")
        for i, text in enumerate(arguments):
            match = re.match(r'^(%(?:"[^"]+"|[\w.:]+)|i\d+)\* (.*) (%[\w.]+)$', text)
            if not match:
                raise self._refuse(f"argument {i + 1} is no reference to a struct: {text}")
            attributes = match[2].split()
            if i + 1 not in named:
                raise self._refuse("no names of its arguments: compile with -g")
            name, key = named[i + 1]
            is_input = "readonly" in attributes or "readnone" in attributes
            if not is_input and "writeonly" not in attributes:
                raise self._refuse(f"{name} is read and written: a port is one or the other")
            if "noalias" not in attributes:
                raise self._refuse(f"{name} lacks __restrict, so it might be another port")
            self._pointers[match[3]] = (i, ())
            self._add_ports(i, (), self._type(match[1]), name, key, is_input)

    def _place(self, pointer: str) -> Place:
        if pointer not in self._pointers:
            raise self._refuse(f"{pointer} points to memory that is no port")
        argument, place = self._pointers[pointer]
        while (argument, place) not in self._place_of:
            place = (*place, 0)  # a pointer to a struct is one to its first member
            if len(place) > 8:
                raise self._refuse(f"{pointer} points to no port")
        return self._place_of[argument, place]

    # ---- values ----

    def _get(self, text: str, width: int, chosen: bool = False) -> Node:
        """A value. `chosen`: by a choice, where clang leaves open what is not used."""
        if text in ("undef", "poison"):
            if not chosen:
                raise self._refuse("a value that is never set is used")
            return self.graph.const(width, 0)
        if text in ("true", "false"):
            return self.graph.const(1, int(text == "true"))
        if text[0] == "%":
            if text not in self._value:
                raise self._refuse(f"{text} is used before it is made, as in a loop")
            return self._value[text]
        return self.graph.const(width, int(text))

    def _binary(self, op: str, width: int, a: Node, b: Node) -> Node:
        g = self.graph
        match op:
            case "add":
                return g.add(a, b)
            case "sub":
                return g.sub(a, b)
            case "mul":
                return g.mul(a, b)
            case "and":
                return g.and_(a, b)
            case "or":
                return g.or_(a, b)
            case "xor":
                return g.xor(a, b)
            case "shl" | "lshr" | "ashr":
                if b.op == "const":
                    return self._shifted(op, a, b.value)
                result = a
                for bit in range((width - 1).bit_length()):
                    result = g.mux(g.slice(b, bit, 1), self._shifted(op, result, 1 << bit), result)
                return result
        raise self._refuse(f"instruction {op} is none of those that become hardware here")

    def _shifted(self, op: str, a: Node, by: int) -> Node:
        return self.graph.shift_left(a, by) if op == "shl" else self.graph.shift_right(a, by, op == "ashr")

    def _compare(self, predicate: str, a: Node, b: Node) -> Node:
        g = self.graph
        is_signed = predicate.startswith("s")
        match predicate[-2:] if len(predicate) == 3 else predicate:
            case "eq":
                return g.equal(a, b)
            case "ne":
                return g.not_(g.equal(a, b))
            case "lt":
                return g.less(a, b, is_signed)
            case "gt":
                return g.less(b, a, is_signed)
            case "le":
                return g.not_(g.less(b, a, is_signed))
            case "ge":
                return g.not_(g.less(a, b, is_signed))
        raise self._refuse(f"icmp {predicate}")

    def _select(self, choose: Node, one: Node, zero: Node) -> Node:
        # clang writes what is chosen by a sign as a comparison with 0: x > 0 ? x : 0 needs the sign alone.
        g = self.graph
        if zero.op == "const" and zero.value == 0 and choose.op == "slt":
            low, high = choose.args
            if low.op == "const" and low.value == 0 and high is one:
                return g.mux(g.slice(one, one.width - 1, 1), zero, one)
        return g.mux(choose, one, zero)

    def _call(self, name: str, width: int, arguments: str) -> Node:
        if not name.startswith("llvm."):
            raise self._refuse(f"a call of {name}: kernels are inlined whole")
        values = [self._get(a.split()[-1], width) for a in self._split(arguments)]
        g = self.graph
        stem = name.removeprefix("llvm.").rsplit(".", 1)[0]
        match stem:
            case "fshl" | "fshr" if values[2].op == "const":
                by = values[2].value % width
                both = g.cat([values[1], values[0]])
                return g.slice(both, width - by if stem == "fshl" else by, width)
            case "smax":
                return self._select(g.less(values[1], values[0], True), *values)
            case "smin":
                return self._select(g.less(values[0], values[1], True), *values)
            case "umax":
                return g.mux(g.less(values[1], values[0], False), *values)
            case "umin":
                return g.mux(g.less(values[0], values[1], False), *values)
        raise self._refuse(f"{name} is none of the functions that become hardware here")

    # ---- control flow ----

    def _enter(self, block: Block) -> None:
        """The condition under which a block runs."""
        g = self.graph
        if block.label not in self._conditions:
            ways = [cond for (_, to), cond in self._edges.items() if to == block.label]
            total = ways[0]
            for way in ways[1:]:
                total = g.or_(total, way)
            self._conditions[block.label] = g.const(1, 1) if block.label in self._always else total

    def _ways(self, label: str, text: str) -> list[tuple[str, str]]:
        """A phi's values, each with the block from which it comes."""
        ways = _PHI_WAY.findall(text)
        for _, source in ways:
            if (source, label) not in self._edges:
                raise self._refuse("a loop was not unrolled")
        return ways

    def _phi_pointer(self, name: str, label: str, text: str) -> None:
        """clang makes one load through a pointer that is chosen out of two loads."""
        ways = self._ways(label, text)
        rest = ways[-1][0]
        for i, (pointer, source) in enumerate(reversed(ways[:-1])):
            step = name if i == len(ways) - 2 else f"{name}.{i}"
            self._choices[step] = (self._edges[source, label], pointer, rest)
            rest = step

    def _load(self, pointer: str, width: int) -> Node:
        if pointer in self._choices:
            choose, one, zero = self._choices[pointer]
            return self.graph.mux(choose, self._load(one, width), self._load(zero, width))
        place = self._place(pointer)
        if not place.is_input or place.width != width:
            raise self._refuse(f"a load of {width} bits of {place.port}, whose integers have {place.width}")
        return self.graph.slice(self.graph.inputs[place.port], place.low, width)

    def _phi(self, label: str, width: int, text: str) -> Node:
        ways = self._ways(label, text)
        result = self._get(ways[-1][0], width, chosen=True)
        for value, source in reversed(ways[:-1]):
            result = self._select(self._edges[source, label], self._get(value, width, chosen=True), result)
        return result

    def _branch(self, block: Block, line: str) -> None:
        g = self.graph
        here = self._conditions[block.label]

        def go(to: str, condition: Node) -> None:
            both = g.and_(here, condition)
            known = self._edges.get((block.label, to))
            self._edges[block.label, to] = both if known is None else g.or_(known, both)

        if m := _BR.match(line):
            go(m[1], g.const(1, 1))
        elif m := _BR_IF.match(line):
            condition = self._get(m[1], 1)
            go(m[2], condition)
            go(m[3], g.not_(condition))
        elif m := _SWITCH.match(line):
            value = self._get(m[2], int(m[1]))
            none = g.const(1, 1)
            for number, to in _SWITCH_WAY.findall(m[4]):
                equal = g.equal(value, g.const(value.width, int(number)))
                none = g.and_(none, g.not_(equal))
                go(to, equal)
            go(m[3], none)
        else:
            raise self._refuse(f"{line.split()[0]}: {line}")

    def _order(self, blocks: list[Block]) -> list[Block]:
        """Blocks so that each stands behind all from which it is reached; a loop has no such order."""
        follow = {b.label: re.findall(r"label %([\w.]+)", b.lines[-1]) for b in blocks}
        waits = {b.label: 0 for b in blocks}
        for to in {(a, b) for a, ways in follow.items() for b in ways}:
            waits[to[1]] += 1
        by_label = {b.label: b for b in blocks}
        ready, order = [blocks[0].label], []
        while ready:
            label = ready.pop(0)
            order.append(by_label[label])
            for to in dict.fromkeys(follow[label]):
                waits[to] -= 1
                if waits[to] == 0:
                    ready.append(to)
        if len(order) < len(blocks):
            raise self._refuse("a loop is left: give it a constant bound, or raise -unroll-threshold")
        # A block through which all ways to the end lead runs always: no branch that is open jumps over it.
        place = {b.label: i for i, b in enumerate(order)}
        furthest = 0
        for i, b in enumerate(order):
            if furthest <= i:
                self._always.add(b.label)
            furthest = max([furthest, *(place[to] for to in follow[b.label])])
        return order

    # ---- all of it ----

    def _store(self, block: Block, width: int, text: str, pointer: str) -> None:
        place = self._place(pointer)
        if place.is_input or place.width != width:
            raise self._refuse(f"a store of {width} bits to {place.port}, whose integers have {place.width}")
        value = self._get(text, width)
        condition = self._conditions[block.label]
        if place in self._stores:
            before, covered = self._stores[place]
            self._stores[place] = self.graph.mux(condition, value, before), self.graph.or_(covered, condition)
        else:
            self._stores[place] = value, condition

    def _instruction(self, block: Block, line: str) -> None:
        if line.startswith("call void @llvm.dbg.value"):
            if (m := _DEBUG_VALUE.search(line)) and m[2] in self._value:
                give_name(self._value[m[2]], self._names.variable(m[3]))
            return
        if (
            re.match(r"(tail )?call void @llvm\.(dbg\.|lifetime|assume|experimental\.noalias)", line)
            or line == "ret void"
        ):
            return
        if m := _STORE.match(line):
            self._store(block, int(m[1]), m[2], m[3])
            return
        result = re.match(r"^(%[\w.]+) = (.*)$", line)
        if not result:
            self._branch(block, line)
            return
        name, text = result[1], re.sub(r", align \d+$", "", result[2])
        if m := _GEP.match(text):
            argument, place = self._pointers.get(m[1], (-1, ()))
            steps = [int(n) for n in re.findall(r"i\d+ (\d+)", m[2])]
            if argument < 0 or steps[0] != 0:
                raise self._refuse(f"memory of its own, or an index that is no constant: {line}")
            self._pointers[name] = (argument, (*place, *steps[1:]))
        elif (m := _BITCAST.match(text)) and m[1] in self._pointers:
            self._pointers[name] = self._pointers[m[1]]
        elif m := _LOAD.match(text):
            self._value[name] = self._load(m[2], int(m[1]))
        elif m := _PHI_POINTER.match(text):
            self._phi_pointer(name, block.label, m[1])
        elif m := _SELECT_POINTER.match(text):
            self._choices[name] = (self._get(m[1], 1), m[2], m[3])
        elif m := _BINARY.match(text):
            width = int(m[3])
            self._value[name] = self._binary(m[1], width, self._get(m[4], width), self._get(m[5], width))
        elif m := _ICMP.match(text):
            width = int(m[2])
            self._value[name] = self._compare(m[1], self._get(m[3], width), self._get(m[4], width))
        elif m := _SELECT.match(text):
            width = int(m[2])
            one, zero = self._get(m[3], width, chosen=True), self._get(m[4], width, chosen=True)
            self._value[name] = self._select(self._get(m[1], 1), one, zero)
        elif m := _CAST.match(text):
            value, width = self._get(m[3], int(m[2])), int(m[4])
            g = self.graph
            self._value[name] = {"zext": g.zext, "sext": g.sext, "trunc": g.trunc}[m[1]](value, width)
        elif m := _PHI.match(text):
            self._value[name] = self._phi(block.label, int(m[1]), m[2])
        elif m := _FREEZE.match(text):
            self._value[name] = self._get(m[2], int(m[1]))
        elif m := _CALL.match(text):
            self._value[name] = self._call(m[2], int(m[1] or 0), m[3])
        elif text.startswith(("getelementptr", "alloca", "bitcast")):
            raise self._refuse(f"memory that is no port: {line}")
        else:
            raise self._refuse(f"instruction {text.split()[0]} is none of those that become hardware here: {line}")

    def read(self) -> Graph:
        version = re.search(r'!"(?:Debian |Ubuntu )?clang version (\d+)', self._text)
        if not version or int(version[1]) != CLANG_MAJOR:
            found = version[1] if version else "none that is named"
            raise self._refuse(f"the IR is of clang {found}; this reads that of clang {CLANG_MAJOR}")
        for line in self._text.splitlines():
            if m := _STRUCT.match(line):
                self._structs[m[1]] = m[2]
        arguments, debug, blocks = self._blocks()
        self._read_ports(arguments, debug)
        ordered = self._order(blocks)
        self._conditions[ordered[0].label] = self.graph.const(1, 1)
        for block in ordered:
            self._enter(block)
            for line in block.lines:
                self._instruction(block, line)
        parts: dict[str, list[Node]] = {}
        for place in self._place_of.values():
            if place.is_input:
                continue
            if place not in self._stores:
                raise self._refuse(f"{place.port} gets no value")
            value, covered = self._stores[place]
            if not always(covered):
                raise self._refuse(f"{place.port} gets a value under a condition alone")
            parts.setdefault(place.port, []).append(value)
        self.graph.outputs = {name: self.graph.cat(values) for name, values in parts.items()}
        return self.graph
