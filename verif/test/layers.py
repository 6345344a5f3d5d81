#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Folders include what docs/architecture.md ("Layers") lets them. A layer includes those below it and their public headers.
An oracle includes nothing that it judges. Nothing that is installed includes a test, an oracle, a mutant or a benchmark.

usage: layers.py SOURCE_DIR
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
from rooms import GROUND, OWNERS, includes, may, place, targets


def refused(path, text, files):
    """Includes that a file of this path may not have."""
    return [name for name in includes(text) if not all(may(path, t) for t in targets(path, name, files))]


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


def faults(source):
    """A line for each include that is not allowed, and for what layers.py itself has wrong."""
    found = [p for room in ("ref", "verif", "cli") for p in sorted((source / room).rglob("*"))]
    files = {str(p.relative_to(source)): p for p in found if p.suffix in (".cpp", ".hpp", ".h", ".c")}
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


def main(source):
    bad = list(faults(source))
    print("\n".join(bad) or "all files include what their layers may")
    return 1 if bad else 0


sys.exit(main(pathlib.Path(sys.argv[1])))
