# SPDX-License-Identifier: Apache-2.0
"""ref/contract/derived.hpp: numbers that follow from the parameters."""

from expressions import camel
from files import NOTE


def derived(defs):
    o = [
        f"// {NOTE}",
        "// SPDX-License-Identifier: Apache-2.0",
        "// clang-format off",
        "//",
        "// Numbers that follow from the parameters; in SystemVerilog: rtl/include/generated/kage_widths.svh.",
        "#pragma once",
        "",
        "#include <cstdint>",
        "#include <string_view>",
        "",
        '#include "kage/defs.hpp"',
        "",
        "namespace kage::derived {",
        "",
    ]
    for n in defs.d["derived"]:
        value = defs.cpp_derived(n["value"]).replace("derived::", "")
        kind = {"flag": "bool", "unsigned": "std::uint32_t"}.get(n["is"], "int")
        if n["is"] == "unsigned":
            value = f"static_cast<std::uint32_t>({value})"
        config = "const Config& c" if "(c)" in value or "c." in value else "const Config& /*c*/"
        o += [f"/// {n['doc']}", f"constexpr {kind} {n['name']}({config}) {{ return {value}; }}"]
    o += ["", "/// Commands that are no token, by kinds of tokens that never become commands."]
    o += [
        f"inline constexpr Kind kCommand{camel(c['name'])} = static_cast<Kind>({c['kind']});  ///< {c['doc']}"
        for c in defs.d["commands"]
    ]
    o += [
        "",
        "/// The name of a command that is no token; empty of one that is.",
        "constexpr std::string_view command_name(Kind k) {",
        *(f'  if (k == kCommand{camel(c["name"])}) return "{c["name"]}";' for c in defs.d["commands"]),
        "  return {};",
        "}",
    ]
    o += ["", "}  // namespace kage::derived", ""]
    return "\n".join(o)
