# SPDX-License-Identifier: Apache-2.0
"""Graphs made again with less in them: bits that nobody asks for, and products in tiles that a multiplier holds."""

from __future__ import annotations

from collections.abc import Callable

from .graph import Graph, Node, give_name, live


def rebuilt(graph: Graph, make: Callable[[Graph, Node, list[Node]], Node]) -> Graph:
    """The same graph with each node made by `make` out of its new operands. Names stay."""
    new = Graph()
    for name, node in graph.inputs.items():
        new.input(name, node.width)
    of: dict[int, Node] = {}
    for n in live(graph.outputs.values()):
        node = make(new, n, [of[a.number] for a in n.args])
        give_name(node, n.name)
        of[n.number] = node
    new.outputs = {name: of[n.number] for name, n in graph.outputs.items()}
    return new


def _needs(graph: Graph) -> dict[int, int]:
    """How many of each node's bits, from bit 0 on, are needed."""
    need: dict[int, int] = {}
    for n in graph.outputs.values():
        need[n.number] = n.width
    for n in reversed(live(graph.outputs.values())):
        bits = need[n.number]

        def ask(a: Node, count: int) -> None:
            need[a.number] = max(need.get(a.number, 1), min(count, a.width))

        match n.op:
            case "slice":
                ask(n.args[0], n.value + bits)
            case "cat":
                at = 0
                for part in n.args:
                    ask(part, max(1, bits - at))
                    at += part.width
            case "add" | "sub" | "mul" | "and" | "or" | "xor" | "sext":
                for a in n.args:
                    ask(a, bits)
            case "mux":
                ask(n.args[0], 1)
                ask(n.args[1], bits)
                ask(n.args[2], bits)
            case "eq" | "ult" | "slt":
                for a in n.args:
                    ask(a, a.width)
    return need


def narrowed(graph: Graph) -> Graph:
    """Without upper bits of sums, products and logic that nobody needs: all of them follow from lower bits alone."""
    need = _needs(graph)

    def make(new: Graph, n: Node, args: list[Node]) -> Node:
        bits = need[n.number]
        if bits < n.width and n.op in ("add", "sub", "mul", "and", "or", "xor", "mux"):
            match n.op:
                case "mux":
                    low = new.mux(args[0], new.trunc(args[1], bits), new.trunc(args[2], bits))
                case "mul":
                    wide = [
                        (new.sext if s else new.zext)(a, max(bits, a.width)) for a, s in zip(args, n.value, strict=True)
                    ]
                    low = new.mul(*(new.trunc(w, bits) for w in wide))
                case _:
                    cut = [new.trunc(a, bits) for a in args]
                    low = {
                        "add": new.add,
                        "sub": new.sub,
                        "and": new.and_,
                        "or": new.or_,
                        "xor": new.xor,
                    }[n.op](*cut)
            give_name(low, n.name)
            return new.zext(low, n.width)  # the bits above are never looked at
        return new.made(n, args)

    return rebuilt(graph, make)


def tiled(graph: Graph, tile: int) -> Graph:
    """Products of more than `tile` bits a factor become sums of products of at most so many."""

    def parts(new: Graph, a: Node, is_signed: bool) -> list[tuple[Node, bool, int]]:
        """Pieces of a factor with their signs and places: all but the last without a sign."""
        found, low = [], 0
        while a.width - low > tile:
            found.append((new.slice(a, low, tile - 1), False, low))
            low += tile - 1
        found.append((new.slice(a, low, a.width - low), is_signed, low))
        return found

    def make(new: Graph, n: Node, args: list[Node]) -> Node:
        if n.op != "mul" or max(a.width for a in args) <= tile:
            return new.made(n, args)
        total = None
        pieces = [parts(new, a, s) for a, s in zip(args, n.value, strict=True)]
        for a, a_signed, at_a in pieces[0]:
            for b, b_signed, at_b in pieces[1]:
                at = at_a + at_b
                if at >= n.width:
                    continue
                width = n.width - at
                wide_a = (new.sext if a_signed else new.zext)(a, max(width, a.width))
                wide_b = (new.sext if b_signed else new.zext)(b, max(width, b.width))
                product = new.mul(new.trunc(wide_a, width), new.trunc(wide_b, width))
                place = new.cat([new.const(at, 0), product]) if at else product
                total = place if total is None else new.add(total, place)
        return total

    return rebuilt(graph, make)
