# SPDX-License-Identifier: Apache-2.0
"""How long operations take on a device: hls/tool/delays/DEVICE.json, measured by hls/tool/characterise."""

from __future__ import annotations

import json
import pathlib
from dataclasses import dataclass

from .graph import Node


@dataclass
class Delays:
    device: str
    tile: int  # bits of a multiplier's factor
    register: float  # ns from a clock's edge to a value, and from a value to the next edge
    lines: dict[str, tuple[float, float]]  # ns of an operation: first + each bit

    @staticmethod
    def read(path: pathlib.Path) -> Delays:
        j = json.loads(path.read_text())
        return Delays(j["device"], j["tile"], j["register_ns"], {k: tuple(v) for k, v in j["operations"].items()})

    def of(self, n: Node) -> float:
        kind, width = n.op, n.width
        if kind in ("sub", "ult", "slt"):
            kind, width = "add", n.args[0].width
        if kind == "add" and n.args[1].op == "const" and width == 1:
            kind = "logic"
        if kind in ("and", "or", "xor"):
            if n.args[1].op == "const":
                return 0.0  # a NOT is part of what reads it
            kind = "logic"
        if kind == "eq":
            width = n.args[0].width
        first, each = self.lines[kind]
        return first + each * width
