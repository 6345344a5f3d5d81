# SPDX-License-Identifier: Apache-2.0
"""See tools/gen-defs."""

import pathlib
import re
import sys

import cpp_clock_phases
import cpp_defs
import cpp_derived
import registers
import stage_values
import sv_layout
import sv_params
import sv_widths
import tables
import yaml
from definition import Defs
from files import BOARD, BOARDS, DEVICES, NOTE, SOURCE, STAGES, TOP
from stages import Stages
from templates import render


def rtl_files(pattern):
    return sorted(str(p.relative_to(TOP)) for p in (TOP / "rtl").glob(pattern))


def boards():
    """Data of constraints/boards for kage.core: files, parameters, and the boards with all parameters together."""
    rows = yaml.safe_load((TOP / BOARDS).read_text())
    folder = (TOP / BOARDS).parent
    tops = sorted({b["top"] for b in rows.values()})
    return {
        "boards": {
            name: {"synth": [], "nextpnr": []} | b | {"parameters": b["core"] | b["board"]} for name, b in rows.items()
        },
        "board_parameters": sorted({name for b in rows.values() for name in b["board"]}),
        "board_tops": {
            top: sorted(
                str(p.relative_to(TOP)) for p in (folder / top).iterdir() if p.suffix in (".sv", ".lpf", ".pcf")
            )
            for top in tops
        },
        "board_sources": rtl_files("board/*.sv"),
        "board_includes": rtl_files("board/include/*.svh"),
    }


def file_list():
    """For tools that read a list of files."""
    lines = [
        f"// {NOTE}",
        "// All files of the core, for use in the top folder: verilator --lint-only -Wall --top-module kage_axi -f rtl/kage.f",
    ]
    return "\n".join([*lines, "+incdir+rtl/include", *rtl_files("*.sv"), "rtl/kage_axi.v"]) + "\n"


# Where what is made of the template of each name goes.
OF_TEMPLATES = (
    "ref/contract/display_curve.hpp",
    "ref/contract/fields.hpp",
    "ref/contract/kinds.hpp",
    "ref/contract/order.hpp",
    "ref/contract/token_text.hpp",
    "ref/bind/generated/golden_names.hpp",
    "python/kage/golden_numbers.py",
    "python/kage/stream.py",
    "ref/include/kage/golden_numbers.h",
    "ref/include/kage/golden_numbers.svh",
    "rtl/include/generated/kage_buses.svh",
    "rtl/include/generated/kage_curve.svh",
    "rtl/include/generated/kage_order.svh",
    "rtl/kage_axi.v",
    "verif/cosim/report/page/stream.js",
    "verif/test/rtl/generated/buses.hpp",
)


def of_definition(defs):
    """The files that rtl/defs/kage.yaml makes, each with its text."""
    out = {path: render(defs, pathlib.PurePath(path).name) for path in OF_TEMPLATES}
    out["kage.core"] = render(
        defs,
        "kage.core",
        release=re.search(r"project\(kage\s+VERSION ([0-9.]+)", (TOP / "CMakeLists.txt").read_text()).group(1),
        sources=rtl_files("*.sv"),
        includes=rtl_files("include/**/*.svh"),
        devices=yaml.safe_load((TOP / DEVICES).read_text()),
        **boards(),
    )
    return out | {
        "ref/include/kage/defs.hpp": cpp_defs.defs_hpp(defs),
        "ref/include/kage/registers.h": registers.registers_h(defs),
        "ref/contract/derived.hpp": cpp_derived.derived(defs),
        "rtl/include/generated/kage_checks.svh": sv_params.checks(defs),
        "rtl/include/generated/kage_impl_param_map.svh": sv_params.param_map(defs, defs.impl),
        "rtl/include/generated/kage_impl_params.svh": sv_params.params(defs, defs.impl),
        "rtl/include/generated/kage_layout.svh": sv_layout.layout(defs),
        "rtl/include/generated/kage_pixel_param_map.svh": sv_params.param_map(defs, defs.pixel),
        "rtl/include/generated/kage_pixel_params.svh": sv_params.params(defs, defs.pixel),
        "rtl/include/generated/kage_registers.svh": registers.registers_svh(defs),
        "rtl/include/generated/kage_widths.svh": sv_widths.widths(defs),
        "rtl/kage.f": file_list(),
        "ref/cost/generated/clock_phases.hpp": cpp_clock_phases.clock_phases(defs),
    }


def of_stages(stages):
    """The files that rtl/defs/stages.yaml makes."""
    return {
        "verif/cosim/diverge/monitors/stages.h": stages.c(),
        "verif/cosim/diverge/monitors/kage_trace_numbers.svh": stages.sv_numbers(),
        "verif/cosim/diverge/monitors/kage_trace_stages.svh": stages.sv_functions(),
        "verif/cosim/diverge/stage_values.hpp": stage_values.stage_values_hpp(stages),
    }


def of_board(board):
    """The files that rtl/defs/board.yaml makes."""
    return {
        "rtl/board/include/board_registers.svh": registers.board_svh(board),
        "verif/board/generated/board_registers.h": registers.board_h(board),
    }


def of_docs(defs):
    """The pages of docs that have tables."""
    texts = {path: path.read_text() for path in sorted((TOP / "docs").glob("*.md"))}
    return {str(p.relative_to(TOP)): tables.filled(defs, t) for p, t in texts.items() if "<!-- defs:" in t}


def main(check):
    defs = Defs(TOP / SOURCE)
    board = registers.checked_board(yaml.safe_load((TOP / BOARD).read_text()))
    defs.d["board"] = board
    out = of_definition(defs) | of_stages(Stages(TOP / STAGES, defs)) | of_board(board) | of_docs(defs)
    stale = [p for p, text in out.items() if not (TOP / p).exists() or (TOP / p).read_text() != text]
    for p in stale:
        print(("differs: " if check else "wrote ") + p)
        if not check:
            (TOP / p).write_text(out[p])
    return 1 if check and stale else 0


sys.exit(main("--check" in sys.argv[1:]))
