#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The table of families in docs/testing.md is that of the tests: each "family N" of a test's name stands in the table beside its
# file, and each row's file names the family.
#
# usage: families.sh SOURCE_DIR
set -euo pipefail
cd "$1"
python3 - <<'PY'
import pathlib, re, sys
table = {}  # family: text of its test column
for line in pathlib.Path("docs/testing.md").read_text().splitlines():
    row = re.match(r"\| (\d+) \| [^|]+ \| ([^|]+) \|$", line)
    if row:
        table[int(row[1])] = row[2]
named = {}  # family: ctest names
tests = pathlib.Path("verif/test")
for path in sorted(tests.rglob("*.cpp")):
    for n in re.findall(r'TEST_CASE\(\s*"family (\d+)', path.read_text()):
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
if not named or not table:
    print("families.sh: found no families"); bad = 1
sys.exit(bad)
PY
