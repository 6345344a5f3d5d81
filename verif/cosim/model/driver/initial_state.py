# SPDX-License-Identifier: Apache-2.0
"""The initial state of registers and memories, as the model's seed decides it."""

import re

from steps import fail


def name_initial_state(obj):
    """Let every register's and memory's first value follow from seed and name (kage_initial() of from_verilator.cpp),
    not from the order in which Verilator draws them. So a model with monitors or waveforms starts as the plain one."""
    name = r"(vlSelf->(\w+)((?:\[\w+\])*))"
    for path in sorted(obj.glob("*.cpp")):
        text = path.read_text()
        if "VL_RAND_RESET" not in text:
            continue

        def index(places):
            return (
                " + ".join(f"{1 << 20 * i}ULL * {at}" for i, at in enumerate(re.findall(r"\[(\w+)\]", places))) or "0"
            )

        text = re.sub(
            name + r"\s*= VL_RAND_RESET_[IQ]\((\d+)\);",
            lambda m: f'{m[1]} = kage_initial({m[4]}, "{m[2]}", {index(m[3])});',
            text,
        )
        text = re.sub(
            r"VL_RAND_RESET_W\((\d+), " + name + r"\);",
            lambda m: f'kage_initial_words({m[1]}, {m[2]}, "{m[3]}", {index(m[4])});',
            text,
        )
        if (
            "VL_RAND_RESET" in text or "___024root" not in path.name
        ):  # a name says where in the whole core, since --flatten leaves one module
            fail(f"this Verilator draws the initial state in a way that is not known: {path.name}")
        path.write_text(text)
