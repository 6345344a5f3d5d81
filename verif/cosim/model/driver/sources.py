# SPDX-License-Identifier: Apache-2.0
"""The files that a model is made of: sources.yaml."""

import fnmatch
import os
import pathlib

import yaml

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parents[3]
RTL = pathlib.Path(os.environ.get("KAGE_RTL_DIR", TOP / "rtl")).resolve()
PATTERNS = yaml.safe_load((HERE / "sources.yaml").read_text())


def places(role, rtl=RTL):
    """The patterns of a role as paths; those below rtl/ below the folder `rtl`."""
    for pattern in PATTERNS[role]:
        path = pathlib.PurePosixPath(pattern)
        yield rtl / path.relative_to("rtl") if path.parts[0] == "rtl" else TOP / path


def files(role, rtl=RTL):
    """All files of a role, sorted. As in a shell, a pattern takes no hidden file."""
    found = []
    for place in places(role, rtl):
        names = (f for f in place.parent.iterdir() if f.is_file()) if place.parent.is_dir() else ()
        found += (f for f in names if fnmatch.fnmatchcase(f.name, place.name) and not f.name.startswith("."))
    return sorted(found)


def only(role, rtl=RTL):
    """The one file of a role."""
    (path,) = places(role, rtl)
    return path
