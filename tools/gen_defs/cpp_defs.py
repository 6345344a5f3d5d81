# SPDX-License-Identifier: Apache-2.0
"""ref/include/kage/defs.hpp: the contract in numbers, for all of C++."""

from cpp_header import frame_header
from cpp_layout import field, layout
from expressions import camel, cpp_expr, quoted
from files import NOTE


def defs_hpp(defs):
    sections = [
        opening(),
        numbers(defs),
        field(),
        frame_header(defs),
        config(defs),
        greatest(defs),
        param_info(defs),
        rule_info(defs),
        param_hash(defs.d["hash"]),
        kinds(defs.d),
        errors(defs.d["errors"]),
        layout(defs),
        ["}  // namespace kage", ""],
    ]
    return "\n".join(line for section in sections for line in section)


def opening():
    return [
        f"// {NOTE}",
        "// SPDX-License-Identifier: Apache-2.0",
        "// clang-format off",
        "",
        "/// @file",
        "/// The contract in numbers: parameters and the rules between them, header, kinds of tokens, places of their fields,",
        "/// errors (docs/stream.md).",
        "#pragma once",
        "",
        "#include <array>",
        "#include <cstddef>",
        "#include <cstdint>",
        "#include <span>",
        "#include <string_view>",
        "",
        "namespace kage {",
        "",
    ]


def numbers(defs):
    d = defs.d
    return [
        f"inline constexpr std::uint32_t kStreamVersion = {d['version']};  ///< of the stream",
        f"inline constexpr std::uint32_t kPolygonVersion = {d['polygon_version']};  ///< of a frame at the polygon level",
        f"inline constexpr std::uint32_t kStreamMagic = {d['magic']:#x};  ///< in a header's first word",
        f"inline constexpr std::uint32_t kHeaderWords = {len(d['header'])};  ///< words of a header",
        "/// Words of a header by name, in their order.",
        f"inline constexpr std::array<std::string_view, {len(d['header'])}> kHeaderWordNames{{{{{', '.join(quoted(h['name']) for h in d['header'])}}}}};",
        "/// Levels of a frame, by its tokens.",
        "enum class Level : std::uint8_t {",
        "  spans,     ///< spans and what ends them",
        "  polygons,  ///< polygons too, which the front end makes spans of",
        "};",
        *(f"inline constexpr int k{camel(c['name'])} = {c['value']};  ///< {c['doc']}" for c in d["constants"]),
        f"inline constexpr std::size_t kMostTokenWords = {defs.most_token_words()};  ///< words of the longest token of any configuration",
        "",
    ]


def config(defs):
    return [
        "/// A configuration of the core. Members keep the lower-case names of the parameters in the definition file.",
        "struct Config {",
        *(f"  int {p['name'].lower()} = {p['default']};  ///< {p['doc']}" for p in defs.pixel + defs.impl),
        "",
        "  bool operator==(const Config&) const = default;",
        "};",
        "",
    ]


def greatest(defs):
    params = defs.pixel + defs.impl
    return [
        "/// Every parameter at its greatest legal value. Together they may break rules: this bounds arrays and limits.",
        "inline constexpr Config kGreatest{",
        *(f"    .{p['name'].lower()} = {p['max']}," for p in params),
        "};",
        "",
    ]


def param_info(defs):
    params = defs.pixel + defs.impl
    o = [
        "/// A parameter's name, member, legal range and whether it changes pixels.",
        "struct ParamInfo {",
        "  std::string_view name;  ///< as in the definition file",
        "  int Config::*member;  ///< where its value is",
        "  int default_value;  ///< of Config{}",
        "  int min;  ///< the least legal value",
        "  int max;  ///< the greatest",
        "  bool affects_pixels;  ///< else it is of how the hardware is made",
        "  bool late;  ///< it came later: streams of cores that have 0 of it are as they were before",
        "  std::uint64_t allowed;  ///< bit v set: value v is legal; 0: every value from min to max is",
        "  std::string_view doc;  ///< what it means",
        "};",
        "",
        "/// All parameters, in the order of the definition file.",
        f"inline constexpr std::array<ParamInfo, {len(params)}> kParams{{{{",
    ]
    for i, p in enumerate(params):
        allowed = sum(1 << v for v in p.get("allowed", []))
        o.append(
            f'    {{"{p["name"]}", &Config::{p["name"].lower()}, {p["default"]}, {p["min"]}, {p["max"]}, '
            f"{'true' if i < len(defs.pixel) else 'false'}, {'true' if p.get('late') else 'false'}, {allowed:#x}, "
            f"{quoted(p['doc'])}}},"
        )
    return [*o, "}};", ""]


