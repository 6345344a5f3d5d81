// SPDX-License-Identifier: Apache-2.0
#include "cosim/stages.hpp"

#include <fmt/format.h>

#include <vector>

#include "kage/defs.hpp"
#include "kage/derived.hpp"

namespace kage::cosim {
namespace {

struct StageInfo {
  std::string_view text;
  std::vector<std::string_view> values;
};

const StageInfo& info(Stage stage) {
  static const std::array<StageInfo, kStages> kInfo{{
      {"token to frame control", {}},
      {"entry of the light table", {"class", "light", "share 0", "share 1", "share 2"}},
      {"face to an expansion unit", {"face", "index", "class", "dz", "color"}},
      {"segment to an expansion unit", {"z", "dx", "face"}},
      {"pixel of an expansion unit", {"z", "index", "color", "class"}},
      {"pixel of the compare tree", {"z", "color", "class"}},
      {"line to the way out", {"first", "blank", "load", "painted", "width", "background", "shade"}},
      {"command to the pixels",
       {"kind", "xl", "xr", "count", "z", "dz", "share", "color 0", "color 1", "color 2", "dcolor 0", "dcolor 1",
        "dcolor 2"}},
      {"state of a pixel", {"kind", "z that came", "color that came", "z", "color", "class", "dsf", "fsf", "counts"}},
      {"pixel that leaves the line", {"color", "covered", "dark", "class", "counts"}},
      {"color that comes back to a pixel", {"x", "color"}},
      {"pixel of video", {"color", "tuser", "tlast"}},
      {"error", {"error", "error_frame", "error_line", "error_token", "error_unit"}},
      {"output of a module", {}},
      {"line asked of the tree", {}},
      {"state of the line", {"bias", "resolved"}},
      {"end of the frame", {}},
  }};
  return kInfo[static_cast<std::size_t>(stage)];
}

}  // namespace

std::string_view describe(Stage stage) { return info(stage).text; }

std::string_view value_name(Stage stage, int index) {
  if (stage == Stage::token && index == KAGE_RTL_EVENT_VALUES - 1) return "flags";  // header, lacking, cut, final
  const auto& values = info(stage).values;
  return static_cast<std::size_t>(index) < values.size() ? values[static_cast<std::size_t>(index)] : "words";
}

std::string value_text(const Config& config, Stage stage, int index, std::uint64_t value) {
  const std::string_view name = value_name(stage, index);
  if (name == "kind") {
    if (value == 1) return "LOAD";
    if (value == 2) return "OUT";
    return std::string(kKindNames[value % kKindNames.size()]);
  }
  if (name == "flags") return fmt::format("{:04b}", value);
  if (name == "words") return fmt::format("{:#018x}", value);
  const bool ramp = (stage == Stage::command && (index == 4 || index == 5)) || (stage == Stage::face && index == 3) ||
                    (stage == Stage::segment && index == 0);
  if (ramp) {
    const int spare = 64 - derived::depth_bits(config);
    const auto fixed = static_cast<std::int64_t>(value << spare) >> spare;
    return fmt::format("{}", static_cast<double>(fixed) / static_cast<double>(std::int64_t{1} << config.z_frac));
  }
  if (name == "color" || name == "color that came" || name == "background") {
    if (config.channels == 1) return fmt::format("{}", value & 255);
    return fmt::format("{},{},{}", value & 255, value >> 8 & 255, value >> 16 & 255);
  }
  if (name == "z" && value == (std::uint64_t{1} << config.z_bits) - 1) return "clear";
  return fmt::format("{}", value);
}

}  // namespace kage::cosim
