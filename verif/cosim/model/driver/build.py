#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Build the RTL model of one configuration: a shared library with the C interface of rtl_model.h.

usage: build.py OUT.so [PARAM=VALUE...] [--fault NAME] [--define NAME[=VALUE]] [--monitors] [--waves] [--mutants] [--quick] [--jobs N] [--keep DIR]

  PARAM=VALUE    a parameter of rtl/defs/kage.yaml; those left out have their default there
  --fault NAME   apply verif/cosim/model/faults/NAME.patch to a copy of the RTL first; a patch that does not apply stops the build
  --define       a macro for Verilator
  --monitors     with the monitors of verif/cosim/diverge/monitors, which tell what passes between modules
  --waves        able to write waveforms
  --mutants      with every mutant of verif/mutants/mutants.yaml behind a select; one whose text the RTL has not exactly once stops the build
  --quick        for a model that runs little, as those of --monitors, --waves and --mutants do: loops over lanes and processors stay
                 loops, and the compiler takes less care. A systolic core of 64 processors takes 5 s to build in place of 36
  --jobs N       compilers at a time (default 2)
  --keep DIR     build in DIR and leave it there (default: a temporary directory, removed)

The RTL is that of this source tree or of $KAGE_RTL_DIR; $VERILATOR and $CXX name other tools. OUT.so appears only when it is whole.
On failure: a line on standard error that names the log, where there is one, then one that names the step and the cause; exit status 2.
SIGTERM ends the build with all its tools, where it is the leader of a process group, as kage makes it.
"""

import argparse
import contextlib
import errno
import hashlib
import os
import pathlib
import re
import shlex
import shutil
import signal
import stat
import struct
import subprocess
import sys
import tempfile
import zlib

import yaml

HERE = pathlib.Path(__file__).resolve().parent
RTL = pathlib.Path(os.environ.get("KAGE_RTL_DIR", HERE.parents[3] / "rtl")).resolve()
FROM_VERILATOR = HERE / "from_verilator.hpp"
FAULTS = HERE.parent / "faults"
MONITORS = HERE.parents[1] / "diverge/monitors"
MUTANTS = HERE.parents[2] / "mutants/mutants.yaml"


def fail(message):
    print(f"build.py: {message}", file=sys.stderr)
    sys.exit(2)


# What a tool says when it may write no more, in the system's words.
NO_ROOM = [os.strerror(e) for e in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS)]


class Log:
    """What the steps say. The disk of its file may be full: then the build goes on, or says its cause, without one."""

    def __init__(self, path):
        self.path = path
        self.whole = True
        self.write("", "w")

    def write(self, text, mode="a"):
        try:
            with open(self.path, mode) as out:
                out.write(text)
        except OSError:
            self.whole = False


def no_room(text, folder):
    """Why a step could not write, or None: as its tool said it, or, as not every tool says it, as a try in the folder says it."""
    said = next((words for words in NO_ROOM if words in text), None)
    if said:
        return said
    try:
        with tempfile.TemporaryFile(dir=folder) as probe:
            probe.write(bytes(1 << 18))
            probe.flush()
            os.fsync(probe.fileno())
    except OSError as e:
        return e.strerror
    return None


def run(step, command, log, otherwise=None):
    """A step of the build, which ends it if it fails; or, with `otherwise`, if that makes nothing of what the step said."""
    command = [str(c) for c in command]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, restore_signals=False)
    except OSError as e:
        fail(f"{step}: {command[0]}: {e.strerror}")
    text = done.stdout.decode(errors="replace")
    log.write("$ " + " ".join(command) + "\n" + text)
    if done.returncode == 0:
        return True
    if otherwise and otherwise(text):
        return False
    if log.whole:
        print(f"build.py: the log is {log.path}", file=sys.stderr)
    wanted = [
        line.strip() for line in text.splitlines() if "rror" in line or "FAILED" in line or line.startswith("%Warning")
    ]
    cause = no_room(text, log.path.parent) or (wanted[0] if wanted else f"exit status {done.returncode}")
    fail(f"{step} failed: {cause}")


def end_all(number, _):
    """The build is over, and so are the tools that it has started."""
    signal.signal(number, signal.SIG_IGN)
    if os.getpgrp() == os.getpid():
        os.killpg(0, number)
    sys.exit(128 + number)


def parameters(arguments):
    defs = yaml.safe_load((RTL / "defs/kage.yaml").read_text())
    values = {p["name"]: p["default"] for p in defs["pixel_params"] + defs["impl_params"]}
    for argument in arguments:
        name, equals, value = argument.partition("=")
        if not equals or name not in values:
            fail(f"{argument}: not PARAM=VALUE with a parameter of {RTL / 'defs/kage.yaml'}")
        try:
            values[name] = int(value, 0)
        except ValueError:
            fail(f"{argument}: {value} is not a whole number")
    return values


def leave_out(monitors, missing, text):
    """Take the monitors that do not fit the RTL from one list to the other; False if that is not all that is wrong. The RTL may have been
    given other names within: then its own stage goes unwatched, and the others do not."""
    wrong = [
        re.match(r"%(?:Error|Warning)(?:-\w+)?: ([^:\s]+\.svh?):\d+", line)
        for line in text.splitlines()
        if line.startswith(("%Error", "%Warning"))
    ]
    places = {pathlib.Path(w[1]).resolve() for w in wrong if w}
    unfit = [m for m in monitors if m.resolve() in places]
    if not unfit or any(p.parent != MONITORS for p in places):
        return False
    for monitor in unfit:
        monitors.remove(monitor)
        missing.append(monitor)
    return True


def unwatched(missing):
    """What the driver says of monitors that were left out: their names, and the stages that nothing gives events of."""
    numbers = (
        dict(re.findall(r"^#define KAGE_STAGE_(\w+) (\d+)$", (MONITORS / "stages.h").read_text(), re.M))
        if missing
        else {}
    )
    told = re.findall(r"\btrace_([a-z]+)|\bkage_trace\(Stage([A-Z][a-z]+)", "".join(m.read_text() for m in missing))
    stages = {(a or b).upper() for a, b in told} & set(numbers) - {"PART"}
    if stages & {"TOKEN", "ERROR"}:  # an error is looked for at the token that it came with
        stages |= {"TOKEN", "ERROR"}
    bits = " | ".join(f"1U << {numbers[s]}" for s in sorted(stages)) or "0"
    return f'const char* const kMissingMonitors = "{", ".join(m.stem for m in missing)}";\nconstexpr std::uint32_t kUnwatched = {bits};\n'


def put_in(rtl, package):
    """Put every mutant into the copy `rtl` behind a select, which `package` holds; return how many there are."""
    mutants = yaml.safe_load(MUTANTS.read_text())
    places = {}
    for number, m in enumerate(mutants, 1):
        text = (rtl / m["file"]).read_text()
        around = m.get("in", m["text"])
        if text.count(around) != 1 or around.count(m["text"]) != 1:
            fail(
                f"mutant {m['name']}: rtl/{m['file']} has not exactly once: {around if text.count(around) != 1 else m['text']}"
            )
        begin = text.index(around) + around.index(m["text"])
        # What is put in before an instance's `.*` leaves room for another there.
        places.setdefault(m["file"], []).append((begin, begin if "port" in m else begin + len(m["text"]), number, m))
    for name, of_file in places.items():
        text = (rtl / name).read_text()
        of_file.sort(key=lambda p: p[0])
        for before, after in zip(of_file, of_file[1:]):
            if before[1] > after[0] and before[:2] != after[:2]:
                fail(f"mutant {after[3]['name']}: overlaps {before[3]['name']}")
        # Those of one text stand in each other's place for "the sound RTL".
        together = {}
        for begin, end, number, m in of_file:
            together.setdefault((begin, end, m.get("port")), []).append((number, m["with"]))
        for (begin, end, port), choices in reversed(together.items()):
            choice = port or text[begin:end]
            for number, mutated in choices:
                choice = f"(kage_mutants::selected == {number} ? {mutated} : {choice})"
            text = f"{text[:begin]}.{port}{choice}, {text[end:]}" if port else text[:begin] + choice + text[end:]
        (rtl / name).write_text(text)
    # Sampled in reset: asked for at each place, it would cost more than the model.
    top = (rtl / "kage_top.sv").read_text()
    sample = '  import "DPI-C" function int kage_mutant();\n  always_ff @(posedge clk_i) if (!rst_ni) kage_mutants::selected <= kage_mutant();\n'
    head, end, tail = top.rpartition("endmodule")
    (rtl / "kage_top.sv").write_text(head + sample + end + tail)
    package.write_text("package kage_mutants;\n  int selected;\nendpackage\n")
    return len(mutants)


def name_initial_state(obj):
    """Let every register's and memory's first value follow from seed and name (kage_initial() of rtl_model.cpp), in place of the
    order in which Verilator draws them: so a model with monitors or waveforms starts as the plain one does."""
    name = r"(vlSelf->(\w+)((?:\[\w+\])*))"
    for path in sorted(obj.glob("*.cpp")):
        text = path.read_text()
        if "VL_RAND_RESET" not in text:
            continue

        def index(places):
            return (
                " + ".join(f"{1 << 20 * i}ULL * {at}" for i, at in enumerate(re.findall(r"\[(\w+)\]", places))) or "0"
            )

        text = re.sub(
            name + r"\s*= VL_RAND_RESET_[IQ]\((\d+)\);",
            lambda m: f'{m[1]} = kage_initial({m[4]}, "{m[2]}", {index(m[3])});',
            text,
        )
        text = re.sub(
            r"VL_RAND_RESET_W\((\d+), " + name + r"\);",
            lambda m: f'kage_initial_words({m[1]}, {m[2]}, "{m[3]}", {index(m[4])});',
            text,
        )
        if (
            "VL_RAND_RESET" in text or "___024root" not in path.name
        ):  # a name says where in the whole core, since --flatten leaves one module
            fail(f"this Verilator draws the initial state in a way that is not known: {path.name}")
        path.write_text(text)


def main():
    signal.signal(signal.SIGTERM, end_all)
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n")[0], add_help=True)
    parser.add_argument("out", nargs="?")
    parser.add_argument("params", nargs="*")
    parser.add_argument("--fault")
    parser.add_argument("--define", action="append", default=[])
    parser.add_argument("--monitors", action="store_true")
    parser.add_argument("--waves", action="store_true")
    parser.add_argument("--mutants", action="store_true")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep")
    args = parser.parse_intermixed_args()
    if args.fault and not (FAULTS / f"{args.fault}.patch").exists():
        fail(f"{args.fault}: no {FAULTS / (args.fault + '.patch')}")
    if not args.out:
        fail("no OUT.so given")
    out = pathlib.Path(args.out).resolve()
    values = parameters(args.params)
    work = pathlib.Path(args.keep).resolve() if args.keep else pathlib.Path(tempfile.mkdtemp(prefix="kage-model-"))
    try:
        work.mkdir(parents=True, exist_ok=True)
        build(out, values, args, work)
    finally:
        if not args.keep:
            shutil.rmtree(work, ignore_errors=True)


def build(out, values, args, work):
    log = Log(
        work / "build.log" if args.keep else pathlib.Path(tempfile.gettempdir()) / f"kage-model-{os.getpid()}.log"
    )  # outlives a failure
    rtl = RTL
    mutants = 0
    if args.fault or args.mutants:
        rtl = work / "rtl"
        shutil.rmtree(rtl, ignore_errors=True)
        shutil.copytree(RTL, rtl)
    if args.fault:
        run(
            f"fault {args.fault}",
            ["patch", "--fuzz=0", "--batch", "-p2", "-d", rtl, "-i", FAULTS / f"{args.fault}.patch"],
            log,
        )

    if args.mutants:
        mutants = put_in(rtl, work / "kage_mutants.sv")

    names = ", ".join(f'"{n}"' for n in values)
    numbers = ", ".join(str(v) for v in values.values())
    (work / "params.inc").write_text(
        f"constexpr std::uint32_t kParamCount = {len(values)};\n"
        f"const char* const kParamNames[] = {{{names}}};\n"
        f"const std::int32_t kParamValues[] = {{{numbers}}};\n"
        f'const char* const kFault = "{args.fault or ""}";\n'
        f"constexpr std::int32_t kMutants = {mutants};\n"
        f"constexpr unsigned kBeatWords = {values['BEAT_WORDS']};\n"
        f"constexpr int kChannels = {values['CHANNELS']};\n"
        f"constexpr unsigned kMaxWidth = {values['MAX_WIDTH']};\n"
    )

    # Loops over processors run 2-3 times as fast unrolled, but then 640 of them take over a minute to build.
    quick = args.quick or args.monitors or args.waves or args.mutants
    unroll = (
        8 if quick else values["MAX_WIDTH"] if values["ARRANGEMENT"] == 0 and 64 < values["MAX_WIDTH"] <= 128 else 64
    )
    verilator = os.environ.get("VERILATOR") or "verilator"
    obj = work / "obj"
    # What the RTL writes goes through the driver. The header is copied, so that these flags are the same in every source tree.
    cflags = f"-fPIC -fvisibility=hidden -fno-gnu-unique -DVL_USER_STOP -DVL_PRINTF=kage_printf -include {FROM_VERILATOR.name}"
    command = [
        verilator,
        "--cc",
        "--prefix",
        "Vkage",
        "--top-module",
        "kage_top",
        "--Mdir",
        obj,
        "-O3",
        "--x-initial",
        "unique",
        "--flatten",
        "--assert",
        "--unroll-count",
        str(unroll),
        "--unroll-stmts",
        "1000000",
        "-Wall",
        f"-I{rtl / 'include'}",
        "-CFLAGS",
        cflags,
    ]
    command += [f"-G{n}={v}" for n, v in values.items()] + [f"-D{d}" for d in args.define]
    if args.waves:
        command += ["--trace-fst", "--trace-structs"]  # a bus by its fields
    if args.monitors:
        command.append(f"-I{MONITORS}")
    if args.mutants:  # what is wrong on purpose may be bad style
        command += ["-Wno-fatal", work / "kage_mutants.sv"]
    command += sorted(rtl.glob("*.sv"))
    monitors = sorted(MONITORS.glob("*.sv")) if args.monitors else []
    missing = []
    while not run("verilator", command + monitors, log, lambda text: leave_out(monitors, missing, text)):
        pass
    with open(work / "params.inc", "a") as params:
        params.write(unwatched(missing))
    name_initial_state(obj)
    shutil.copy(FROM_VERILATOR, obj)
    for speed in ("fast", "slow"):  # what its make asks for is there, so it makes none
        (obj / f"none.{speed}.gch").touch()

    cxx = shlex.split(os.environ.get("CXX") or "c++")  # it may be "ccache g++"
    make = [
        "make",
        "-C",
        obj,
        "-f",
        "Vkage.mk",
        f"-j{args.jobs}",
        # Newer Verilators give large models a precompiled header. A compiler takes one as its first include only, and
        # from_verilator.hpp comes first: so there is none.
        "VK_PCH_H=none",
        "VK_PCH_I_FAST=",
        "VK_PCH_I_SLOW=",
        f"OPT_FAST={'-O1' if quick else '-O2'}",
        "OPT_SLOW=-O0",
        "OPT_GLOBAL=-O1",
        f"CXX={shlex.join(cxx)}",
    ]
    extra = ["verilated_threads.o"] if needs_threads(obj) else []
    if args.waves:
        extra.append("verilated_fst_c.o")
    if args.monitors or args.mutants:
        extra.append("verilated_dpi.o")
    runtime = Runtime(verilator, cxx, [*make[-4:], cflags], obj)
    runtime.take(["verilated.o", *extra])
    run("compiling the model", make + ["Vkage__ALL.a", "verilated.o", *extra], log)
    runtime.keep(["verilated.o", *extra])
    include = subprocess.run([verilator, "--getenv", "VERILATOR_ROOT"], capture_output=True, text=True).stdout.strip()
    partial = out.with_name(f".{out.name}.{os.getpid()}")
    out.parent.mkdir(parents=True, exist_ok=True)
    try:
        has = [f"-DKAGE_{part.upper()}" for part in ("monitors", "waves", "mutants") if getattr(args, part)]
        run(
            "linking the model",
            [
                *cxx,
                "-std=c++17",
                "-O2",
                "-fPIC",
                "-fvisibility=hidden",
                "-fno-gnu-unique",
                "-shared",
                *has,
                f"-I{obj}",
                f"-I{work}",
                f"-I{HERE}",
                *([f"-I{MONITORS}"] if args.monitors else []),
                "-isystem",
                f"{include}/include",
                "-isystem",
                f"{include}/include/vltstd",
                "-o",
                partial,
                HERE / "rtl_model.cpp",
                obj / "Vkage__ALL.a",
                obj / "verilated.o",
                *(obj / e for e in extra),
                *(["-lz", *(f"-Wl,--wrap={f}" for f in ("fwrite", "fflush", "fclose"))] if args.waves else []),
                "-Wl,-Bsymbolic",
                "-Wl,--exclude-libs,ALL",
                "-Wl,-z,defs",
                "-pthread",
            ],
            log,
        )
        os.replace(partial, out)
    finally:
        partial.unlink(missing_ok=True)
    if not args.keep:
        log.path.unlink(missing_ok=True)


class Runtime:
    """Verilator's own objects, the same in every model of a tool and its flags: kept beside the models."""

    def __init__(self, verilator, cxx, flags, obj):
        self.obj = obj
        versions = [
            subprocess.run([*tool, "--version"], capture_output=True, text=True).stdout for tool in ([verilator], cxx)
        ]
        own = (obj / "Vkage_classes.mk").read_text().split("### Object file lists")[0]  # threads, tracing and the like
        key = hashlib.sha256("\0".join([*versions, *flags, own, FROM_VERILATOR.read_text()]).encode()).hexdigest()[:24]
        cache = os.environ.get("XDG_CACHE_HOME") or (
            os.path.join(os.environ["HOME"], ".cache") if os.environ.get("HOME") else None
        )
        self.folder = pathlib.Path(cache) / "kage" / "verilator" / key if cache else None
        if self.folder:
            for folder in (self.folder.parent.parent, self.folder.parent, self.folder):
                trust(folder, link=True)

    def take(self, names):
        for name in names if self.folder else ():
            try:
                trust(self.folder / name)
                whole = (self.folder / name).read_bytes()
                if whole[-SUM_BYTES:] == check_sum(whole[:-SUM_BYTES]):  # a damaged one is compiled
                    (self.obj / name).write_bytes(whole[:-SUM_BYTES])
            except OSError:
                (self.obj / name).unlink(missing_ok=True)  # it is compiled: make would take half of one for the whole

    def keep(self, names):
        for name in names if self.folder else ():
            try:
                self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
                data = (self.obj / name).read_bytes()
                # Among the build's own files, which go if it is killed; beside its place where that is another disk.
                if not any(self.put(data + check_sum(data), place, name) for place in (self.obj, self.folder)):
                    return
            except OSError:
                return  # the next one compiles them too

    def put(self, data, place, name):
        """Keep `data` as `name`, by way of a file in the folder `place`; False if that is on another disk."""
        partial = place / f".{name}.{os.getpid()}"
        try:
            with open(os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o600), "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.replace(partial, self.folder / name)
            return True
        except OSError as e:
            if e.errno == errno.EXDEV:
                return False
            raise
        finally:
            with contextlib.suppress(OSError):
                partial.unlink()


SUM_BYTES = 12


def check_sum(data):
    """What stands behind a kept object: its length and CRC-32."""
    return struct.pack("<QI", len(data), zlib.crc32(data))


def trust(path, link=False):
    """Stop if somebody else could have put `path` there: what is kept becomes part of a program. With `link` it may be a link,
    which then must be this user's too, as what it leads to."""
    try:
        states = [path.lstat(), path.stat()]
    except FileNotFoundError:
        return
    linked = stat.S_ISLNK(states[0].st_mode)
    others = any(s.st_uid not in (0, os.geteuid()) for s in states) or states[1].st_mode & 0o022
    if others or (linked and not link):
        what = "somebody else's, or others may write to it" if others else "a link"
        fail(
            f"{path}: it is {what}, and what is kept there becomes part of RTL models: remove it, or set XDG_CACHE_HOME to a folder of your own"
        )


def needs_threads(obj):
    return "verilated_threads" in (obj / "Vkage_classes.mk").read_text()


if __name__ == "__main__":
    try:
        main()
    except OSError as e:
        fail(f"{e.filename}: {e.strerror}" if e.filename else e.strerror)
