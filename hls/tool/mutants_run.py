# SPDX-License-Identifier: Apache-2.0
"""Tries mutants of the generated modules (mutate.py), by vectors, by all inputs or by proofs, and says what became of them."""

from __future__ import annotations

import hashlib
import os
import pathlib
import random
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field

from .configurations import configurations
from .mutate import Module, Mutant
from .trouble import Trouble

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
GENERATED = [TOP / "hls/generated", TOP / "rtl"]  # the latter has the core's
HARNESS = TOP / "verif/test/hls/mutants.cpp"
BENCH = TOP / "verif/test/rtl/hls_blend_bench.sv"
BLEND = "hls_pixel_blend_"
PROOFS = TOP / "verif/test/hls/proofs.sh"
WORK = TOP / "build/hls-mutants"


@dataclass
class Verdicts:
    module: str
    by: str  # what they were tried by
    tried: list[Mutant] = field(default_factory=list)
    found: list[Mutant] = field(default_factory=list)
    equivalent: list[Mutant] = field(default_factory=list)
    lived: list[Mutant] = field(default_factory=list)


def _run(command: list, what: str, cwd: pathlib.Path | None = None) -> str:
    done = subprocess.run([str(c) for c in command], cwd=cwd, capture_output=True, text=True, check=False)
    if done.returncode:
        said = (done.stderr + done.stdout).strip().splitlines()
        raise Trouble(f"{what}: {next((s for s in said if 'rror' in s), said[0] if said else 'failed')}")
    return done.stdout


class Vectors:
    """A pipeline, or the blender, with its mutants as a program, which is kept in build/ as long as nothing of it changes."""

    def __init__(self) -> None:
        self._verilator = os.environ.get("VERILATOR") or "verilator"
        if not shutil.which(self._verilator):
            raise Trouble("verilator is missing (tools/deps test)")
        self._cxx = shlex.split(os.environ.get("CXX") or "c++")
        if shutil.which("ccache") and "ccache" not in self._cxx[0]:
            self._cxx.insert(0, "ccache")
        self._include = (
            pathlib.Path(_run([self._verilator, "--getenv", "VERILATOR_ROOT"], "verilator").strip()) / "include"
        )
        versions = _run([self._verilator, "--version"], "verilator") + _run([*self._cxx, "--version"], self._cxx[0])
        sources = [
            HARNESS,
            BENCH,
            *sorted((TOP / "rtl/include").rglob("*.svh")),
            *sorted((TOP / "verif/test/rtl").rglob("*.hpp")),
            *sorted((TOP / "hls/kernels").glob("*.hpp")),
        ]
        self._key = versions + "".join(
            p.read_text() for p in [*sources, TOP / "hls/types.hpp", TOP / "hls/pragmas.hpp"]
        )
        self._flags = ["-std=c++20", "-O1", "-g0", "-w", "-I.", f"-I{self._include}", f"-I{self._include}/vltstd"]
        self._flags += [f"-I{TOP}/verif/test/rtl", f"-I{TOP}/hls"]

    def _runtime(self) -> list[pathlib.Path]:
        folder = WORK / hashlib.sha256(f"runtime {self._key}".encode()).hexdigest()[:16]
        objects = [folder / f"{name}.o" for name in ("verilated", "verilated_threads")]
        if not all(o.is_file() for o in objects):
            folder.mkdir(parents=True, exist_ok=True)
            for o in objects:
                _run(
                    [*self._cxx, *self._flags, "-c", self._include / f"{o.stem}.cpp", "-o", o], f"{o.stem}.cpp", folder
                )
        return objects

    def _ways(self, module: Module) -> tuple[list, list]:
        """Options of Verilator and of the compiler: a pipeline is a model of its own, the blender stands in a bench."""
        if not module.name.startswith(BLEND):
            ports = "".join(part.capitalize() for part in module.name.removeprefix("hls_").split("_")) + "Ports"
            stages = re.search(r"^// Latency: (\d+) clock", "\n".join(module.lines), re.M)[1]
            return ["--top-module", module.name], [f"-DPORTS={ports}", f"-DSTAGES={stages}"]
        frac = configurations(["SHADE_FRAC"])[module.name.removeprefix(BLEND)]["SHADE_FRAC"]
        way = ["--top-module", BENCH.stem, f"-DKERNEL={module.name}", "-DMUTANTS", f"-I{TOP}/rtl/include", BENCH]
        return [*way, f"-GSHADE_FRAC={frac}", "-GTRANSLUCENCY=1", "-GCHANNELS=1"], [f"-DBLEND_FRAC={frac}"]

    def program(self, module: Module, mutants: list[Mutant]) -> pathlib.Path:
        text = module.with_mutants(mutants, has_port=True)
        folder = WORK / hashlib.sha256(f"{module.name} {text} {self._key}".encode()).hexdigest()[:16]
        program = folder / "mutants"
        if program.is_file():
            return program
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        (folder / f"{module.name}.sv").write_text(text)
        options, defines = self._ways(module)
        command = [self._verilator, "--cc", "--prefix", "Vmutants", "--Mdir", folder, "--x-initial", "unique", *options]
        command += ["-Wno-lint", "-Wno-style", "-Wno-fatal", f"{module.name}.sv"]
        _run(command, f"verilator: {module.name}", folder)
        lines = ["#define VL_INCLUDE_OPT include", '#include "Vmutants.h"']
        lines += [f'#include "{p.name}"' for p in sorted(folder.glob("Vmutants*.cpp"))] + [f'#include "{HARNESS}"']
        (folder / "all.cpp").write_text("\n".join(lines) + "\n")
        defines.append("-DMODEL=Vmutants")
        _run(
            [*self._cxx, *self._flags, *defines, "-c", "all.cpp", "-o", "all.o"], f"{module.name}: its program", folder
        )
        _run([*self._cxx, "all.o", *self._runtime(), "-pthread", "-o", program], f"{module.name}: its program", folder)
        return program

    def try_all(self, module: Module, mutants: list[Mutant], vectors: int, seed: int) -> Verdicts:
        exhausted = module.name.startswith(BLEND)
        verdicts = Verdicts(module.name, "all inputs" if exhausted else f"{vectors} vectors", mutants)
        program = self.program(module, mutants)
        numbers = [str(m.number) for m in mutants]
        done = subprocess.run([program, str(vectors), str(seed), *numbers], capture_output=True, text=True, check=False)
        if done.returncode:
            raise Trouble(f"{module.name}: without a mutant: {done.stdout.strip() or f'exit code {done.returncode}'}")
        said = dict(line.split(" ", 1) for line in done.stdout.splitlines())
        for m in mutants:
            if said[str(m.number)] != "lives":
                verdicts.found.append(m)
            elif exhausted or (m.terms and same_terms(module, m.terms)):
                verdicts.equivalent.append(m)
            else:
                verdicts.lived.append(m)
        return verdicts


