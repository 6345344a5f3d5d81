#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Elaboration refuses every parameter out of its range and all that breaks a rule, by name, and takes the ends of the
ranges. Ranges and rules are those of rtl/defs/kage.yaml. A run of Verilator reports all faults, so one run tries many
parameters. The modules of rtl/board say themselves what is legal; each of their reasons has its case.

usage: parameters.py SOURCE_DIR
"""

import concurrent.futures
import itertools
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import yaml

# For each rule, parameters that break it and no other.
BREAKS = {
    "fsf_alone": ["DSF_BITS=0"],
    "count_alone": ["COUNT_BITS=1 DSF_BITS=0 FSF=0"],
    "class_alone": ["CLASS_BITS=2"],
    "lights_alone": ["LIGHTS=2", "LIGHTS=2 COUNT_BITS=1"],
    "linear_alone": [
        *(
            "LINEAR_BITS=10 COLOR_FRAC=2 SMOOTH=1 DSF_BITS=0 FSF=0",
            "LINEAR_BITS=12 SMOOTH=1 COLOR_FRAC=8 COUNT_BITS=1 CLASS_BITS=2",
        ),
        "LINEAR_BITS=12 SMOOTH=1 COLOR_FRAC=8 COUNT_BITS=1 CLASS_BITS=2 LIGHTS=2",
    ],
    "linear_frac": ["LINEAR_BITS=10 SMOOTH=1 COLOR_FRAC=1", "LINEAR_BITS=14 SMOOTH=1 COLOR_FRAC=9 COUNT_BITS=4"],
    "color_frac_alone": ["COLOR_FRAC=4"],
    "classic_segment": ["CLASSIC=1 UNITS=2", "CLASSIC=1 UNITS=2 Z_BITS=15 Z_FRAC=0 DX_BITS=8"],
    "width_for_x": ["MAX_WIDTH=2048", "X_BITS=4 MAX_WIDTH=16"],
}
# Legal ones, at ends of ranges: nothing in the whole core is wrong.
LEGAL = (
    "X_BITS=4 MAX_WIDTH=15 Z_BITS=4 Z_FRAC=0 CHANNELS=1 DSF_BITS=0 FSF=0 SHADE_FRAC=1 LANES=32 BEAT_WORDS=8",
    "X_BITS=15 MAX_WIDTH=32767 Z_BITS=28 Z_FRAC=16 SMOOTH=1 COLOR_FRAC=16 DSF_BITS=8 SHADE_FRAC=16 LANES=1 BEAT_WORDS=1",
    "X_BITS=11 MAX_WIDTH=2047",
    "MAX_WIDTH=1",
    "MAX_WIDTH=1 ARRANGEMENT=0",
    "UNITS=64 LANES=32 SMOOTH=1 FACE_BITS=12 DX_BITS=15 SEG_BITS=12 ORDER_BITS=16",
    "UNITS=1 MAX_WIDTH=1 ARRANGEMENT=0 DSF_BITS=0 FSF=0 CHANNELS=1 FACE_BITS=2 DX_BITS=2 SEG_BITS=2 ORDER_BITS=1",
    "COUNT_BITS=8 LIGHTS=8 CLASS_BITS=11 SHADE_FRAC=16 TRANSLUCENCY=1 UNITS=3 SMOOTH=1 COLOR_FRAC=16 LANES=32",
    "COUNT_BITS=8 LIGHTS=8 CLASS_BITS=11 SHADE_FRAC=1 FSF=0 DSF_BITS=8 CHANNELS=1 ARRANGEMENT=0 MAX_WIDTH=9",
    "COUNT_BITS=1 CLASS_BITS=2 UNITS=1 LANES=1 BEAT_WORDS=1 SHADE_FRAC=16",
    "COUNT_BITS=1 X_BITS=4 MAX_WIDTH=15 Z_BITS=4 Z_FRAC=0 CHANNELS=1 FSF=0 TRANSLUCENCY=1",
    "UNITS=5 CLASSIC=1 Z_BITS=15 Z_FRAC=0",
    "LINEAR_BITS=14 SMOOTH=1 COLOR_FRAC=16 COUNT_BITS=8 DSF_BITS=8 TRANSLUCENCY=1 UNITS=3 LANES=32 SHADE_FRAC=16 ACTIVE=4",
    "LINEAR_BITS=10 SMOOTH=1 COLOR_FRAC=2 CHANNELS=1 FSF=0 ARRANGEMENT=0 MAX_WIDTH=9 UNITS=1 SHADE_FRAC=1 ACTIVE=1",
    "LINEAR_BITS=12 SMOOTH=1 COLOR_FRAC=12 COUNT_BITS=8 FSF=0 TRANSLUCENCY=1 LANES=1 X_BITS=4 MAX_WIDTH=15 Z_BITS=4 Z_FRAC=0",
)

# For each module of rtl/board, parameters for each of its reasons, in the order in which it gives them, and legal ones
# at the ends of ranges.
BOARD = {
    "async_fifo": (["DEPTH=6", "DEPTH=2"], ["DEPTH=4"]),
    "block_memory": (["WORDS=100", "WORDS=1024 ADDR_BITS=9"], ["WORDS=2 ADDR_BITS=1"]),
    "board_registers": (["LINES=2049", "PIXELS=4097"], ["LINES=2048 PIXELS=4096"]),
    "line_capture": (["CHANNELS=2", "PIXELS=1", "PIXELS=32769"], ["CHANNELS=1 PIXELS=2", "PIXELS=32768"]),
    "line_signature": (["CHANNELS=2", "LINES=1", "LINES=32769"], ["CHANNELS=1 LINES=2", "LINES=32768"]),
    "link_receiver": (["SLOTS=1", "SLOTS=3", "SLOTS=128"], ["SLOTS=2", "SLOTS=64"]),
    "reset_release": (["CLOCKS=2"], ["CLOCKS=3"]),
    "sdram_controller": (
        [
            *("CLOCK_HZ=999999 T_REF=640000000", "BURST=3", "BURST=1", "BURST=512", "CAS_LATENCY=4 READ_DELAY=3"),
            *("READ_DELAY=0", "ROW_BITS=10", "COLUMN_BITS=11", "BANK_BITS=0"),
            *("T_RP=0", "T_REF=64000", "T_RAS_MAX=1000"),
        ],
        ["CLOCK_HZ=1000000 T_REF=640000000 T_RAS_MAX=1000000", "BURST=2", "CAS_LATENCY=2"],
    ),
    "sdram_memory": (["WORDS=48", "BURST=32 WORDS=32", "BURST=128 WORDS=256"], ["BURST=32 WORDS=64"]),
    "stream_player": (["BEAT_WORDS=3", "RUN_BITS=0", "RUN_BITS=16"], ["BEAT_WORDS=8 RUN_BITS=1", "RUN_BITS=15"]),
    "uart_receiver": (
        ["BAUD=115199", "BAUD=3000001", "CLOCK_HZ=11999999 BAUD=3000000"],
        ["CLOCK_HZ=460800 BAUD=115200"],
    ),
    "uart_transmitter": (
        ["BAUD=115199", "BAUD=3000001", "CLOCK_HZ=11999999 BAUD=3000000"],
        ["CLOCK_HZ=460800 BAUD=115200"],
    ),
    "video_out": (["CHANNELS=2"], ["CHANNELS=1"]),
    "video_timing": (
        ["H_ACTIVE=1", "H_SYNC=0", "V_ACTIVE=1", "V_BACK=0", "H_POSITIVE=2", "V_POSITIVE=-1"],
        ["H_ACTIVE=2 V_ACTIVE=2"],
    ),
}

# A module of the core's parameters and checks alone: with nonsense for a width, Verilator gives up on the whole core before
# it comes to the checks.
CHECKS = """
`include "kage_illegal.svh"
module kage_top #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_impl_params.svh"
);
  `include "generated/kage_checks.svh"
