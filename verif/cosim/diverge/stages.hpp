// SPDX-License-Identifier: Apache-2.0
//
// The stages of the core as a person reads of them. Which there are, and what their events hold: stage_values.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "cosim/diverge/stage_values.hpp"
#include "kage/config.hpp"

namespace kage::cosim {

/// A stage's event in words: "a command to the pixels".
std::string_view describe(Stage stage);

/// The name of a stage's value `index`: "xl".
std::string_view value_name(Stage stage, int index);

/// A value as a person reads it: depths with their fraction, colours by channel.
std::string value_text(const Config& config, Stage stage, int index, std::uint64_t value);

}  // namespace kage::cosim
