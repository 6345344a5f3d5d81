#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Folders include what docs/architecture.md ("Layers") lets them: a layer those below it, public headers only each other,
second opinions nothing of what they judge, and nothing that is installed a test, an opinion, a mutant or a benchmark.

usage: layers.py SOURCE_DIR
"""

import pathlib
import re
import sys

# Of the golden model, what stands right below each folder; what is below that may be included too.
BELOW = {
    "number": [],
    "simd": [],
    "arena": [],
    "file": [],
    "module": [],
    "contract": ["file", "number"],
    "stream": ["contract"],
    "core": ["stream", "simd"],
    "bind": ["core"],
    "order": ["file", "arena", "simd"],
    "scene": ["file", "module"],
    "shadow": ["scene", "order", "number"],
    "geometry": ["shadow", "contract"],
    "frontend": ["geometry", "arena"],
    "image": ["file", "module"],
    "pipeline": ["frontend", "stream", "core", "image"],
}
MODEL = [*BELOW, "kage"]

# Beside the golden model: all that may be included, in full.
ABOVE = {
    "verif/stimulus": ["stimulus", *MODEL],
    "verif/cosim": ["cosim", *MODEL],
    "verif/opinion": ["opinion", "kage", "number"],
    "verif/mutants": ["mutants", "cosim", "stimulus", *MODEL],
    "verif/bench": ["bench", "cosim", "stimulus", "opinion", *MODEL],
    "verif/test": ["test", "cosim", "stimulus", "opinion", *MODEL],
    "cli": ["cosim", "stimulus", *MODEL],
}


def at_or_below(folder):
    return {folder}.union(*(at_or_below(f) for f in BELOW.get(folder, [])))


def allowed(path):
    """First folders of what a file may include, by the file's path in the source."""
    parts = path.split("/")
    if parts[0] == "ref":
        return {"kage"} if parts[1] == "include" else at_or_below(parts[1]) | {"kage"}
    return set(ABOVE.get("cli" if parts[0] == "cli" else "/".join(parts[:2]), []))


def refused(path, text):
    """Includes in quotes that a file of this path may not have. One without folder is of the file's own."""
    found = re.findall(r'^\s*#\s*include\s*"([^"]+)"', text, re.M)
    return [name for name in found if "/" in name and name.split("/")[0] not in allowed(path)]


EXAMPLES = (  # each must be refused
    ("verif/opinion/oracle.hpp", "test/support/shapes.hpp"),
    ("verif/opinion/oracle.hpp", "stimulus/random.hpp"),
    ("verif/opinion/oracle.cpp", "geometry/plane.hpp"),
    ("verif/bench/shadows.cpp", "test/support/shapes.hpp"),
    ("verif/cosim/run.cpp", "opinion/oracle.hpp"),
    ("verif/cosim/run.cpp", "../test/support/shapes.hpp"),
    ("cli/main.cpp", "test/support/catch.hpp"),
    ("ref/core/core.cpp", "frontend/scan.hpp"),
    ("ref/contract/rules.hpp", "stream/file.hpp"),
    ("ref/include/kage/core.hpp", "contract/rules.hpp"),
)


def main(source):
    bad = [
        f"layers.py lets {path} include {name}" for path, name in EXAMPLES if not refused(path, f'#include "{name}"')
    ]
    files = [p for room in ("ref", "verif", "cli") for p in sorted((source / room).rglob("*"))]
    files = [p for p in files if p.suffix in (".cpp", ".hpp", ".h", ".c")]
    for p in files:
        path = str(p.relative_to(source))
        bad += [f"{path}: includes {name}, which its layer may not" for name in refused(path, p.read_text())]
    if len(files) < 300:
        bad.append(f"layers.py: found {len(files)} files only")
    print("\n".join(bad) or f"{len(files)} files include what their layers may")
    return 1 if bad else 0


sys.exit(main(pathlib.Path(sys.argv[1])))
