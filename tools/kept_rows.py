# SPDX-License-Identifier: Apache-2.0
"""Rows of a long run, in a file as JSON: written as they come, and taken up by --resume."""

import hashlib
import json
import pathlib


class NotThese(Exception):
    """The file's rows are no rows to go on from: a line that says why."""


def hash_of(files):
    """Of the files' contents, in this order: rows of other files do not go together."""
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
