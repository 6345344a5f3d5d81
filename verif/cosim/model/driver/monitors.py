# SPDX-License-Identifier: Apache-2.0
"""Monitors, which tell what passes between modules, and those that do not fit an RTL of other names."""

import pathlib
import re

import sources

MONITORS = sources.only("monitors").parent


def leave_out(monitors, missing, text):
    """Take the monitors that do not fit the RTL from one list to the other; False if that is not all that is wrong. The RTL may have been
    given other names within: then its own stage goes unwatched, and the others do not."""
    wrong = [
        re.match(r"%(?:Error|Warning)(?:-\w+)?: ([^:\s]+\.svh?):\d+", line)
        for line in text.splitlines()
        if line.startswith(("%Error", "%Warning"))
    ]
    places = {pathlib.Path(w[1]).resolve() for w in wrong if w}
    unfit = [m for m in monitors if m.resolve() in places]
    if not unfit or any(p.parent != MONITORS for p in places):
        return False
    for monitor in unfit:
        monitors.remove(monitor)
        missing.append(monitor)
    return True


def unwatched(missing):
    """The driver's constants for monitors that were left out: their names, and the stages that have no events."""
    numbers = (
        dict(re.findall(r"^#define KAGE_STAGE_(\w+) (\d+)$", (MONITORS / "stages.h").read_text(), re.M))
        if missing
        else {}
    )
    told = re.findall(r"\btrace_([a-z]+)|\bkage_trace\(Stage([A-Z][a-z]+)", "".join(m.read_text() for m in missing))
    stages = {(a or b).upper() for a, b in told} & set(numbers) - {"PART"}
    if stages & {"TOKEN", "ERROR"}:  # an error is looked for at the token that it came with
        stages |= {"TOKEN", "ERROR"}
    bits = " | ".join(f"1U << {numbers[s]}" for s in sorted(stages)) or "0"
    return f'const char* const kMissingMonitors = "{", ".join(m.stem for m in missing)}";\nconstexpr std::uint32_t kUnwatched = {bits};\n'
