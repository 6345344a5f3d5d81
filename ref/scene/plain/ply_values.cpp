// SPDX-License-Identifier: Apache-2.0
#include "scene/plain/ply_values.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "kage/error.hpp"
#include "number/counted.hpp"
#include "scene/notes.hpp"

namespace kage::scene {
namespace {

/// The least and the largest value of a whole type.
std::pair<double, double> range_of(PlyType type) {
  const auto bits = static_cast<int>(8 * size_of(type));
  const bool is_signed = type == PlyType::kInt8 || type == PlyType::kInt16 || type == PlyType::kInt32;
  if (is_signed) return {-std::ldexp(1.0, bits - 1), std::ldexp(1.0, bits - 1) - 1};
  return {0, std::ldexp(1.0, bits) - 1};
}

template <typename T, typename Bits>
double as(std::uint64_t bits) {
  return static_cast<double>(std::bit_cast<T>(static_cast<Bits>(bits)));
}

}  // namespace

PlyValues::PlyValues(TextLines& lines, PlyHeader::Form form) : lines_(lines), form_(form), left_(lines.left()) {}

void PlyValues::begin(const PlyElement& element, std::uint64_t number) {
  element_ = &element;
  number_ = number;
  if (form_ != PlyHeader::Form::kAscii) return;
  do {
    if (!lines_.next())
      lines_.fail(fmt::format("the file ends behind {} of {} of element {}", number, element.count,
                              one_line(element.name, 40)));
    left_ = trimmed(lines_.line());
  } while (left_.empty());
}

double PlyValues::value(PlyType type) {
  return form_ == PlyHeader::Form::kAscii ? text_value(type) : binary_value(type);
}

double PlyValues::finite(PlyType type) {
  const double v = value(type);
  if (!std::isfinite(v)) fail("a number is not finite");
  return v;
}

double PlyValues::text_value(PlyType type) {
  const std::string_view word = take_word(left_);
  if (word.empty()) lines_.fail("the line has too few numbers for element " + one_line(element_->name, 40));
  if (type == PlyType::kDouble) return lines_.wide(word);
  if (!is_integer(type)) return static_cast<double>(lines_.number(word));
  const auto whole = integer_of(word);
  const auto [least, most] = range_of(type);
  if (!whole || static_cast<double>(*whole) < least || static_cast<double>(*whole) > most)
    lines_.fail(fmt::format("{} is no whole number from {} to {}", one_line(word, 40), least, most));
  return static_cast<double>(*whole);
}

double PlyValues::binary_value(PlyType type) {
  const std::size_t size = size_of(type);
  if (left_.size() < size) fail("the file ends within it");
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t at = form_ == PlyHeader::Form::kBig ? i : size - 1 - i;
    bits = bits << 8 | static_cast<unsigned char>(left_[at]);
  }
  left_.remove_prefix(size);
  switch (type) {
    case PlyType::kInt8:
      return as<std::int8_t, std::uint8_t>(bits);
    case PlyType::kInt16:
      return as<std::int16_t, std::uint16_t>(bits);
    case PlyType::kInt32:
      return as<std::int32_t, std::uint32_t>(bits);
    case PlyType::kFloat:
      return as<float, std::uint32_t>(bits);
    case PlyType::kDouble:
      return std::bit_cast<double>(bits);
    default:
      return static_cast<double>(bits);
  }
}

std::uint64_t PlyValues::length(PlyType type, PlyType of_values) {
  const double length = value(type);
  if (length < 0) fail(fmt::format("a list of length {}", length));
  // In text each value takes a character and a blank.
  const std::size_t least = form_ == PlyHeader::Form::kAscii ? 2 : size_of(of_values);
  if (length * static_cast<double>(least) > static_cast<double>(left_.size()) + 1)
    fail(fmt::format("a list of length {} is longer than what is left", length));
  return static_cast<std::uint64_t>(length);
}

void PlyValues::end() const {
  if (form_ == PlyHeader::Form::kAscii && !trimmed(left_).empty())
    lines_.fail(
        fmt::format("'{}' is too much for element {}", one_line(trimmed(left_), 40), one_line(element_->name, 40)));
}

bool PlyValues::has_more() {
  if (form_ != PlyHeader::Form::kAscii) return !left_.empty();
  while (lines_.next())
    if (!trimmed(lines_.line()).empty()) return true;
  return false;
}

void PlyValues::fail(const std::string& cause) const {
  if (form_ == PlyHeader::Form::kAscii) lines_.fail(cause);
  throw Error(fmt::format("{}: element {} {}: {}", lines_.file(), one_line(element_->name, 40), number_, cause));
}

void PlyValues::check_room(const PlyElement& element) const {
  const std::size_t least = element.least_size();
  if (form_ == PlyHeader::Form::kAscii || least == 0 || element.count <= left_.size() / least) return;
  throw Error(fmt::format("{}: {} of element {} do not fit into the {} left", lines_.file(), element.count,
                          one_line(element.name, 40), counted(left_.size(), "byte")));
}

}  // namespace kage::scene
