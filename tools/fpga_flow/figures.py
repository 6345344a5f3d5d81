# SPDX-License-Identifier: Apache-2.0
"""constraints/figures.json: what each device and core was measured to reach, a row each, and the gate against it. A row keeps of
which RTL, constraints and flow it is, so that who quotes it can tell whether that is what is there (tools/figures)."""

import datetime
import json
import pathlib
import re
import statistics
import sys

import board as boards
import core
from trouble import Trouble

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
import kept_rows

PLACE = "constraints/figures.json"
BOARDS = "constraints/board_figures.json"


def key_of(row):
    return row["device"], row["core"]


def rows_of(top):
    path = top / PLACE
    try:
        rows = json.loads(path.read_text()) if path.exists() else []
        return {key_of(row): row for row in rows}
    except (ValueError, KeyError, TypeError) as e:
        raise Trouble(f"{path}: no list of rows: {e}") from e


FLOW = "tools/fpga_flow/flow.py"  # the options of yosys and nextpnr


def values_of(device, what):
    """Options of a run that change its figures, beside files and versions."""
    values = {"parameters": what.parameters, "nextpnr": list(device.nextpnr)}
    return values | ({"synth": list(device.synth)} if device.synth else {})


def other_tools(top, row):
    """Tools of the row that are of another version than the one that is installed here (tools/deps fpga)."""
    pinned = (top / "tools/pypi.sh").read_text() + (top / "tools/deps").read_text()
    versions = {t: re.search(rf"\byowasp-{t}(?:==|\]=)([0-9.]+)", pinned) for t in row["tools"]}
    return [
        f"{t} {v}" for t, v in row["tools"].items() if not versions[t] or not f"{versions[t][1]}.".startswith(f"{v}.")
    ]


def of_run(top, device, what, modules):
    """Hash of all that a run of the core was measured on; `modules` are all that the core has."""
    files = [f for m in modules for f in (f"rtl/{m}.sv", f"constraints/{m}.sv") if (top / f).is_file()]
    files = kept_rows.with_includes(top, files)
    files += [FLOW, "constraints/least_loop.sv", "constraints/lone_adder.sv"]
    return kept_rows.of_what(top, files, values_of(device, what))


def moved(top, row):
    """Which files and tools are others than those that the row was measured on; [] if it is of what is there."""
    if "of" not in row:
        return ["all: the row does not say of what it is"]
    try:
        values = values_of(core.find_device(top, row["device"]), core.find_core(top, [row["core"]]))
    except Trouble:
        return ["its core or device"]
    return kept_rows.moved(top, row["of"], values) + other_tools(top, row)


def values_of_board(board):
    """Options of a board that change its bitstream's figures, beside files and versions."""
    design = board.design
    return {
        "parameters": design.values,
        "synth": list(design.synth),
        "nextpnr": [*board.device.nextpnr, *design.nextpnr],
    }


def of_board(top, board):
    """Hash of all that a board's bitstream is made of."""
    sources = [str(f.relative_to(top)) for pattern in board.design.sources.split() for f in top.glob(pattern)]
    includes = [
        str(f.relative_to(top)) for folder in board.design.includes for f in top.glob(f"{folder}/**/*") if f.is_file()
    ]
    return kept_rows.of_what(top, [*sources, *includes, board.pins, FLOW], values_of_board(board))


def board_moved(top, row):
    """moved() of a row of BOARDS."""
    if "of" not in row:
        return ["all: the row does not say of what it is"]
    if row["board"] not in boards.names(top):
        return ["its board"]
    return kept_rows.moved(top, row["of"], values_of_board(boards.find(top, row["board"]))) + other_tools(top, row)


def row_of(figures):
    """The row that is kept of a run's figures."""
    path = figures["worst_path"]
    return {
        "device": figures["device"],
        "core": figures["core"],
        **({"front_end": True} if figures["parameters"]["ACTIVE"] > 0 else {}),
        "date": datetime.date.today().isoformat(),
        "tools": figures["tools"],
        "cells": {k: v["used"] for k, v in figures["cells"].items()},
        "clocks_mhz": [round(c, 2) for c in figures["clock_mhz"]["all"]],
        "clock_mhz": round(figures["clock_mhz"]["median"], 2),
        "least_loop_mhz": round(figures["least_loop_mhz"]["median"], 2),
        "lone_adder_mhz": round(figures["lone_adder_mhz"]["median"], 2),
        "loop_bits": figures["loop_bits"],
        "worst_path": [path["from"], *(f"{cells} of {module}" for module, cells in path["through"]), path["to"]],
        "of": figures["of"],
    }


