# SPDX-License-Identifier: Apache-2.0
"""kage_widths.svh: the widths of what passes between modules, as localparams of their parameter lists."""

from expressions import camel
from files import NOTE


def number(defs, n):
    """A derived number as a localparam."""
    kind, value = "int", defs.sv_expr(n["value"])
    if n["is"] == "flag":
        kind = "bit"
    elif "bits" in n:
        bits = defs.sv_expr(n["bits"])
        kind, value = f"logic [{bits}-1:0]", f"{bits}'({value})"
    return f"localparam {kind} {defs.sv_name(n['name'])} = {value},  // {n['doc']}"


def places(defs, word):
    """Where the fields of a word are."""
    before, o = [], []
    for f in word["fields"]:
        at = " + ".join(before) or "0"
        place = f"{defs.sv_bits(f)} > 0 ? {at} : 0" if f["lacks"] and before else at
        o.append(f"localparam int {camel(word['name'])}{camel(f['name'])}At = {place},  // {f['doc']}")
        before.append(defs.sv_bits(f))
    return o


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
    o += [f"localparam int {camel(c['name'])} = {c['value']},  // {c['doc']}" for c in defs.d["constants"]]
    o += [number(defs, n) for n in defs.d["derived"]]
    o += ["// Words whose fields a configuration may lack: where they are; 0, and not to be read, if they are not."]
    for w in defs.d["words"]:
        o += places(defs, w)
    o += ["// The buses of kage_buses.svh."]
    for b in defs.d["buses"]:
        bits = " + ".join(defs.sv_bits(f) for f in b["fields"])
        o.append(f"localparam int {camel(b['name'])}Bits = {bits},  // {b['doc']}")
    o += ["// Commands without token, by kinds that never become commands."]
    o += [
        f"localparam logic [KindBits-1:0] Cmd{camel(c['name'])} = KindBits'({c['kind']}),  // {c['doc']}"
        for c in defs.d["commands"]
    ]
    o += ["/* verilator lint_on UNUSEDPARAM */", "// verilog_lint: waive-stop line-length", ""]
    return "\n".join(o)
