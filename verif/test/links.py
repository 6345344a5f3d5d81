#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Links in the Markdown pages lead somewhere: to a file of the tree, and to a heading that its page has.

usage: links.py SOURCE
"""

import pathlib
import re
import sys
import tempfile

CODE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)  # what a block of code shows is no link
LINK = re.compile(r"\]\(([^)\s]+)(?:\s+\"[^\"]*\")?\)")
# Links of a page docs/README.md beside one with a heading "One `place`, and more": how many of them are wrong.
EXAMPLES = {
    "[a](b.md) [a](b.md#one-place-and-more) [a](#here) [a](https://example.com/x)\n# Here": 0,
    "[a](c.md)": 1,
    '[a](c.md "of a title")': 1,
    "[a](b.md#one)": 1,
    "[a](#there)": 1,
    "```\n[a](c.md)\n```": 0,
    "[![a](c.png)](b.md)": 1,
}


def headings(text):
    """A page's headings as links name them: lower case, without punctuation, with hyphens for spaces."""
    names = (
        re.sub(r"[^\w\- ]", "", m.lower()).replace(" ", "-") for m in re.findall(r"^#+ (.*)$", CODE.sub("", text), re.M)
    )
    return set(names)


def wrong(page, top):
    """The fault of each link of the page that has one."""
    for target in LINK.findall(CODE.sub("", page.read_text())):
        if re.match(r"[a-z]+:", target):
            continue  # another host's
        path, _, heading = target.partition("#")
        file = page.parent / path if path else page
        if not file.exists():
            yield f"{page.relative_to(top)}: {target}: no such file"
        elif heading and file.suffix == ".md" and heading not in headings(file.read_text()):
            yield f"{page.relative_to(top)}: {target}: no such heading"


def examples():
    """Whether this finds the wrong links of EXAMPLES, and no others."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "b.md").write_text("# One `place`, and more\n")
        page = folder / "README.md"
        for text, count in EXAMPLES.items():
            page.write_text(text + "\n")
            found = list(wrong(page, folder))
            if len(found) != count:
                print(f"{text!r}: {count} wrong links, found: {found}")
                return False
    return True


def main(top):
    pages = [p for p in top.rglob("*.md") if not {"build", "out", ".git"} & set(p.relative_to(top).parts)]
    found = [line for page in sorted(pages) for line in wrong(page, top)]
    links = sum(len(LINK.findall(CODE.sub("", p.read_text()))) for p in pages)
    print(*found, sep="\n", end="\n" if found else "")
    print(f"{links} links in {len(pages)} pages, {len(found)} of them wrong")
    return 1 if found or not examples() else 0


sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
