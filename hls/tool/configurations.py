# SPDX-License-Identifier: Apache-2.0
"""The named configurations of the core (rtl/defs/configs.yaml), as far as a kernel's parameters go. No kernel has light after
light, so those with LINEAR_BITS are left out."""

from __future__ import annotations

import pathlib

import yaml

TOP = pathlib.Path(__file__).resolve().parent.parent.parent


def configurations(names: list[str]) -> dict[str, dict[str, int]]:
    """For each set of values that these parameters have, the first configuration that has it."""
    definition = yaml.safe_load((TOP / "rtl/defs/kage.yaml").read_text())
    defaults = {p["name"]: p["default"] for p in definition["pixel_params"]}
    found: dict[str, dict[str, int]] = {}
    for config, given in yaml.safe_load((TOP / "rtl/defs/configs.yaml").read_text()).items():
        if (given or {}).get("LINEAR_BITS"):
            continue
        values = {name: (given or {}).get(name, defaults[name]) for name in names}
        if values not in found.values():
            found[config] = values
    return found
