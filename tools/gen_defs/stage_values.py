# SPDX-License-Identifier: Apache-2.0
"""verif/cosim/diverge/stage_values.hpp: what monitors tell (rtl/defs/stages.yaml), for C++."""

from files import STAGES_NOTE

LEVELS = ("wiring", "leaf", "parent")
WAYS = ("number", "kind", "flags", "words", "ramp", "color", "depth")  # to write a value


def stage_values_hpp(stages):
    d = stages.d
    sections = [
        opening(d),
        stage_enum(d["stages"]),
        stage_info(d["stages"]),
        places(d["stages"]),
        flags(d["stages"]),
        ports(d["ports"]),
        handshakes(d),
        parts(d["parts"]),
        ["}  // namespace kage::cosim", ""],
    ]
    return "\n".join(line for section in sections for line in section)


def opening(d):
    return [
        "// SPDX-License-Identifier: Apache-2.0",
        f"// {STAGES_NOTE}",
        "// clang-format off",
        "//",
        "// The stages of the core, what their events hold, the ports between modules, and the modules that are watched.",
        "#pragma once",
        "",
        "#include <array>",
        "#include <cstdint>",
        "#include <string_view>",
        "",
        '#include "cosim/model/driver/rtl_model.h"',
        "",
        "namespace kage::cosim {",
        "",
        f"static_assert(KAGE_RTL_EVENT_VALUES == {d['values']});",
        "",
    ]


def stage_enum(stages):
    return [
        "/// In the order in which a token passes them.",
        "enum class Stage : std::uint8_t {",
        *(f"  {s['name']}," + (f"  ///< {s['doc']}" if s["doc"] else "") for s in stages),
        "};",
        f"inline constexpr int kStages = {len(stages)};",
        f"inline constexpr int kHandshakeStage = {len(stages)};  ///< no event: RtlCore::handshakes()",
        "",
    ]


def stage_info(stages):
    def value(v, i):
        """A value's name and way; of several of one name all but words are numbered."""
        numbered = v.get("count", 1) > 1 and v.get("as") != "words"
        name = v.get("text", v["name"]) + (f" {i}" if numbered else "")
        return f'{{"{name}", ValueText::{v.get("as", "number")}}}'

    def stage(s):
        values = ", ".join(value(v, i) for v in s["values"] for i in range(v.get("count", 1)))
        return f'    {{"{s["text"]}", {{{{{values}}}}}}},'

    return [
        "/// How a value is written.",
        f"enum class ValueText : std::uint8_t {{ {', '.join(WAYS)} }};",
        "struct ValueInfo {",
        "  std::string_view name;",
        "  ValueText as = ValueText::number;",
        "};",
        "",
        "/// A stage's event in words, and its values.",
        "struct StageInfo {",
        "  std::string_view text;",
        "  std::array<ValueInfo, KAGE_RTL_EVENT_VALUES> values;",
        "};",
        "",
        "inline constexpr std::array<StageInfo, kStages> kStageInfo{{",
        *(stage(s) for s in stages),
        "}};",
        "",
    ]


def places(stages):
    def stage(s):
        values = ", ".join(f"{v['name']} = {v['at']}" for v in s["values"])
        return f"namespace {s['name']} {{ enum : int {{ {values} }}; }}"

    return [
        "/// Places of values in events.",
        "namespace at {",
        *(stage(s) for s in stages if s["values"]),
        "}  // namespace at",
        "",
    ]


def flags(stages):
    bits = [(bit, 1 << i) for s in stages for v in s["values"] for i, bit in enumerate(v.get("bits", []))]
    return [
        "/// Bits of flags.",
        "namespace flag {",
        *(f"inline constexpr std::uint64_t {bit} = {value};" for bit, value in bits),
        "}  // namespace flag",
        "",
    ]


def ports(ports):
    return [
        "/// Ports between modules, from the way in to the way out.",
        f"enum class Port : std::uint8_t {{ {', '.join(p['name'] for p in ports)} }};",
        "struct PortInfo {",
        "  Port port;",
        "  std::string_view name;",
        "  std::string_view from;",
        "  std::string_view to;",
        "};",
        f"inline constexpr std::array<PortInfo, {len(ports)}> kPorts{{{{",
        *(f'    {{Port::{p["name"]}, "{p["text"]}", "{p["from"]}", "{p["to"]}"}},' for p in ports),
        "}};",
        "",
    ]


def handshakes(d):
    first_flag = 2 * len(d["ports"])
    return [
        "/// Who waits for whom: RtlCore::handshakes().",
        "class Handshakes {",
        " public:",
        "  explicit constexpr Handshakes(std::uint32_t bits = 0) : bits_(bits) {}",
        "  [[nodiscard]] constexpr bool ready(Port p) const { return bit(2 * static_cast<unsigned>(p)); }",
        "  [[nodiscard]] constexpr bool valid(Port p) const { return bit(2 * static_cast<unsigned>(p) + 1); }",
        "  /// Whether an item is offered there and not taken.",
        "  [[nodiscard]] constexpr bool waits(Port p) const { return valid(p) && !ready(p); }",
        *(
            f"  [[nodiscard]] constexpr bool {flag}() const {{ return bit({bit}); }}"
            for bit, flag in enumerate(d["handshake_flags"], first_flag)
        ),
        "",
        " private:",
        "  [[nodiscard]] constexpr bool bit(unsigned i) const { return (bits_ >> i & 1U) != 0; }",
        "  std::uint32_t bits_;",
        "};",
        "",
    ]


def parts(parts):
    return [
        "/// Modules that are watched from their ports, and modules whose wires to others are.",
        "enum class Part : std::uint8_t {",
        *(f"  {p['name']}," + (f"  ///< {p['doc']}" if "doc" in p else "") for p in parts),
        "};",
        "/// At equal clocks wiring is to blame first, then leaf modules, then their parents.",
        f"enum class Blame : std::uint8_t {{ {', '.join(LEVELS)} }};",
        "struct PartInfo {",
        "  std::string_view module;",
        "  Blame blame;",
        "};",
        f"inline constexpr std::array<PartInfo, {len(parts)}> kParts{{{{",
        *(f'    {{"{p.get("module", p["name"])}", Blame::{p["level"]}}},' for p in parts),
        "}};",
        "",
    ]
