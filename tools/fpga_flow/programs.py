# SPDX-License-Identifier: Apache-2.0
"""yosys, nextpnr and the packers: where they are, which version, and running one with its output in a log."""

import contextlib
import dataclasses
import fcntl
import os
import pathlib
import re
import shutil
import subprocess
import sys

from trouble import Trouble

# Debian packages, and the oldest version that the flow was tried with.
PROGRAMS = {
    "yosys": ("yosys", (0, 23)),
    "nextpnr-ecp5": ("nextpnr-ecp5", (0, 7)),
    "nextpnr-ice40": ("nextpnr-ice40", (0, 7)),
    "ecppack": ("prjtrellis", None),
    "icepack": ("fpga-icestorm", None),
}


@dataclasses.dataclass
class Program:
    name: str
    command: tuple
    version: str
    said: str = ""  # the line that has the version


class Failed(Trouble):
    """A program ended with an exit code that is not 0; `error` is its own line."""

    def __init__(self, message, code, error):
        super().__init__(message)
        self.code, self.error = code, error


class Programs:
    """`which`: wheels, system, or any: the wheels where tools/deps has put them, else those of PATH."""

    def __init__(self, which, wheels, top):
        self.asked = which
        if which == "any":
            which = "wheels" if wheels.is_dir() else "system"
        self.which, self.wheels, self.top = which, wheels, top
        self.environment = dict(os.environ)
        if which == "wheels":
            # The wheels hold WebAssembly, which is compiled once for this machine and kept.
            self.compiled = wheels / "compiled"
            self.compiled.mkdir(exist_ok=True)
            self.environment["YOWASP_CACHE_DIR"] = str(self.compiled)
            self.environment["PYTHONPATH"] = str(wheels)

    def find(self, name):
        if self.which == "wheels":
            path = self.wheels / "bin" / f"yowasp-{name}"
            if not path.is_file():
                raise Trouble(f"{path}: missing; tools/deps fpga installs it")
            command = (sys.executable, str(path))
        else:
            path = shutil.which(name)
            if not path:
                way = "tools/deps fpga installs it" if self.asked == "any" else "or leave --tools system out"
                raise Trouble(f"{name}: not found; Debian's package is {PROGRAMS[name][0]}, {way}")
            command = (path,)
        program = Program(name, command, "")
        oldest = PROGRAMS[name][1]
        text = self.first_output([*command, "-V" if name == "yosys" else "--version" if oldest else "--help"])
        if oldest:
            m = re.search(r"(\d+)\.(\d+)(?:\.(\d+))?", text)
            if not m:
                raise Trouble(f"{name}: says no version: {text.strip()[:80]}")
            program.version = m.group(0)
            program.said = next(line.strip() for line in text.splitlines() if m.group(0) in line)
            if (int(m.group(1)), int(m.group(2))) < oldest:
                print(
                    f"tools/fpga: note: {name} {m.group(0)} is older than {oldest[0]}.{oldest[1]}, the oldest one tried",
                    file=sys.stderr,
                )
        return program

    def first_output(self, command):
        """The first run of a program here. If several run at once, one compiles the WebAssembly, which takes a minute, and
        the others wait. One that wrote it anew would cut it off under another that has it in memory, which ends by SIGBUS."""
        with contextlib.ExitStack() as stack:
            if self.which == "wheels":
                folder = os.open(self.compiled, os.O_RDONLY)
                stack.callback(os.close, folder)
                fcntl.flock(folder, fcntl.LOCK_EX)
            done = subprocess.run(
                command, capture_output=True, text=True, env=self.environment, stdin=subprocess.DEVNULL
            )
        return done.stdout + done.stderr

    def run(self, program, arguments, folder, log):
        """Runs in `folder` (relative paths: the wheels see no absolute ones in /tmp); a failure tells the log's first error."""
        command = [*program.command, *map(str, arguments)]
        path = pathlib.Path(folder) / log
        with open(path, "w") as out:
            done = subprocess.run(
                command,
                cwd=folder,
                stdout=out,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                env=self.environment,
            )
        if done.returncode != 0:
            text = path.read_text(errors="replace")
            error = next(
                (line for line in text.splitlines() if re.search(r"\bERROR\b|\bFatal\b", line)),
                (text.strip().splitlines() or ["no output"])[-1],
            )
            kept = self.top / "build/log" / f"fpga-{log}"
            kept.parent.mkdir(parents=True, exist_ok=True)
            kept.write_text(text)
            message = f"{program.name}: exit code {done.returncode}: {error.strip()} (log: {kept})"
            raise Failed(message, done.returncode, error.strip())
        return path.read_text(errors="replace")
