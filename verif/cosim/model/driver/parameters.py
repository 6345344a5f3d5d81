# SPDX-License-Identifier: Apache-2.0
"""The parameters of a model: rtl/defs/kage.yaml."""

import yaml
from sources import only
from steps import fail

DEFS = only("parameters")


def parameters(arguments):
    """The value of each parameter of the core: that of PARAM=VALUE, or its default."""
    defs = yaml.safe_load(DEFS.read_text())
    values = {p["name"]: p["default"] for p in defs["pixel_params"] + defs["impl_params"]}
    for argument in arguments:
        name, equals, value = argument.partition("=")
        if not equals or name not in values:
            fail(f"{argument}: not PARAM=VALUE with a parameter of {DEFS}")
        try:
            values[name] = int(value, 0)
        except ValueError:
            fail(f"{argument}: {value} is not a whole number")
    return values


def pixel_parameters():
    """The names of those that change pixels."""
    return [p["name"] for p in yaml.safe_load(DEFS.read_text())["pixel_params"]]
