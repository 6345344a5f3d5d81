#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tools/selection.py: a change selects the tests that it concerns, and a selected test has all built that it needs.

usage: selection.py SOURCE_DIR BUILD_DIR
"""

import pathlib
import re
import sys

source, build = (pathlib.Path(word).resolve() for word in sys.argv[1:])
sys.path.insert(0, str(source / "tools"))
import selection  # noqa: E402

EXAMPLES = (  # changed files, tests that they concern, tests that they do not
    (
        "ref/image/diff.cpp",
        "unit/image/diff cli/diff contract/layers",
        "unit/order/ways rtl/lane_ramp extremes/family_1",
    ),
    ("ref/image/png_chunks.cpp", "unit/image/files", "unit/order/ways"),
    ("ref/scene/plain/obj_file.cpp", "unit/scene/obj", "unit/order/ways cli/diff"),
    ("ref/geometry/light.cpp", "unit/geometry/light extremes/family_29", "unit/image/diff unit/file/paths"),
    ("verif/extremes/depth.cpp", "extremes/family_3", "unit/image/diff"),
    ("verif/test/support/catch.hpp", "unit/image/diff unit/order/ways", "cli/diff"),
    ("verif/test/cli/common.bash", "cli/diff cli/usage", "unit/order/ways"),
    ("verif/test/unit/order/ways.cpp", "unit/order/ways simd/emu128/unit/order/ways", "unit/order/build"),
    ("cli/diff.cpp", "cli/diff cli/diff_streams", "cli/sweep unit/image/diff"),
    (
        "rtl/lane_ramp.sv",
        "rtl/lane_ramp rtl/pixel_core rtl/kage_top rtl/elaborate_slang",
        "rtl/uart formal/skid_buffer",
    ),
    ("rtl/board/uart_link.sv", "rtl/uart_link", "rtl/lane_ramp rtl/kage_top"),
    ("rtl/skid_buffer.sv", "formal/skid_buffer rtl/stream_cells", "rtl/tmds"),
    ("verif/test/formal/queue_rules.sv", "formal/skid_buffer formal/stream_fifo", "rtl/lane_ramp"),
    ("verif/cosim/model/faults.yaml", "rtl/fault_lost_token unit/cosim/faults", "unit/order/ways"),
    ("rtl/include/kage_pixel_next.svh", "rtl/elaborate_slang rtl/tb rtl/cells hls/proofs rtl/pixel_core", "rtl/uart"),
    ("rtl/ram_1r1w.sv", "gates/models_ice40 rtl/cells rtl/stream_cells", "rtl/tmds"),
    ("verif/cosim/model/cells/ecp5.v", "gates/models_ecp5", "rtl/tmds"),
    ("verif/test/support/fake_board.cpp", "cli/board", "cli/diff"),
    ("verif/test/support/import_answers.cpp", "unit/scene/import", "cli/diff"),
    ("ref/include/kage/golden.h", "examples/c python/module unit/bind/golden_c", "cli/diff"),
    ("ref/plugin/plugin.cpp", "cli/plugins", "rtl/tmds"),
    ("scenes/courtyard.gltf", "scene/builtin cli/cosim", "rtl/tmds"),
    ("docs/lights.md", "contract/links docs/families", "unit/geometry/light"),
)
NEEDS = (  # options of ctest, outputs that must be built, outputs that must not
    (["-R", "^unit/image/diff$"], {"verif/bin/unit_image_diff"}, {"bin/kage", "verif/bin/rtl_modules", "all"}),
    (["-R", "^cli/diff$"], {"bin/kage"}, {"verif/bin/unit_image_diff", "all"}),
    (["-R", "^extremes/family_40$"], {"verif/bin/kage_extremes", "verif/test/rtl/flat4.so"}, {"bin/kage", "all"}),
    (["-R", "^contract/layers$"], set(), {"bin/kage", "all"}),
    (["-R", "^package/consumer$"], {"all"}, set()),
)

UNREAD = ("verif/test/sanitize/race.cpp",)  # its test is there under the thread sanitizer alone

bad = []
tree, tests = selection.Tree(source), selection.listed(build)
names = {test["name"] for test in tests}
benches = "contract/counted" in names
for file, those, not_those in EXAMPLES:
    if file not in tree.files:
        bad.append(f"{file}: no such file")
        continue
    chosen, unread = selection.concerned(tree, tests, [file])
    bad += [f"{file} does not select {name}" for name in those.split() if name in names and name not in chosen]
    bad += [f"{file} selects {name}" for name in not_those.split() if name in chosen]
    bad += [f"selection.py: there is no test {name}" for name in those.split() + not_those.split() if name not in names]
for file in ("CMakeLists.txt", "rtl/defs/kage.yaml", "verif/test/rtl/CMakeLists.txt"):
    if selection.concerned(tree, tests, [file])[0] is not None:
        bad.append(f"{file} does not concern all tests")
if selection.concerned(tree, tests, ["NOTICE"])[1] != ["NOTICE"]:
    bad.append("a file that no test reads is not named")
# Every source file has a test that reads it.
for file in sorted(tree.files):
    if file.startswith(("ref/", "cli/", "rtl/", "verif/")) and file.endswith(
        (".cpp", ".hpp", ".h", ".sv", ".svh", ".v")
    ):
        if (file.startswith("verif/bench/") and not benches) or file in UNREAD:
            continue
        if selection.concerned(tree, tests, [file])[1]:
            bad.append(f"no test reads {file}")
# At night every test that has a stamp is run.
nightly = re.findall(r"^tools/test [^\n]*?-R '([^']+)'", (source / ".ci/nightly").read_text(), re.M)
for test in tests:
    if any(word.endswith("tools/stamped.py") for word in test["command"]) and not any(
        re.search(p, test["name"]) for p in nightly
    ):
        bad.append(f".ci/nightly leaves out {test['name']}, which has a stamp")
for options, made, not_made in NEEDS:
    found = set(selection.needs(build, options))
    if made - found or not_made & found:
        bad.append(f"{options}: builds {sorted(found)}")
print("\n".join(bad) or f"{len(EXAMPLES)} changes and {len(NEEDS)} selections as they should be")
sys.exit(1 if bad else 0)
