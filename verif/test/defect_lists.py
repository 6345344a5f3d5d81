#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every deliberate defect is a change of files that are here, and names what must see it.

usage: defect_lists.py SOURCE BUILD      BUILD: a build folder with tests
"""

import importlib.machinery
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE, BUILD = (pathlib.Path(a).resolve() for a in sys.argv[1:])
sys.dont_write_bytecode = True
sys.path[:0] = [str(SOURCE / "verif/cosim/model/driver"), str(SOURCE / "tools")]
import defects  # noqa: E402
import mutants  # noqa: E402
import selection  # noqa: E402

PROOFS = 'proof() { echo "$1"; }; . verif/test/formal/proofs.bash'
tests = {test["name"] for test in selection.listed(BUILD)}
proofs = set(
    subprocess.run(["bash", "-c", PROOFS], cwd=SOURCE, capture_output=True, text=True, check=True).stdout.split()
)
modules = {"pixels"} | {file.stem for file in (SOURCE / "rtl").glob("*.sv")}

LISTS = importlib.machinery.SourceFileLoader("tool", str(SOURCE / "tools/defects")).load_module().LISTS
# The names that seen_by may have in each list: no name where one test sees the whole list, None where seen_by is any text.
SEERS = {
    "verif/cosim/model/faults.yaml": tests,
    "verif/board/faults.yaml": set(),
    "verif/mutants/mutants.yaml": modules,
    "verif/test/rtl/board_mutants.yaml": tests,
    "verif/test/formal/defects.yaml": proofs,
    "verif/test/cells/defects.yaml": set(),
    "verif/test/examples/defects.yaml": None,
}
# Lists whose defects are tried by the beginning of their name, or by a name that stands in a test.
BEGINNINGS = {
    "verif/test/cells/defects.yaml": ("ice40_", "ecp5_"),
    "verif/test/examples/defects.yaml": ("axi_dma_", "litex_"),
}
BOARD_TEST = (SOURCE / "verif/test/board/rehearsal.cpp").read_text()
NAMED = {"verif/cosim/model/faults.yaml", "verif/test/rtl/board_mutants.yaml", "verif/test/formal/defects.yaml"}

# Lists that must be refused, with words of why; the file is rtl/skid_buffer.sv.
SOUND = "name: a, file: rtl/skid_buffer.sv, was: 'module skid_buffer', is: ''"
REFUSED = {
    "[{file: f, was: a, is: b}]": "without a name",
    f"[{{{SOUND}}}, {{{SOUND}}}]": "two defects a",
    f"[{{{SOUND}, text: x}}]": "unknown keys text",
    f"[{{{SOUND}, changes: []}}]": "either",
    "": "no list",
    "[a]": "no list",
    "{a: b}": "no list",
    "[{": "no YAML",
    "[{name: a, changes: x}]": "no list, or empty",
    "[{name: a, changes: []}]": "no list, or empty",
    "[{name: a, changes: [{file: f, was: x, is: y, inn: z}]}]": "other keys",
    "[{name: a, file: f, was: 1, is: x}]": "are texts",
    "[{name: a, file: f, was: '', is: x}]": "are texts",
    "[{name: a}]": "either",
    "[{name: a, file: f, was: x}]": "lacks is",
    "[{name: a, changes: [{file: f, is: x}]}]": "lacks was",
    f"[{{{SOUND}, lives: x, named: y}}]": "more than one",
    "[{name: a, file: rtl/skid_buffer.sv, was: out_valid_q, is: x}]": "not exactly once: out_valid_q",
    "[{name: a, file: rtl/skid_buffer.sv, was: no such text, is: x}]": "not exactly once: no such text",
    f"[{{{SOUND}, in: module}}]": "not exactly once: module",
}

bad = []


def names_it(test, fault):
    """Whether a test tries the fault: by its own name, or in its script, its program or its list of models. cli/faults tries most
    without a name."""
    if test == "cli/faults":
        return f"{fault} |" not in (SOURCE / "verif/test/cli/faults.sh").read_text()
    sources = [SOURCE / f"verif/test/{test}{end}" for end in (".sh", ".cpp")]
    sources.append(SOURCE / "verif/test/rtl/CMakeLists.txt")
    return test.endswith(f"/fault_{fault}") or any(f.exists() and fault in f.read_text() for f in sources)


def try_list(path, keys):
    """The defects of a list, each put into the texts of its files."""
    listed = defects.load(path, keys)
    for defect in listed.values():
        texts = {}
        for change in defects.changes(defect):
            file = SOURCE / change["file"]
            text = texts.get(file) or file.read_text()
            begin = defects.place(text, change)
            texts[file] = text[:begin] + change["is"] + text[begin + len(change["was"]) :]
            if change["is"] == change["was"]:
                raise defects.DefectError(f"{path}: {defect['name']} changes nothing")
    return listed


with tempfile.TemporaryDirectory() as temp:
    for text, why in REFUSED.items():
        example = pathlib.Path(temp) / "example.yaml"
        example.write_text(text)
        try:
            try_list(example, ())
            bad.append(f"defects.py takes {text}")
        except defects.DefectError as e:
            if why not in str(e):
                bad.append(f"defects.py says of {text}: {e}")

    total = 0
    for path, (keys, _) in LISTS.items():
        seers = SEERS[path]
        try:
            listed = try_list(SOURCE / path, keys)
        except (defects.DefectError, OSError) as e:
            bad.append(f"{path}: {e}")
            continue
        total += len(listed)
        for name, defect in listed.items():
            if not name.startswith(BEGINNINGS.get(path, "")):
                bad.append(f"{path}: {name} is tried by nothing: names begin with one of {BEGINNINGS[path]}")
            if path == "verif/board/faults.yaml" and f'"{name}"' not in BOARD_TEST:
                bad.append(f"{path}: verif/test/board/rehearsal.cpp does not try {name}")
            seer = defect.get("seen_by")
            if path == "verif/cosim/model/faults.yaml" and not names_it(seer, name):
                bad.append(f"{path}: {name}: {seer} does not try it")
            if (seer is None and path in NAMED) or (None not in (seer, seers) and seer not in seers):
                bad.append(f"{path}: {name}: seen_by {seer}: there is none of that name")

    # tools/defects lists them, and refuses a name before it tries another.
    listing = [SOURCE / "tools/defects", "--list"]
    printed = subprocess.run(listing, capture_output=True, text=True).stdout.splitlines()
    if len(printed) != total:
        bad.append(f"tools/defects --list has {len(printed)} defects of {total}")
    refused = subprocess.run([SOURCE / "tools/defects", "skid_spare", "no-such"], capture_output=True, text=True)
    if refused.returncode != 2 or refused.stdout or not refused.stderr.startswith("tools/defects: no-such: no defect"):
        bad.append(f"tools/defects takes no-such: {refused.stdout}{refused.stderr}")

    # All mutants together, behind their select.
    copy = pathlib.Path(temp) / "rtl"
    shutil.copytree(SOURCE / "rtl", copy)
    if mutants.put_in(copy, pathlib.Path(temp) / "package.sv") < 100:
        bad.append("verif/mutants/mutants.yaml: there are few of them")

print(*bad, sep="\n", file=sys.stderr, end="\n" if bad else "")
print(f"{total} defects of {len(LISTS)} lists are changes of files that are here, and {len(REFUSED)} lists are refused")
sys.exit(1 if bad else 0)
