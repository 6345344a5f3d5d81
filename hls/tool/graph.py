# SPDX-License-Identifier: Apache-2.0
"""A kernel as a graph of operations on bit vectors.

Each node has one value of `width` bits. Operations that cost nothing in hardware are written as wiring (slice, cat,
sext). Nodes are simplified as they are made: constants are folded, equal nodes are one node, and known bits turn logic
into wiring and make adders narrow. Order and numbers of nodes follow from the order of calls alone, so the same kernel
always gives the same graph.
"""

from __future__ import annotations

from collections.abc import Iterable

WIRING = frozenset({"in", "const", "slice", "cat", "sext"})


class Node:
    """An operation. `value`: a constant's value, an input's name, a slice's lowest bit, signs of a mul's operands."""

    __slots__ = ("args", "name", "number", "ones", "op", "signs", "value", "width", "zeros")

    def __init__(self, op: str, width: int, args: tuple[Node, ...], value, number: int):
        self.op = op
        self.width = width
        self.args = args
        self.value = value
        self.number = number
        self.name = ""  # of the C++ variable that has this value
        self.zeros = 0  # bits that are always 0
        self.ones = 0  # bits that are always 1
        self.signs = 1  # so many upper bits are equal

    def __repr__(self) -> str:
        return f"%{self.number} = {self.op}<{self.width}>({', '.join(f'%{a.number}' for a in self.args)}) {self.value}"


def give_name(n: Node, name: str) -> None:
    """Names the operation whose value a C++ variable has, or has with bits above it that follow from it."""
    while n.op == "sext" or (n.op == "cat" and len(n.args) == 2 and n.args[1].op == "const"):
        n = n.args[0]
    if n.op not in WIRING:
        n.name = n.name or name


def mask(width: int) -> int:
    return (1 << width) - 1


def signed(value: int, width: int) -> int:
    return value - (1 << width) if value >> (width - 1) & 1 else value


def top_run(bits: int, width: int) -> int:
    """How many bits from the top of `width` are set."""
    return width - (~bits & mask(width)).bit_length()


def low_run(bits: int, width: int) -> int:
    """How many bits from bit 0 on are set."""
    clear = ~bits & mask(width)
    return width if clear == 0 else (clear & -clear).bit_length() - 1


