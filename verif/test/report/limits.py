# SPDX-License-Identifier: Apache-2.0
"""Runs that do not fit on a page, and names that are no plain text."""

import json
import os
import subprocess

from page import at_rest, check, kage, panel


def full_page(b):
    """Tokens that do not fit: the command instead, and it is right."""
    b.open("full/report.html")
    missing = b.run(
        "(() => { for (const f of Explain.data.frames) for (let y = 0; y < f.height; ++y)"
        " if (!Explain.has(f.frame, y)) return [f.frame, y]; return null; })()"
    )
    check(missing is not None, "all of polyhedra fits: this test needs a larger run")
    if missing:
        frame, y = missing
        b.run(f"Report.select({frame}, 300, {y})")
        at_rest(b, f"{frame}/300/{y}")
        check("has no room for the tokens of this line" in panel(b), "not said that the line is missing")
        line = b.run("document.querySelector('#pixel code').innerText")
        r = subprocess.run(["bash", "-c", line.replace("kage ", f"'{kage}' ", 1)], capture_output=True, text=True)
        check(
            r.returncode == 0 and f"frame {frame}, pixel 300,{y}:" in r.stdout,
            f"{line}: {r.stdout[:100]} {r.stderr[:200]}",
        )


def odd_name(b):
    b.open("odd/report.html")
    name = "a<b>&'\"$x <!-- --> <script>alert(1)"
    check(b.run("document.getElementById('name').innerText") == name, "the name is another")
    check(b.run("document.title").endswith(name), "the title is another")
    line = b.run("document.querySelector('#again .command code').innerText")
    line = line.replace("kage ", f"'{kage}' ", 1).replace("--out odd", "--out odd-again --json -")
    r = subprocess.run(["bash", "-c", line], capture_output=True, text=True)
    check(r.returncode == 0 and json.loads(r.stdout)["seed"] == 9, f"{line}: {r.stderr[:200]}")
    check(os.path.exists("odd-again/report.html"), "the line did not run the same thing")