def same_terms(module: Module, terms: tuple[str, str]) -> bool:
    """Whether two terms of a module have the same value for all inputs, as yosys' SAT solver has it."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "values.sv"
        path.write_text(module.values_alone([terms]))
        script = f"read_verilog -sv -formal {path}; prep -top {module.name}; opt -full; sat -verify -prove-asserts -timeout 100"
        done = subprocess.run(["yosys", "-q", "-p", script], capture_output=True, text=True, check=False)
        if done.returncode and "proof did fail" not in done.stdout + done.stderr:
            raise Trouble(f"yosys: {module.name}: {(done.stdout + done.stderr).strip().splitlines()[-1]}")
        return done.returncode == 0


def try_by_proof(module: Module, mutants: list[Mutant]) -> Verdicts:
    """A mutant for which the proof still holds is the hand-written RTL too, so it is equivalent."""
    verdicts = Verdicts(module.name, "proof", mutants)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / f"{module.name}.sv"
        path.write_text(module.with_mutants(mutants, has_port=False))
        read = _run(["bash", PROOFS, "--script", module.name, path], "proofs.sh")
        script = [read.replace("opt -full", "setundef -undriven -expose; opt -full")]
        # A module with a register is proved by induction, as in proofs.sh.
        way = "-tempinduct " if "compare_cell" in module.name else ""
        for number in [0, *(m.number for m in mutants)]:
            script += [f"log mutant {number}:", f"sat {way}-prove-asserts -set dut.mutant_i {number} proof"]
        (pathlib.Path(folder) / "script.ys").write_text("\n".join(script) + "\n")
        said = _run(["yosys", "-s", pathlib.Path(folder) / "script.ys"], f"yosys: {module.name}", TOP)
    holds: dict[int, bool] = {}
    for part in said.split("\nmutant ")[1:]:
        number = int(part.split(":")[0])
        proved, refuted = "SUCCESS!" in part, "FAIL!" in part
        if proved == refuted:
            raise Trouble(f"{module.name}: yosys says neither yes nor no to mutant {number}")
        holds[number] = proved
    if not holds[0]:
        raise Trouble(f"{module.name}: the proof does not hold without a mutant")
    for m in mutants:
        (verdicts.equivalent if holds[m.number] else verdicts.found).append(m)
    return verdicts


def chosen(names: list[str]) -> list[Module]:
    """The modules of that name, or of kernels of that name; all, if none is named."""
    paths = (p for folder in GENERATED for p in folder.glob("hls_*.sv"))
    modules = [Module.read(p) for p in sorted(paths, key=lambda p: p.name)]
    if not names:
        return modules
    found = []
    for name in names:
        stem = name if name.startswith("hls_") else f"hls_{name}"
        some = [
            m for m in modules if m.name == stem or (stem.startswith("hls_pixel_") and m.name.startswith(f"{stem}_"))
        ]
        if not some:
            raise Trouble(f"{name}: neither a kernel nor a generated module")
        found += [m for m in some if m not in found]
    return found


def run(names: list[str], seed: int, count: int, vectors: int, shows: bool) -> int:
    if not shutil.which("yosys"):
        raise Trouble("yosys is missing (tools/deps test)")
    tried: list[Verdicts] = []
    harness = None
    for module in chosen(names):
        mutants = module.mutants()
        if 0 < count < len(mutants):
            mutants = sorted(random.Random(f"{seed} {module.name}").sample(mutants, count), key=lambda m: m.number)
        if module.name.startswith(BLEND) or any("always_ff" in line for line in module.lines):
            harness = harness or Vectors()
            tried.append(harness.try_all(module, mutants, vectors, seed))
        else:
            tried.append(try_by_proof(module, mutants))
        v = tried[-1]
        print(f"{module.name}: {len(v.found)} of {len(mutants)} mutants found", file=sys.stderr, flush=True)
    print("| module | tried by | mutants | found | equivalent | live |\n|---|---|---|---|---|---|")
    for v in tried:
        numbers = " | ".join(str(len(x)) for x in (v.tried, v.found, v.equivalent, v.lived))
        print(f"| `{v.module}` | {v.by} | {numbers} |")
    for v in tried:
        for m in v.equivalent if shows else ():
            print(f"equivalent: {m}")
        for m in v.lived:
            print(f"LIVES: {m}")
    return 1 if any(v.lived for v in tried) else 0