class Graph:
    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self.inputs: dict[str, Node] = {}
        self.outputs: dict[str, Node] = {}
        self._known: dict[tuple, Node] = {}

    # ---- making nodes ----

    def _make(self, op: str, width: int, args: Iterable[Node] = (), value=None) -> Node:
        args = tuple(args)
        key = (op, width, tuple(a.number for a in args), value)
        node = self._known.get(key)
        if node is not None:
            return node
        node = Node(op, width, args, value, len(self.nodes))
        self._learn(node)
        if op != "const" and node.zeros | node.ones == mask(width):
            return self.const(width, node.ones)
        self.nodes.append(node)
        self._known[key] = node
        return node

    def _learn(self, n: Node) -> None:
        """Known bits and equal upper bits."""
        full = mask(n.width)
        a = n.args
        match n.op:
            case "const":
                n.ones, n.zeros = n.value, full & ~n.value
            case "slice":
                n.zeros, n.ones = a[0].zeros >> n.value & full, a[0].ones >> n.value & full
                n.signs = max(1, a[0].signs - (a[0].width - n.value - n.width))
            case "cat":
                at = 0
                for part in a:
                    n.zeros |= part.zeros << at
                    n.ones |= part.ones << at
                    at += part.width
                n.signs = a[-1].signs
            case "sext":
                wide = full & ~mask(a[0].width)
                top = 1 << (a[0].width - 1)
                n.zeros = a[0].zeros | (wide if a[0].zeros & top else 0)
                n.ones = a[0].ones | (wide if a[0].ones & top else 0)
                n.signs = a[0].signs + n.width - a[0].width
            case "and":
                n.zeros, n.ones = a[0].zeros | a[1].zeros, a[0].ones & a[1].ones
                n.signs = min(a[0].signs, a[1].signs)
            case "or":
                n.zeros, n.ones = a[0].zeros & a[1].zeros, a[0].ones | a[1].ones
                n.signs = min(a[0].signs, a[1].signs)
            case "xor":
                n.zeros = a[0].zeros & a[1].zeros | a[0].ones & a[1].ones
                n.ones = a[0].zeros & a[1].ones | a[0].ones & a[1].zeros
                n.signs = min(a[0].signs, a[1].signs)
            case "mux":
                n.zeros, n.ones = a[1].zeros & a[2].zeros, a[1].ones & a[2].ones
                n.signs = min(a[1].signs, a[2].signs)
            case "mul":
                low = min(n.width, low_run(a[0].zeros, a[0].width) + low_run(a[1].zeros, a[1].width))
                n.zeros = mask(low)
        n.signs = min(n.width, max(n.signs, top_run(n.zeros, n.width), top_run(n.ones, n.width)))

    def const(self, width: int, value: int) -> Node:
        return self._make("const", width, (), value & mask(width))

    def input(self, name: str, width: int) -> Node:
        node = self._make("in", width, (), name)
        self.inputs[name] = node
        return node

    # ---- wiring ----

    def slice(self, a: Node, low: int, width: int) -> Node:
        assert 0 <= low and width > 0 and low + width <= a.width, (a, low, width)
        if width == a.width:
            return a
        if a.op == "const":
            return self.const(width, a.value >> low)
        if a.op == "slice":
            return self.slice(a.args[0], a.value + low, width)
        if a.op == "cat":
            parts, at = [], 0
            for part in a.args:
                first, last = max(low, at), min(low + width, at + part.width)
                if first < last:
                    parts.append(self.slice(part, first - at, last - first))
                at += part.width
            return self.cat(parts)
        if a.op == "sext":
            inner = a.args[0]
            if low + width <= inner.width:
                return self.slice(inner, low, width)
            kept = min(low, inner.width - 1)
            return self.sext(self.slice(inner, kept, inner.width - kept), width)
        return self._make("slice", width, (a,), low)

    def cat(self, parts: Iterable[Node]) -> Node:
        """Parts from bit 0 on."""
        flat: list[Node] = []
        for part in parts:
            for p in part.args if part.op == "cat" else (part,):
                last = flat[-1] if flat else None
                if last is not None and last.op == "const" and p.op == "const":
                    flat[-1] = self.const(last.width + p.width, last.value | p.value << last.width)
                elif last is not None and self._adjacent(last, p):
                    base, low = self._place(last)
                    flat[-1] = self.slice(base, low, last.width + p.width)
                else:
                    flat.append(p)
        return flat[0] if len(flat) == 1 else self._make("cat", sum(p.width for p in flat), flat)

    @staticmethod
    def _place(a: Node) -> tuple[Node, int]:
        return (a.args[0], a.value) if a.op == "slice" else (a, 0)

    def _adjacent(self, low: Node, high: Node) -> bool:
        (a, at), (b, bt) = self._place(low), self._place(high)
        return a is b and at + low.width == bt

    def zext(self, a: Node, width: int) -> Node:
        return a if width == a.width else self.cat([a, self.const(width - a.width, 0)])

    def sext(self, a: Node, width: int) -> Node:
        if width == a.width:
            return a
        top = 1 << (a.width - 1)
        if a.zeros & top:
            return self.zext(a, width)
        if a.op == "sext":
            a = a.args[0]
        return self._make("sext", width, (a,))

    def trunc(self, a: Node, width: int) -> Node:
        return self.slice(a, 0, width)

    def shift_left(self, a: Node, by: int) -> Node:
        if by >= a.width:
            return self.const(a.width, 0)
        return a if by == 0 else self.cat([self.const(by, 0), self.trunc(a, a.width - by)])

    def shift_right(self, a: Node, by: int, arithmetic: bool) -> Node:
        if arithmetic:
            by = min(by, a.width - 1)
            return self.sext(self.slice(a, by, a.width - by), a.width)
        if by >= a.width:
            return self.const(a.width, 0)
        return a if by == 0 else self.zext(self.slice(a, by, a.width - by), a.width)

    # ---- logic ----

    def _by_bits(self, a: Node, b: Node, which) -> Node | None:
        """Wiring, if each bit of the result is known or is a bit of one operand: which(bit) says 0, 1, "a" or "b"."""
        runs: list[tuple[object, int, int]] = []
        for bit in range(a.width):
            source = which(bit)
            if source is None:
                return None
            if runs and runs[-1][0] == source:
                runs[-1] = (source, runs[-1][1], runs[-1][2] + 1)
            else:
                runs.append((source, bit, 1))
        parts = []
        for source, low, width in runs:
            if source in ("a", "b"):
                parts.append(self.slice(a if source == "a" else b, low, width))
            else:
                parts.append(self.const(width, mask(width) * source))
        return self.cat(parts)

    def and_(self, a: Node, b: Node) -> Node:
        def which(bit: int):
            if (a.zeros | b.zeros) >> bit & 1:
                return 0
            if b.ones >> bit & 1:
                return "a"
            return "b" if a.ones >> bit & 1 else None

        if a is b:
            return a
        if self._opposite(a, b):
            return self.const(a.width, 0)
        return self._by_bits(a, b, which) or self._make("and", a.width, self._sorted(a, b))

    def or_(self, a: Node, b: Node) -> Node:
        def which(bit: int):
            if (a.ones | b.ones) >> bit & 1:
                return 1
            if b.zeros >> bit & 1:
                return "a"
            return "b" if a.zeros >> bit & 1 else None

        if a is b:
            return a
        if self._opposite(a, b):
            return self.const(a.width, -1)
        return self._by_bits(a, b, which) or self._make("or", a.width, self._sorted(a, b))

    def xor(self, a: Node, b: Node) -> Node:
        def which(bit: int):
            if b.zeros >> bit & 1:
                return "a"
            return "b" if a.zeros >> bit & 1 else None

        if a is b:
            return self.const(a.width, 0)
        if b.op == "const" and a.op == "xor" and a.args[1].op == "const":
            return self.xor(a.args[0], self.const(a.width, a.args[1].value ^ b.value))
        wires = self._by_bits(a, b, which)
        if wires is not None:
            return wires
        # A bit that is not changed is a wire, whichever operand it comes from.
        low = low_run(a.zeros | b.zeros, a.width)
        if low == 0:
            high = top_run(a.zeros | b.zeros, a.width)
            low = a.width - high if high > 0 else 0
        if 0 < low < a.width:
            rest = a.width - low
            return self.cat(
                [
                    self.xor(self.trunc(a, low), self.trunc(b, low)),
                    self.xor(self.slice(a, low, rest), self.slice(b, low, rest)),
                ]
            )
        return self._make("xor", a.width, self._sorted(a, b))

    @staticmethod
    def _opposite(a: Node, b: Node) -> bool:
        """Whether one is the other's complement."""
        return any(
            x.op == "xor" and x.args[0] is y and x.args[1].op == "const" and x.args[1].value == mask(x.width)
            for x, y in ((a, b), (b, a))
        )

    def not_(self, a: Node) -> Node:
        return self.xor(a, self.const(a.width, -1))

    @staticmethod
    def _sorted(a: Node, b: Node) -> tuple[Node, Node]:
        """Operands of what commutes: a constant last, else the older node first."""
        if (a.op == "const") != (b.op == "const"):
            return (b, a) if a.op == "const" else (a, b)
        return (a, b) if a.number <= b.number else (b, a)

    def mux(self, choose: Node, one: Node, zero: Node) -> Node:
        if one is zero:
            return one
        if choose.op == "const":
            return one if choose.value else zero
        if choose.op == "xor" and choose.args[1].op == "const":  # not x
            return self.mux(choose.args[0], zero, one)
        if one.width == 1 and one.op == "const" and zero.op == "const":
            return choose if one.value else self.not_(choose)
        if one.width == 1 and zero.op == "const":
            return self.or_(self.not_(choose), one) if zero.value else self.and_(choose, one)
        if one.width == 1 and one.op == "const":
            return self.or_(choose, zero) if one.value else self.and_(self.not_(choose), zero)
        same = low_run(one.zeros & zero.zeros | one.ones & zero.ones, one.width)
        if 0 < same < one.width:
            rest = one.width - same
            return self.cat(
                [self.slice(one, 0, same), self.mux(choose, self.slice(one, same, rest), self.slice(zero, same, rest))]
            )
        spare = min(one.signs, zero.signs) - 1
        if spare > 0:
            kept = one.width - spare
            return self.sext(self.mux(choose, self.trunc(one, kept), self.trunc(zero, kept)), one.width)
        return self._make("mux", one.width, (choose, one, zero))

    # ---- arithmetic ----

    def add(self, a: Node, b: Node) -> Node:
        return self._sum("add", *self._sorted(a, b))

    def sub(self, a: Node, b: Node) -> Node:
        if a is b:
            return self.const(a.width, 0)
        if b.op == "const":
            return self.add(a, self.const(a.width, -b.value))
        return self._sum("sub", a, b)

    def _sum(self, op: str, a: Node, b: Node) -> Node:
        width = a.width
        if a.op == "const" and b.op == "const":
            return self.const(width, a.value + b.value if op == "add" else a.value - b.value)
        if b.zeros == mask(width):
            return a
        if op == "add" and b.op == "const" and a.op == "add" and a.args[1].op == "const" and a.args[1].width == width:
            return self.add(a.args[0], self.const(width, a.args[1].value + b.value))
        # Lower bits to which nothing is added are wires.
        low = low_run(b.zeros, width)
        if 0 < low < width:
            return self.cat([self.trunc(a, low), self._sum(op, self.slice(a, low, width - low), self._upper(b, low))])
        low = low_run(a.zeros, width) if op == "add" else 0
        if 0 < low < width:
            return self.cat([self.trunc(b, low), self.add(self._upper(a, low), self.slice(b, low, width - low))])
        # Upper bits that follow from the others.
        if op == "add":
            positive = max(width - top_run(a.zeros, width), width - top_run(b.zeros, width)) + 1
            if positive < width:
                return self.zext(self.add(self.trunc(a, positive), self.trunc(b, positive)), width)
        narrow = max(width - a.signs, width - b.signs) + 2
        if narrow < width:
            return self.sext(self._sum(op, self.trunc(a, narrow), self.trunc(b, narrow)), width)
        return self._make(op, width, (a, b))

    def _upper(self, a: Node, low: int) -> Node:
        return self.slice(a, low, a.width - low)

    def mul(self, a: Node, b: Node) -> Node:
        width = a.width
        a, b = self._sorted(a, b)
        if a.op == "const":
            return self.const(width, a.value * b.value)
        if b.op == "const" and b.value & (b.value - 1) == 0:
            return self.const(width, 0) if b.value == 0 else self.shift_left(a, b.value.bit_length() - 1)
        low = low_run(a.zeros, width)
        if low > 0:
            return self.shift_left(self.mul(self.shift_right(a, low, False), b), low)
        (a, a_signed), (b, b_signed) = self._factor(a), self._factor(b)
        whole = a.width + b.width
        product = self._make("mul", min(width, whole), (a, b), (a_signed, b_signed))
        if product.width == width:
            return product
        return self.sext(product, width) if a_signed or b_signed else self.zext(product, width)

    def _factor(self, a: Node) -> tuple[Node, bool]:
        """An operand of a product in the fewest bits, and whether those have a sign."""
        zeros = top_run(a.zeros, a.width)
        if zeros > 0:
            return self.trunc(a, max(1, a.width - zeros)), False
        return self.trunc(a, a.width - a.signs + 1), True

    # ---- comparisons, of one bit ----

    def equal(self, a: Node, b: Node) -> Node:
        a, b = self._sorted(a, b)
        if a is b:
            return self.const(1, 1)
        if a.zeros & b.ones or a.ones & b.zeros:
            return self.const(1, 0)
        spare = min(a.signs, b.signs) - 1
        if spare > 0:
            return self.equal(self.trunc(a, a.width - spare), self.trunc(b, b.width - spare))
        if a.width == 1:
            return self.not_(self.xor(a, b))
        return self._make("eq", 1, (a, b))

    def less(self, a: Node, b: Node, is_signed: bool) -> Node:
        width = a.width
        if a is b:
            return self.const(1, 0)
        if is_signed and b.op == "const" and b.value == 0:
            return self.slice(a, width - 1, 1)
        if is_signed and a.op == "const" and a.value == mask(width):  # -1 < b
            return self.not_(self.slice(b, width - 1, 1))
        if not is_signed and b.op == "const" and b.value & (b.value - 1) == 0 and b.value > 0:  # a < 2^k
            k = b.value.bit_length() - 1
            return self.equal(self.slice(a, k, width - k), self.const(width - k, 0))
        spare = min(a.signs, b.signs) - 1
        if spare > 0:
            return self.less(self.trunc(a, width - spare), self.trunc(b, width - spare), is_signed)
        return self._make("slt" if is_signed else "ult", 1, (a, b))

    def made(self, n: Node, args: list[Node]) -> Node:
        """The operation of `n` on other operands."""
        match n.op:
            case "const":
                return self.const(n.width, n.value)
            case "in":
                return self.input(n.value, n.width)
            case "slice":
                return self.slice(args[0], n.value, n.width)
            case "cat":
                return self.cat(args)
            case "sext":
                return self.sext(args[0], n.width)
            case "and":
                return self.and_(*args)
            case "or":
                return self.or_(*args)
            case "xor":
                return self.xor(*args)
            case "mux":
                return self.mux(*args)
            case "add":
                return self.add(*args)
            case "sub":
                return self.sub(*args)
            case "eq":
                return self.equal(*args)
            case "ult":
                return self.less(*args, False)
            case "slt":
                return self.less(*args, True)
            case "mul":
                wide = [
                    (self.sext if s else self.zext)(a, max(n.width, a.width))
                    for a, s in zip(args, n.value, strict=True)
                ]
                width = max(w.width for w in wide)
                wide = [(self.sext if s else self.zext)(a, width) for a, s in zip(args, n.value, strict=True)]
                return self.trunc(self.mul(*wide), n.width)
        raise AssertionError(n.op)


