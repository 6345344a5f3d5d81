#!/usr/bin/env -S python3 -B
# SPDX-License-Identifier: Apache-2.0
"""Deliberate defects: lists of changes to files, each of a text that the file has exactly once. A test must see each of them.

usage: defects.py LIST list               a line a defect: its name, what sees it, and its files, with tabs between. Keys of a
                                          list's own are passed over
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

PLACE = {"file", "was", "is", "in"}
FORM = PLACE | {"name", "changes", "breaks", "seen_by", "equivalent", "lives", "named"}
ANY = None  # for load(): keys of any name


class DefectError(Exception):
    """A list is not as it should be, or a file has not what a defect changes."""


def load(path, more=()):
    """The defects of a list by name, in its order. `more`: keys that the list has of its own."""
    try:
        listed = yaml.safe_load(pathlib.Path(path).read_text())
    except (OSError, yaml.YAMLError) as e:
        raise DefectError(f"{path}: {getattr(e, 'strerror', None) or 'no YAML: ' + str(e).splitlines()[0]}") from e
    if not isinstance(listed, list) or not all(isinstance(defect, dict) for defect in listed):
        raise DefectError(f"{path}: no list of defects")
    defects = {}
    for defect in listed:
        name = defect.get("name", "")
        if not name or name in defects:
            raise DefectError(f"{path}: {f'two defects {name}' if name else 'a defect without a name'}")
        try:
            check(defect, more)
        except DefectError as e:
            raise DefectError(f"{path}: {name}: {e}") from e
        defects[name] = defect
    return defects


def check(defect, more):
    """Whether a defect has the form above."""
    if more is not ANY and (odd := defect.keys() - FORM - set(more)):
        raise DefectError(f"unknown keys {', '.join(sorted(odd))}")
    if ("changes" in defect) == bool(defect.keys() & PLACE):
        raise DefectError("it has either `changes` or `file`, `was` and `is`")
    if len(defect.keys() & {"equivalent", "lives", "named"}) > 1:
        raise DefectError("more than one of equivalent, lives and named")
    if not isinstance(changes(defect), list) or not changes(defect):
        raise DefectError("`changes` is no list, or empty")
    for change in changes(defect):
        if not isinstance(change, dict) or ("changes" in defect and change.keys() - PLACE):
            raise DefectError("a change has other keys than file, was, is and in")
        if missing := {"file", "was", "is"} - change.keys():
            raise DefectError(f"a change lacks {', '.join(sorted(missing))}")
        if not all(isinstance(change[key], str) for key in PLACE & change.keys()) or not change["was"]:
            raise DefectError("file, was, is and in are texts, and `was` is not empty")


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
        for name, defect in load(arguments[0], ANY).items():
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