def rule_info(defs):
    rules = defs.d["rules"]
    o = [
        "/// A rule that binds parameters together. `text` says it, and why; `legal` is it as an expression of parameters.",
        "struct RuleInfo {",
        "  std::string_view text;  ///< for messages",
        "  std::string_view legal;  ///< for messages",
        "  bool (*holds)(const Config&);  ///< whether it does",
        "  void (*repair)(Config&);  ///< makes it hold; rule after rule, all of them",
        "};",
        "",
        "/// All rules, in the order of the definition file.",
        f"inline constexpr std::array<RuleInfo, {len(rules)}> kRules{{{{",
    ]
    for r in rules:
        repair = " ".join(f"c.{name.lower()} = {cpp_expr(value, defs.names)};" for name, value in r["repair"].items())
        legal = cpp_expr(r["legal"], defs.names)
        o.append(f'    {{"{r["doc"]}", "{r["legal"]}",')
        o.append(f"     [](const Config& c) {{ return {legal}; }}, [](Config& c) {{ {repair} }}}},")
    return [*o, "}};", ""]


def param_hash(fnv):
    return [
        "/// Hash of the parameters that affect pixels: FNV-1a over their values in the order of the definition file.",
        "/// @param c any configuration",
        "/// @return what a frame's header must carry",
        "constexpr std::uint32_t param_hash(const Config& c) {",
        f"  std::uint32_t h = {fnv['basis']}u;",
        "  for (const ParamInfo& p : kParams)",
        "    if (p.affects_pixels && !(p.late && c.*p.member == 0))",
        f"      h = (h ^ static_cast<std::uint32_t>(c.*p.member)) * {fnv['prime']}u;",
        "  return h;",
        "}",
        "",
    ]


def kinds(d):
    tokens = d["tokens"]
    names = ", ".join(f'"{t["name"]}"' if t else '"-"' for t in d["by_kind"])
    reused = sum(1 << t["code"] for t in tokens if t["level"] == "polygons")
    return [
        "/// Kinds of tokens, by the names of docs/stream.md.",
        "enum class Kind : std::uint8_t {",
        *(f"  {t['name']} = {t['kind']},  ///< {t['doc']}" for t in tokens),
        "};",
        "",
        "/// How many numbers kinds have; not each of them is a kind.",
        f"inline constexpr std::size_t kKinds = {d['kinds']};",
        "",
        "/// The kind of a token.",
        "/// @param word the token's first",
        "/// @param level of its frame",
        "/// @return its kind; 0 is none",
        "constexpr Kind kind_of(std::uint32_t word, Level level = Level::spans) {",
        "  const std::uint32_t code = word & ((1u << kKindBits) - 1u);",
        f"  const bool moved = level == Level::polygons && ({reused:#x}u >> code & 1u) != 0;  // a code that both levels use",
        "  return static_cast<Kind>(moved ? code + (1u << kKindBits) : code);",
        "}",
        "",
        "/// The code of a kind in a token's first word.",
        "/// @param kind any",
        "/// @return the lowest bits of the word",
        "constexpr std::uint32_t code_of(Kind kind) { return static_cast<std::uint32_t>(kind) & ((1u << kKindBits) - 1u); }",
        "",
        "/// The names of the kinds, by their numbers.",
        "inline constexpr std::array<std::string_view, kKinds> kKindNames{",
        f"    {names}}};",
        "",
    ]


def errors(errors):
    names = ", ".join(f'"{e["name"]}"' for e in errors)
    return [
        "/// Errors of a core, the same in golden model and RTL, by the names of docs/stream.md.",
        "enum class ErrorCode : std::uint8_t {",
        *(f"  {e['name']} = {e['code']},  ///< {e['doc']}" for e in errors),
        "};",
        "",
        "/// The names of the errors, by their codes.",
        f"inline constexpr std::array<std::string_view, {len(errors)}> kErrorNames{{",
        f"    {names}}};",
        "",
        "/// Meanings of the errors, by their codes.",
        f"inline constexpr std::array<std::string_view, {len(errors)}> kErrorTexts{{",
        *(f'    "{e["doc"]}",' for e in errors),
        "};",
        "",
        "/// Whether an error is an expansion unit's, which FrameStatus and the register ERROR_UNIT name.",
        "/// @param error any",
        "/// @return whether it is one of " + ", ".join(e["name"] for e in errors if e["of_unit"]),
        "constexpr bool is_of_unit(ErrorCode error) {",
        "  return " + " || ".join(f"error == ErrorCode::{e['name']}" for e in errors if e["of_unit"]) + ";",
        "}",
        "",
    ]
