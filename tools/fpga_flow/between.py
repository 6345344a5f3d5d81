# SPDX-License-Identifier: Apache-2.0
"""Paths from one clock to another, which nextpnr's clock rates leave out: each is held against a period of the faster clock.

Why that is enough, with T the faster clock's period:
  async_fifo, pointers: all bits of a Gray pointer arrive between 0 and T, so none comes more than T later than another. The clock
      that sends them changes one bit a period of its own, which is T or more: the bits arrive in the order in which they changed.
  async_fifo, words: a word is written with the edge that changes the pointer. It is read two clocks of the output later at the
      earliest, by a register that takes it one clock later at the earliest; T is within one clock.
  synchronizer of one bit: needs no bound. T keeps its latency to what it says.
  tmds_shifter: each edge of pix_clk_i is one of bit_clk_i, so a path has 1, 2, 3 .. T. `phase_q` to `seen_q` needs less than T, or
      the words are taken at one time in one pixel and at another in the next. A word is taken two T after it changed, and T is
      asked of it too, because both are of the same pair of clocks.
From a rising edge to a falling one, or from a falling one to a rising one, half of that is allowed.

The time of a pair of clocks is the greater of two that nextpnr's report has:
* `critical_paths` has a path of each pair, with its setup time. nextpnr chooses it by arrivals, which hold the first clock's wire to
  its flip-flop. It reports the path without that wire, which differs from bit to bit of a pointer.
* `detailed_net_timings` has the arrivals, counted from where the first clock's net begins. It names one first clock a net, so it
  has nothing on a net that two clocks launch. Such nets are words; a bit of a pointer comes from one flip-flop alone.
The time leaves out the second clock's wire to its flip-flop, and all that lies before both clocks' nets."""

import collections
import dataclasses

import flow
from trouble import Trouble

PADS = "<async>"  # in place of a clock: a pin, or what a PLL or a pin brings


@dataclasses.dataclass(frozen=True)
class Latest:
    ns: float
    cell: str  # of the netlist, that it ends at


def pair(start, end, clock_of):
    """(edge, clock, edge, clock) of two events of the report as "posedge net"; None where they are of one clock, or of none."""
    if PADS in (start, end):
        return None
    (edge, net), (to_edge, to_net) = start.split(" ", 1), end.split(" ", 1)
    unknown = {net, to_net} - set(clock_of)
    if unknown:
        raise Trouble(f"nextpnr's report has a path of {unknown.pop()}, which is no clock of the board")
    return None if net == to_net else (edge, clock_of[net], to_edge, clock_of[to_net])


def latest_of(report, clock_of):
    """{pair: Latest} of a report."""
    found, setup = {}, {}
    for path in report["critical_paths"]:
        if key := pair(path["from"], path["to"], clock_of):
            found[key] = Latest(sum(s["delay"] for s in path["path"]), path["path"][-1]["to"]["cell"])
            setup[key] = sum(s["delay"] for s in path["path"] if s["type"] == "setup")
    for net in report["detailed_net_timings"]:
        times = collections.Counter((end["cell"], end["port"]) for end in net["endpoints"])
        for end in net["endpoints"]:
            key = pair(net["event"], end["event"], clock_of)
            if not key or times[end["cell"], end["port"]] > 1:
                continue
            if key not in found:
                raise Trouble(f"nextpnr's report has no critical path from {key[1]} to {key[3]}, and an arrival")
            at = Latest(max(end["delay"]) + setup[key], end["cell"])
            if at.ns > found[key].ns:
                found[key] = at
    return found


def rows_of(reports, clocks):
    """A row for each way from a clock to another. `clocks`: the rows of the clocks, which have the names of nextpnr's nets."""
    clock_of = {c["net"]: c["clock"] for c in clocks}
    needs = {c["clock"]: c["need_mhz"] for c in clocks}
    found = [latest_of(r, clock_of) for r in reports]
    if len(clocks) > 1 and not found[0]:
        raise Trouble("nextpnr's report has no path between two clocks, and the board has several: its form is another")
    if any(f.keys() != found[0].keys() for f in found):
        raise Trouble("nextpnr's reports of two seeds have paths between other clocks")
    return [
        {
            "from": source,
            "to": sink,
            "allowed_ns": 1000 / max(needs[source], needs[sink]) / (1 if edge == to_edge else 2),
            "ns": [f[edge, source, to_edge, sink].ns for f in found],
            "cells": [f[edge, source, to_edge, sink].cell for f in found],
        }
        for edge, source, to_edge, sink in sorted(found[0], key=lambda k: (k[1], k[3], k))
    ]


def tell(rows, seed):
    """The rows for people; `seed` from 0."""
    wide = max((len(r["from"]) + len(r["to"]) for r in rows), default=0) + 4
    for r in rows:
        text = (
            f"{r['from'] + ' to ' + r['to']:<{wide}} {r['ns'][seed]:6.2f} ns of {r['allowed_ns']:.4g} allowed: "
            f"{'met' if r['met'] else 'NOT MET, at ' + r['ends_at']}"
        )
        if len(r["ns"]) > 1:
            s = flow.spread(r["ns"])
            text += f"; median of {len(r['ns'])} seeds {s['median']:.2f}, worst {s['best']:.2f}, best {s['worst']:.2f}"
        print(text)
