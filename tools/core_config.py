#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""core_config.py NAME: the parameters of a core that rtl/defs/configs.yaml or constraints/cores.yaml names, as PARAMETER: value
lines, which `kage --config FILE` takes."""

import pathlib
import sys

import yaml

TOP = pathlib.Path(__file__).resolve().parent.parent
known = {}
for path in ("rtl/defs/configs.yaml", "constraints/cores.yaml"):
    known |= yaml.safe_load((TOP / path).read_text())
if sys.argv[1] not in known:
    sys.exit(f"{sys.argv[1]}: no such configuration; there are {', '.join(known)}")
for name, value in (known[sys.argv[1]] or {}).items():
    print(f"{name}: {value}")
