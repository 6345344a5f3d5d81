#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The table of families in docs/testing.md is that of the tests: each "family N" of a test's name stands in the table beside its
# file, and each row's file names the family. The last column, what a campaign came to, has every check that kage_extremes
# knows of the family.
#
# usage: families.sh SOURCE_DIR KAGE_EXTREMES
set -euo pipefail
cd "$1"
python3 - "$2" <<'PY'
import pathlib, re, subprocess, sys
table = {}  # family: text of its test column
figures = {}  # family: text of its last column
for line in pathlib.Path("docs/testing.md").read_text().splitlines():
    row = re.match(r"\| (\d+) \| [^|]+ \| ([^|]+) \| ([^|]+) \|$", line)
    if row:
        table[int(row[1])] = row[2]
        figures[int(row[1])] = row[3]
named = {}  # family: ctest names
tests = pathlib.Path("verif/test")
for path in sorted(tests.rglob("*.cpp")):
    for numbers in re.findall(r'TEST_CASE\(\s*"(?:family|families) ((?:\d+|, | and )+)', path.read_text()):
        for n in re.findall(r"\d+", numbers):
            named.setdefault(int(n), set()).add(str(path.relative_to(tests).with_suffix("")))
for name in re.findall(r"core_test\((famil(?:y|ies)_[0-9_]+)", pathlib.Path("verif/test/rtl/CMakeLists.txt").read_text()):
    for n in re.findall(r"\d+", name):
        named.setdefault(int(n), set()).add("rtl/" + name + "*")
bad = 0
for n in sorted(named.keys() | table.keys()):
    for test in named.get(n, []):
        if f"`{test}`" not in table.get(n, ""):
            print(f"docs/testing.md: family {n} has the test {test}, the table does not say so"); bad = 1
    for test in re.findall(r"`((?:extremes|unit|scene|rtl)/[^`]+)`", table.get(n, "")):
        if test not in named.get(n, []):
            print(f"docs/testing.md: family {n}: {test} names no such family"); bad = 1
for line in subprocess.run([sys.argv[1], "--list"], capture_output=True, text=True, check=True).stdout.splitlines():
    part = re.match(r"(\d+) ?(\w*) ", line)
    if part and part[2] not in figures.get(int(part[1]), ""):
        print(f"docs/testing.md: family {part[1]}: no figure of its check \"{part[2]}\""); bad = 1
    if part and int(part[1]) not in figures:
        print(f"docs/testing.md: no row for family {part[1]}"); bad = 1
if not named or not table:
    print("families.sh: found no families"); bad = 1
sys.exit(bad)
PY
