// SPDX-License-Identifier: Apache-2.0
#include "file/shown.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "file/one_line.hpp"

namespace kage {

std::string shown(const std::string& text) {
  constexpr std::size_t kMost = 4096;
  const bool plain = std::none_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7F;
  });
  return plain ? text : one_line(text, kMost);
}

std::string quoted(const std::string& text) {
  const auto plain = [](char c) {
    return (std::isalnum(static_cast<unsigned char>(c)) != 0) ||
           std::string_view("_./,:=+-@%").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out + "'";
}

}  // namespace kage
