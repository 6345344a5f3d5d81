# SPDX-License-Identifier: Apache-2.0
"""Field and Layout of ref/include/kage/defs.hpp: where the fields of tokens are."""

from expressions import cpp_expr


def layout(defs):
    return [*kind_field(), *members(defs.d), *constructor(defs)]


def field():
    return [
        "/// Place of a field in its token or header: `bits` from bit `lsb` of its words, the first word lowest.",
        "struct Field {",
        "  std::uint16_t lsb = 0;  ///< its lowest bit",
        "  std::uint8_t bits = 0;  ///< 0: the configuration lacks the field",
        "  bool is_signed = false;  ///< two's complement",
        "};",
        "",
    ]


def kind_field():
    return [
        "/// The kind, which comes before a token's fields.",
        "inline constexpr Field kKindField{0, kKindBits, false};",
        "",
    ]


def members(d):
    o = ["/// Places of all fields for one configuration. An absent field has no bits.", "struct Layout {"]
    for t in d["tokens"]:
        for f in t["fields"]:
            n = f["name"] + ("[3]" if f["repeat"] else "")
            o.append(f"  Field {t['name'].lower()}_{n};  ///< {t['name']}'s {f['name']}")
    return [
        *o,
        "  std::array<std::uint8_t, kKinds> words{};   ///< words of a token of each kind; 0: the configuration lacks the kind",
        "  std::array<std::uint16_t, kKinds> bits{};   ///< bits in use of a token of each kind",
        "",
        "  /// How long a token is.",
        "  /// @param word the token's first",
        "  /// @param level of its frame",
        "  /// @return its words; 0: the configuration lacks its kind, or there is no such kind",
        "  [[nodiscard]] constexpr std::size_t words_of(std::uint32_t word, Level level = Level::spans) const {",
        "    return words[static_cast<std::size_t>(kind_of(word, level))];",
        "  }",
        "",
    ]


def constructor(defs):
    """Field after field gets its place, token after token; with it Layout ends."""
    o = [
        "  /// Where the fields are.",
        "  /// @param c a legal configuration",
        "  explicit constexpr Layout(const Config& c) {",
        "    unsigned at = 0;",
        "    const auto put = [&at](Field& f, int n, bool is_signed) {",
        "      f = Field{static_cast<std::uint16_t>(at), static_cast<std::uint8_t>(n), is_signed};",
        "      at += static_cast<unsigned>(n);",
        "    };",
    ]
    for t in defs.d["tokens"]:
        o.append(f"    at = kKindBits;  // {t['name']}")
        o += [put(defs, t, f) for f in t["fields"]]
        there = cpp_expr(t["needs"], defs.names)
        o.append(f"    bits[{t['kind']}] = static_cast<std::uint16_t>(at);")
        o.append(f"    words[{t['kind']}] = static_cast<std::uint8_t>(({there}) ? (at + 31) / 32 : 0);")
    return [*o, "  }", "};", ""]


def put(defs, token, field):
    """The line that gives a field its place, or three of it theirs."""

    def text(expr):
        return cpp_expr(expr, defs.names)

    signed = field["signed"]
    signed = ("true" if signed else "false") if isinstance(signed, bool) else f"({text(signed)}) != 0"
    name, bits = f"{token['name'].lower()}_{field['name']}", text(field["bits"])
    if field["repeat"]:
        return f"    for (int i = 0; i < {text(field['repeat'])}; ++i) put({name}[i], {bits}, {signed});"
    return f"    put({name}, {bits}, {signed});"
