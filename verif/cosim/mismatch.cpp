// SPDX-License-Identifier: Apache-2.0
#include "cosim/mismatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "stream/field_diff.hpp"

namespace kage::cosim {
namespace {

std::vector<std::uint32_t> words_of(const std::uint64_t* values) {
  std::vector<std::uint32_t> words;
  for (std::size_t i = at::token::words; i < at::token::at_last; ++i)
    for (const int half : {0, 32}) words.push_back(static_cast<std::uint32_t>(values[i] >> half));
  return words;
}

// A token's words say less than the field in them that differs. Nothing if that is none of its fields.
std::optional<MismatchText> describe_words(const Config& config, const Mismatch& m) {
  const auto expected = words_of(m.expected.value.data());
  const auto actual = words_of(m.actual->value);
  if (m.expected.token == 0) {
    const auto at = static_cast<std::size_t>(
        std::mismatch(expected.begin(), expected.begin() + kHeaderWords, actual.begin()).first - expected.begin());
    if (at == kHeaderWords) return std::nullopt;
    return MismatchText{std::string(kHeaderWordNames[at]), fmt::format("{:#010x}", expected[at]),
                        fmt::format("{:#010x}", actual[at])};
  }
  const auto field = first_field_diff(config, Layout(config), expected, actual);
  if (!field) return std::nullopt;
  const auto text = [&](std::int64_t value) {
    if (field->name == "kind") return std::string(kKindNames[static_cast<std::size_t>(value)]);
    return fmt::format("{}", value);
  };
  return MismatchText{field->name, text(field->a), text(field->b)};
}

}  // namespace

bool differs(const ExpectedEvent& e, const kage_rtl_event& a, int value) {
  if ((e.cares >> value & 1U) == 0) return false;
  const bool unseen = e.stage == Stage::pixel && (value == at::pixel::z_came || value == at::pixel::color_came) &&
                      a.value[value] == ~std::uint64_t{0};
  const std::uint64_t bits = e.value[static_cast<std::size_t>(value)] ^ a.value[value];
  return !unseen && (bits & (value == e.masked ? e.mask : ~std::uint64_t{0})) != 0;
}

int first_difference(const ExpectedEvent& e, const kage_rtl_event& a) {
  for (int i = 0; i < KAGE_RTL_EVENT_VALUES; ++i)
    if (differs(e, a, i)) return i;
  return e.stage != Stage::pixel && e.unit != a.unit ? kUnitValue : -1;
}

MismatchText describe(const Config& config, const Mismatch& m) {
  const ExpectedEvent& e = m.expected;
  if (!m.actual) {
    return {"missing",
            e.stage == Stage::command ? value_text(config, e.stage, at::command::kind, e.value[at::command::kind])
                                      : std::string(describe(e.stage)),
            "nothing"};
  }
  if (m.value == kUnitValue)
    return {e.stage == Stage::exit ? "last of the line" : "unit", fmt::format("{}", e.unit),
            fmt::format("{}", m.actual->unit)};
  if (e.stage == Stage::token && m.value < at::token::at_last)
    if (auto text = describe_words(config, m)) return *text;
  return {std::string(value_name(e.stage, m.value)),
          value_text(config, e.stage, m.value, e.value[static_cast<std::size_t>(m.value)]),
          value_text(config, e.stage, m.value, m.actual->value[m.value])};
}

}  // namespace kage::cosim
