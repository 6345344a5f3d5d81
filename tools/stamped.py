#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a test that is a function of files, unless it has passed with the same files, command and tools before.

usage: stamped.py [--reads GLOB]... [--program FILE]... [--tool COMMAND]... [--variable NAME]... -- COMMAND...

  --reads GLOB      files of the source tree that the test reads, as rtl/** or tools/pypi.sh
  --program FILE    a file outside the tree that it reads, as a built program
  --tool COMMAND    prints the version of a tool that it runs
  --variable NAME   an environment variable that it asks for
  COMMAND           words that name a file of the source tree mean the copy

The command runs in a copy of the files that --reads names, and is given no other file of the source tree. A file that is
not named is missing where a script looks for it. A test that passes leaves a stamp in ~/.cache/kage/stamps, named by the SHA-256 of
all of these, and is not run again while that stands, which is for 90 days after its last use. KAGE_FRESH=1 (tools/test --fresh) runs every test, as .ci/nightly
does. Where KAGE_DATA_DIR names other data the command runs as it is, without a stamp.
"""

import argparse
import contextlib
import datetime
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

TOP = pathlib.Path(__file__).resolve().parent.parent
# Scripts of tests run by these; which version of PyYAML there is decides what they read.
PYTHON = "/usr/bin/python3 -c 'import sys, yaml; print(sys.version, yaml.__version__)'"
MOST_DAYS = 90


def cache():
    home = os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache"
    return pathlib.Path(home) / "kage/stamps"


def copied(globs, into):
    """Copies the files of the patterns and returns their names. A pattern that no file has is a mistake."""
    names = set()
    for pattern in globs:
        found = {p.relative_to(TOP) for p in TOP.glob(pattern) if p.is_file() and "__pycache__" not in p.parts}
        if pattern.endswith("**"):
            found |= {
                p.relative_to(TOP) for p in TOP.glob(f"{pattern}/*") if p.is_file() and "__pycache__" not in p.parts
            }
        if not found:
            sys.exit(f"stamped.py: {pattern}: there is no such file")
        names |= found
    for name in sorted(names):
        (into / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(TOP / name, into / name)
    return sorted(names)


def version(command):
    """Output of a command. One that fails says nothing of its tool, so no stamp can be told by it."""
    done = subprocess.run(command, shell=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        sys.exit(f"stamped.py: {command}: exit code {done.returncode}")
    return done.stdout


def drop_old(folder):
    """Stamps that no test has used for a while are of files that are gone."""
    for stamp in folder.iterdir():
        with contextlib.suppress(OSError):  # another test drops it too
            if time.time() - stamp.stat().st_mtime > MOST_DAYS * 86400:
                stamp.unlink()


def key_of(options, command, tree, names):
    """The SHA-256 of all that decides the test."""
    sha = hashlib.sha256()

    def part(kind, name, content):
        sha.update(f"{kind} {name} {len(content)}\n".encode())
        sha.update(content)

    part("runner", "", pathlib.Path(__file__).read_bytes())
    for name in names:
        part(f"file {os.access(tree / name, os.X_OK)}", name, (tree / name).read_bytes())
    for program in options.program:
        part("program", pathlib.Path(program).name, pathlib.Path(program).read_bytes())
    part("python", "", f"{sys.version} {os.environ.get('PYTHONPATH', '')}".encode())
    for tool in [PYTHON, *options.tool]:
        part("tool", tool, version(tool))
    for name in options.variable:
        part("variable", name, os.environ.get(name, "").encode())
    for word in command:
        part("word", "", word.replace(str(TOP), "TOP").encode())
    return sha.hexdigest()


def in_copy(word, tree, programs):
    """A word of the command with the copy in place of the source tree."""
    if word != str(TOP) and not word.startswith(f"{TOP}/"):
        return word
    if (tree / word[len(str(TOP)) + 1 :]).exists():
        return str(tree) + word[len(str(TOP)) :]
    if word not in programs:
        sys.exit(f"stamped.py: {word} is neither among --reads nor a --program")
    return word


def main():
    words = sys.argv[1:]
    if "--" not in words or words[-1] == "--":
        sys.exit(__doc__)
    at = words.index("--")
    parser = argparse.ArgumentParser(usage="stamped.py [OPTION]... -- COMMAND...")
    for name in ("reads", "program", "tool", "variable"):
        parser.add_argument(f"--{name}", action="append", default=[])
    options, command = parser.parse_args(words[:at]), words[at + 1 :]
    if "KAGE_DATA_DIR" in os.environ:  # another RTL is under test
        return subprocess.run(command, check=False).returncode
    with tempfile.TemporaryDirectory(prefix="kage-stamped-") as folder:
        tree = pathlib.Path(folder) / "kage"
        tree.mkdir()
        names = copied(options.reads, tree)
        key = key_of(options, command, tree, names)
        stamp = cache() / key
        if not os.environ.get("KAGE_FRESH") and stamp.exists():
            stamp.touch()
            print(f"not run again, for the same {len(names)} files, command and tools: {stamp.read_text().strip()}")
            return 0
        begin = time.monotonic()
        moved = [in_copy(word, tree, options.program) for word in command]
        code = subprocess.run(moved, check=False, env=os.environ | {"KAGE_DATA_DIR": str(tree)}).returncode
        if code != 0:
            stamp.unlink(missing_ok=True)
        else:
            stamp.parent.mkdir(parents=True, exist_ok=True)
            hidden = stamp.with_suffix(f".{os.getpid()}")
            hidden.write_text(f"passed on {datetime.date.today()} in {time.monotonic() - begin:.0f} s\n")
            hidden.replace(stamp)
            drop_old(stamp.parent)
        return code


if __name__ == "__main__":
    sys.exit(main())