endmodule
"""


class Elaborator:
    """Verilator, with what it is to read."""

    def __init__(self, source, rules, files):
        self.command = ["verilator", "--lint-only", "-Wall", f"-I{source}/rtl/include", "--top-module", "kage_top"]
        self.files = files
        self.rules = {rule["doc"]: rule["name"] for rule in rules}

    def fault(self, values, ranges, rules):
        """A line if Verilator refuses others than these parameters by their range, or breaks of others than these rules
        (None: whichever), or refuses without a reason; None if all is right. values: PARAM=VALUE, by blanks."""
        options = [f"-G{value}" for value in values.split()]
        run = subprocess.run([*self.command, *options, *self.files], capture_output=True, text=True, check=False)
        said = run.stdout + run.stderr
        reasons = set(re.findall(r"USERFATAL: \S+ (.*)", said))
        out = {found[1] for reason in reasons if (found := re.match(r"(\w+) must be (one of|-?\d)", reason))}
        broken = {name for doc, name in self.rules.items() if doc in reasons}
        if out == ranges and rules in (None, broken) and (run.returncode != 0) == bool(out or broken):
            return None
        return (
            f"{values}: out of range: {sorted(out)}, breaks {sorted(broken)}, exit code {run.returncode}\n{said[:400]}"
        )


def text(values):
    return " ".join(f"{name}={value}" for name, value in values.items())


def out_of_range(params):
    """Values below, above, and in each gap of what is allowed, of as many parameters at a time as there are."""
    yield {p["name"]: p["min"] - 1 for p in params}
    yield {p["name"]: p["max"] + 1 for p in params}
    allowed = {p["name"]: p["allowed"] for p in params if "allowed" in p}
    gaps = {name: [a + 1 for a, b in itertools.pairwise(list_) if a + 1 < b] for name, list_ in allowed.items()}
    for i in range(max(map(len, gaps.values()))):
        yield {name: values[i] for name, values in gaps.items() if i < len(values)}


def trials(source, folder, params, rules):
    """(Elaborator, and what its fault() takes) of all that is tried."""
    only = folder / "kage_top.sv"
    only.write_text(CHECKS)
    checks = Elaborator(source, rules, [str(only)])
    core = Elaborator(source, rules, [str(f) for f in sorted((source / "rtl").glob("*.sv"))])
    for values in out_of_range(params):
        yield checks, text(values), set(values), None
    for end in ("min", "max"):  # together they break rules, but no range
        yield checks, text({p["name"]: p[end] for p in params}), set(), None
    above = {p["name"]: p["max"] + 1 for p in params}
    yield core, text(above), above.keys(), None
    for name, cases in BREAKS.items():
        for values in cases:
            yield core, values, set(), {name}
    for values in LEGAL:
        yield core, values, set(), set()


def board_fault(source, module, values, legal):
    """A line if a module of rtl/board takes what is illegal, refuses what is legal, or gives another module's reason; and
    the reasons that it gave."""
    rtl = source / "rtl"
    command = ["verilator", "--lint-only", "-Wall", f"-I{rtl}/include", f"-I{rtl}/board/include", "-y", f"{rtl}/board"]
    options = [f"-G{value}" for value in values.split()]
    run = subprocess.run(
        [*command, "-y", rtl, "--top-module", module, *options, rtl / "board" / f"{module}.sv"],
        capture_output=True,
        text=True,
        check=False,
    )
    said = run.stdout + run.stderr
    reasons = set(re.findall(r"USERFATAL: \S*/board/%s.sv\S* (.*)" % module, said))
    if (run.returncode == 0) == legal and legal == (not reasons):
        return None, reasons
    return f"rtl/board/{module}.sv: {values}: exit code {run.returncode}, {sorted(reasons)}\n{said[:400]}", reasons


def board_faults(source, pool):
    """The same of all cases, and reasons of rtl/board that no case has."""
    cases = [(m, v, legal) for m, both in BOARD.items() for legal in (False, True) for v in both[legal]]
    given = list(pool.map(lambda case: board_fault(source, *case), cases))
    yield from (fault for fault, _ in given)
    for file in sorted((source / "rtl/board").glob("*.sv")):
        stated = set(re.findall(r'`KAGE_ILLEGAL\("(.*)"\)', file.read_text()))
        seen = set().union(
            *(reasons for (module, _, _), (_, reasons) in zip(cases, given, strict=True) if module == file.stem)
        )
        if stated - seen:
            yield f"{file}: without a case: {sorted(stated - seen)}"


def faults(source, folder):
    defs = yaml.safe_load((source / "rtl/defs/kage.yaml").read_text())
    params, rules = defs["pixel_params"] + defs["impl_params"], defs["rules"]
    if odd := BREAKS.keys() ^ {rule["name"] for rule in rules}:
        yield f"rules without a case, or cases without a rule: {sorted(odd)}"
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        yield from pool.map(lambda trial: trial[0].fault(*trial[1:]), trials(source, folder, params, rules))
        yield from board_faults(source, pool)


def main(source):
    with tempfile.TemporaryDirectory() as folder:
        bad = [fault for fault in faults(source, pathlib.Path(folder)) if fault]
    print("\n".join(bad) or "refused by name what is out of its range or breaks a rule")
    return 1 if bad else 0


sys.exit(main(pathlib.Path(sys.argv[1])))
