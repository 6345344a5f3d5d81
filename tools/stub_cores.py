# SPDX-License-Identifier: Apache-2.0
"""See tools/stub-cores."""

import argparse
import collections
import concurrent.futures
import ctypes
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

import kept_rows

SCHEMA = "kage.stub-cores/1"  # of a row: docs/schema
MAY_USE_A_CORE = r"^(cli|rtl|examples|mutants)/|^unit/cosim/|^package/consumer$"
# Their program has the core in it: it is built of the copied tree.
CORE_IN_THE_PROGRAM = {"rtl/kage_top", "rtl/kage_top_units"}
LONGEST = 1800  # seconds a test may take
LINES = 20  # of what a test said that fails with the sound core

# Tests that a core which is wrong in every way leaves as they are, and why.
EXEMPT = {
    r"rtl/fault_.*": "looks for a fault: any will do",
    r"cli/usage": "looks at what command lines are refused with",
    r"rtl/failed_assertion": "looks for a failed assertion, behind which no pixel counts",
}

# Goes into the driver of the copied tree: a core that was made leaves a mark. The name does not begin with KAGE_, because
# cli/help looks for such names in the sources.
MARK = """
  if (const char* mark = std::getenv("STUB_CORES_MARK")) {
    if (FILE* file = std::fopen(mark, "a")) std::fclose(file);
  }
"""


class Trouble(Exception):
    pass


class Table(ctypes.Structure):
    """The beginning of kage_rtl_table (verif/cosim/model/driver/rtl_model.h)."""

    _fields_ = [
        ("abi", ctypes.c_uint32),
        ("param_count", ctypes.c_uint32),
        ("param_names", ctypes.POINTER(ctypes.c_char_p)),
        ("param_values", ctypes.POINTER(ctypes.c_int32)),
    ]


def defects(top):
    """The command that knows the faults of the core."""
    return [sys.executable, "-B", top / "verif/cosim/model/driver/defects.py", top / "verif/cosim/model/faults.yaml"]


def sources_of(top):
    """The tree's files that git knows; in an unpacked archive, which git does not know, all but those of builds."""
    if (top / ".git").exists():
        command = ["git", "-C", top, "ls-files", "-z"]
        names = subprocess.run(command, check=True, capture_output=True).stdout.split(b"\0")
        names = [pathlib.Path(os.fsdecode(name)) for name in names if name]
    else:
        made = {"build", "out"}  # as .gitignore has it
        names = [
            f.relative_to(top) for entry in top.iterdir() if entry.name not in made for f in [entry, *entry.rglob("*")]
        ]
    return sorted(name for name in names if (top / name).is_file())


