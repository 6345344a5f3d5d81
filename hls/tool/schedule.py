# SPDX-License-Identifier: Apache-2.0
"""Which operation works in which stage of a pipeline.

A stage ends in registers. As soon as possible (ASAP): each operation stands in the first stage in which its operands
are ready early enough that it ends within the period. The period is the least one for which the kernel has no more
stages than asked for. Then operations move to later stages where that saves registers.
"""

from __future__ import annotations

from dataclasses import dataclass

from .delays import Delays
from .graph import WIRING, Graph, Node, live


@dataclass
class Schedule:
    stages: int  # clocks from inputs to outputs: each stage ends in registers
    period: float  # ns, by the table of delays
    stage_of: dict[int, int]  # by node number; constants have none

    def end(self, n: Node) -> int:
        return self.stage_of.get(n.number, 0)


def _asap(nodes: list[Node], delays: Delays, period: float) -> tuple[dict[int, int], dict[int, float]] | None:
    stage: dict[int, int] = {}
    ready: dict[int, float] = {}
    for n in nodes:
        operands = [a for a in n.args if a.op != "const"]
        if n.op == "const":
            continue
        first = max((stage[a.number] for a in operands), default=0)
        begin = max((ready[a.number] for a in operands if stage[a.number] == first), default=delays.register)
        cost = 0.0 if n.op in WIRING else delays.of(n)
        if begin + cost > period:
            first, begin = first + 1, delays.register
            if begin + cost > period:
                return None
        stage[n.number], ready[n.number] = first, begin + cost
    return stage, ready


def _registers(graph: Graph, nodes: list[Node], stage: dict[int, int], stages: int) -> int:
    """Bits of registers: each value is held from the end of its stage to its last use."""
    last = _last_use(graph, nodes, stage, stages)
    return sum(
        n.width * (last[n.number] - stage[n.number]) for n in nodes if n.op not in ("const", "slice", "cat", "sext")
    )


def _last_use(graph: Graph, nodes: list[Node], stage: dict[int, int], stages: int) -> dict[int, int]:
    """The last stage that reads a value; wiring is looked through, as it is done where it is read."""
    last = {n.number: stage.get(n.number, 0) for n in nodes}
    for n in graph.outputs.values():
        last[n.number] = stages
    for n in reversed(nodes):
        at = last[n.number] if n.op in ("slice", "cat", "sext") else stage.get(n.number, 0)
        for a in n.args:
            last[a.number] = max(last[a.number], at)
    return last


def _move_later(
    graph: Graph, nodes: list[Node], delays: Delays, period: float, stage: dict[int, int], stages: int
) -> None:
    """Moves operations to later stages while that saves bits of registers."""
    users: dict[int, list[Node]] = {n.number: [] for n in nodes}
    for n in nodes:
        for a in n.args:
            users[a.number].append(n)
    outputs = {n.number for n in graph.outputs.values()}
    best = _registers(graph, nodes, stage, stages)
    for _ in range(4):
        before = best
        for n in reversed(nodes):
            if n.op in ("const", "in"):
                continue
            limit = min((stage[u.number] for u in users[n.number]), default=stages - 1)
            if n.number in outputs:
                limit = min(limit, stages - 1)
            for to in range(limit, stage[n.number], -1):
                was = stage[n.number]
                stage[n.number] = to
                bits = _registers(graph, nodes, stage, stages)
                if bits < best and _fits(nodes, delays, period, stage):
                    best = bits
                    break
                stage[n.number] = was
        if best == before:
            return


def begins_and_ends(graph: Graph, schedule: Schedule, delays: Delays) -> dict[int, tuple[float, float]]:
    """When each operation begins and ends, in ns from the edge that its stage begins with."""
    times: dict[int, tuple[float, float]] = {}
    for n in live(graph.outputs.values()):
        if n.op == "const":
            continue
        stage = schedule.end(n)
        ready = (times[a.number][1] for a in n.args if a.op != "const" and schedule.end(a) == stage)
        begin = max(ready, default=delays.register)
        times[n.number] = begin, begin + (0.0 if n.op in WIRING else delays.of(n))
    return times


def _fits(nodes: list[Node], delays: Delays, period: float, stage: dict[int, int]) -> bool:
    ready: dict[int, float] = {}
    for n in nodes:
        if n.op == "const":
            continue
        begin = max(
            (ready[a.number] for a in n.args if a.op != "const" and stage[a.number] == stage[n.number]),
            default=delays.register,
        )
        ready[n.number] = begin + (0.0 if n.op in WIRING else delays.of(n))
        if ready[n.number] > period:
            return False
    return True


def scheduled(graph: Graph, delays: Delays, stages: int) -> Schedule:
    """In `stages` clocks, at the least period that they allow."""
    nodes = live(graph.outputs.values())
    whole = _asap(nodes, delays, float("inf"))
    assert whole is not None
    low, high = 0.0, max(whole[1].values(), default=0.0)
    if stages == 0:
        return Schedule(0, high, {n.number: 0 for n in nodes if n.op != "const"})
    for _ in range(24):
        middle = (low + high) / 2
        found = _asap(nodes, delays, middle)
        if found is None or max(found[0].values(), default=0) >= stages:
            low = middle
        else:
            high = middle
    stage = _asap(nodes, delays, high)[0]
    _move_later(graph, nodes, delays, high, stage, stages)
    return Schedule(stages, high, stage)
