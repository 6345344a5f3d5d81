# SPDX-License-Identifier: Apache-2.0
"""FrameHeader of ref/include/kage/defs.hpp."""

from expressions import camel


def frame_header(defs):
    """FrameHeader: what a writer chooses comes first, then what every core demands."""
    demanded = {"version": "kStreamVersion", "magic": "kStreamMagic"}

    def is_int(f):
        return f["bits"] < 32 and "same" not in f

    o = ["/// A frame's header. Fields narrower than 32 bits hold no negative number.", "struct FrameHeader {"]
    o += [
        f"  static constexpr Field k{camel(f['name'])}{{{32 * f['word'] + f['lsb']}, {f['bits']}, false}};  ///< where {f['name']} is"
        for f in defs.header_fields
    ]
    o.append("")
    for f in sorted(defs.header_fields, key=lambda f: "same" in f):
        kind = "int" if is_int(f) else "std::uint32_t"
        o.append(f"  {kind} {f['name']} = {demanded.get(f.get('same'), 0)};  ///< {f['doc']}")
    o += [
        "",
        "  /// Reads a header. Words that are missing count as 0.",
        "  /// @param words begin with it",
        "  /// @return its fields, whatever they are",
        "  static constexpr FrameHeader read(std::span<const std::uint32_t> words) {",
        "    FrameHeader h;",
    ]
    for f in defs.header_fields:
        there = f"words.size() > {f['word']}" if f["word"] > 0 else "!words.empty()"
        word = f"({there} ? words[{f['word']}] : 0)"
        shifted = f"{word} >> {f['lsb']}" if f["lsb"] else word
        value = word if f["bits"] == 32 else f"{shifted} & 0x{(1 << f['bits']) - 1:X}"
        o.append(f"    h.{f['name']} = " + (f"static_cast<int>({value});" if is_int(f) else f"{value};"))
    o += [
        "    return h;",
        "  }",
        "",
        "  /// Writes the header.",
        "  /// @param words get it, from the first on, as far as there are words",
        "  constexpr void write(std::span<std::uint32_t> words) const {",
        "    const std::array<std::uint32_t, kHeaderWords> all{",
    ]
    for at in range(len(defs.d["header"])):
        parts = [
            f"static_cast<std::uint32_t>({f['name']})" + (f" << {f['lsb']}" if f["lsb"] else "")
            for f in defs.header_fields
            if f["word"] == at
        ]
        o.append("        " + " | ".join(parts) + ",")
    o += [
        "    };",
        "    for (std::size_t i = 0; i < all.size() && i < words.size(); ++i) words[i] = all[i];",
        "  }",
        "",
        "  /// @return whether magic and version are this stream's, at either level",
        "  [[nodiscard]] constexpr bool known() const {",
        "    return magic == kStreamMagic && (version == kStreamVersion || version == kPolygonVersion);",
        "  }",
        "",
        "  /// @return what the frame's tokens are, of a header that is known",
        "  [[nodiscard]] constexpr Level level() const {",
        "    return version == kPolygonVersion ? Level::polygons : Level::spans;",
        "  }",
        "};",
        "",
    ]
    return o
