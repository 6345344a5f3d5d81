# SPDX-License-Identifier: Apache-2.0
"""kage_widths.svh: the widths of what passes between modules, as localparams of their parameter lists."""

from expressions import camel
from files import NOTE


def widths(defs):
    o = [
        f"// {NOTE}",
        "// SPDX-License-Identifier: Apache-2.0",
        "// Part of a module's parameter list, right after kage_pixel_params.svh: the widths of the buses between modules, and",
        "// what they carry. A bus whose feature is absent keeps one bit, tied to 0, because SystemVerilog has no vectors",
        "// without bits.",
        "// verilog_lint: waive-start line-length",
        "/* verilator lint_off UNUSEDPARAM */",
    ]
    for n in defs.d["derived"]:
        o.append(f"localparam int {defs.sv_name(n['name'])} = {defs.sv_expr(n['value'])},  // {n['doc']}")
    o += ["// The buses of kage_buses.svh."]
    for b in defs.d["buses"]:
        bits = " + ".join(defs.sv_bits(f) for f in b["fields"])
        o.append(f"localparam int {camel(b['name'])}Bits = {bits},  // {b['doc']}")
    o += ["// Commands without token, by kinds that never become commands."]
    o += [f"localparam logic [3:0] Cmd{camel(c['name'])} = 4'd{c['kind']},  // {c['doc']}" for c in defs.d["commands"]]
    o += ["/* verilator lint_on UNUSEDPARAM */", "// verilog_lint: waive-stop line-length", ""]
    return "\n".join(o)
