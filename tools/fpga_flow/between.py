# SPDX-License-Identifier: Apache-2.0
"""Paths from one clock to another, which nextpnr's clock rates leave out: each is held against a period of the faster clock.

Why that is enough, with T the faster clock's period:
  async_fifo, pointers: all bits of a Gray pointer arrive between 0 and T, so none comes more than T later than another. The clock
      that sends them changes one bit a period of its own, which is T or more: the bits arrive in the order in which they changed.
  async_fifo, words: a word is written with the edge that changes the pointer. It is read two clocks of the output later at the
      earliest, by a register that takes it one clock later at the earliest; T is within one clock.
  synchronizer of one bit: needs no bound. T keeps its latency to what it says.
  tmds_shifter: each edge of pix_clk_i is one of bit_clk_i, so a path has 1, 2, 3 .. T. `phase_q` to `seen_q` needs less than T, or
      the words are taken at one time in one clock and at another in the next. A word is taken two T after it changed, and T is
      asked of it too, because nextpnr tells one path of each pair of clocks, the longest.
From a rising edge to a falling one, or from a falling one to a rising one, half of that is allowed.

What is not in these figures: nextpnr takes every clock to reach all its flip-flops at once, so the times at which two clock nets
reach theirs are not compared."""

import flow
import timing
from trouble import Trouble

PADS = "<async>"  # in place of a clock: a pin, or what a PLL or a pin brings


def ends(path, clock_of):
    """((edge, clock), (edge, clock)) of a path between two clocks; None where it is of one, or of none."""
    if PADS in (path["from"], path["to"]):
        return None
    (edge, net), (to_edge, to_net) = path["from"].split(" ", 1), path["to"].split(" ", 1)
    unknown = {net, to_net} - set(clock_of)
    if unknown:
        raise Trouble(f"nextpnr's report has a path of {unknown.pop()}, which is no clock of the board")
    return None if net == to_net else ((edge, clock_of[net]), (to_edge, clock_of[to_net]))


def longest(report, clock_of, needs):
    """{(from, to, ns allowed): path} of a report."""
    found = {}
    for path in report["critical_paths"]:
        if not (pair := ends(path, clock_of)):
            continue
        (edge, source), (to_edge, sink) = pair
        allowed = 1000 / max(needs[source], needs[sink]) / (1 if edge == to_edge else 2)
        key = source, sink, allowed
        if key not in found or timing.delay(path) > timing.delay(found[key]):
            found[key] = path
    return found


def rows_of(reports, clocks):
    """A row for each way from a clock to another. `clocks`: the rows of the clocks, which have their names of nextpnr's nets."""
    clock_of = {c["net"]: c["clock"] for c in clocks}
    needs = {c["clock"]: c["need_mhz"] for c in clocks}
    found = [longest(r, clock_of, needs) for r in reports]
    if len(clocks) > 1 and not found[0]:
        raise Trouble("nextpnr's report has no path between two clocks, and the board has several: its form is another")
    if any(f.keys() != found[0].keys() for f in found):
        raise Trouble("nextpnr's reports of two seeds have paths between other clocks")
    return [
        {"from": key[0], "to": key[1], "allowed_ns": key[2], "ns": [timing.delay(f[key]) for f in found]}
        for key in sorted(found[0])
    ]


def worst_path(report, places, row, clocks):
    """The longest path of a row, in the RTL's words."""
    clock_of = {c["net"]: c["clock"] for c in clocks}
    needs = {c["clock"]: c["need_mhz"] for c in clocks}
    path = longest(report, clock_of, needs)[row["from"], row["to"], row["allowed_ns"]]
    return timing.in_words(path["path"], places)


def tell(rows, seed):
    """The rows for people; `seed` from 0."""
    wide = max((len(r["from"]) + len(r["to"]) for r in rows), default=0) + 4
    for r in rows:
        text = (
            f"{r['from'] + ' to ' + r['to']:<{wide}} {r['ns'][seed]:6.2f} ns of {r['allowed_ns']:.4g} allowed: "
            f"{'met' if r['met'] else 'NOT MET'}"
        )
        if len(r["ns"]) > 1:
            s = flow.spread(r["ns"])
            text += f"; median of {len(r['ns'])} seeds {s['median']:.2f}, worst {s['best']:.2f}, best {s['worst']:.2f}"
        print(text)
    for r in rows:
        if "worst_path" in r:
            timing.tell(r["worst_path"], f"longest path from {r['from']} to {r['to']}")
