// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>

#include "cosim/diverge/expected_events.hpp"

namespace kage::cosim {

/// An event that is not what was expected, or that never came.
struct Mismatch {
  ExpectedEvent expected;
  std::optional<kage_rtl_event> actual;
  int value = -1;  ///< the first that differs, or kUnitValue; -1: missing
  std::uint64_t clock = 0;

  /// The order in which a token passes the stages.
  [[nodiscard]] auto order() const { return std::tuple(expected.nth, expected.line, expected.step, expected.x); }
};

/// In place of a value's index: the event's unit, of Stage::exit whether the pixel is the last of its line.
inline constexpr int kUnitValue = KAGE_RTL_EVENT_VALUES;

/// Whether a value of the event that matters is another than the RTL's.
bool differs(const ExpectedEvent& expected, const kage_rtl_event& actual, int value);

/// The first value that matters and differs, then kUnitValue, or -1.
int first_difference(const ExpectedEvent& expected, const kage_rtl_event& actual);

/// A mismatch in words for a person.
struct MismatchText {
  std::string field;  ///< "z"; of a token that of docs/stream.md: "color[1]"; "missing": it never came
  std::string expected;
  std::string actual;
};
MismatchText describe(const Config& config, const Mismatch& mismatch);

}  // namespace kage::cosim
