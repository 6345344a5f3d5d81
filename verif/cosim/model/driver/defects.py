#!/usr/bin/env -S python3 -B
# SPDX-License-Identifier: Apache-2.0
"""Deliberate defects: lists of changes to files, each of a text that the file has exactly once. A test must see each of them.

usage: defects.py LIST list               a line a defect: its name, what sees it, and its files, with tabs between
       defects.py LIST put NAME TREE      change the files of the tree, which is laid out as the source tree

A list is YAML, a sequence of defects:

  name       of its own in the list
  file       from the top of the source tree
  was, is    the text in the file, and what stands there with the defect
  in         a longer text that the file has once and that has `was` once; without it the file has `was` once
  changes    in place of file, was, is and in: several changes, each a mapping of these
  breaks     what the defect does, in words
  seen_by    what must see it: each list says in what words
  equivalent, lives, named
             at most one: why nothing can see it; why what sees others cannot; why something else may see it first

A list may have keys of its own beside these.
"""

import pathlib
import sys

import yaml

PLACE = {"file", "was", "is", "in", "port"}
FORM = PLACE | {"name", "changes", "breaks", "seen_by", "equivalent", "lives", "named"}


class DefectError(Exception):
    """A list is not as it should be, or a file has not what a defect changes."""


def load(path, more=()):
    """The defects of a list by name, in its order. `more`: keys that the list has of its own."""
    defects = {}
    for defect in yaml.safe_load(pathlib.Path(path).read_text()):
        name = defect.get("name", "")
        if not name or name in defects:
            raise DefectError(f"{path}: {f'two defects {name}' if name else 'a defect without a name'}")
        if odd := defect.keys() - FORM - set(more):
            raise DefectError(f"{path}: {name}: unknown keys {', '.join(sorted(odd))}")
        if ("changes" in defect) == ("file" in defect):
            raise DefectError(f"{path}: {name}: it has either `changes` or `file`, `was` and `is`")
        if len(defect.keys() & {"equivalent", "lives", "named"}) > 1:
            raise DefectError(f"{path}: {name}: more than one of equivalent, lives and named")
        for change in changes(defect):
            if missing := {"file", "was", "is"} - change.keys():
                raise DefectError(f"{path}: {name}: a change lacks {', '.join(sorted(missing))}")
        defects[name] = defect
    return defects


def changes(defect):
    """The places that a defect changes."""
    return defect.get("changes", [defect])


def place(text, change):
    """Where in the file's text the change's `was` begins."""
    around = change.get("in", change["was"])
    for whole, part in ((text, around), (around, change["was"])):
        if whole.count(part) != 1:
            raise DefectError(f"{change['file']} has not exactly once: {part}")
    return text.index(around) + around.index(change["was"])


def put_in(defect, tree):
    """Change the files below `tree`, which is laid out as the source tree."""
    for change in changes(defect):
        file = pathlib.Path(tree) / change["file"]
        text = file.read_text()
        begin = place(text, change)
        file.write_text(text[:begin] + change["is"] + text[begin + len(change["was"]) :])


def main(arguments):
    if arguments[1:] == ["list"]:
        for name, defect in load(arguments[0]).items():
            files = dict.fromkeys(change["file"] for change in changes(defect))
            print(name, defect.get("seen_by", ""), *files, sep="\t")
    elif len(arguments) == 4 and arguments[1] == "put":
        defects = load(arguments[0])
        if arguments[2] not in defects:
            raise DefectError(f"{arguments[0]} has no {arguments[2]}")
        put_in(defects[arguments[2]], arguments[3])
    else:
        raise DefectError(__doc__.split("\n\n")[1])


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except (DefectError, OSError, yaml.YAMLError) as e:
        sys.exit(f"defects.py: {e}")
