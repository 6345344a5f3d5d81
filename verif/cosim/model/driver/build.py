#!/usr/bin/env -S python3 -B
# -B: the folder may be nobody's to write to, and all that lies in it is hashed.
# SPDX-License-Identifier: Apache-2.0
"""Build the RTL model of one configuration: a shared library with the C interface of rtl_model.h.

usage: build.py OUT.so [PARAM=VALUE...] [--fault NAME] [--define NAME[=VALUE]] [--monitors] [--waves] [--mutants] [--lines] [--ports MODULE] [--netlist FAMILY] [--quick] [--jobs N] [--keep DIR]

  PARAM=VALUE    a parameter of rtl/defs/kage.yaml; those left out have their default there
  --fault NAME   put a fault of verif/cosim/model/faults.yaml into a copy of the RTL; one whose text the RTL has not exactly once stops the build
  --define       a macro for Verilator
  --monitors     with the monitors of verif/cosim/diverge/monitors, which tell what passes between modules
  --waves        able to write waveforms
  --mutants      with every mutant of verif/mutants/mutants.yaml behind a select; one whose text the RTL has not exactly once stops the build
  --lines        counts how often each line and branch of the RTL runs
  --ports        writes the ports of each instance of rtl/MODULE.sv as text at every clock (ports.py)
  --netlist      of the cells that yosys makes of the RTL for ice40 or ecp5, in place of the RTL (netlist.py); of the monitors it has those that
                 need the core's ports alone
  --quick        for a model that runs little, as those of --fault, --monitors, --waves and --mutants do: loops over lanes and processors stay
                 loops, and the compiler takes less care. A systolic core of 64 processors takes 4 s to build in place of 10
  --jobs N       compilers at a time (default 2)
  --keep DIR     build in DIR and leave it there (default: a temporary directory, removed)

The RTL is that of this source tree or of $KAGE_RTL_DIR; $VERILATOR and $CXX name other tools. OUT.so appears only when it is whole.
On failure: a line on standard error that names the log, where there is one, then one that names the step and the cause; exit status 2.
SIGTERM ends the build with all its tools, where it is the leader of a process group, as kage makes it.
"""

import argparse
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import tempfile

import defects
import netlist
import ports
from initial_state import name_initial_state
from monitors import MONITORS, leave_out, unwatched
from mutants import put_in
from parameters import parameters, pixel_parameters
from ports import write_monitor
from runtime import Runtime
from sources import HERE, PATTERNS, RTL, TOP, files, only, places
from steps import Log, end_all, fail, run, without_blanks

FROM_VERILATOR = HERE / "from_verilator.hpp"
# Flags with which every part is compiled. Text that the RTL writes goes through the driver. The header is copied, so
# that these flags are the same in every source tree.
CFLAGS = f"-fPIC -fvisibility=hidden -DVL_USER_STOP -DVL_PRINTF=kage_printf -include {FROM_VERILATOR.name}"
# A library with unique symbols, which g++ makes and clang does not, would stay in memory for ever.
OF_GNU = " -fno-gnu-unique"
# Variables that make and compilers would take from the environment beside $CXX. They are no part of a model's key, so
# no model is built with them.
UNASKED = "CXXFLAGS CPPFLAGS CFLAGS LDFLAGS LDLIBS OPT OPT_FAST OPT_SLOW OPT_GLOBAL USER_CPPFLAGS USER_LDFLAGS USER_LDLIBS MAKEFLAGS MFLAGS"
PARTS = ("monitors", "waves", "mutants", "lines")  # options that a model is built with


def main():
    signal.signal(signal.SIGTERM, end_all)
    for name in UNASKED.split():
        os.environ.pop(name, None)
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n")[0], add_help=True)
    parser.add_argument("out", nargs="?")
    parser.add_argument("params", nargs="*")
    parser.add_argument("--fault")
    parser.add_argument("--define", action="append", default=[])
    parser.add_argument("--monitors", action="store_true")
    parser.add_argument("--waves", action="store_true")
    parser.add_argument("--mutants", action="store_true")
    parser.add_argument("--lines", action="store_true")
    parser.add_argument("--ports")
    parser.add_argument("--netlist", choices=netlist.FAMILIES)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep")
    args = parser.parse_intermixed_args()
    if not args.out:
        fail("no OUT.so given")
    if args.netlist and (args.mutants or args.ports):
        fail("--netlist: it has no modules within, so no --mutants and no --ports")
    out = pathlib.Path(args.out).resolve()
    values = parameters(args.params)
    work = pathlib.Path(args.keep).resolve() if args.keep else pathlib.Path(tempfile.mkdtemp(prefix="kage-model-"))
    try:
        work.mkdir(parents=True, exist_ok=True)
        for folder in (TOP, RTL, work):
            without_blanks(folder)
        build(out, values, args, work)
    finally:
        if not args.keep:
            shutil.rmtree(work, ignore_errors=True)


