#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Folders include only what docs/architecture.md ("Layers") lets them. A layer includes those below it and their
public headers. Oracles include nothing that they judge, and installed code includes no test, oracle, mutant or
benchmark.

usage: layers.py SOURCE_DIR
"""

import pathlib
import posixpath
import re
import sys

# The golden model: the folders right below each folder; those below these may be included too.
BELOW = {
    "number": [],
    "simd": [],
    "arena": [],
    "file": [],
    "module": ["file"],
    "json": ["file"],
    "hls": [],
    "contract": ["file", "number"],
    "polygon": ["contract", "hls"],
    "stream": ["polygon"],
    "core": ["stream", "simd"],
    "bind": ["core"],
    "cost": ["stream"],
    "order": ["file", "arena", "simd"],
    "scene": ["file", "json", "module", "number"],
    "shadow": ["scene", "order", "number"],
    "geometry": ["shadow", "contract"],
    "frontend": ["geometry", "arena", "polygon"],
    "image": ["file", "module", "number"],
    "pipeline": ["frontend", "stream", "core", "cost", "image"],
    "plan": ["pipeline", "cost"],
}
MODEL = [*BELOW, "kage"]

# The public headers (ref/include/kage) of each folder: those of which it has the functions.
PUBLIC = {
    "contract": ["config.hpp", "token.hpp"],
    "stream": ["stream.hpp", "stream_diff.hpp"],
    "core": ["core.hpp", "explain.hpp"],
    "bind": ["golden.h", "golden_numbers.h"],
    "order": ["order.hpp"],
    "scene": ["scene.hpp"],
    "shadow": ["shadow.hpp"],
    "geometry": ["geometry.hpp", "light.hpp"],
    "frontend": ["frontend.hpp"],
    "file": ["paths.hpp"],
    "image": ["image.hpp", "diff.hpp"],
    "pipeline": ["bless.hpp", "pipeline.hpp", "provenance.hpp"],
    "plan": ["plan.hpp"],
}
OWNERS = {name: folder for folder, names in PUBLIC.items() for name in names}
GROUND = {"defs.hpp", "error.hpp", "registers.h"}  # they have no functions elsewhere and stand below all folders

# Beside the golden model: all that may be included, in full. The longest path counts.
ABOVE = {
    "verif/stimulus": ["stimulus", *MODEL],
    "verif/cosim": ["cosim", *MODEL],
    "verif/cosim/report": ["report", "cosim", *MODEL],
    "verif/cosim/session": ["session", "report", "cosim", "stimulus", *MODEL],
    "verif/cosim/regress": ["regress", "session", "report", "cosim", "stimulus", *MODEL],
    "verif/oracle": ["oracle", "kage", "number"],
    "verif/vectors": ["vectors", "report", "cosim", "stimulus", *MODEL],
    "verif/board": ["board", "vectors", "session", "report", "cosim", *MODEL],
    "verif/explore": ["explore", "oracle", "session", "report", "cosim", "stimulus", *MODEL],
    "verif/mutants": ["mutants", "cosim", "stimulus", *MODEL],
    "verif/extremes": ["extremes", "cosim", "stimulus", "oracle", *MODEL],
    "verif/fuzz": ["fuzz", "explore", "vectors", "report", "cosim", "stimulus", *MODEL],
    "verif/bench": ["bench", "report", "cosim", "stimulus", "oracle", *MODEL],
    "verif/test": [
        "test",
        "extremes",
        "explore",
        "board",
        "vectors",
        "regress",
        "session",
        "report",
        "cosim",
        "stimulus",
        "oracle",
        *MODEL,
    ],
    "cli": ["cli", "explore", "board", "vectors", "regress", "session", "report", "cosim", "stimulus", *MODEL],
}

ROOTS = (
    "ref",
    "ref/include",
    "verif",
    "verif/cosim/include",
    "",
)  # what includes are named from, but for those of a file's own folder


def at_or_below(folder):
    return {folder}.union(*(at_or_below(f) for f in BELOW.get(folder, [])))


def place(path):
    """The folder a file belongs to, by its path in the source, and its name there if it is a public header."""
    parts = path.split("/")
    if parts[:3] == ["ref", "include", "kage"]:
        return "kage", "/".join(parts[3:])
    if parts[0] == "cli":
        return "cli", None
    return parts[2] if "/".join(parts[:3]) in ABOVE and parts[:2] != ["verif", "test"] else parts[1], None


def may(path, target):
    """Whether the file of one path may include that of the other."""
    folder, public = place(target)
    if not path.startswith("ref/"):
        rooms = [room for room in ABOVE if path.startswith(room + "/")]
        return bool(rooms) and folder in ABOVE[max(rooms, key=len)]
    own, own_public = place(path)
    below = at_or_below(OWNERS.get(own_public, "") if own_public else own)
    if public is not None:
        return public in GROUND or OWNERS.get(public) in below
    return own_public is None and folder in below


def targets(path, name, files):
    """The files of the source that an include can mean: of the including file's folder, of a root, else of any folder,
    which a compiler's -I may name. None for what is the system's or made by the build."""
    for folder in (posixpath.dirname(path), *ROOTS):
        target = posixpath.normpath(posixpath.join(folder, name))
        if target in files:
            return [target]
    return [f for f in files if f.endswith("/" + name)]


def refused(path, text, files):
    """Includes that a file of this path may not have."""
    found = re.findall(r'^\s*#\s*include\s*["<]([^">]+)[">]', text, re.M)
    return [name for name in found if not all(may(path, t) for t in targets(path, name, files))]


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
