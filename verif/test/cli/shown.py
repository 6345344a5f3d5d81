# SPDX-License-Identifier: Apache-2.0
"""Runs the commands that a page of documentation shows and compares what they print with what it shows.

usage: shown.py PAGE CODE...

Each "sh" block that is followed by a plain block is run, in the page's order, in the folder at hand; its exit code must
be the CODE at that place. Times ("0.123 s") may be any. A line "..." stands for any lines,
and " ..." at the end of a line for the rest of it.
"""

import difflib
import os
import re
import subprocess
import sys


def timeless(text):
    return re.sub(r"\b\d+\.\d{3} s\b", "0.000 s", text).splitlines()


def fits(shown, printed):
    """Whether the lines are what is shown, where "..." leaves out some."""
    if not shown:
        return not printed
    if shown[0] == "...":
        return any(fits(shown[1:], printed[n:]) for n in range(len(printed) + 1))
    if not printed:
        return False
    whole = shown[0] == printed[0] or (shown[0].endswith(" ...") and printed[0].startswith(shown[0][:-4]))
    return whole and fits(shown[1:], printed[1:])


def main():
    text = open(sys.argv[1]).read()
    codes = [int(c) for c in sys.argv[2:]]
    pairs = re.findall(r"^```sh\n(.*?)^```\n\n```\n(.*?)^```$", text, flags=re.S | re.M)
    if not len(pairs) == len(codes) == text.count("```sh\n"):
        sys.exit(
            f"{sys.argv[1]}: {len(pairs)} commands with output, {len(codes)} exit codes, {text.count('```sh')} commands"
        )
    path = os.getcwd() + "/bin:" + os.environ["PATH"]
    bad = False
    for (commands, shown), code in zip(pairs, codes):
        ran = subprocess.run(["bash", "-c", commands], capture_output=True, text=True, env={**os.environ, "PATH": path})
        if ran.returncode != code or not fits(timeless(shown), timeless(ran.stdout)):
            print(
                f"exit {ran.returncode}",
                ran.stderr,
                *difflib.unified_diff(timeless(shown), timeless(ran.stdout), lineterm=""),
                sep="\n",
            )
            bad = True
    sys.exit(bad)


main()
