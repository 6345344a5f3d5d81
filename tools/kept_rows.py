# SPDX-License-Identifier: Apache-2.0
"""Rows of a long run, in a file as JSON: written as they come, and taken up by --resume. And what a figure that is told was
measured on, so that it can be seen when that is no more what is there."""

import functools
import hashlib
import json
import pathlib
import re


class NotThese(Exception):
    """The file's rows are no rows to go on from: a line that says why."""


def hash_of(files):
    """Hash of the files' contents, in this order: rows of other files do not go together."""
    return hashlib.sha256(b"".join(hashlib.sha256(f.read_bytes()).digest() for f in files)).hexdigest()[:16]


def load(path, schema, same):
    """The rows of an earlier run; none if there is no file. Each must have the schema, and what `same` says."""
    path = pathlib.Path(path)
    if not path.exists():
        return []
    try:
        rows = json.loads(path.read_text())
    except ValueError as e:
        raise NotThese(f"{path}: {e}") from None
    if not isinstance(rows, list) or not all(isinstance(row, dict) and row.get("schema") == schema for row in rows):
        raise NotThese(f"{path}: not rows of {schema}, which alone --resume goes on from")
    for row in rows:
        other = [key for key, value in same.items() if row.get(key) != value]
        if other:
            raise NotThese(f"{path}: its rows are of another run: {', '.join(other)}")
    return rows


def write(path, rows):
    """The file is there whole or as it was before."""
    part = pathlib.Path(f"{path}.part")
    part.write_text(json.dumps(rows, indent=1) + "\n")
    part.replace(path)


# ---- figures that depend on files -------------------------------------------------------------------------------------
# A figure keeps of what it was measured: {"sha256": of all, "files": {name: of it, eight digits}}.

COMMENT = {
    ".sv": r"/\*.*?\*/|//[^\n]*",
    ".svh": r"/\*.*?\*/|//[^\n]*",
    ".v": r"/\*.*?\*/|//[^\n]*",
    ".cpp": r"/\*.*?\*/|//[^\n]*",
    ".hpp": r"/\*.*?\*/|//[^\n]*",
}
STRINGS = r'"(?:[^"\\\n]|\\.)*"'
NOT_MADE = re.compile(r"`ifndef\s+SYNTHESIS\b.*?`endif\b", re.S)  # assertions: no part of what tools make


def what_matters_lines(path):
    """A source without what no tool makes anything of: comments, and of RTL the assertions."""
    text = path.read_text()
    comment = COMMENT.get(path.suffix, r"(?<![^\s])#[^\n]*")
    # Strings stay as they are, a comment's signs within them too.
    text = re.sub(f"({STRINGS})|{comment}", lambda m: m.group(1) or " ", text, flags=re.S)
    if path.suffix in (".sv", ".svh"):
        text = NOT_MADE.sub(" ", text)
    return text


@functools.cache
def what_matters(path):
    """The same without the blanks that a formatter moves: those beside a sign."""
    return re.sub(r" ?([^\w ]) ?", r"\1", " ".join(what_matters_lines(path).split()))


def of_what(top, names, values=None):
    """Hashes that a figure keeps of the files `names` and of `values`, anything that JSON can hold."""
    files = {name: hashlib.sha256(what_matters(top / name).encode()).hexdigest() for name in sorted(set(names))}
    whole = json.dumps([files, values], sort_keys=True)
    return {"sha256": hashlib.sha256(whole.encode()).hexdigest(), "files": {n: h[:8] for n, h in files.items()}}


def moved(top, of, values=None):
    """Which of the files that a figure was measured on are others now, or gone; [] if it is of what is there."""
    names = of["files"]
    gone = [n for n in names if not (top / n).is_file()]
    if gone:
        return gone
    now = of_what(top, names, values)
    if now["sha256"] == of["sha256"]:
        return []
    return [n for n, h in names.items() if now["files"][n] != h] or ["its parameters"]


INCLUDED = re.compile(r'`include\s+"([^"]+)"')


def with_includes(top, modules, folder="rtl/include"):
    """The files `modules` and all that they include."""
    found = []
    left = list(modules)
    while left:
        name = left.pop()
        if name in found:
            continue
        found.append(name)
        left += [f"{folder}/{i}" for i in INCLUDED.findall((top / name).read_text())]
    return sorted(found)
