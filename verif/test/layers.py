#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Folders have of each other what docs/architecture.md ("Layers") and the tables of tools/rooms.py let them.

Includes of C++: a layer includes those below it and their public headers. An oracle includes public headers and wide integers.
It calls nothing that draws or measures what it judges, but for those that rooms.py names.
CMake lists (cmake_lists.py): a target links targets of rooms that its own may include, and a list names files of these alone.
Products alone are installed. They name no file of tests, mutants, extremes, fuzzing or benchmarks.
Python (python_imports.py): a file imports from folders that its own may. No imports make a circle.

usage: layers.py SOURCE_DIR
"""

import os
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import cmake_lists
import python_imports
from rooms import DRAWING, DRAWS, GROUND, OWNERS, includes, may, place, targets


def refused(path, text, files):
    """Includes that a file of this path may not have."""
    return [name for name in includes(text) if not all(may(path, t) for t in targets(path, name, files))]


def drawn(text):
    """The functions and classes of DRAWS that a file calls."""
    code = re.sub(r"//[^\n]*", "", text)
    return [name for name in DRAWS if re.search(rf"\b{name}( \w+)?\(", code)]


EXAMPLES = (  # each must be refused
    ("verif/oracle/oracle.hpp", "test/support/catch.hpp"),
    ("verif/oracle/oracle.hpp", "stimulus/random.hpp"),
    ("verif/oracle/oracle.cpp", "geometry/plane.hpp"),
    ("verif/bench/shadows.cpp", "test/support/catch.hpp"),
    ("verif/cosim/run.cpp", "oracle/oracle.hpp"),
    ("verif/cosim/run.cpp", "cosim/session/session.hpp"),
    ("verif/cosim/run.cpp", "cosim/report/run_record.hpp"),
    ("verif/cosim/report/joined.cpp", "cosim/session/session.hpp"),
    ("verif/cosim/session/session.cpp", "cosim/regress/regress.hpp"),
    ("verif/vectors/pack.cpp", "cosim/session/source.hpp"),
    ("verif/extremes/depth.cpp", "test/support/catch.hpp"),
    ("verif/oracle/oracle.hpp", "extremes/family.hpp"),
    ("verif/bench/shadows.cpp", "extremes/family.hpp"),
    ("verif/cosim/run.cpp", "../test/support/catch.hpp"),
    ("verif/cosim/run.cpp", "catch.hpp"),
    ("verif/test/unit/stream/diff.cpp", "cli/progress.hpp"),
    ("cli/main.cpp", "test/support/catch.hpp"),
    ("ref/core/core.cpp", "frontend/scan.hpp"),
    ("ref/core/core.cpp", "kage/frontend.hpp"),
    ("ref/contract/rules.hpp", "stream/count.hpp"),
    ("ref/contract/order.hpp", "kage/stream.hpp"),
    ("ref/shadow/kept.hpp", "kage/geometry.hpp"),
    ("ref/include/kage/core.hpp", "contract/rules.hpp"),
    ("ref/include/kage/token.hpp", "kage/stream.hpp"),
)
CALLS = (
    "const auto g = make_geometry(f, config, w, h);",
    "  GoldenCore core(config);",
    "x = light_points(light, 15, 1)",
)


def in_oracles(files):
    for text in CALLS:
        if not drawn(text):
            yield f"layers.py lets an oracle say {text}"
    calls = {path: drawn(p.read_text()) for path, p in files.items() if path.startswith("verif/oracle/")}
    for path, names in calls.items():
        if names and path not in DRAWING:
            yield f"{path}: calls {' and '.join(names)}, which make what it judges"
    yield from (f"rooms.py: DRAWING: {path}: calls nothing that draws" for path in DRAWING if not calls.get(path))


def is_python(path, p):
    if path.endswith(".py"):
        return True
    if "." in p.name:
        return False
    with p.open("rb") as file:
        return b"python" in file.readline(100) if file.read(2) == b"#!" else False


def faults(source):
    """A line for each thing that is not allowed, and for what the checks themselves have wrong."""
    everything = {}  # files and folders
    for folder, folders, names in os.walk(source):
        folders[:] = [f for f in folders if f not in ("build", "out", "__pycache__") and not f.startswith(".")]
        everything |= {(pathlib.Path(folder) / name).relative_to(source).as_posix(): False for name in folders}
        everything |= {(pathlib.Path(folder) / name).relative_to(source).as_posix(): True for name in names}
    paths = sorted(path for path, is_file in everything.items() if is_file)
    files = {
        path: source / path
        for path in paths
        if path.startswith(("ref/", "verif/", "cli/")) and path.endswith((".cpp", ".hpp", ".h", ".c"))
    }
    for path, name in EXAMPLES:
        for quotes in ('"{}"', "<{}>"):
            if not refused(path, "#include " + quotes.format(name), files):
                yield f"layers.py lets {path} include {name}"
    public = {place(path)[1] for path in files} - {None}
    yield from (f"layers.py: {name}: is of no folder, or is no header" for name in public ^ (OWNERS.keys() | GROUND))
    for path, p in files.items():
        for name in refused(path, p.read_text(), files):
            yield f"{path}: includes {name}, which its layer may not"
    if len(files) < 300:
        yield f"layers.py: found {len(files)} files only"
    yield from in_oracles(files)
    lists = {path: (source / path).read_text() for path in paths if cmake_lists.is_list(path)}
    yield from cmake_lists.faults(lists, everything)
    scripts = {path: (source / path).read_text() for path in paths if is_python(path, source / path)}
    yield from python_imports.faults(scripts)


def main(source):
    bad = list(faults(source))
    print("\n".join(bad) or "all files have of other folders what they may")
    return 1 if bad else 0


sys.exit(main(pathlib.Path(sys.argv[1])))
