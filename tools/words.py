# SPDX-License-Identifier: Apache-2.0
"""Sentences of Markdown that a tired reader has to read twice: longer than 35 words, or opened by a word that stands for a
noun which never comes ("What it gives is ...", "Of these the first ...", "That which ...").

usage: words.py FILE...      A line for each: FILE:LINE: why: the sentence. Exit code 1: there is one.
"""

import pathlib
import re
import sys

MOST = 35
# "That file" has its noun; "That of", "That is" and "That a file ..." have none.
NO_NOUN = re.compile(
    r"(What|Of|That (a|an|the|of|is|was|which|it|they|no|each|every|what|who|whose|there|these|those|this)"
    r"|Those (of|that|which|who|with|without|are|were|for|in|on))\b(?![^?]*\?$)"
)
END = re.compile(r"(?<=[.!?])[\"')*_]*\s+(?=[\"'(*_`\[]*[A-Z0-9`])")
ENTRY = re.compile(END.pattern + r"|;\s+")


def plain(text):
    """Without marks of Markdown; a piece of code, a link's address and a formula count as one word or none."""
    text = re.sub(r"!\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"`[^`]*`", "CODE", text)
    return re.sub(r"[*_]{1,2}(?=\S)|(?<=\S)[*_]{1,2}", "", text)


def paragraphs(lines):
    """(first line's number, text, whether it is a cell) of each paragraph, list entry, table cell and caption outside of code blocks."""
    code = False
    begin, words = 0, []

    def closed():
        nonlocal words
        out = [(begin, " ".join(words), False)] if words else []
        words = []
        return out

    for number, line in enumerate(lines, 1):
        bare = line.strip()
        if re.match(r"(```|~~~)", bare):
            code = not code
            yield from closed()
            continue
        if code or bare.startswith("<!--") or re.match(r"\|?[\s:|-]+\|[\s:|-]*$", bare):
            continue
        if bare.startswith("|"):
            yield from closed()
            yield from (
                (number, cell.strip(), True) for cell in re.split(r"(?<!\\)\|", bare.strip("|")) if cell.strip()
            )
            continue
        if not bare or bare.startswith("#") or re.match(r"([*+-]|\d+[.)])\s", bare) or line.startswith("    "):
            yield from closed()
        if not bare or bare.startswith("#") or (line.startswith("    ") and not words):
            continue
        if not words:
            begin = number
        words.append(re.sub(r"^([*+-]|\d+[.)])\s+", "", bare))
    yield from closed()


def faults(path):
    for number, text, cell in paragraphs(path.read_text().splitlines()):
        # A cell of a table may be a list, whose entries semicolons part.
        for sentence in (END if not cell else ENTRY).split(plain(text)):
            words = [w for w in sentence.split() if re.search(r"\w", w)]
            if len(words) > MOST:
                yield f"{path}:{number}: {len(words)} words: {sentence}"
            if NO_NOUN.match(sentence.lstrip("\"'(")):
                yield f"{path}:{number}: no noun: {sentence}"


def main(files):
    if not files:
        sys.exit(__doc__)
    found = [fault for file in files for fault in faults(pathlib.Path(file))]
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
