// SPDX-License-Identifier: Apache-2.0
//
// The stages of the core, in the order in which a token passes them, and what their events hold (rtl_model.h).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "kage/config.hpp"
#include "rtl_model/rtl_model.h"

namespace kage::cosim {

enum class Stage : std::uint8_t {
  token = KAGE_STAGE_TOKEN,
  table = KAGE_STAGE_TABLE,
  face = KAGE_STAGE_FACE,
  segment = KAGE_STAGE_SEGMENT,
  unit = KAGE_STAGE_UNIT,
  tree = KAGE_STAGE_TREE,
  line = KAGE_STAGE_LINE,
  command = KAGE_STAGE_COMMAND,
  pixel = KAGE_STAGE_PIXEL,
  exit = KAGE_STAGE_EXIT,
  load = KAGE_STAGE_LOAD,
  out = KAGE_STAGE_OUT,
  error = KAGE_STAGE_ERROR,
  part = KAGE_STAGE_PART,  ///< not of a token: a small module that breaks its own contract
  claim = KAGE_STAGE_CLAIM,
  state = KAGE_STAGE_STATE,
  end = KAGE_STAGE_END,
};
inline constexpr int kStages = 17;

/// What an event of a stage is, in words: "a command to the pixels".
std::string_view describe(Stage stage);

/// The name of a stage's value `index`: "xl".
std::string_view value_name(Stage stage, int index);

/// A value as a person reads it: depths with their fraction, colours by channel.
std::string value_text(const Config& config, Stage stage, int index, std::uint64_t value);

}  // namespace kage::cosim
