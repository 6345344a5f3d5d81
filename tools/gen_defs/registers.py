# SPDX-License-Identifier: Apache-2.0
"""Registers, for the RTL and for drivers in C: the core's of rtl/defs/kage.yaml, a board's of rtl/defs/board.yaml."""

from expressions import camel
from files import BOARD, BOARD_NOTE, NOTE, SOURCE


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


def svh(note, inside, registers, bits):
    """Addresses, values and fields in SystemVerilog; an address has so many bits."""

    def address(name, at, access):
        return f"localparam logic [{bits - 1}:0] Reg{camel(name)} = {bits}'h{at:0{bits // 4}x};  // {access}"

    o = [
        f"// {note}",
        "// SPDX-License-Identifier: Apache-2.0",
        f"// Included inside {inside}: byte addresses, and the fields of registers that have some.",
        "/* verilator lint_off UNUSEDPARAM */",
    ]
    o += [address(r["name"], r["addr"], r["access"]) for r in registers]
    last = max(registers, key=lambda r: r["addr"])
    o.append(f"localparam logic [{bits - 1}:0] RegLast = Reg{camel(last['name'])};")
    for r in registers:
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
    for r in registers:
        if "fields" not in r:
            continue
        o += ["", "typedef struct packed {"]
        o += [f"  logic{'' if bits == 1 else f' [{bits - 1}:0]'} {name};" for name, bits in struct(r)]
        o += [f"}} reg_{r['name'].lower()}_t;"]
    o.append("")
    return "\n".join(o)


def registers_svh(defs):
    return svh(NOTE, "the register module", defs.d["registers"], 8)


def board_svh(board):
    """The windows are beside the registers: where each begins, and how many words it has."""
    o = [svh(BOARD_NOTE, "board_registers", board["registers"], 16)]
    o.append("/* verilator lint_off UNUSEDPARAM */")
    for w in board["windows"]:
        o.append(f"localparam logic [15:0] Window{camel(w['name'])} = 16'h{w['addr']:04x};  // {w['access']}")
        o.append(f"localparam int Window{camel(w['name'])}Words = {w['words']};")
    o += ["/* verilator lint_on UNUSEDPARAM */", ""]
    return "\n".join(o)


def c_fields(prefix, registers):
    o = []
    for r in registers:
        for f in r.get("fields", []):
            name, mask = f"{prefix}{r['name']}_{f['name']}", ((1 << f["bits"]) - 1) << f["lsb"]
            o.append(f"#define {name}_SHIFT {f['lsb']}u /**< {r['name']}: {f['doc']} */")
            o.append(f"#define {name}_MASK 0x{mask:08X}u /**< its bits */")
    return o


def board_h(board):
    """Macros of the form of ref/include/kage/registers.h, whose KAGE_FIELD takes these fields too."""
    o = [
        f"/* {BOARD_NOTE} */",
        "/* SPDX-License-Identifier: Apache-2.0 */",
        "/* clang-format off */",
        "",
        "/** @file",
        " * What a host finds on a board behind the serial link (docs/boards.md): byte addresses. */",
        "#ifndef KAGE_BOARD_REGISTERS_H",
        "#define KAGE_BOARD_REGISTERS_H",
        "",
        '#include "kage/registers.h"',
        "",
    ]
    for r in board["registers"]:
        o.append(
            f"#define KAGE_BOARD_{r['name'].removeprefix('BOARD_')} 0x{r['addr']:04X}u /**< {r['access']}: {r['doc']} */"
        )
        if "value" in r:
            o.append(
                f"#define KAGE_BOARD_{r['name'].removeprefix('BOARD_')}_VALUE 0x{r['value']:08X}u /**< what it always is */"
            )
    for w in board["windows"]:
        o.append(f"#define KAGE_BOARD_{w['name']} 0x{w['addr']:04X}u /**< {w['access']}: {w['doc']} */")
        o.append(f"#define KAGE_BOARD_{w['name']}_WORDS {w['words']}u /**< words of that window */")
    o += ["", *c_fields("KAGE_BOARD_", board["registers"] + board["windows"]), "", "#endif", ""]
    return "\n".join(o)


def checked_board(board):
    """rtl/defs/board.yaml as read; no two registers or windows overlap."""
    taken = [(r["addr"], r["addr"] + 4, r["name"]) for r in board["registers"]]
    taken += [(w["addr"], w["addr"] + 4 * w["words"], w["name"]) for w in board["windows"]]
    for (_, end, name), (begin, _, following) in zip(sorted(taken), sorted(taken)[1:], strict=False):
        if end > begin:
            raise SystemExit(f"{BOARD}: {name} overlaps {following}")
    return board


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
        f"#define KAGE_VERSION_SPANS {defs.d['version']}u /**< in a header at the span level: what VERSION always is */",
        f"#define KAGE_VERSION_POLYGONS {defs.d['polygon_version']}u /**< in a header at the polygon level */",
        "",
        "/** A field of a register's value: KAGE_FIELD(value, KAGE_ERROR_CODE). */",
        "#define KAGE_FIELD(value, field) (((value) & field##_MASK) >> field##_SHIFT)",
        "/** The field alone, as part of a register's value. */",
        "#define KAGE_FIELD_IS(field, number) (((number) << field##_SHIFT) & field##_MASK)",
        "",
    ]
    o += c_fields("KAGE_", defs.d["registers"])
    o += [""] + [f"#define KAGE_ERR_{e['name']} {e['code']}u /**< {e['doc']} */" for e in defs.d["errors"]]
    o += ["", "#endif", ""]
    return "\n".join(o)
