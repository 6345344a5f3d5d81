# SPDX-License-Identifier: Apache-2.0
"""The registers, for the RTL and for drivers in C."""

from expressions import camel
from files import NOTE, SOURCE


def struct(r):
    """(name, bits) from the highest field down to bit 0, gaps with them."""
    parts, at = [], max(f["lsb"] + f["bits"] for f in r["fields"])
    for f in sorted(r["fields"], key=lambda f: -f["lsb"]):
        if f["lsb"] + f["bits"] > at:
            raise SystemExit(f"{SOURCE}: registers: {r['name']}: {f['name']} overlaps another field")
        if f["lsb"] + f["bits"] < at:
            parts.append((f"gap_{at - 1}", at - f["lsb"] - f["bits"]))
        parts.append((f["name"].lower(), f["bits"]))
        at = f["lsb"]
    if at > 0:
        parts.append((f"gap_{at - 1}", at))
    return parts


def registers_svh(defs):
    o = [
        f"// {NOTE}",
        "// SPDX-License-Identifier: Apache-2.0",
        "// Included inside the register module: byte addresses, and the fields of registers that have some.",
        "/* verilator lint_off UNUSEDPARAM */",
    ]
    for r in defs.d["registers"]:
        o.append(f"localparam logic [7:0] Reg{camel(r['name'])} = 8'h{r['addr']:02x};  // {r['access']}")
    o.append(f"localparam logic [7:0] RegLast = Reg{camel(max(defs.d['registers'], key=lambda r: r['addr'])['name'])};")
    for r in defs.d["registers"]:
        if "value" in r:
            o.append(f"localparam logic [31:0] {camel(r['name'])}Value = 32'h{r['value']:08x};")
        if "fields" in r:
            o.append(
                f"localparam int Reg{camel(r['name'])}Bits = {sum(n for _, n in struct(r))};  // up to its highest field"
            )
            o += [
                f"localparam int Reg{camel(r['name'])}{camel(f['name'])}Bits = {f['bits']};"
                for f in r["fields"]
                if f["bits"] > 1
            ]
    o.append("/* verilator lint_on UNUSEDPARAM */")
    for r in defs.d["registers"]:
        if "fields" not in r:
            continue
        o += ["", "typedef struct packed {"]
        o += [f"  logic{'' if bits == 1 else f' [{bits - 1}:0]'} {name};" for name, bits in struct(r)]
        o += [f"}} reg_{r['name'].lower()}_t;"]
    o.append("")
    return "\n".join(o)


def registers_h(defs):
    o = [
        f"/* {NOTE} */",
        "/* SPDX-License-Identifier: Apache-2.0 */",
        "/* clang-format off */",
        "",
        "/** @file",
        " * The core's registers, by byte addresses, and the codes of its errors: for drivers in C (docs/stream.md, docs/integration.md). */",
        "#ifndef KAGE_REGISTERS_H",
        "#define KAGE_REGISTERS_H",
        "",
    ]
    for r in defs.d["registers"]:
        o.append(f"#define KAGE_REG_{r['name']} 0x{r['addr']:02X}u /**< {r['access']}: {r['doc']} */")
    last = max(defs.d["registers"], key=lambda r: r["addr"])
    o.append(f"#define KAGE_REG_LAST KAGE_REG_{last['name']} /**< behind it there is none */")
    for r in defs.d["registers"]:
        if "value" in r:
            o.append(f"#define KAGE_{r['name']}_VALUE 0x{r['value']:08X}u /**< what {r['name']} always is */")
    o += [
        "",
        "/** A field of a register's value: KAGE_FIELD(value, KAGE_ERROR_CODE). */",
        "#define KAGE_FIELD(value, field) (((value) & field##_MASK) >> field##_SHIFT)",
        "/** The field alone, as part of a register's value. */",
        "#define KAGE_FIELD_IS(field, number) (((number) << field##_SHIFT) & field##_MASK)",
        "",
    ]
    for r in defs.d["registers"]:
        for f in r.get("fields", []):
            name, mask = f"KAGE_{r['name']}_{f['name']}", ((1 << f["bits"]) - 1) << f["lsb"]
            o.append(f"#define {name}_SHIFT {f['lsb']}u /**< {r['name']}: {f['doc']} */")
            o.append(f"#define {name}_MASK 0x{mask:08X}u /**< its bits */")
    o += [""] + [f"#define KAGE_ERR_{e['name']} {e['code']}u /**< {e['doc']} */" for e in defs.d["errors"]]
    o += ["", "#endif", ""]
    return "\n".join(o)