def record_board(top, figures):
    """Puts the row of a board's run into BOARDS, in place of the one that was there."""
    path = top / BOARDS
    try:
        rows = {row["board"]: row for row in (json.loads(path.read_text()) if path.exists() else [])}
    except (ValueError, KeyError, TypeError) as e:
        raise Trouble(f"{path}: no list of rows: {e}") from e
    rows[figures["board"]] = {
        "board": figures["board"],
        "date": datetime.date.today().isoformat(),
        "tools": figures["tools"],
        "cells": figures["cells"],
        "of": figures["of"],
        "best_seed": figures["best_seed"],
        "clocks": [
            {
                "clock": c["clock"],
                "need_mhz": round(c["need_mhz"], 3),
                "clocks_mhz": [round(mhz, 2) for mhz in c["mhz"]["all"]],
            }
            for c in figures["clocks"]
        ],
        "crossings": [
            {
                "from": c["from"],
                "to": c["to"],
                "allowed_ns": round(c["allowed_ns"], 3),
                "ns": [round(ns, 2) for ns in c["ns"]],
            }
            for c in figures["crossings"]
        ],
    }
    text = ",\n".join(json.dumps(rows[k], ensure_ascii=False) for k in sorted(rows))
    path.write_text(f"[\n{text}\n]\n")


def said_of(top, old, row):
    """A sentence: what a row says now that it did not, and which files have moved since."""
    now = f"{row['device']} {row['core']}: clock {row['clock_mhz']:.1f} MHz"
    if not old:
        return f"{now}, a new row"
    now += f", was {old['clock_mhz']:.1f}"
    for cell, used in row["cells"].items():
        if old["cells"].get(cell) != used:
            now += f"; {cell.upper()} {used}, was {old['cells'].get(cell)}"
    return f"{now}; moved since: {', '.join(moved(top, old)) or 'nothing'}"


def record(top, figures):
    """Puts the row of a run into the file, in place of the one that was there, and gives a sentence of what has moved. Where
    `before_mhz` stood it stays."""
    rows = rows_of(top)
    row = row_of(figures)
    old = rows.get(key_of(row), {})
    said = said_of(top, old, row)
    if "before_mhz" in old:
        row["before_mhz"] = old["before_mhz"]
    rows[key_of(row)] = row
    text = ",\n".join(json.dumps(rows[k], ensure_ascii=False) for k in sorted(rows))
    (top / PLACE).write_text(f"[\n{text}\n]\n")
    return said


def row_for(top, device, core, seeds):
    """The row that a run by so many seeds can be held against."""
    row = rows_of(top).get((device, core))
    if not row:
        raise Trouble(f"--gate: {PLACE} has no row of {device} {core}; --record makes one")
    if seeds > len(row["clocks_mhz"]):
        raise Trouble(f"--gate: the row of {device} {core} has {len(row['clocks_mhz'])} seeds, not {seeds}")
    return row


def lost(row, figures, tolerance):
    """Sentences, one for each figure that is worse than the row's by more than `tolerance` per cent. The same seeds are compared."""
    if figures["tools"] != row["tools"]:
        raise Trouble(
            f"--gate: the row was measured with {row['tools']}, this run with {figures['tools']}; measure it anew with --record"
        )
    now = figures["clock_mhz"]["all"]
    then = statistics.median(row["clocks_mhz"][: len(now)])
    said = []
    if figures["clock_mhz"]["median"] < then * (1 - tolerance / 100):
        said.append(f"clock {figures['clock_mhz']['median']:.1f} MHz, was {then:.1f}")
    for cell, used in row["cells"].items():
        if figures["cells"][cell]["used"] > used * (1 + tolerance / 100):
            said.append(f"{cell.upper()} {figures['cells'][cell]['used']}, was {used}")
    return said
