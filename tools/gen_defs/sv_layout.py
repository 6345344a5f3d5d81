# SPDX-License-Identifier: Apache-2.0
"""kage_layout.svh: kinds, errors, and the place of every field of header and tokens."""

from expressions import camel
from files import NOTE


def layout(defs):
    sections = [
        opening(),
        header(defs),
        *numbers(defs.d),
        places(defs.d),
        shared_places(defs),
        token_words("", defs.at_level("spans")),
        token_words("Polygon", defs.at_level("polygons")),
        param_hash(defs),
        words_function(defs),
        ["/* verilator lint_on UNUSEDPARAM */", "// verilog_lint: waive-stop line-length", ""],
    ]
    return "\n".join(line for section in sections for line in section)


def opening():
    return [
        f"// {NOTE}",
        "// SPDX-License-Identifier: Apache-2.0",
        "// Included inside a module that has the pixel parameters: kinds, errors, and the place of every field.",
        "// verilog_lint: waive-start line-length",
        "/* verilator lint_off UNUSEDPARAM */",
    ]


def header(defs):
    return [
        f"localparam int StreamVersion = {defs.d['version']};",
        f"localparam int PolygonVersion = {defs.d['polygon_version']};  // at the polygon level",
        f"localparam int StreamMagic = 'h{defs.d['magic']:x};",
        f"localparam int HeaderWords = {len(defs.d['header'])};",
        "",
        *(f"localparam int Header{camel(f['name'])}Lsb = {32 * f['word'] + f['lsb']};" for f in defs.header_fields),
        *(f"localparam int Header{camel(f['name'])}Bits = {f['bits']};" for f in defs.header_fields),
        "",
    ]


def numbers(d):
    def numbered(prefix, bits, entries, number):
        return (f"localparam logic [{bits - 1}:0] {prefix}{camel(e['name'])} = {bits}'d{e[number]};" for e in entries)

    kinds = numbered("Kind", d["kind_bits"], d["tokens"], "code")
    errors = numbered("Err", d["code_bits"], d["errors"], "code")
    return [*kinds, ""], [*errors, ""]


def places(d):
    """Field after field, and how long each token is with them."""
    o = []
    for t in d["tokens"]:
        token = camel(t["name"])
        at = str(d["kind_bits"])
        for f in t["fields"]:
            field = token + camel(f["name"])
            o.append(f"localparam int {field}Lsb = {at};")
            o.append(f"localparam int {field}Bits = {f['bits']};")
            at = f"{field}Lsb + {field}Bits" + (f" * {f['repeat']}" if f["repeat"] else "")
        o.append(f"localparam int {token}Bits = {at};")
        o.append(f"localparam int {token}Words = ({t['sv_needs']}) != 0 ? ({token}Bits + 31) / 32 : 0;")
    return [*o, ""]


def shared_places(defs):
    """Places that tokens with a range have in common."""
    return [
        "// In all tokens with a range that have it.",
        *(f"localparam int {camel(s)}Lsb = {camel(token)}{camel(field)}Lsb;" for s, token, field in defs.shared_places),
        "",
    ]


def token_words(level, tokens):
    o, most = [], "1"
    for i, t in enumerate(tokens):
        words = f"{camel(t['name'])}Words"
        o.append(f"localparam int {level}TokenMax{i} = {words} > {most} ? {words} : {most};")
        most = f"{level}TokenMax{i}"
    return [*o, f"localparam int {level}TokenWords = {most};  // words of the longest token", ""]


def param_hash(defs):
    params, fnv = defs.pixel, defs.d["hash"]
    o = [f"localparam logic [31:0] ParamHash0 = 32'd{fnv['basis']};"]
    for i, p in enumerate(params):
        skips = f"{p['name']} == 0 ? ParamHash{i} : " if p.get("late") else ""
        hashed = f"(ParamHash{i} ^ 32'({p['name']})) * 32'd{fnv['prime']}"
        o.append(f"localparam logic [31:0] ParamHash{i + 1} = {skips}{hashed};")
    return [*o, f"localparam logic [31:0] ParamHash = ParamHash{len(params)};  // what a header must carry", ""]


def words_function(defs):
    assert defs.most_token_words() < 32, "token_words() has 5 bits"

    def function(name, level, of):
        return [
            f"// Words of a token of this kind{of}; 0: the configuration lacks it.",
            f"function automatic logic [4:0] {name}(input logic [{defs.d['kind_bits'] - 1}:0] kind);",
            "  unique case (kind)",
            *(f"    Kind{camel(t['name'])}: {name} = 5'({camel(t['name'])}Words);" for t in defs.at_level(level)),
            f"    default: {name} = 5'd0;",
            "  endcase",
            "endfunction",
        ]

    polygons = function("polygon_token_words", "polygons", " in a frame at the polygon level")
    return [*function("token_words", "spans", ""), *polygons]
