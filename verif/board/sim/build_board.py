#!/usr/bin/env -S python3 -B
# SPDX-License-Identifier: Apache-2.0
"""Build a board of constraints/boards/boards.yaml as a program for simulation, a shared library (board_model.h).

usage: build_board.py BOARD CACHE [--fault NAME]
       build_board.py --list
       build_board.py --core BOARD

  BOARD         a board that has a simulation
  CACHE         the folder that libraries are kept in; one that is there already, of the same sources and tools, is not built again
  --fault NAME  put a fault of verif/board/faults.yaml into a copy of the sources
  --list        print the boards that have a simulation
  --core BOARD  print the parameters of the core that the board has in simulation, as a line of YAML: a pack for it is made
                with them (kage vectors --config FILE)

Prints the screen, as dvi, vga or none and the ten numbers H_ACTIVE to V_POSITIVE of its mode, and, in the last line, the
library's path.

$VERILATOR and $CXX name other tools. On failure: a line on standard error that names the step and the log; exit status 2.
"""

import argparse
import hashlib
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

import yaml

TOP = pathlib.Path(__file__).resolve().parent.parent.parent.parent
HERE = pathlib.Path("verif/board/sim")
BOARDS = pathlib.Path("constraints/boards")
FAULTS = TOP / "verif/board/faults.yaml"
DEFECTS = TOP / "verif/cosim/model/driver/defects.py"
# All that a board's library is made of. Paths are from the top of the source tree.
PATTERNS = (
    "rtl/*.sv",
    "rtl/include/**/*.svh",
    "rtl/board/**/*.sv*",
    "constraints/boards/**/*.sv",
    "constraints/boards/boards.yaml",
    f"{HERE}/*",
)


def fail(text):
    print(text, file=sys.stderr)
    sys.exit(2)


def sources():
    return sorted(p for pattern in PATTERNS for p in TOP.glob(pattern) if p.is_file())


def version(command):
    try:
        return subprocess.run([*command, "--version"], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        fail(f"{command[0]}: cannot be run (tools/deps test)")


def run(step, command, log, folder):
    with log.open("ab") as out:
        out.write((shlex.join(str(c) for c in command) + "\n").encode())
        out.flush()
        if subprocess.run(command, stdout=out, stderr=out, cwd=folder).returncode != 0:
            kept = pathlib.Path(tempfile.gettempdir()) / f"kage-board-{os.getpid()}.log"
            shutil.copy(log, kept)
            fail(f"{step} failed: see {kept}")


def core_of(board):
    return board["core"] | board["simulation"]["core"]


def build(work, name, board, fault, verilator, cxx, partial):
    log = work / "build.log"
    tree = TOP
    if fault:
        tree = work / "tree"
        for source in sources():
            copy = tree / source.relative_to(TOP)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, copy)
        run(f"fault {fault}", [sys.executable, "-B", DEFECTS, FAULTS, "put", fault, tree], log, work)
    simulation = board["simulation"]
    parameters = board["board"] | core_of(board) | simulation["board"]
    flags = "-fPIC -fvisibility=hidden -std=c++20 -O1 -DVL_USER_FINISH -DVL_USER_STOP -DVL_USER_FATAL -DVL_PRINTF=kage_board_printf"
    flags += f" -include {TOP / HERE}/board_printf.hpp -I{TOP / HERE} -DKAGE_BAUD={simulation['baud']}"
    flags += f" -DKAGE_CRYSTAL_PS={simulation['crystal_ps']}"
    command = [
        *verilator,
        "--cc",
        "--exe",
        "--timing",
        "--timescale",
        "1ps/1ps",
        "--assert",
        "--x-initial",
        "unique",
        "-Wno-fatal",
        "-Wno-lint",
    ]
    command += ["--prefix", "Vboard", "--top-module", "board_sim", "--Mdir", work / "obj", "-O3"]
    command += [f"-I{tree}/{folder}" for folder in ("rtl/include", "rtl/board/include")]
    for folder in ("rtl", "rtl/board", BOARDS / board["top"], BOARDS / "sim"):
        command += ["-y", tree / folder]
    command += [f"-G{n}={v}" for n, v in parameters.items()] + ["-CFLAGS", flags, "-LDFLAGS", "-shared", "-o", partial]
    command += [
        tree / BOARDS / "sim/synchronizer_sim.sv",
        tree / BOARDS / "sim" / simulation["primitives"],
        tree / BOARDS / "sim" / simulation["file"],
        TOP / HERE / "board_model.cpp",
    ]
    run("verilator", command, log, work)
    run(
        "compiling the board",
        [
            "make",
            "-C",
            work / "obj",
            "-f",
            "Vboard.mk",
            "-j2",
            f"CXX={shlex.join(cxx)}",
            "OPT_FAST=-O2",
            "VM_PARALLEL_BUILDS=0",
        ],
        log,
        work,
    )


MODE = (
    "H_ACTIVE",
    "H_FRONT",
    "H_SYNC",
    "H_BACK",
    "V_ACTIVE",
    "V_FRONT",
    "V_SYNC",
    "V_BACK",
    "H_POSITIVE",
    "V_POSITIVE",
)


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n\n")[0])
    parser.add_argument("board", nargs="?")
    parser.add_argument("cache", nargs="?")
    parser.add_argument("--fault", default="")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--core", metavar="BOARD")
    args = parser.parse_args()
    boards = {n: b for n, b in yaml.safe_load((TOP / BOARDS / "boards.yaml").read_text()).items() if "simulation" in b}
    if args.list:
        print("\n".join(boards))
        return
    name = args.core or args.board
    if name not in boards:
        fail(f"sim:{name}: no board with a simulation; there are {', '.join(boards)}")
    if args.core:
        print("{" + ", ".join(f"{n}: {v}" for n, v in core_of(boards[name]).items()) + "}")
        return
    if args.fault:
        listed = subprocess.run([sys.executable, "-B", DEFECTS, FAULTS, "list"], capture_output=True, text=True)
        if args.fault not in (line.split("\t")[0] for line in listed.stdout.splitlines()):
            fail(listed.stderr.strip() or f"{args.fault}: not in {FAULTS}")
    verilator = shlex.split(os.environ.get("VERILATOR") or "verilator")
    cxx = shlex.split(os.environ.get("CXX") or "c++")
    key = hashlib.sha256((version(verilator) + version(cxx)).encode())
    for source in sources() + ([FAULTS, DEFECTS] if args.fault else []):
        key.update(str(source.relative_to(TOP)).encode() + b"\0" + hashlib.sha256(source.read_bytes()).digest())
    cache = pathlib.Path(args.cache)
    library = cache / f"{args.board}{'-' + args.fault if args.fault else ''}-{key.hexdigest()[:16]}.so"
    if not library.exists():
        cache.mkdir(parents=True, exist_ok=True)
        partial = cache.resolve() / f".{library.name}.{os.getpid()}"
        try:
            with tempfile.TemporaryDirectory(prefix="kage-board-") as work:
                build(pathlib.Path(work), args.board, boards[args.board], args.fault, verilator, cxx, partial)
            os.replace(partial, library)
        finally:
            partial.unlink(missing_ok=True)
    parameters = boards[args.board]["board"] | boards[args.board]["simulation"]["board"]
    print(boards[args.board]["simulation"]["screen"], *(parameters.get(name, 0) for name in MODE))
    print(library)


if __name__ == "__main__":
    main()
