# SPDX-License-Identifier: Apache-2.0
"""Sentences that a tired reader has to read twice. They are longer than 35 words, or their first word stands for a noun
that never comes ("What it gives is ...", "Of these the first ...", "That which ...").

usage: words.py FILE...      A line for each: FILE:LINE: why: the sentence. Exit code 1: there is one.

Markdown is read whole but for its code blocks. In C++, C, SystemVerilog, Python, shell, CMake and YAML files comments are
read, docstrings among them. In C++ files in cli/ the texts are read too, which a person sees on the screen.
"""

import io
import pathlib
import re
import sys
import tokenize

MOST = 35
# "That file" has its noun; "That of", "That is" and "That a file ..." have none.
NO_NOUN = re.compile(
    r"(What|Of|That (a|an|the|of|is|was|which|it|they|no|each|every|what|who|whose|there|these|those|this)"
    r"|Those (of|that|which|who|with|without|are|were|for|in|on))\b(?![^?]*\?$)"
)
END = re.compile(r"(?<=[.!?])[\"')*_]*\s+(?=[\"'(*_`\[]*[A-Z0-9`])")
ENTRY = re.compile(END.pattern + r"|;\s+")
# A list's entry, a name with its meaning in the next column, or a field for Doxygen: it begins a paragraph of its own.
BULLET = re.compile(r"([*+-]|\d+[.)]|@\w+(\[\w+\])?( \w+)?)\s+|[^\s,]+( [A-Z]+)?(, [^\s,]+){0,5},?\s{2,}")


def plain(text):
    """Without marks of Markdown; a piece of code, a link's address and a formula count as one word or none."""
    text = re.sub(r"!\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"`[^`]*`", "CODE", text)
    return re.sub(r"[*_]{1,2}(?=\S)|(?<=\S)[*_]{1,2}", "", text)


def markdown(lines):
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


def blocks(lines, comments):
    """The paragraphs of (line, column, text) of comments: lines that follow one another in one column. An empty line parts them, an
    entry of a list or one beside code begins one, and a line that is set further in stands alone, as tables and code do."""
    begin, at, words, last = 0, None, [], -1
    for line, column, text in comments:
        set_in = text.startswith("   ")
        entry = BULLET.match(text.strip())
        beside = lines[line - 1][:column].strip()
        if words and (line != last + 1 or column != at or not text.strip() or entry or set_in or beside):
            yield begin, " ".join(words), False
            words = []
        last, at = line, column
        text = text.strip()
        if not text or re.match(r"SPDX-|NOLINT|clang-format|shellcheck|verilator |verible|noqa|ruff:", text):
            continue
        if not words:
            begin = line
        words.append(BULLET.sub("", text, count=1) if entry else text)
        if set_in:
            yield begin, " ".join(words), True
            words = []
    if words:
        yield begin, " ".join(words), False


def place(text, offset):
    """(line, column) of an offset."""
    return text.count("\n", 0, offset) + 1, offset - text.rfind("\n", 0, offset) - 1


C_TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<d>[^(\s]*)\(.*?\)(?P=d)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.DOTALL
)


def c_comments(text):
    for token in C_TOKEN.finditer(text):
        line, column = place(text, token.start())
        if token[0].startswith("//"):
            yield line, column, re.sub(r"^///?<? ?", "", token[0])
        elif token[0].startswith("/*"):
            for more, part in enumerate(token[0][2:-2].lstrip("*").split("\n")):
                yield line + more, column, re.sub(r"^\s*\* ?", "", part)


def c_texts(text):
    """Literals of C++, those that stand one after another as one; an end of a line in them ends a paragraph."""
    begin, words, end = 0, "", 0
    for token in C_TOKEN.finditer(text):
        if token[0][0] not in '"R':
            continue
        piece = re.sub(r'^R"[^(]*\(|\)[^()]*"$', "", token[0]) if token[0][0] == "R" else token[0][1:-1]
        if words and text[end : token.start()].strip():
            yield begin, words
            words = ""
        if not words:
            begin = place(text, token.start())[0]
        words += piece.replace("\\n", "\n").replace('\\"', '"')
        end = token.end()
    if words:
        yield begin, words


def hash_comments(text):
    for number, line in enumerate(text.splitlines(), 1):
        if (found := re.match(r"(\s*)#(?!!)( ?)(.*)", line)) is not None:
            yield number, len(found[1]), found[3]
        elif (found := re.match(r"""((?:[^"'#]|"(?:\\.|[^"\\])*"|'[^']*'|(?<=\S)#)*?\s)# (.*)$""", line)) is not None:
            yield number, len(found[1]), found[2]


def python_comments(text):
    before = tokenize.NEWLINE
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            if not token.string.startswith("#!"):
                yield *token.start, re.sub(r"^#\s?", "", token.string)
        elif token.type == tokenize.STRING and before in (tokenize.NEWLINE, tokenize.INDENT, tokenize.NL):
            indent = token.start[1]
            yield token.start[0], indent, ""  # a comment before it is another paragraph
            for more, part in enumerate(re.sub(r'^[rb]*("""|"|\')|("""|"|\')$', "", token.string).split("\n")):
                yield token.start[0] + more, indent, part[indent:] if more else part
        if token.type not in (tokenize.COMMENT, tokenize.NL):
            before = token.type


def paragraphs(path):
    """(line, text, whether semicolons part it) of all that a person reads in a file."""
    text = path.read_text()
    if path.suffix == ".md":
        yield from markdown(text.splitlines())
    elif path.suffix in (".cpp", ".hpp", ".c", ".h", ".sv", ".svh", ".v"):
        yield from blocks(text.splitlines(), c_comments(text))
        if path.parts[0] == "cli":
            yield from ((line, part, True) for line, whole in c_texts(text) for part in whole.split("\n"))
    elif path.suffix == ".py" or text.startswith("#!/usr/bin/env python3"):
        yield from blocks(text.splitlines(), python_comments(text))
    else:
        yield from blocks(text.splitlines(), hash_comments(text))


def faults(path):
    for number, text, cell in paragraphs(path):
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
