#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Links in the Markdown pages lead somewhere: to a file of the tree, and to a heading that its page has.

usage: links.py SOURCE
"""

import pathlib
import re
import sys

CODE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)  # what a block of code shows is no link
LINK = re.compile(r"\]\(([^)\s]+)\)")


def headings(text):
    """A page's headings as links name them: lower case, without punctuation, with hyphens for spaces."""
    names = (
        re.sub(r"[^\w\- ]", "", m.lower()).replace(" ", "-") for m in re.findall(r"^#+ (.*)$", CODE.sub("", text), re.M)
    )
    return set(names)


def wrong(page, top):
    """What is wrong with each link of the page."""
    for target in LINK.findall(CODE.sub("", page.read_text())):
        if re.match(r"[a-z]+:", target):
            continue  # another host's
        path, _, heading = target.partition("#")
        file = page.parent / path if path else page
        if not file.exists():
            yield f"{page.relative_to(top)}: {target}: no such file"
        elif heading and file.suffix == ".md" and heading not in headings(file.read_text()):
            yield f"{page.relative_to(top)}: {target}: no such heading"


def main(top):
    pages = [p for p in top.rglob("*.md") if not {"build", "out", ".git"} & set(p.relative_to(top).parts)]
    found = [line for page in sorted(pages) for line in wrong(page, top)]
    links = sum(len(LINK.findall(CODE.sub("", p.read_text()))) for p in pages)
    print(*found, sep="\n", end="\n" if found else "")
    print(f"{links} links in {len(pages)} pages, {len(found)} of them wrong")
    return 1 if found or links < 100 else 0


sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
