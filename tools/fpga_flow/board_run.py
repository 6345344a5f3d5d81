# SPDX-License-Identifier: Apache-2.0
"""A board's bitstream: placed by several seeds, each clock and each path between clocks held against what it must be, the best
seed packed."""

import json
import shlex

import between
import board as boards
import figures as kept
import flow
import timing
from trouble import Trouble


def net_of(clock, nets):
    """nextpnr's net of a clock of the top: $glbnet$clk, clk_$glb_clk or clk."""
    found = [net for net in nets if net.removeprefix("$glbnet$").split("$")[0].removesuffix("_") == clock]
    return found[0] if found else None


def clock_rows(runs, needs):
    """A row for each clock that has flip-flops: MHz by seed beside the MHz that it runs at."""
    rows = []
    for clock, need in needs.items():
        net = net_of(clock, runs[0])
        if net is None:
            continue  # a pin or a PLL's output that clocks nothing
        reached = [run[net][0] for run in runs]
        held = runs[0][net][1]
        # nextpnr rounds a period to picoseconds.
        if abs(held - need) > need / 1000:
            raise Trouble(f"{clock}: runs at {need:.3f} MHz, and nextpnr holds it against {held:.3f}")
        rows.append({"clock": clock, "net": net, "mhz": flow.spread(reached), "need_mhz": need})
    left = [net for net in runs[0] if net not in [r["net"] for r in rows]]
    if left:
        raise Trouble(f"{', '.join(left)}: a clock of which neither the pins' file nor a PLL says how fast it is")
    return sorted(rows, key=lambda r: r["clock"])


def best_seed(rows, crossings=()):
    """The seed, from 0, whose least margin is the greatest: where it is 1 or more all clocks and paths between them are met."""

    def margin(s):
        clocks = [r["mhz"]["all"][s] / r["need_mhz"] for r in rows]
        return min(clocks + [r["allowed_ns"] / r["ns"][s] for r in crossings if r["ns"][s] > 0])

    return max(range(len(rows[0]["mhz"]["all"])), key=margin)


def judge(rows, crossings, seed):
    """Says of each clock and each way between clocks whether the seed, from 0, meets it; gives whether it meets all."""
    for r in rows:
        r["met"] = r["mhz"]["all"][seed] >= r["need_mhz"]
    for r in crossings:
        r["met"] = r["ns"][seed] <= r["allowed_ns"]
    return all(r["met"] for r in [*rows, *crossings])


def figures_of(b, options, tools, folder, progress):
    design = b.design
    progress.step(f"{b.name}: synthesis", lambda: flow.synthesize(tools, b.device, design, folder))
    reports = [
        progress.step(f"{b.name}: place, seed {s}", lambda s=s: flow.place(tools, b.device, design, folder, s))
        for s in range(1, options.seeds + 1)
    ]
    modules = json.loads((folder / f"{b.name}-modules.json").read_text())["modules"]
    rows = clock_rows([flow.clocks_of(r) for r in reports], boards.needs(modules, b, folder))
    crossings = between.rows_of(reports, rows)
    best = best_seed(rows, crossings)
    bitstream = progress.step("bitstream", lambda: flow.pack(tools, b.device, design, folder, best + 1, b.name))
    netlist = json.loads((folder / f"{b.name}.json").read_text())["modules"][b.top]
    places = timing.Places(modules, next(n for n in modules if boards.plain(n) == b.top), netlist)
    met = judge(rows, crossings, best)
    for r in rows:
        if not r["met"] or r["clock"] == "clk":
            r["worst_path"] = timing.worst_path(reports[best], places, r["net"])
    for r in crossings:
        r["ends_at"] = places.register(r.pop("cells")[best])
    return {
        "schema": "kage.fpga-board/1",  # docs/schema/fpga-board.json
        "board": b.name,
        "device": b.device.name,
        "parameters": b.core.parameters,
        "board_parameters": b.values,
        "of": kept.of_board(folder, b),
        "tools": {n: tools.find(n).version for n in ("yosys", f"nextpnr-{b.device.family}")},
        "cells": flow.cells_of(b.device, reports[best], netlist),
        "clocks": [{k: v for k, v in r.items() if k != "net"} for r in rows],
        "crossings": crossings,
        "best_seed": best + 1,
        "met": met,
        "bitstream": bitstream,
        "load": b.load,
        "seconds": progress.steps,
    }


def tell(f, out):
    """The figures for people."""
    print(f"{f['board']}, {f['device']}; " + ", ".join(f"{k} {v}" for k, v in f["tools"].items()))
    print("  ".join(f"{k.upper()} {v['used']} of {v['available']}" for k, v in f["cells"].items()))
    seeds = len(f["clocks"][0]["mhz"]["all"])
    wide = max(len(c["clock"]) for c in f["clocks"])
    for c in f["clocks"]:
        reached = c["mhz"]["all"][f["best_seed"] - 1]
        text = (
            f"{c['clock']:<{wide}} {reached:7.1f} MHz of {c['need_mhz']:g} needed: {'met' if c['met'] else 'NOT MET'}"
        )
        if seeds > 1:
            m = c["mhz"]
            text += f"; median of {seeds} seeds {m['median']:.1f}, worst {m['worst']:.1f}, best {m['best']:.1f}"
        print(text)
    between.tell(f["crossings"], f["best_seed"] - 1)
    if seeds > 1:
        print(f"seed {f['best_seed']} has the greatest least margin: the bitstream is of it")
    for c in f["clocks"]:
        if "worst_path" in c:
            timing.tell(c["worst_path"], f"worst path of {c['clock']}")
    print(f"bitstream, netlist, logs: {out}")
    print(
        f"{'load it' if f['met'] else 'a clock or a path between clocks is not met: it may fail where'}: {f['load']} {shlex.quote(str(out / f['bitstream']))}"
    )
