# SPDX-License-Identifier: Apache-2.0
"""ref/cost/generated/clock_phases.hpp: what the clocks of a frame are counted under."""

from files import NOTE


def clock_phases(defs):
    phases, tokens = defs.d["clock_phases"], sorted(defs.d["tokens"], key=lambda t: t["kind"])

    def kinds(phase):
        return ", ".join(t["name"] for t in tokens if t["counts_as"] == phase["name"])

    o = [
        "// SPDX-License-Identifier: Apache-2.0",
        f"// {NOTE}",
        "// clang-format off",
        "#pragma once",
        "",
        "#include <array>",
        "#include <cstdint>",
        "#include <string_view>",
        "",
        '#include "kage/defs.hpp"',
        "",
        "namespace kage {",
        "",
        "/// Phases of a frame under which its clocks are counted.",
        f"enum class Phase : std::uint8_t {{ {', '.join(p['name'] for p in phases)} }};",
        f"inline constexpr std::size_t kPhases = {len(phases)};",
        "",
        "inline constexpr std::array<std::string_view, kPhases> kPhaseNames{",
        "    " + ", ".join(f'"{p["text"]}"' for p in phases) + "};",
        "",
        '/// Tokens of each phase: "SP, NC, IF".',
        "inline constexpr std::array<std::string_view, kPhases> kPhaseTokens{",
        "    " + ", ".join(f'"{kinds(p)}"' for p in phases) + "};",
        "",
        "/// By kind; what is no kind counts as state.",
        "inline constexpr std::array<Phase, kKinds> kPhaseOfKind{",
        "    " + ", ".join(f"Phase::{t['counts_as'] if t else 'state'}" for t in defs.d["by_kind"]) + "};",
        "constexpr Phase phase_of(Kind kind) { return kPhaseOfKind[static_cast<std::size_t>(kind)]; }",
        "",
        "}  // namespace kage",
        "",
    ]
    return "\n".join(o)
