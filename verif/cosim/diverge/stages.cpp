// SPDX-License-Identifier: Apache-2.0
#include "cosim/diverge/stages.hpp"

#include <fmt/format.h>

#include <span>

#include "contract/derived.hpp"
#include "kage/defs.hpp"
#include "number/bits.hpp"
#include "number/packed_color.hpp"

namespace kage::cosim {
namespace {

const ValueInfo& info(Stage stage, int index) {
  return kStageInfo[static_cast<std::size_t>(stage)].values[static_cast<std::size_t>(index)];
}

std::string kind_text(std::uint64_t kind) {
  const std::uint64_t number = kind & ((1U << kKindBits) - 1U);  // of a command
  const std::string_view command = derived::command_name(static_cast<Kind>(number));
  return std::string(command.empty() ? kKindNames[number] : command);
}

}  // namespace

std::string_view describe(Stage stage) { return kStageInfo[static_cast<std::size_t>(stage)].text; }

std::string_view value_name(Stage stage, int index) {
  const std::string_view name = info(stage, index).name;
  return name.empty() ? "words" : name;
}

std::string value_text(const Config& config, Stage stage, int index, std::uint64_t value) {
  switch (info(stage, index).as) {
    case ValueText::kind:
      return kind_text(value);
    case ValueText::flags:
      return fmt::format("{:04b}", value);
    case ValueText::words:
      return fmt::format("{:#018x}", value);
    case ValueText::ramp:
      return fmt::format("{}", static_cast<double>(sign_extend(value, derived::depth_bits(config))) /
                                   static_cast<double>(std::int64_t{1} << config.z_frac));
    case ValueText::color: {
      const bool shown = stage == Stage::line || stage == Stage::load || stage == Stage::out;
      const auto color = unpacked_levels(value, shown ? 8 : derived::pixel_level_bits(config));
      return fmt::format("{}", fmt::join(std::span(color).first(static_cast<std::size_t>(config.channels)), ","));
    }
    case ValueText::depth:
      if (value == derived::clear_depth(config)) return "clear";
      break;
    case ValueText::number:
      break;
  }
  return fmt::format("{}", value);
}

}  // namespace kage::cosim
