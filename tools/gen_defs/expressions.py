# SPDX-License-Identifier: Apache-2.0
"""Names and expressions of the definition files as each language has them."""

import re


def camel(name):
    return "".join(part.capitalize() for part in name.lower().split("_"))


def cpp_expr(expr, names):
    """A width expression as C++: parameters become members of Config."""
    return re.sub(
        r"[A-Z][A-Z0-9_]*", lambda m: "c." + m.group(0).lower() if m.group(0) in names else m.group(0), str(expr)
    )


def linked(expr, form):
    """An expression with its <name>s in the given form, in which \\1 is the name."""
    return re.sub(r"<(\w+)>", form, str(expr))


def js_expr(expr):
    """An expression as JavaScript: parameters become members of c, <name>s calls of what they stand for."""
    if isinstance(expr, bool):
        return "true" if expr else "false"
    return linked(re.sub(r"\b([A-Z][A-Z0-9_]*)\b", r"c.\1", str(expr)), r"derived.\1(c)")


def py_expr(expr):
    """The same as Python, whose conditional stands in another order."""
    if isinstance(expr, bool):
        return str(expr)
    # Parts in parentheses go first, and stand as @number@ till the rest is done.
    text, inner = str(expr), []
    while group := re.search(r"\(([^()]*)\)", text):
        inner.append(group.group(1))
        text = f"{text[: group.start()]}@{len(inner) - 1}@{text[group.end() :]}"

    def done(text):
        condition, question, rest = text.partition(" ? ")
        if question:
            yes, _, no = rest.partition(" : ")
            return f"{done(yes)} if {done(condition)} else {done(no)}"
        text = re.sub(r"\b([A-Z][A-Z0-9_]*)\b", r"c.\1", text.replace("&&", "and").replace("||", "or"))
        text = linked(text, r'DERIVED["\1"](c)')
        return re.sub(r"@(\d+)@", lambda m: f"({done(inner[int(m.group(1))])})", text)

    return done(text)


def quoted(text):
    """A text as C++ and Python have it."""
    return '"' + text.replace('"', '\\"') + '"'


def plain(expr):
    """An expression for a reader."""
    return linked(expr, r"\1")
