# SPDX-License-Identifier: Apache-2.0
"""Parameters in SystemVerilog: lists for modules and instances, and the check of their ranges and rules.

Parameter lists are includes, not macros: Verible parses the former only. A module's pixel parameters come first, so their
list ends in a comma; an instance's come last, so the other list does.
"""

from files import NOTE


def params(defs, group):
    tail = "," if group is defs.pixel else ""
    body = ",\n".join(f"parameter int {p['name']} = {p['default']}" for p in group)
    return (
        f"// {NOTE}\n// SPDX-License-Identifier: Apache-2.0\n// Part of a module's parameter list.\n"
        f"/* verilator lint_off UNUSEDPARAM */\n{body}{tail}\n/* verilator lint_on UNUSEDPARAM */\n"
    )


def param_map(defs, group):
    tail = "," if group is defs.impl else ""  # those that affect pixels are an instance's last
    body = ",\n".join(f".{p['name']}({p['name']})" for p in group)
    return (
        f"// {NOTE}\n// SPDX-License-Identifier: Apache-2.0\n"
        f"// Part of an instance's parameter list: each passed on by name.\n{body}{tail}\n"
    )


def checks(defs):
    o = [
        f"// {NOTE}",
        "// SPDX-License-Identifier: Apache-2.0",
        "// Included inside the top module: a parameter out of its range stops elaboration.",
        "// verilog_lint: waive-start line-length",
    ]
    for p in defs.pixel + defs.impl:
        if "allowed" in p:
            bad = " && ".join(f"{p['name']} != {v}" for v in p["allowed"])
            legal = "one of " + " ".join(map(str, p["allowed"]))
        else:
            bad, legal = f"{p['name']} < {p['min']} || {p['name']} > {p['max']}", f"{p['min']} .. {p['max']}"
        o += [
            f"if ({bad}) begin : gen_bad_{p['name'].lower()}",
            f'  `KAGE_ILLEGAL("{p["name"]} must be {legal}")',
            "end",
        ]
    for r in defs.d["rules"]:
        o += [f"if (!({r['legal']})) begin : gen_bad_{r['name']}", f'  `KAGE_ILLEGAL("{r["doc"]}")', "end"]
    o += ["// verilog_lint: waive-stop line-length", ""]
    return "\n".join(o)