def is_clang(compiler):
    """Whether a compiler is clang, whose options are not all g++'s. One that cannot be run is told of where it compiles."""
    try:
        return "clang" in subprocess.run([*compiler, "--version"], capture_output=True, text=True, check=False).stdout
    except OSError:
        return False


class Build:
    """A model in the making, in the folder `work`."""

    def __init__(self, values, args, work):
        self.values = values
        self.args = args
        self.work = work
        self.obj = work / "obj"
        self.verilator = os.environ.get("VERILATOR") or "verilator"
        self.cxx = shlex.split(os.environ.get("CXX") or "c++")  # it may be "ccache g++"
        self.clang = is_clang(self.cxx)
        self.cflags = CFLAGS if self.clang else CFLAGS + OF_GNU
        self.quick = args.quick or bool(args.fault) or args.monitors or args.waves or args.mutants or args.lines
        # The log outlives a failure.
        beside = pathlib.Path(tempfile.gettempdir()) / f"kage-model-{os.getpid()}.log"
        self.log = Log(work / "build.log" if args.keep else beside)
        self.rtl = RTL
        self.mutants = 0

    def change_rtl(self):
        """A copy of the RTL with the fault or the mutants, if there are any."""
        if not (self.args.fault or self.args.mutants):
            return
        self.rtl = self.work / "rtl"
        shutil.rmtree(self.rtl, ignore_errors=True)
        shutil.copytree(RTL, self.rtl)
        if self.args.fault:
            try:
                faults = defects.load(only("faults"))
                if self.args.fault not in faults:
                    fail(f"{self.args.fault}: not in {only('faults')}")
                defects.put_in(faults[self.args.fault], self.work)
            except defects.DefectError as e:
                fail(f"fault {self.args.fault}: {e}")
        if self.args.mutants:
            self.mutants = put_in(self.rtl, self.work / "kage_mutants.sv")

    def verilate(self):
        """Returns the monitors that do not fit the RTL."""
        # Loops over processors run 2-3 times as fast unrolled, but then 640 of them take over a minute to build.
        width = self.values["MAX_WIDTH"]
        unroll = 8 if self.quick else width if self.values["ARRANGEMENT"] == 0 and 64 < width <= 128 else 64
        command = [self.verilator, "--cc", "--prefix", "Vkage", "--top-module", "kage_top", "--Mdir", self.obj, "-O3"]
        command += ["--x-initial", "unique", "--flatten", *PATTERNS["flags"]]
        # A netlist is nobody's style.
        command += ["-Wno-fatal", "-Wno-lint", "-Wno-style"] if self.args.netlist else ["-Wall"]
        command += ["--unroll-count", str(unroll), "--unroll-stmts", "1000000"]
        command += [*(f"-I{folder}" for folder in places("includes", self.rtl)), "-CFLAGS", self.cflags]
        command += [f"-G{n}={v}" for n, v in self.values.items()] + [f"-D{d}" for d in self.args.define]
        if self.args.waves:
            command += ["--trace-fst", "--trace-structs"]  # a bus by its fields
        if self.args.lines:
            command.append("--coverage-line")
        if self.args.monitors:
            command.append(f"-I{MONITORS}")
        if self.args.monitors and self.args.waves:  # a waveform is of the RTL
            untraced = self.work / "untraced.vlt"
            untraced.write_text('`verilator_config\ntracing_off -file "*_monitor.sv"\n')
            command.append(untraced)
        if self.args.mutants:  # what is wrong on purpose may be bad style
            command += ["-Wno-fatal", self.work / "kage_mutants.sv"]
        command += self.netlist() if self.args.netlist else files("modules", self.rtl)
        if self.args.ports:
            write_monitor(self.work / ports.NAME, self.rtl, self.args.ports, pixel_parameters())
            command += ["-Wno-fatal", self.work / ports.NAME]
        monitors = [m for m in files("monitors") if m.suffix == ".sv"] if self.args.monitors else []
        missing = []
        if self.args.netlist:
            missing = [m for m in monitors if m not in files("port_monitors")]
            monitors = [m for m in monitors if m not in missing]
        while not run("verilator", command + monitors, self.log, lambda text: leave_out(monitors, missing, text)):
            # Files left by a Verilator that failed would be compiled, too.
            shutil.rmtree(self.obj, ignore_errors=True)
        name_initial_state(self.obj)
        return missing

    def netlist(self):
        """The sources in place of the RTL: its netlist, its cells' models, and a kage_top with parameters around it."""
        synthesized, top = self.work / "netlist.v", self.work / "kage_top.sv"
        netlist.synthesize(self.args.netlist, synthesized, self.values, self.rtl, self.log, "kage_netlist")
        netlist.wrapper(top, self.rtl, "kage_netlist")
        return [top, synthesized, *(f for f in files("cells") if f.stem == self.args.netlist)]

    def write_params(self, missing):
        """Write the model's constants for the driver."""
        values = self.values
        names = ", ".join(f'"{n}"' for n in values)
        numbers = ", ".join(str(v) for v in values.values())
        (self.obj / "params.inc").write_text(
            f"constexpr std::uint32_t kParamCount = {len(values)};\n"
            f"const char* const kParamNames[] = {{{names}}};\n"
            f"const std::int32_t kParamValues[] = {{{numbers}}};\n"
            f'const char* const kFault = "{self.args.fault or ""}";\n'
            f"constexpr std::int32_t kMutants = {self.mutants};\n"
            f"constexpr unsigned kBeatWords = {values['BEAT_WORDS']};\n"
            f"constexpr int kChannels = {values['CHANNELS']};\n"
            f"constexpr unsigned kMaxWidth = {values['MAX_WIDTH']};\n"
            f"constexpr unsigned kLanes = {values['LANES']};\n"
            f"constexpr unsigned kActive = {values['ACTIVE']};\n" + unwatched(missing)
        )

    def make_one_unit(self):
        """Write the model and its driver as one unit of the compiler, which so reads the headers once: half of the time
        of a small model. Code that Verilator calls slow runs once, when a model begins, so the compiler takes no care
        over it. That saves a third of the time of a model with waveforms, whose list of nets is such code."""
        sources = files("driver") + (files("monitors") if self.args.monitors else [])
        for source in sources:
            if source.suffix in (".cpp", ".hpp", ".h"):
                shutil.copy(source, self.obj)
        made = sorted(f.name for f in self.obj.glob("Vkage*.cpp"))
        slow = [name for name in made if name.endswith(("__Slow.cpp", "__Syms.cpp"))]
        fast = [name for name in made if name not in slow]
        driver = [f.name for f in sources if f.suffix == ".cpp"]
        lines = [f"#define KAGE_{part.upper()}" for part in PARTS if getattr(self.args, part)]
        lines += ["#define VL_INCLUDE_OPT include", *(f'#include "{name}"' for name in fast + driver)]
        lines += ["#ifdef __clang__", "#pragma clang optimize off", "#else", '#pragma GCC optimize("O0")', "#endif"]
        lines += [f'#include "{name}"' for name in slow]
        (self.obj / "Vkage__ALL.cpp").write_text("\n".join(lines) + "\n")

    def compile(self):
        """The model's objects: what its library is linked of."""
        self.make_one_unit()
        for speed in ("fast", "slow"):  # what its make asks for is there, so it makes none
            (self.obj / f"none.{speed}.gch").touch()
        flags = [f"OPT_FAST={'-O1' if self.quick else '-O2'} -std=gnu++17", "OPT_SLOW=-O0", "OPT_GLOBAL=-O1"]
        flags.append(f"CXX={shlex.join(self.cxx)}")
        # Verilator's makefile refuses a folder with a blank in its name, by this variable. All that is made there has names
        # without a folder, which make takes wherever it is.
        make = ["make", "-C", self.obj, "-f", "Vkage.mk", f"-j{self.args.jobs}", "VM_PARALLEL_BUILDS=0", "CURDIR=."]
        # Newer Verilators give large models a precompiled header. A compiler takes one as its first include only, and
        # from_verilator.hpp comes first: so there is none.
        make += ["VK_PCH_H=none", "VK_PCH_I_FAST=", "VK_PCH_I_SLOW=", *flags]
        objects = ["verilated.o"]
        if "verilated_threads" in (self.obj / "Vkage_classes.mk").read_text():
            objects.append("verilated_threads.o")
        if self.args.waves:
            objects.append("verilated_fst_c.o")
        if self.args.monitors or self.args.mutants:
            objects.append("verilated_dpi.o")
        if self.args.lines:
            objects.append("verilated_cov.o")
        runtime = Runtime(self.verilator, self.cxx, [*flags, self.cflags], self.obj)
        runtime.take(objects)
        run("compiling the model", [*make, "Vkage__ALL.o", *objects], self.log)
        runtime.keep(objects)
        return [self.obj / o for o in ("Vkage__ALL.o", *objects)]

    def link(self, objects, library):
        command = [*self.cxx, "-shared", "-o", library, *objects]
        if self.args.waves:
            command += ["-lz", *(f"-Wl,--wrap={f}" for f in ("fwrite", "fputc", "fseeko", "fflush", "fclose"))]
        if self.clang:  # it calls a function for what g++ knows of atomic numbers
            command.append("-latomic")
        command += ["-Wl,-Bsymbolic", "-Wl,--exclude-libs,ALL", "-Wl,-z,defs", "-pthread"]
        run("linking the model", command, self.log)


def build(out, values, args, work):
    model = Build(values, args, work)
    model.change_rtl()
    model.write_params(model.verilate())
    objects = model.compile()
    partial = out.with_name(f".{out.name}.{os.getpid()}")
    out.parent.mkdir(parents=True, exist_ok=True)
    try:
        model.link(objects, partial)
        os.replace(partial, out)
    finally:
        partial.unlink(missing_ok=True)
    if not args.keep:
        model.log.path.unlink(missing_ok=True)


if __name__ == "__main__":
    try:
        main()
    except OSError as e:
        fail(f"{e.filename}: {e.strerror}" if e.filename else e.strerror)
