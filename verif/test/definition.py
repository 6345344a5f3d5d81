# SPDX-License-Identifier: Apache-2.0
"""definition.py SOURCE: what tools/gen-defs demands of rtl/defs/kage.yaml and rtl/defs/stages.yaml beyond YAML is refused
where it does not hold."""

import pathlib
import sys
import tempfile

top = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(top / "tools/gen_defs"))
from definition import Defs  # noqa: E402
from stages import Stages  # noqa: E402

TEXT = (top / "rtl/defs/kage.yaml").read_text()
XL, XR, W = "{name: xl, bits: X_BITS}", "{name: xr, bits: X_BITS}", '{name: w, bits: "DSF_BITS + 1", signed: true}'
# The injected errors: the text that each stands behind, the old text, the new text; and the message.
INJECTED = [
    ("name: EV,", f"{XL}, {XR}", f"{XR}, {XL}", "tokens: EV: xl is elsewhere"),
    ("name: TP,", XR, "{name: xr, bits: 16}", "tokens: TP: xr is elsewhere"),
    ("name: ES,", XL, "{name: pad, member: null, bits: 1}, " + XL, "tokens: ES: xl is elsewhere"),
    (
        "name: NC,",
        f"{XL}, {XR}, {W}",
        f"{XL}, {XR}, {{name: pad, member: null, bits: 2}}, {W}",
        "tokens: NC: w is elsewhere",
    ),
    (
        "name: FACE,",
        "{name: dz, bits",
        "{name: pad, member: null, bits: 1}, {name: dz, bits",
        "words: entry: is not FACE from index on",
    ),
    ("name: SHAPE", "bits: 6, parameter", "bits: 5, parameter", "registers: SHAPE: LANES: no parameter"),
    ("golden_fields:", "  - {name: alpha,", "  - {name: beta,", "golden_fields: lacks alpha of TP"),
    ("golden_pixel:", "  - {name: fsf,", "  - {name: flag,", "golden_pixel: has other fields"),
    ("golden_pixel:", "times: 8", "times: 7", "golden_pixel: has other fields"),
    ("constants:", "value: 15,", "value: 14,", "constants: line_number_bits: lines of a frame do not fit"),
    ("constants:", "value: 6,", "value: 5,", "constants: unit_number_bits: UNITS do not fit"),
    (
        "constants:",
        "{name: kind_bits,        value: 4,",
        "{name: kind_bits, value: 3,",
        "constants: kind_bits: kinds do not fit",
    ),
    ("name: TREE,", "kind: 5,", "kind: 4,", "tokens: kinds of the level spans are not numbered"),
    (
        "constants:",
        "{name: code_bits,        value: 4,",
        "{name: code_bits, value: 3,",
        "constants: code_bits: errors do not fit",
    ),
]


def said_of(text):
    """The message about a definition; empty for one that is taken."""
    with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
        file.write(text)
        file.flush()
        try:
            defs = Defs(pathlib.Path(file.name))
            defs.golden_numbers(), defs.golden_pixel()
        except SystemExit as e:
            return str(e)
    return ""


def said_of_stages(text):
    """Likewise of rtl/defs/stages.yaml."""
    with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
        file.write(text)
        file.flush()
        try:
            Stages(pathlib.Path(file.name), Defs(top / "rtl/defs/kage.yaml"))
        except SystemExit as e:
            return str(e)
    return ""


failures = [f"as it is: {said_of(TEXT)}"] if said_of(TEXT) else []
for behind, old, new, expected in INJECTED:
    before, mark, rest = TEXT.partition(behind)
    assert old in rest, f"{behind} {old}"
    said = said_of(before + mark + rest.replace(old, new, 1))
    if expected not in said:
        failures.append(f"{behind} {new}: said is {said!r}, not {expected!r}")
stages = (top / "rtl/defs/stages.yaml").read_text()
if said := said_of_stages(stages):
    failures.append(f"stages as they are: {said}")
for old, new, expected in (
    ("{name: blank}, ", "", "stage line: field blank of bus line is no value"),
    ("unwatched: [last], text: color", "text: color", "stage load: field last of bus load is no value"),
    ("{name: dcolor, count: 3}", "{name: dcolor, count: 4}", "stage command: 14 values"),
):
    assert old in stages, old
    said = said_of_stages(stages.replace(old, new, 1))
    if expected not in said:
        failures.append(f"stages: {new}: said is {said!r}, not {expected!r}")
print("\n".join(failures), end="\n" if failures else "")
sys.exit(bool(failures))