def parameters(library):
    """PARAM=VALUE of a model; read by a process of its own, which keeps no library open."""
    text = (
        "import ctypes, sys; sys.path.insert(0, sys.argv[1]); from stub_cores import Table\n"
        "api = ctypes.CDLL(sys.argv[2]).kage_rtl_api; api.restype = ctypes.POINTER(Table); t = api()[0]\n"
        "print(*(f'{t.param_names[i].decode()}={t.param_values[i]}' for i in range(t.param_count)))"
    )
    command = [sys.executable, "-c", text, str(pathlib.Path(__file__).parent), str(library)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()


def tests(build, wanted):
    command = ["ctest", "--test-dir", build, "--show-only=json-v1"]
    listed = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    chosen = [t for t in listed["tests"] if re.search(wanted, t["name"]) and "command" in t]
    chosen = [t for t in chosen if not any(re.fullmatch(pattern, t["name"]) for pattern in EXEMPT)]
    if not chosen:
        raise Trouble(f"--tests {wanted}: no such test")
    return chosen


class Tree:
    """A copy of the tree whose cores leave a mark, with a fault or without, and the models of tests that are given one."""

    def __init__(self, top, work, fault):
        self.top = top
        self.copy = work / "tree"
        self.cache = work / "cache"
        self.models = work / "models"
        self.scratch = work / "scratch"
        self.build = work / "build"
        self.sound = not fault
        self.building = threading.Lock()
        for name in sources_of(top):
            (self.copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(top / name, self.copy / name)
        if fault:
            subprocess.run([*defects(top), "put", fault, self.copy], check=True)
        driver = self.copy / "verif/cosim/model/driver/model.hpp"
        text = driver.read_text()
        constructor = re.search(r"explicit kage_rtl\(std::uint64_t seed\)[^{;]*\{\n", text)
        if not constructor:
            raise Trouble(f"{driver}: no constructor to put the mark in")
        begin = constructor.end()
        driver.write_text("#include <cstdlib>\n" + text[:begin] + MARK + text[begin:])
        for folder in (self.models, self.cache, self.scratch):
            folder.mkdir()

    def model(self, library):
        """The same model, of this tree's core."""
        out = self.models / pathlib.Path(library).name
        with self.building:
            if not out.exists():
                command = [self.copy / "verif/cosim/model/driver/build.py", out, *parameters(library), "--quick"]
                subprocess.run(command, check=True, env={**os.environ, "XDG_CACHE_HOME": str(self.cache)})
        return str(out)

    def program(self, name):
        """The program of that name, of this tree's RTL."""
        options = {"CMAKE_BUILD_TYPE": "Release", "KAGE_TESTS": "ON", "KAGE_UNITY": "ON"}
        if not self.build.exists():
            command = [
                "cmake",
                "-S",
                self.copy,
                "-B",
                self.build,
                "-G",
                "Ninja",
                *(f"-D{k}={v}" for k, v in options.items()),
            ]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        subprocess.run(["cmake", "--build", self.build, "--target", name], check=True, stdout=subprocess.DEVNULL)
        return str(next(path for path in self.build.rglob(name) if path.is_file() and os.access(path, os.X_OK)))

    def run(self, test):
        """("passes" | "fails" | "left out" | "takes too long", whether it made a core, seconds)."""
        command = []
        for word in test["command"]:
            if word.endswith(".so"):
                word = self.model(word)
            elif word == str(self.top) or word.startswith(str(self.top) + "/verif/"):
                word = str(self.copy) + word[len(str(self.top)) :]
            command.append(word)
        if test["name"] in CORE_IN_THE_PROGRAM:
            with self.building:
                command[0] = self.program(pathlib.Path(command[0]).name)
        scratch = pathlib.Path(tempfile.mkdtemp(dir=self.scratch))
        mark = scratch / "mark"
        (scratch / "tmp").mkdir()
        environment = {**os.environ, "KAGE_DATA_DIR": str(self.copy), "XDG_CACHE_HOME": str(self.cache)}
        environment |= {"STUB_CORES_MARK": str(mark), "TMPDIR": str(scratch / "tmp")}
        properties = {p["name"]: p["value"] for p in test.get("properties", [])}
        environment.update(e.split("=", 1) for e in properties.get("ENVIRONMENT", []))
        verdict = ""
        start = time.monotonic()
        said = (scratch / "said").open("w+", errors="replace")
        process = subprocess.Popen(
            command,
            cwd=properties.get("WORKING_DIRECTORY"),
            env=environment,
            start_new_session=True,
            stdout=said,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
        )
        try:
            code = process.wait(timeout=LONGEST)
            verdict = "passes" if (code == 0) != bool(properties.get("WILL_FAIL")) else "fails"
            if code == properties.get("SKIP_RETURN_CODE"):
                verdict = "left out"
        except subprocess.TimeoutExpired:
            verdict = "takes too long"
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()
            marked = mark.exists()
            with said:
                if self.sound and verdict in ("fails", "takes too long"):
                    said.seek(0)
                    print("".join(collections.deque(said, LINES)), end="", flush=True)
            shutil.rmtree(scratch, ignore_errors=True)
        return verdict, marked or test["name"] in CORE_IN_THE_PROGRAM, time.monotonic() - start


def all_tests(tree, core, chosen, jobs, record):
    """A row for each of the chosen tests, so many at a time; each is printed and recorded when it has ended."""

    def one(test):
        if row := record.row(core, test["name"]):
            return row
        verdict, uses_core, seconds = tree.run(test)
        print(
            f"{core:<14} {verdict:<14} {'core' if uses_core else '-':<5} {seconds:6.1f} s  {test['name']}", flush=True
        )
        row = {"core": core, "test": test["name"], "verdict": verdict, "uses_core": uses_core, "seconds": seconds}
        return record.add(row)

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        return list(pool.map(one, chosen))


class Record:
    """The rows so far: of an earlier run that ended too soon, and of this one. --json has them after each test."""

    def __init__(self, options):
        self.path = options.json
        self.lock = threading.Lock()
        self.of = kept_rows.hash_of(options.top / name for name in sources_of(options.top) if "docs" not in name.parts)
        self.rows = []
        if options.resume:
            if self.path is None:
                raise Trouble("--resume needs --json FILE")
            self.rows = kept_rows.load(self.path, SCHEMA, {"of": self.of})

    def row(self, core, test):
        return next((row for row in self.rows if (row["core"], row["test"]) == (core, test)), None)

    def add(self, row):
        row = {"schema": SCHEMA, "of": self.of} | row
        with self.lock:
            self.rows.append(row)
            if self.path:
                kept_rows.write(self.path, self.rows)
        return row


def run(options):
    record = Record(options)
    listed = subprocess.run([*defects(options.top), "list"], check=True, capture_output=True, text=True).stdout
    listed = [line.split("\t")[0] for line in listed.splitlines()]
    faults = options.fault or [name for name in listed if name.startswith("stub_")]
    if not faults or not set(faults) <= set(listed):
        raise Trouble(f"--fault {' '.join(faults)}: not all of them are in verif/cosim/model/faults.yaml")
    chosen = tests(options.build, options.tests)
    rows = []
    for fault in ["", *faults]:
        with tempfile.TemporaryDirectory(prefix="kage-dead-") as work:
            tree = Tree(options.top, pathlib.Path(work), fault)
            rows += all_tests(tree, fault or "sound", chosen, options.jobs, record)
        if not fault:  # the others have nothing to say
            uses = {row["test"] for row in rows if row["verdict"] == "passes" and row["uses_core"]}
            chosen = [t for t in chosen if t["name"] in uses]
    return rows


def tell(rows):
    """Prints what came of it; returns the exit code."""
    sound = [row for row in rows if row["core"] == "sound"]
    dead = [row for row in rows if row["core"] != "sound"]

    def named(these):
        return ", ".join(sorted({row["test"] for row in these}))

    without = [row for row in sound if row["verdict"] == "passes" and not row["uses_core"]]
    left_out = [row for row in sound if row["verdict"] == "left out"]
    broken = [row for row in sound if row["verdict"] not in ("passes", "left out")]
    print(
        f"{len(sound)} tests with the sound core: {sum(row['verdict'] == 'passes' for row in sound)} pass, {len(without)} of these make no core"
    )
    for core in dict.fromkeys(row["core"] for row in dead):
        verdicts = collections.Counter(row["verdict"] for row in dead if row["core"] == core)
        print(f"{core}: {', '.join(f'{count} {verdict}' for verdict, count in sorted(verdicts.items()))}")
    if without:
        print(f"make no core: {named(without)}")
    if left_out:
        print(f"left out here: {named(left_out)}")
    late = [row for row in dead if row["verdict"] == "takes too long"]
    if late:
        print(f"do not end with a stub core: {named(late)}")
    # A test that fails before it makes a core says nothing of the core.
    early = [
        row for row in dead if row["verdict"] == "left out" or (row["verdict"] == "fails" and not row["uses_core"])
    ]
    if early:
        print(f"fail or leave out before they make a stub core: {named(early)}")
    passed = [row for row in dead if row["verdict"] == "passes"]
    if passed:
        print("PASS with a stub core: " + ", ".join(f"{row['test']} ({row['core']})" for row in passed))
    if broken:
        raise Trouble(f"these do not pass with the sound core: {named(broken)}")
    if not dead:
        raise Trouble("none of these tests makes a core")
    return 1 if passed or late or early else 0


def main():
    parser = argparse.ArgumentParser(prog="tools/stub-cores")
    parser.add_argument("top", type=pathlib.Path)
    parser.add_argument("build")
    parser.add_argument("--fault", action="append", default=[])
    parser.add_argument("--tests", default=MAY_USE_A_CORE)
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    return tell(run(options))


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Trouble, kept_rows.NotThese) as e:
        print(f"tools/stub-cores: {e}", file=sys.stderr)
    except subprocess.CalledProcessError as e:
        print(f"tools/stub-cores: {' '.join(map(str, e.cmd))}: exit code {e.returncode}", file=sys.stderr)
    except OSError as e:
        print(f"tools/stub-cores: {e}", file=sys.stderr)
    sys.exit(2)
