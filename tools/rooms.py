# SPDX-License-Identifier: Apache-2.0
"""The rooms of the source tree, and which of them may include which (docs/architecture.md, "Layers"). The test contract/layers
holds every include to this table, and CMake lists and Python imports. By the same table tools/selection.py finds the tests
that a change concerns."""

import posixpath
import re

# Folders of the golden model, each with those right below it; it may include theirs and all below them.
BELOW = {
    "number": [],
    "simd": [],
    "arena": [],
    "file": [],
    "plugin": ["file"],
    "json": ["file"],
    "hls": [],
    "contract": ["file", "number"],
    "polygon": ["contract", "hls"],
    "stream": ["polygon"],
    "kernels": ["contract", "simd"],
    "core": ["stream", "kernels"],
    "bind": ["core"],
    "cost": ["stream"],
    "order": ["file", "arena", "simd"],
    "scene": ["file", "json", "plugin", "number"],
    "shadow": ["scene", "order", "number"],
    "geometry": ["shadow", "contract"],
    "frontend": ["geometry", "arena", "polygon", "kernels"],
    "image": ["file", "plugin", "number"],
    "direct": ["frontend", "core"],
    "pipeline": ["frontend", "direct", "stream", "core", "cost", "image"],
    "plan": ["pipeline", "cost"],
}
MODEL = [*BELOW, "kage"]

# The public headers (ref/include/kage) whose functions each folder has.
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

# Folders beside the golden model, each with all that it may include. The longest path counts.
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

# The products: all that is installed, and all that an installed kage is made of. Lists install nothing else, but for pages at
# the top.
PRODUCTS = (
    "cli",
    "cmake",
    "constraints",
    "docs",
    "examples",
    "python",
    "ref",
    "rtl",
    "scenes",
    "verif/board",
    "verif/cosim",
    "verif/explore",
    "verif/oracle",
    "verif/stimulus",
    "verif/vectors",
)
# Rooms that judge, try and measure the products. No CMake list of a product's room names a file of it, and no Python file of a product.
# (sources.yaml of verif/cosim/model/driver does: models with mutants are built in a source tree only.)
JUDGES = ("verif/bench", "verif/extremes", "verif/fuzz", "verif/mutants", "verif/test")

# Folders of Python files, each with those that its files may import from, beside itself; a folder stands for all below it.
IMPORTS = {
    "examples": ["python"],
    "hls/tool": ["tools/fpga_flow"],
    "python": [],
    "scenes/maker": [],
    "tools": ["verif/cosim/model/driver"],
    "tools/fpga_flow": ["python", "tools"],
    "tools/gen_defs": ["tools/fpga_flow"],
    "verif/board/sim": [],
    "verif/cosim/model/driver": [],
    "verif/test": ["hls/tool", "python", "tools", "verif/cosim/model/driver"],
}

# Exemptions: a CMake list, a room that its own may not include, and why it has files of it.
EXEMPT = {
    ("ref/CMakeLists.txt", "explore"): "a checksum of what plugins and their callers take a table to be",
    ("verif/cosim/CMakeLists.txt", "session"): "a checksum of all that judges, by which verdicts are kept",
    ("verif/test/CMakeLists.txt", "mutants"): "all headers in one unit",
    ("verif/test/CMakeLists.txt", "cli"): "all headers in one unit",
}

# Functions and classes of the golden model that make what oracles judge. The oracles of DRAWING call one: they draw, and then
# judge it.
DRAWS = (
    "GoldenCore",
    "Renderer",
    "SceneFrames",
    "attenuation",
    "check_frame",
    "decode",
    "draw_frame",
    "explain_pixel",
    "light_points",
    "make_frame",
    "make_geometry",
    "make_order",
    "received",
)
DRAWING = ("verif/oracle/face_pixels.hpp", "verif/oracle/judge.hpp", "verif/oracle/ray_truth.hpp")

ROOTS = (
    "ref",
    "ref/include",
    "verif",
    "verif/cosim/include",
    "",
)  # folders that an include may be named from, besides the file's own


def at_or_below(folder):
    return {folder}.union(*(at_or_below(f) for f in BELOW.get(folder, [])))


def is_below(path, folders):
    """Whether a path is one of the folders, or below one."""
    return any(path == folder or path.startswith(folder + "/") for folder in folders)


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


def includes(text):
    """The names that a C++ file's text includes."""
    return re.findall(r'^\s*#\s*include\s*["<]([^">]+)[">]', text, re.M)
