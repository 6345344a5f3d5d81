# SPDX-License-Identifier: Apache-2.0
"""Python files import and name nothing that their folders may not, and no imports make a circle: a part of layers.py."""

import ast
import posixpath
import sys

from rooms import IMPORTS, JUDGES, PRODUCTS, is_below


def constants(node):
    return [n.value for n in ast.walk(node) if isinstance(n, ast.Constant) and isinstance(n.value, str)]


def added(path, tree):
    """The folders that a file adds to sys.path, those before its own and those behind. A text in the statement names a folder
    from the source's root or from the file's folder. Without a text the number of parents of __file__ does."""
    before, behind, here = [], [], posixpath.dirname(path)
    for node in ast.walk(tree):
        if not isinstance(node, (ast.Expr, ast.Assign)) or not ast.unparse(node).startswith("sys.path"):
            continue
        values = node.value.args[-1:] if isinstance(node, ast.Expr) else node.value.elts
        for value in values:
            texts = [text.strip("/") for text in constants(value)]
            folders = [f for text in texts for f in (text, posixpath.join(here, text))]
            if not texts:
                up = [".."] * (ast.unparse(value).count(".parent") - 1)
                folders = [posixpath.normpath(posixpath.join(here, *up))]
            (before if "insert(0" in ast.unparse(node) else behind).extend(folders)
    return before, behind


def module(folder, name, files):
    """The file of a module below a folder, or None."""
    stem = posixpath.normpath(posixpath.join(folder, *name.split(".")))
    return next((f for f in (f"{stem}.py", f"{stem}/__init__.py") if f in files), None)


def imports(path, text, files):
    """The files that a file imports. A module that none of its folders has is looked for in all: PYTHONPATH may name one."""
    tree, found = ast.parse(text), set()
    before, behind = added(path, tree)
    own = [*before, posixpath.dirname(path), *behind]
    everywhere = own + sorted(
        {up for f in files for up in (posixpath.dirname(f), posixpath.dirname(posixpath.dirname(f)))}
    )
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            asked = [(alias.name, []) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            asked = [(node.module or ".", [alias.name for alias in node.names])]
        else:
            continue
        up = getattr(node, "level", 0)
        for name, parts in asked:
            if up:
                folders = [posixpath.normpath(posixpath.join(posixpath.dirname(path), *[".."] * (up - 1)))]
            elif name.split(".")[0] in sys.stdlib_module_names:
                continue
            else:
                folders = everywhere
            for folder in folders:
                of_parts = [module(folder, f"{name}.{part}".strip("."), files) for part in parts]
                whole = [module(folder, name, files)] if not parts or None in of_parts else []
                here = {f for f in (*of_parts, *whole) if f}
                found |= here
                if here:
                    break
    return found


def may_import(path, target):
    """Whether the file of one path may import that of the other: by the longest path in the table that the first has."""
    rows = [folder for folder in IMPORTS if is_below(path, [folder])]
    if not rows:
        return posixpath.dirname(path) == posixpath.dirname(target)
    own = max(rows, key=len)
    return is_below(target, [own, *IMPORTS[own]])


def refused(path, text, files):
    """A line for each thing that a file of this path may not have."""
    bad = {f"imports {t}, which its folder may not" for t in imports(path, text, files) if not may_import(path, t)}
    if is_below(path, PRODUCTS):
        tree = ast.parse(text)
        said = {id(n.value) for n in ast.walk(tree) if isinstance(n, ast.Expr)}  # what documents, and does nothing
        names = [n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and id(n) not in said]
        named = {n for n in names if isinstance(n, str) and any(f"{room}/" in f"{n}/" for room in JUDGES)}
        bad |= {f"names {n}, and no product has a file of it" for n in named}
    return sorted(bad)


def circle(graph):
    """The files of a circle, the first again at its end; none where there is none."""
    done, way = set(), []

    def follow(file):
        if file in way:
            return [*way[way.index(file) :], file]
        if file in done:
            return []
        way.append(file)
        found = next((c for c in map(follow, sorted(graph.get(file, ()))) if c), [])
        way.pop()
        done.add(file)
        return found

    return next((c for c in map(follow, sorted(graph)) if c), [])


EXAMPLES = (  # each must be refused
    ("verif/board/sim/build_board.py", 'import sys\nsys.path.append(str(TOP / "verif/test/cli"))\nimport fst'),
    ("verif/board/sim/build_board.py", 'PATTERNS = ("rtl/*.sv", "verif/test/formal/stream_rules.sv")'),
    ("verif/board/sim/build_board.py", 'folders = (BOARDS / "sim", "verif/mutants")'),
    ("verif/cosim/model/driver/build.py", 'def f():\n    sys.path.insert(0, f"{TOP}/tools")\n    import kept_rows'),
    ("python/kage/pack.py", "from tool.graph import Graph"),
    ("scenes/maker/gem.py", "import kage"),
    ("tools/words.py", 'sys.path.insert(0, str(TOP / "verif/test/report"))\nfrom page import check'),
    ("tools/gen_defs/tables.py", "import kept_rows"),
    ("hls/tool/graph.py", "from kage import stream"),
    ("hls/tool/graph.py", "from ...verif.test import links"),
    ("constraints/more.py", "import rooms"),
)
CIRCLES = (  # each must be found: files by path, with their text
    {"a/b.py": "import c", "a/c.py": "def f():\n    from b import g"},
    {
        "a/t/__main__.py": "sys.path.append(str(P(__file__).resolve().parent.parent))\nfrom t import r",
        "a/t/r.py": "from .__main__ import f",
    },
    {"k/a.py": "import k.b", "k/b.py": "from k import c", "k/c.py": "from . import a"},
)


def faults(files):
    """A line for each thing that a file may not have, and for what this file has wrong."""
    for path, text in EXAMPLES:
        if not refused(path, text, files):
            yield f"python_imports.py lets {path} say {text}"
    for texts in CIRCLES:
        if not circle({path: imports(path, text, texts) for path, text in texts.items()}):
            yield f"python_imports.py sees no circle of {' and '.join(texts)}"
    for path, text in files.items():
        yield from (f"{path}: {what}" for what in refused(path, text, files))
    found = circle({path: imports(path, text, files) for path, text in files.items()})
    if found:
        yield f"a circle of imports: {' -> '.join(found)}"
    if len(files) < 100:
        yield f"python_imports.py: found {len(files)} files only"
