# SPDX-License-Identifier: Apache-2.0
"""Events that monitors report (rtl/defs/stages.yaml), for SystemVerilog and for the C that its testbench links."""

import yaml
from expressions import camel
from files import STAGES, STAGES_NOTE


class Stages:
    """Events that monitors report (rtl/defs/stages.yaml)."""

    def __init__(self, path, defs):
        self.d = yaml.safe_load(path.read_text())
        buses = {bus["name"]: {f["name"] for f in bus["fields"]} for bus in defs.d["buses"]}
        for stage in self.d["stages"]:
            at = 0
            for value in stage["values"]:
                value["at"] = at
                at += value.get("count", 1)
            if at > self.d["values"]:
                raise SystemExit(f"{STAGES}: stage {stage['name']}: {at} values, and an event holds {self.d['values']}")
            watched = {v["name"] for v in stage["values"]} | set(stage.get("unwatched", ()))
            for field in sorted(buses[stage["bus"]] - watched if "bus" in stage else ()):
                raise SystemExit(
                    f"{STAGES}: stage {stage['name']}: field {field} of bus {stage['bus']} is no value of it"
                )

    def numbered(self):
        """Stages with their numbers, the handshakes last."""
        return enumerate([s["name"] for s in self.d["stages"]] + ["handshake"])

    def handshake_bits(self):
        bits = [f"{p['name']}_{side}" for p in self.d["ports"] for side in ("ready", "valid")]
        return bits + self.d["handshake_flags"]

    def c(self):
        o = [
            f"/* {STAGES_NOTE} */",
            "/* SPDX-License-Identifier: Apache-2.0 */",
            "/* clang-format off */",
            "#ifndef KAGE_STAGES_H",
            "#define KAGE_STAGES_H",
            "",
        ]
        o += [f"#define KAGE_STAGE_{name.upper()} {number}" for number, name in self.numbered()]
        o += ["", "#endif", ""]
        return "\n".join(o)

    def sv_numbers(self):
        o = [f"// {STAGES_NOTE}", "// SPDX-License-Identifier: Apache-2.0", "// Included by kage_trace.svh."]
        o += [f"localparam int Stage{camel(name)} = {number};" for number, name in self.numbered()]
        o += [f"localparam int Part{camel(p['name'])} = {i};" for i, p in enumerate(self.d["parts"])]
        bits = self.handshake_bits()
        o += [f"localparam int Handshake{camel(name)} = {i};" for i, name in enumerate(bits)]
        o += [f"localparam int HandshakeBits = {len(bits)};", f"localparam int TraceValues = {self.d['values']};", ""]
        return "\n".join(o)

    def sv_functions(self):
        o = [
            f"// {STAGES_NOTE}",
            "// SPDX-License-Identifier: Apache-2.0",
            "// Included by kage_trace.svh: an event of each stage, its values by name.",
            "// verilog_lint: waive-start line-length",
        ]
        for s in self.d["stages"]:
            if s["name"] == "part":
                continue  # kage_trace_part of kage_trace.svh, which the driver takes apart
            # v_: names of their own beside those of a monitor's ports.
            ports = "".join(f", input logic [{64 * v.get('count', 1) - 1}:0] v_{v['name']}" for v in s["values"])
            names = ", ".join("v_" + v["name"] for v in reversed(s["values"]))
            values = f"TraceBits'({{{names}}})" if names else "'0"
            o += [
                "",
                f"function automatic void trace_{s['name']}(input int v_unit_at{ports});",
                f"  kage_trace(Stage{camel(s['name'])}, v_unit_at, {values});",
                "endfunction",
            ]
        o += ["// verilog_lint: waive-stop line-length", ""]
        return "\n".join(o)
