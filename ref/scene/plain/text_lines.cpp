// SPDX-License-Identifier: Apache-2.0
#include "scene/plain/text_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "kage/error.hpp"
#include "scene/notes.hpp"

namespace kage::scene {
namespace {

/// std::from_chars takes no plus sign.
std::string_view without_plus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

/// Whether a word is a number, whatever its size.
bool is_number(std::string_view word) {
  double value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error != std::errc::invalid_argument && stop == word.data() + word.size();
}

/// Whether a number that is out of a float's range is too small, not too large: by the place of its first digit that is
/// not 0, in powers of ten.
bool is_small(std::string_view number) {
  const std::size_t e = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, e);
  const std::size_t first = digits.find_first_of("123456789");
  if (first == std::string_view::npos) return true;
  const auto point = static_cast<std::int64_t>(std::min(digits.find('.'), digits.size()));
  std::int64_t exponent = 0;
  if (e < number.size()) {
    const auto wide = integer_of(number.substr(e + 1));
    // Beyond 64 bits the sign says all.
    exponent = wide                   ? std::clamp<std::int64_t>(*wide, -(1LL << 40), 1LL << 40)
               : number[e + 1] == '-' ? -(1LL << 40)
                                      : 1LL << 40;
  }
  return point - static_cast<std::int64_t>(first) + exponent < 0;
}

}  // namespace

std::string_view take_word(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(word.size());
  return word;
}

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  text.remove_suffix(text.size() - std::min(text.find_last_not_of(kBlanks) + 1, text.size()));
  return text;
}

std::optional<float> number_of(std::string_view word) {
  word = without_plus(word);
  float value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (stop != word.data() + word.size() || word.empty()) return std::nullopt;
  if (error == std::errc()) return value;
  if (error != std::errc::result_out_of_range || !is_small(word)) return std::nullopt;
  double fine = 0;  // a denormal float, or 0
  (void)std::from_chars(word.data(), word.data() + word.size(), fine);
  return static_cast<float>(fine);
}

std::optional<std::int64_t> integer_of(std::string_view word) {
  word = without_plus(word);
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || stop != word.data() + word.size()) return std::nullopt;
  return value;
}

TextLines::TextLines(std::string_view text, std::string file) : file_(std::move(file)), left_(text) {
  if (text.starts_with("\xEF\xBB\xBF")) left_.remove_prefix(3);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw Error(file_ + ": its text is UTF-16, which is not read (UTF-8 is)");
}

bool TextLines::next() {
  if (left_.empty()) return false;
  const char* const begin = left_.data();
  const char* const end = begin + left_.size();
  const char* at = begin;
  while (at != end && *at != '\n' && *at != '\r') ++at;
  line_ = left_.substr(0, static_cast<std::size_t>(at - begin));
  std::size_t taken = line_.size();
  const bool at_both = at != end && *at == '\r' && !end_at_returns_ && at + 1 != end && at[1] == '\n';
  ended_at_return_ = at != end && *at == '\r' && !at_both;
  if (at != end) taken += at_both ? 2 : 1;
  left_.remove_prefix(taken);
  at_ = ++passed_;
  return true;
}

void TextLines::fail_at(std::size_t line, const std::string& cause) const {
  throw Error(fmt::format("{}: line {}: {}", file_, line, cause));
}

float TextLines::finite(std::string_view word) const {
  const float value = number(word);
  if (!std::isfinite(value)) fail(fmt::format("{} is not finite", one_line(word, 40)));
  return value;
}

float TextLines::number(std::string_view word) const {
  const auto value = number_of(word);
  if (!value)
    fail(fmt::format("{} is {}", word.empty() ? "the line's end" : one_line(word, 40),
                     is_number(without_plus(word)) ? "too large" : "not a number"));
  return *value;
}

double TextLines::wide(std::string_view word) const {
  if (const auto narrow = number_of(word)) return static_cast<double>(*narrow);
  const std::string_view bare = without_plus(word);
  double value = 0;
  const auto [stop, error] = std::from_chars(bare.data(), bare.data() + bare.size(), value);
  if (error == std::errc() && stop == bare.data() + bare.size()) return value;
  return static_cast<double>(number(word));  // it fails
}

std::uint32_t TextLines::whole(std::string_view word, const char* what) const {
  const auto value = integer_of(word);
  if (!value || *value < 0 || *value > std::numeric_limits<std::uint32_t>::max())
    fail(fmt::format("{} is no {}", word.empty() ? "the line's end" : one_line(word, 40), what));
  return static_cast<std::uint32_t>(*value);
}

}  // namespace kage::scene