def live(outputs: Iterable[Node]) -> list[Node]:
    """The nodes that outputs depend on, operands first, in the order of numbers."""
    seen: set[int] = set()
    found: list[Node] = []
    stack = list(outputs)
    while stack:
        n = stack.pop()
        if n.number not in seen:
            seen.add(n.number)
            found.append(n)
            stack.extend(n.args)
    return sorted(found, key=lambda n: n.number)


def always(condition: Node) -> bool:
    """Whether a condition holds whatever the values are that it is made of by and, or, xor: of 16 or fewer."""
    inner = ("and", "or", "xor", "const")
    nodes = [n for n in live([condition]) if n.width == 1]
    free = [n for n in nodes if n.op not in inner]
    if len(free) > 16:
        return False
    for case in range(1 << len(free)):
        value = {n.number: case >> i & 1 for i, n in enumerate(free)}
        for n in nodes:
            a = [value.get(x.number, 0) for x in n.args]
            match n.op:
                case "const":
                    value[n.number] = n.value
                case "and":
                    value[n.number] = a[0] & a[1]
                case "or":
                    value[n.number] = a[0] | a[1]
                case "xor":
                    value[n.number] = a[0] ^ a[1]
        if not value[condition.number]:
            return False
    return True


def evaluate(graph: Graph, inputs: dict[str, int]) -> dict[str, int]:
    """The outputs for given inputs, all as unsigned numbers."""
    value: dict[int, int] = {}
    for n in live(graph.outputs.values()):
        a = [value[x.number] for x in n.args]
        match n.op:
            case "const":
                v = n.value
            case "in":
                v = inputs[n.value]
            case "slice":
                v = a[0] >> n.value
            case "cat":
                v = at = 0
                for part, bits in zip(n.args, a, strict=True):
                    v |= bits << at
                    at += part.width
            case "sext":
                v = signed(a[0], n.args[0].width)
            case "and":
                v = a[0] & a[1]
            case "or":
                v = a[0] | a[1]
            case "xor":
                v = a[0] ^ a[1]
            case "mux":
                v = a[1] if a[0] else a[2]
            case "add":
                v = a[0] + a[1]
            case "sub":
                v = a[0] - a[1]
            case "eq":
                v = int(a[0] == a[1])
            case "ult":
                v = int(a[0] < a[1])
            case "slt":
                v = int(signed(a[0], n.args[0].width) < signed(a[1], n.args[1].width))
            case "mul":
                f = [signed(x, p.width) if s else x for x, p, s in zip(a, n.args, n.value, strict=True)]
                v = f[0] * f[1]
            case _:
                raise AssertionError(n.op)
        value[n.number] = v & mask(n.width)
    return {name: value[n.number] for name, n in graph.outputs.items()}
