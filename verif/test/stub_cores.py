#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/stub-cores tells a test that fails with a stub core from one that does not, and its rows are what docs/schema says.

usage: stub_cores.py SOURCE BUILD      BUILD: a build folder with tests
"""

import json
import pathlib
import subprocess
import sys
import tempfile

SOURCE, BUILD = (pathlib.Path(a).resolve() for a in sys.argv[1:])
TEST = "rtl/families_39_40_41_narrow1"
failures = []


def run(build, folder, *arguments):
    """Exit code, what was printed, rows."""
    file = folder / "stub-cores.1.json"
    command = [
        sys.executable,
        SOURCE / "tools/stub_cores.py",
        SOURCE,
        build,
        "--fault",
        "stub_silent",
        "--json",
        file,
        *arguments,
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr, json.loads(file.read_text()) if file.exists() else []


def expect(what, condition, said):
    if not condition:
        failures.append(f"{what}:\n{said}")


def tests_of(folder, *tests):
    """A build folder with these tests: names and commands."""
    folder.mkdir()
    lines = [f"add_test({name} {' '.join(f'{word!s}' for word in command)})" for name, command in tests]
    (folder / "CTestTestfile.cmake").write_text("\n".join(lines) + "\n")
    return folder


with tempfile.TemporaryDirectory() as name:
    temp = pathlib.Path(name)
    (temp / "json").mkdir()
    code, said, rows = run(BUILD, temp / "json", "--tests", f"^{TEST}$")
    expect("a test that looks at pixels", code == 0, said)
    expect(
        "its rows",
        [(r["core"], r["verdict"], r["uses_core"]) for r in rows]
        == [("sound", "passes", True), ("stub_silent", "fails", True)],
        said,
    )
    checker = [sys.executable, SOURCE / "verif/test/cli/schema.py", SOURCE / "docs/schema", temp / "json"]
    if subprocess.run(checker).returncode != 0:
        failures.append("schema")

    # A test that runs a core and looks at nothing passes with the dead one, which must be told; likewise one that fails
    # before it makes a core.
    listed = json.loads(
        subprocess.run(
            ["ctest", "--test-dir", BUILD, "--show-only=json-v1", "-R", f"^{TEST}$"], capture_output=True, check=True
        ).stdout
    )
    command = listed["tests"][0]["command"]
    blind = temp / "blind.sh"
    blind.write_text('"$@" >/dev/null\nexit 0\n')
    early = temp / "early.sh"
    early.write_text(f'cmp -s "$KAGE_DATA_DIR/rtl/kage_top.sv" "{SOURCE}/rtl/kage_top.sv" || exit 1\n"$@" >/dev/null\n')
    code, said, _ = run(
        tests_of(temp / "a", ("rtl/blind", ["bash", blind, *command])), temp / "a", "--tests", "^rtl/blind$"
    )
    expect("a test that looks at nothing", code == 1 and "PASS with a stub core: rtl/blind (stub_silent)" in said, said)
    code, said, _ = run(
        tests_of(temp / "b", ("rtl/early", ["bash", early, *command])), temp / "b", "--tests", "^rtl/early$"
    )
    expect(
        "a test that ends before its stub core", code == 1 and "before they make a stub core: rtl/early" in said, said
    )
print(*failures, sep="\n", end="\n" if failures else "")
sys.exit(bool(failures))
