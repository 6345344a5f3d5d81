// SPDX-License-Identifier: Apache-2.0
//
// Lines of a text file with their numbers, and words that are read strictly. A word is a number as a whole or not at
// all: "1,5" and "1.0D+01" are refused, though they begin like numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kage::scene {

/// The characters that part words.
inline constexpr std::string_view kBlanks = " \t\v\f";

/// The next word of `rest`, which loses it; empty at the end. Blanks, tabs, vertical tabs and form feeds part words.
std::string_view take_word(std::string_view& rest);

/// Without the blanks round it.
std::string_view trimmed(std::string_view text);

/// The nearest float of a decimal number, with or without sign, point and exponent; not a number and infinity too. A
/// number too small for a float is 0 or a denormal. None for any other word, and for a number that is too large.
std::optional<float> number_of(std::string_view word);

/// A decimal integer with or without sign; none for any other word, or beyond 64 bits.
std::optional<std::int64_t> integer_of(std::string_view word);

class TextLines {
 public:
  /// Takes a text, which must stay where it is. A byte order mark of UTF-8 is passed over. Throws Error if it is
  /// UTF-16. `file` is how messages call it.
  TextLines(std::string_view text, std::string file);

  /// Goes to the next line, the first at first. It ends at a line feed, a carriage return, or both. False at the end.
  bool next();

  /// Whether the line ended at a carriage return without a line feed.
  [[nodiscard]] bool ended_at_return() const { return ended_at_return_; }
  /// From here on a carriage return ends a line by itself: a line feed behind it is something else.
  void end_at_returns() { end_at_returns_ = true; }

  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::size_t at() const { return at_; }           ///< the line's number, from 1
  [[nodiscard]] std::string_view left() const { return left_; }  ///< what is behind the line
  [[nodiscard]] const std::string& file() const { return file_; }

  /// Throws Error with file and line.
  [[noreturn]] void fail(const std::string& cause) const { fail_at(at_, cause); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& cause) const;

  /// As number_of(), and finite. Throws Error with the word.
  [[nodiscard]] float finite(std::string_view word) const;
  /// As number_of(). Throws Error with the word.
  [[nodiscard]] float number(std::string_view word) const;
  /// number_of(), and where that is too large for a float, the nearest double. Throws Error with the word.
  [[nodiscard]] double wide(std::string_view word) const;
  /// An integer from 0 to 2^32 - 1. Throws Error with the word, "... is no " `what`.
  [[nodiscard]] std::uint32_t whole(std::string_view word, const char* what) const;

 protected:
  /// Messages name the line of this number until the next().
  void set_at(std::size_t line) { at_ = line; }

 private:
  std::string file_;
  std::string_view left_;
  std::string_view line_;
  std::size_t at_ = 0;
  std::size_t passed_ = 0;  // lines
  bool ended_at_return_ = false;
  bool end_at_returns_ = false;
};

}  // namespace kage::scene
