# SPDX-License-Identifier: Apache-2.0
"""See tools/fpga."""

import argparse
import json
import os
import pathlib
import shutil
import sys
import time
from functools import partial

import board as boards
import board_run
import core
import feed
import figures as kept
import flow
import need
import programs
import timing
from trouble import Trouble

FIGURES = "figures.json"  # in the folder of a run


class Progress:
    """A line a step, with its seconds, on standard error."""

    def __init__(self):
        self.steps = {}

    def step(self, title, work):
        start = time.monotonic()
        done = work()
        seconds = time.monotonic() - start
        self.steps[title] = seconds
        print(f"{title:<28} {seconds:6.1f} s", file=sys.stderr, flush=True)
        return done


def netlist_of(folder, design):
    text = json.loads((folder / f"{design.name}.json").read_text())
    return text["modules"][design.top]


def measure(tools, device, design, seeds, folder, progress, title):
    """Synthesizes and places by every seed; gives the reports."""
    progress.step(f"{title}: synthesis", lambda: flow.synthesize(tools, device, design, folder))
    return [
        progress.step(f"{title}: place, seed {s}", lambda s=s: flow.place(tools, device, design, folder, s))
        for s in range(1, seeds + 1)
    ]


def figures_of(top, device, what, options, tools, folder):
    progress = Progress()
    line_clocks = options.stream and need.clocks_of(options.kage, options.stream, what.parameters, folder)
    needed = line_clocks and need.need_of(options.stream, line_clocks, options.fps, options.total_lines)
    bits = what.loop_bits
    yardsticks = {}
    for name in ("least_loop", "lone_adder"):
        design = flow.Design(name, name, {"BITS": bits})
        reports = measure(tools, device, design, options.seeds, folder, progress, name.replace("_", " "))
        yardsticks[name] = flow.spread([flow.clock_of(r) for r in reports])
    design = flow.Design("kage", "kage_wrap", what.values, synth=device.synth)
    reports = measure(tools, device, design, options.seeds, folder, progress, "core")
    clocks = [flow.clock_of(r) for r in reports]
    median = sorted(range(len(clocks)), key=lambda i: clocks[i])[(len(clocks) - 1) // 2]
    bitstream = progress.step("bitstream", lambda: flow.pack(tools, device, design, folder, median + 1))
    netlist = netlist_of(folder, design)
    modules = json.loads((folder / "kage-modules.json").read_text())["modules"]
    places = timing.Places(modules, next(n for n in modules if timing.Places.plain(n) == "kage_wrap"), netlist)
    report = reports[median]
    return {
        "schema": "kage.fpga/1",  # docs/schema/fpga.json
        "device": device.name,
        "core": what.name,
        "parameters": what.parameters,
        "tools": {p.name: p.version for p in core_programs(tools, device)},
        "cells": flow.cells_of(device, report, netlist),
        "clock_mhz": flow.spread(clocks),
        "least_loop_mhz": yardsticks["least_loop"],
        "lone_adder_mhz": yardsticks["lone_adder"],
        "loop_bits": bits,
        "share": flow.spread(clocks)["median"] / yardsticks["least_loop"]["median"],
        **({"need": {**needed, "met": need.verdict(needed, flow.spread(clocks)["median"])}} if needed else {}),
        "worst_path": timing.worst_path(report, places),
        "worst_endpoints": timing.worst_endpoints(report, places, 10),
        "bitstream": bitstream,
        "of": kept.of_run(folder, device, what, {timing.Places.plain(n) for n in modules}),
        "seconds": progress.steps,
    }


def core_figures_of(device, what, options, tools, folder):
    """The clock of the core alone, without yardsticks and bitstream; or why it has none."""
    design = flow.Design("kage", "kage_wrap", what.values, synth=device.synth)
    clocks, why = None, None
    try:
        reports = measure(tools, device, design, options.seeds, folder, Progress(), "core")
        clocks = flow.spread([flow.clock_of(r) for r in reports])
    except flow.NotPlaced as e:
        why = e.why
    return {
        "schema": "kage.fpga-core/1",  # docs/schema/fpga-core.json
        "device": device.name,
        "core": what.name,
        "parameters": what.parameters,
        "tools": {p.name: p.version for p in core_programs(tools, device)},
        "clock_mhz": clocks,
        "not_placed": why,
    }


def core_programs(tools, device):
    """The programs that a core's clock is found by."""
    return [tools.find(n) for n in ("yosys", f"nextpnr-{device.family}")]


def tell_clock(f):
    """The same for people."""
    clock = f["clock_mhz"]
    said = f"not placed: {f['not_placed']}" if clock is None else f"clock {clock['median']:.1f} MHz"
    print(f"{f['device']}, {f['core']}; " + ", ".join(f"{k} {v}" for k, v in f["tools"].items()) + f"; {said}")


def tell(f):
    """The figures for people."""
    clock, loop, adder = (f[k]["median"] for k in ("clock_mhz", "least_loop_mhz", "lone_adder_mhz"))
    seeds = len(f["clock_mhz"]["all"])
    print(f"{f['device']}, {f['core']}; " + ", ".join(f"{k} {v}" for k, v in f["tools"].items()))
    print("  ".join(f"{k.upper()} {v['used']} of {v['available']}" for k, v in f["cells"].items()))
    text = f"clock {clock:.1f} MHz"
    if seeds > 1:
        text += f" (median of {seeds} seeds; worst {f['clock_mhz']['worst']:.1f}, best {f['clock_mhz']['best']:.1f})"
    print(
        f"{text}: {100 * f['share']:.0f} % of the least loop of {f['loop_bits']} bits, {loop:.1f} MHz; a lone adder reaches {adder:.1f}"
    )
    if "need" in f:
        print(need.tell(f["need"], clock))
    timing.tell(f["worst_path"])
    print("latest registers:")
    for row in f["worst_endpoints"]:
        print(f"    {row['ns']:6.2f} ns  {row['register']}")


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Trouble(f"{message}; see --help")


def check_board_options(options):
    """Checks options that go with a board only, or with a device only. Sets `board`, its name or None, and `feed`, whether
    it is to be fed with frames."""
    is_board = options.device in boards.names(options.top)
    options.board = options.device if is_board else None
    options.feed = is_board and (options.pack or options.stream)
    if not is_board:
        core.find_device(options.top, options.device)
        if options.pack:
            raise Trouble(f"--pack: takes a board ({', '.join(boards.names(options.top))}), not {options.device}")
        for name in ("stream", "gate", "record"):
            if options.core_only and getattr(options, name) not in (None, False):
                raise Trouble(f"--{name}: is of a run with yardsticks, and --core-only has none")
        return
    for name in ("core_only", "versions"):
        if getattr(options, name):
            raise Trouble(f"--{name.replace('_', '-')}: is of a device, and {options.device} is a board")
    if options.core:
        raise Trouble(f"{options.core[0]}: a board's core stands in {boards.BOARDS}/boards.yaml")
    for name in ("gate", "fps", "total_lines"):
        if getattr(options, name) is not None:
            raise Trouble(f"--{name.replace('_', '-')}: is of a device, and {options.device} is a board")
    if options.pack and options.stream:
        raise Trouble("--pack, --stream: one at a time")
    for name in ("json", "out", "record", "seeds"):
        if options.feed and getattr(options, name) not in (None, False):
            raise Trouble(f"--{name}: is of a placement, and nothing is placed for --pack or --stream")


def options_of_line():
    """The command line's options; Trouble if they are not legal."""
    parser = Parser(prog="tools/fpga", add_help=False, allow_abbrev=False)
    parser.add_argument("--top", type=pathlib.Path, required=True)
    parser.add_argument("--wheels", type=pathlib.Path, required=True)
    parser.add_argument("device")
    parser.add_argument("core", nargs="*")
    parser.add_argument("--seeds", type=int)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--json")
    parser.add_argument("--tools", choices=("wheels", "system", "any"), default="wheels")
    parser.add_argument("--core-only", action="store_true")
    parser.add_argument("--versions", action="store_true")
    parser.add_argument("--kage", type=pathlib.Path)
    parser.add_argument("--stream", type=pathlib.Path)
    parser.add_argument("--fps", type=float)
    parser.add_argument("--total-lines", type=int)
    parser.add_argument("--gate", type=float)
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--pack", type=pathlib.Path)
    options = parser.parse_args()
    check_board_options(options)
    options.seeds = 1 if options.seeds is None else options.seeds
    if not 1 <= options.seeds <= 100:
        raise Trouble(f"--seeds {options.seeds}: legal is 1 .. 100")
    for name in ("fps", "total_lines"):
        if getattr(options, name) is not None and not options.stream:
            raise Trouble(f"--{name.replace('_', '-')}: takes --stream, whose frames it is about")
    options.fps = 60 if options.fps is None else options.fps
    if not 0 < options.fps <= 10000:
        raise Trouble(f"--fps {options.fps:g}: legal is above 0, up to 10000")
    if options.gate is not None and not 0 <= options.gate < 100:
        raise Trouble(f"--gate {options.gate:g}: legal is 0 to 99 per cent")
    if options.gate is not None and options.record:
        raise Trouble("--gate compares with a row, --record replaces it: one at a time")
    return options


def run_into(out, top, options, measured):
    """Measures, and leaves the run in the folder `out` once all is done; gives its figures, and their text. `measured` takes
    programs and folder."""
    work = out.with_name(f"{out.name}.part{os.getpid()}")
    try:
        tools = programs.Programs(options.tools, options.wheels, top)
        work.mkdir(parents=True)
        shutil.copytree(top / "rtl", work / "rtl")
        shutil.copytree(top / "constraints", work / "constraints")
        (work / kept.FLOW).parent.mkdir(parents=True)  # so that the figures are of what was there at the start
        shutil.copy(top / kept.FLOW, work / kept.FLOW)
        figures = measured(tools, work)
        text = json.dumps(figures, indent=2) + "\n"
        (work / FIGURES).write_text(text)
        for folder in ("rtl", "constraints", "tools"):
            shutil.rmtree(work / folder)
        if out.exists():
            shutil.rmtree(out)
        work.rename(out)
        if options.json and options.json != "-":
            pathlib.Path(options.json).write_text(text)
    except OSError as e:
        raise Trouble(f"{e.filename}: {e.strerror}") from e
    finally:
        shutil.rmtree(work, ignore_errors=True)
    return figures, text


def tell_or_print(options, figures, text, out, told):
    if options.json == "-":
        print(text, end="")
    else:
        told(figures, out)


def checked_out(out):
    if out.exists() and not (out / FIGURES).is_file():
        raise Trouble(f"{out}: is there already, and holds no run of tools/fpga that could be replaced")
    return out


def main_board(options):
    top = options.top
    if options.feed:
        frames = feed.of_pack(options.pack) if options.pack else feed.of_stream(top, options.stream)
        tools = programs.Programs(options.tools, options.wheels, top)
        feed.tell(frames, *feed.hold(top, tools, frames, options.board))
        return 0
    b = boards.find(top, options.board)
    out = checked_out(options.out or top / "build/fpga" / b.name)
    figures, text = run_into(
        out, top, options, lambda tools, work: board_run.figures_of(b, options, tools, work, Progress())
    )
    tell_or_print(options, figures, text, out, board_run.tell)
    if options.record:
        kept.record_board(top, figures)
    return 0 if figures["met"] else 1


def tell_core(figures, out):
    tell(figures)
    print(f"bitstream, netlist, logs: {out}")


def tell_core_only(figures, out):
    tell_clock(figures)
    print(f"netlist, logs: {out}")


def main():
    options = options_of_line()
    if options.board:
        return main_board(options)
    top = options.top
    device = core.find_device(top, options.device)
    if options.versions:
        for program in core_programs(programs.Programs(options.tools, options.wheels, top), device):
            print(f"{program.name}: {program.said}")
        return 0
    what = core.find_core(top, options.core)
    row = None if options.gate is None else kept.row_for(top, device.name, what.name, options.seeds)
    out = checked_out(options.out or top / "build/fpga" / f"{device.name}-{what.name}")
    if options.core_only:
        measured, told = partial(core_figures_of, device, what, options), tell_core_only
    else:
        measured, told = partial(figures_of, top, device, what, options), tell_core
    figures, text = run_into(out, top, options, measured)
    tell_or_print(options, figures, text, out, told)
    if options.core_only:
        return 0 if figures["not_placed"] is None else 1
    if options.record:
        print(f"tools/fpga: {kept.record(top, figures)}", file=sys.stderr)
    lost = [] if row is None else kept.lost(row, figures, options.gate)
    for sentence in lost:
        print(f"tools/fpga: {device.name} {what.name} lost more than {options.gate:g} %: {sentence}", file=sys.stderr)
    return 1 if lost else 0


try:
    sys.exit(main())
except Trouble as trouble:
    print(f"tools/fpga: {trouble}", file=sys.stderr)
    sys.exit(2)
except KeyboardInterrupt:
    sys.exit(130)
