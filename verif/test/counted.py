# SPDX-License-Identifier: Apache-2.0
"""Words, clocks and errors of light that pages tell are those that benchmarks count: a page's table is the benchmark's, and each number of a
sentence is one that a benchmark prints. Nothing is timed, so all is the same on every machine.

usage: counted.py SOURCE_DIR FOLDER_OF_BENCHMARKS
"""

import pathlib
import re
import subprocess
import sys

SOURCE, BENCHES = map(pathlib.Path, sys.argv[1:3])
wrong = []


def lines(name, *arguments):
    return subprocess.run(
        [BENCHES / f"bench_{name}", *arguments], check=True, stdout=subprocess.PIPE, text=True
    ).stdout.splitlines()


def rows(page, name, *arguments, part=()):
    """The page's table is the benchmark's, line by line and with no other; of some scenes, where they are named. `part`: its arguments, where
    it prints a table for each."""
    text = (SOURCE / page).read_text().splitlines()
    printed = [line.rstrip() for line in lines(name, *part, *arguments)]
    if len(printed) < 3:
        wrong.append(f"bench_{name} prints no table")
        return
    if text.count(printed[0]) != 1:
        wrong.append(f"{page}: has {text.count(printed[0])} tables of tools/bench {name}, which begin: {printed[0]}")
        return
    told = []
    for line in text[text.index(printed[0]) :]:
        if not line or line.startswith("```"):
            break
        scene = line.strip("| ").split()[0]
        if not arguments or scene in arguments or line == printed[0]:
            told.append(line)
    wrong.extend(f"{page}: tools/bench {name} prints another line: {line}" for line in printed if line not in told)
    wrong.extend(f"{page}: tools/bench {name} prints no such line: {line}" for line in told if line not in printed)
    if sorted(told) == sorted(printed) and told != printed:
        wrong.append(f"{page}: the lines of tools/bench {name} have another order")


def numbers(page, begin, name, scenes):
    """All numbers of thousands in the page's paragraph that begins so are printed of these scenes, and there are some."""
    (paragraph,) = re.findall(rf"^\* \*\*{re.escape(begin)}.*?(?=^\* |^$)", (SOURCE / page).read_text(), re.S | re.M)
    printed = set(" ".join(lines(name, *scenes)).split())
    told = [n.replace(",", "") for n in re.findall(r"\b\d{1,3}(?:,\d{3})+\b", paragraph)]
    if not told:
        wrong.append(f"{page}: no number of thousands in {begin}")
    wrong.extend(
        f"{page}: {n} is nothing that tools/bench {name} prints of {', '.join(scenes)}"
        for n in told
        if n not in printed
    )


rows("docs/stream.md", "polygon_level")
for which in ("light", "built-in", "steps", "dicing"):
    rows("docs/lights.md", "lights", part=(which,))
rows("docs/shadows.md", "phases", "courtyard", "knot", "fifteen", "glass")
numbers("docs/rtl.md", "It keeps up.", "front_end", ["courtyard"])
for line in wrong:
    print(line)
sys.exit(bool(wrong))
